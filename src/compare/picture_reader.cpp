#include "domelight/compare/picture_reader.h"

#include "domelight/base/parallel.h"
#include "domelight/io/environment/open_environment.h"
#include "domelight/texture/texture.h"

#include "io/environment/cube_input.h"
#include "io/environment/cube_texture_reader.h"
#include "io/exr/exr_layers.h"
#include "io/file/printable.h"
#include "io/image_reader.h"
#include "io/picture/exif.h"
#include "io/picture/oriented_reader.h"
#include "io/picture/png_colour.h"
#include "io/picture/texture_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

namespace domelight {
namespace {

Result<Picture> read_texture_picture(const std::filesystem::path& file, const std::string& container, int level) {
    const Result<Texture> texture = read_texture(file);
    if (!texture) return texture.error().at(file.string());
    if (level < 0 || level >= int(texture->levels.size()))
        return Error{fmt::format("no level {}: the texture has {}", level, texture->levels.size()), file.string(), ""};
    Picture picture;
    picture.format = container;
    picture.cube = texture->faces == 6;
    const int width = texture->level_width(level), height = texture->level_height(level);
    picture.rgb = ImageF(width, height * texture->faces, 3);
    for (int f = 0; f < texture->faces; ++f) {
        const ImageF face = decode_texture(*texture, level, f);
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                std::copy_n(face.at(x, y), std::min(face.channels(), 3), picture.rgb.at(x, f * height + y));
    }
    return picture;
}

/// The picture itself, read by the reader of environments (which converts luminance and chroma, and other primaries).
Result<Picture> read_plain(std::shared_ptr<const FileBytes> bytes, const ReaderOptions& options) {
    auto opened = open_image_reader(std::move(bytes), options);
    if (!opened) return opened.error();
    ImageReader& reader = **opened;
    const ImageFacts& facts = reader.facts();
    if (std::int64_t(facts.width) * facts.height * 12 > options.max_bytes)
        return Error{fmt::format("{} x {} pixels need more memory than the limit of {} bytes", facts.width,
                                 facts.height, options.max_bytes),
                     "", ""};
    Picture picture;
    picture.rgb = ImageF(facts.width, facts.height, 3);
    constexpr int k_rows = 64;
    for (int y = 0; y < facts.height; y += k_rows)
        if (auto read = reader.read(picture.rgb.view().rows(y, std::min(k_rows, facts.height - y))); !read)
            return read.error();
    if (facts.to_rec709)
        for (int y = 0; y < facts.height; ++y)
            for (int x = 0; x < facts.width; ++x) {
                float* p = picture.rgb.at(x, y);
                const Vec3d v = *facts.to_rec709 * Vec3d{p[0], p[1], p[2]};
                p[0] = float(v.x), p[1] = float(v.y), p[2] = float(v.z);
            }
    picture.format = facts.format;
    picture.layer = facts.layer;
    picture.high_dynamic_range = facts.high_dynamic_range;
    if (picture.high_dynamic_range) picture.warnings = facts.warnings;  // the other warnings are about environments
    return picture;
}

Result<void> read_variance(ExrLayers& layers, const PictureOptions& options, Picture& picture) {
    for (const char* name : {"variance", "Variance"}) {
        const auto channels = layers.colour_of(name);
        if (!channels) continue;
        auto variance = layers.read(*channels);
        if (!variance) return variance.error();
        std::string samples;
        for (const char* s : {"samples", "samples.Y", "sample-count", "samples.samples"})
            if (samples.empty() && layers.has(s)) samples = s;
        if (options.variance == "sample" && samples.empty())
            return Error{"a variance of samples needs a channel \"samples\"", "", ""};
        if (options.variance == "sample") {
            const auto counts = layers.read(std::vector<std::string>{samples});
            if (!counts) return counts.error();
            for (std::size_t i = 0; i < counts->pixels().size(); ++i)
                for (int c = 0; c < 3; ++c) variance->pixels()[3 * i + c] /= std::max(counts->pixels()[i], 1.0f);
        }
        for (float& v : variance->pixels())
            if (!(v >= 0 && std::isfinite(v))) v = 0;
        picture.variance = std::move(*variance);
        return {};
    }
    return {};
}

Result<void> read_objects(ExrLayers& layers, Picture& picture) {
    for (const char* name : {"object", "object.id", "object.Y", "objectId", "id"}) {
        if (!layers.has(name)) continue;
        auto ids = layers.read(std::vector<std::string>{name});
        if (!ids) return ids.error();
        picture.objects = std::move(*ids);
        std::istringstream lines(layers.attribute("objects").value_or(""));
        for (std::string line; std::getline(lines, line) && picture.object_names.size() < 100000;)
            picture.object_names.push_back(printable(line, 60));
        return {};
    }
    return {};
}

/// The channel of opacity that goes with a layer. A layer without an opacity of its own has that of the whole picture.
std::string opacity_channel(const ExrLayers& layers, const std::string& layer) {
    const std::string own = layer.empty() ? "A" : layer + ".A";
    return layers.has(own) ? own : layers.has("A") ? "A" : "";
}

Result<void> read_exr_opacity(ExrLayers& layers, Picture& picture) {
    const std::string channel = opacity_channel(layers, picture.layer);
    if (channel.empty()) return {};
    auto opacity = layers.read(std::vector<std::string>{channel});
    if (!opacity) return opacity.error();
    picture.opacity = std::move(*opacity);
    return {};
}

/// Multiplies the colours with the opacity. PNG stores them unmultiplied, OpenEXR multiplied.
Result<void> read_png_opacity(const FileBytes& bytes, Picture& picture) {
    const auto texels = decode_png_texture(bytes.bytes());
    if (!texels) return texels.error();
    ImageF stored(texels->width, texels->height, 1), opacity(picture.rgb.width(), picture.rgb.height(), 1);
    bool opaque = true;
    for (std::size_t i = 0; i < stored.pixels().size(); ++i) {
        const std::uint8_t code = texels->rgba[4 * i + 3];
        opaque = opaque && code == 255;
        stored.pixels()[i] = float(code) / 255;
    }
    const auto exif = find_png_chunk(bytes.bytes(), "eXIf");
    const int orientation = exif ? exif_orientation(*exif) : 1;
    for (int y = 0; y < opacity.height(); ++y)
        for (int x = 0; x < opacity.width(); ++x) {
            *opacity.at(x, y) = *seen_texel(stored, orientation, x, y);
            for (int c = 0; c < 3; ++c) picture.rgb.at(x, y)[c] *= *opacity.at(x, y);
        }
    if (!opaque) picture.opacity = std::move(opacity);
    return {};
}

Result<Picture> read_exr_picture(std::shared_ptr<const FileBytes> bytes, const PictureOptions& options,
                                 const ReaderOptions& reader) {
    auto picture = read_plain(bytes, reader);
    if (!picture) return picture;
    const auto layers = open_exr_layers(bytes, reader);
    if (!layers) return picture;
    // The variance belongs to the picture, not to a layer. The sizes differ if the picture is the data window of an
    // environment.
    const bool same = (*layers)->width() == picture->rgb.width() && (*layers)->height() == picture->rgb.height();
    if (!same) return picture;
    if (options.layer.empty())
        if (auto ok = read_variance(**layers, options, *picture); !ok) return ok.error();
    if (options.opacity)
        if (auto ok = read_exr_opacity(**layers, *picture); !ok) return ok.error();
    if (auto ok = read_objects(**layers, *picture); !ok) return ok.error();
    return picture;
}

bool is_exr(const FileBytes& bytes) {
    const auto all = bytes.bytes();
    return all.size() >= 4 && all[0] == 0x76 && all[1] == 0x2f && all[2] == 0x31 && all[3] == 0x01;
}

}  // namespace

Result<Picture> read_picture(const std::filesystem::path& file, const PictureOptions& options) {
    auto bytes = FileBytes::open(file, options.max_bytes);
    if (!bytes) return bytes.error().at(file.string());
    const std::string container = texture_container((*bytes)->bytes());
    if (!container.empty() && !options.layer.empty()) return no_layers().at(file.string());
    if (!container.empty()) return read_texture_picture(file, container, options.level);
    ReaderOptions reader;
    reader.max_bytes = options.max_bytes;
    reader.threads = options.threads;
    reader.decode = options.decode;
    reader.layer = options.layer;
    reader.max_black = k_most_black_in_memory;
    auto picture = is_exr(**bytes) ? read_exr_picture(*bytes, options, reader) : read_plain(*bytes, reader);
    if (!picture) return picture.error().at(file.string());
    if (options.opacity && picture->format == "PNG")
        if (auto ok = read_png_opacity(**bytes, *picture); !ok) return ok.error().at(file.string());
    return picture;
}

namespace {

/// Whether a cell of a cross holds one colour, apart from the noise that JPEG leaves at its edges.
bool is_empty_cell(const ImageF& rgb, int column, int row, int n) {
    const int margin = std::min(8, n / 4);
    const float* first = rgb.at(column * n + margin, row * n + margin);
    for (int y = row * n + margin; y < (row + 1) * n - margin; ++y)
        for (int x = column * n + margin; x < (column + 1) * n - margin; ++x)
            for (int c = 0; c < 3; ++c)
                if (!(std::abs(rgb.at(x, y)[c] - first[c]) <= 0.01f * std::max(1.0f, std::abs(first[c])))) return false;
    return true;
}

/// Whether the cells that a cross of cube faces leaves unused are empty, as they are in a cross.
bool is_cross(const ImageF& rgb, CubeLayout layout) {
    using Cells = std::vector<std::array<int, 2>>;  // column, row
    const bool horizontal = layout == CubeLayout::horizontal_cross;
    const Cells unused = horizontal ? Cells{{0, 0}, {2, 0}, {3, 0}, {0, 2}, {2, 2}, {3, 2}}
                                    : Cells{{0, 0}, {2, 0}, {0, 2}, {2, 2}, {0, 3}, {2, 3}};
    const int n = rgb.width() / (horizontal ? 4 : 3);
    return std::all_of(unused.begin(), unused.end(),
                       [&](const auto& cell) { return is_empty_cell(rgb, cell[0], cell[1], n); });
}

}  // namespace

bool Picture::cut_out() const {
    for (std::size_t i = 0; i < opacity.pixels().size(); ++i)
        for (std::size_t c = 0; c < 3; ++c)
            if (opacity.pixels()[i] <= 0 && rgb.pixels()[3 * i + c] != 0) return false;
    return !opacity.empty();
}

namespace {

Result<PictureFacts> facts_of(std::shared_ptr<const FileBytes> bytes) {
    PictureFacts facts;
    const auto reader = open_image_reader(bytes, {});
    if (reader) {
        const ImageFacts& head = (*reader)->facts();
        facts.format = head.format;
        facts.width = head.width;
        facts.height = head.height;
        facts.environment = head.envmap != ImageFacts::Envmap::none;
    }
    if (!is_exr(*bytes)) return reader ? Result<PictureFacts>(facts) : reader.error();
    const auto layers = open_exr_layers(bytes, {});
    if (!layers) return reader ? Result<PictureFacts>(facts) : layers.error();
    facts.layers = (*layers)->layers();
    facts.channels = (*layers)->channels();
    if (reader) return facts;
    facts.format = "OpenEXR";  // a file without colour, for example one that holds only depth
    facts.width = (*layers)->width();
    facts.height = (*layers)->height();
    return facts;
}

}  // namespace

Result<PictureFacts> read_picture_facts(const std::filesystem::path& file) {
    const auto bytes = FileBytes::open(file, std::int64_t(1) << 30);
    if (!bytes) return bytes.error().at(file.string());
    if (const std::string container = texture_container((*bytes)->bytes()); !container.empty()) {
        const auto info = read_texture_info(file);
        if (!info) return info.error().at(file.string());
        PictureFacts facts;
        facts.format = container;
        facts.width = info->width;
        facts.height = info->height;
        facts.cube = info->faces == 6;
        return facts;
    }
    auto facts = facts_of(*bytes);
    if (!facts) return facts.error().at(file.string());
    return facts;
}

bool is_picture_of_its_own(const std::filesystem::path& file) {
    const auto facts = read_picture_facts(file);
    if (!facts || facts->environment || facts->cube) return false;
    if (facts->layers.size() > 1 || !has_environment_shape(facts->width, facts->height)) return true;
    const auto layout = cube_layout_of_shape(facts->width, facts->height);
    if (layout != CubeLayout::horizontal_cross && layout != CubeLayout::vertical_cross) return false;
    const auto picture = read_picture(file);
    return picture && !is_cross(picture->rgb, *layout);
}

Result<ImageF> read_number_image(const std::filesystem::path& file, const std::string& name) {
    auto bytes = FileBytes::open(file, std::int64_t(1) << 30);
    if (!bytes) return bytes.error().at(file.string());
    ReaderOptions options;
    options.decode = Decode::linear;
    options.max_black = k_most_black_in_memory;
    if (is_exr(**bytes)) {
        auto layers = open_exr_layers(*bytes, options);
        if (!layers) return layers.error().at(file.string());
        std::string channel = name;
        for (const char* usual : {"object", "Y", "R", "A"})
            if (channel.empty() && (*layers)->has(usual)) channel = usual;
        if (channel.empty()) channel = (*layers)->channels()[0];
        auto image = (*layers)->read(std::vector<std::string>{channel});
        if (!image) return image.error().at(file.string());
        return image;
    }
    const auto picture = read_plain(*bytes, options);
    if (!picture) return picture.error().at(file.string());
    ImageF image(picture->rgb.width(), picture->rgb.height(), 1);
    for (std::size_t i = 0; i < image.pixels().size(); ++i)
        image.pixels()[i] =
            picture->high_dynamic_range ? picture->rgb.pixels()[3 * i] : std::round(picture->rgb.pixels()[3 * i] * 255);
    return image;
}

}  // namespace domelight
