#include "converting.h"

#include "domelight/io/environment/convert.h"
#include "domelight/io/file/file_extension.h"
#include "domelight/io/write_image.h"
#include "domelight/projection/projections.h"
#include "domelight/texture/texture.h"

#include "base/field_place.h"
#include "environment.h"
#include "keywords.h"
#include "maps.h"
#include "preview/screen_picture.h"
#include "work.h"

#include <fmt/format.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/map.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

namespace domelight::python {
namespace {

nb::dict run_convert(const Environment& environment, const std::string& to, const nb::dict& dictionary,
                     const nb::object& progress) {
    const Keywords words(dictionary);
    const auto target = projection_from_name(to);
    if (!target) throw Failure(target.error().at(field_place("to")));
    ConvertOptions options;
    options.height = matched_height(environment, *target);
    words.read("size", options.height);
    words.read("sharp", options.sharp);
    words.read("turn", options.turn);
    words.read("threads", options.threads);
    if (options.height < 1 || options.height > 32768)
        throw Failure({fmt::format("{} is not from 1 to 32768", options.height), field_place("size"), ""});
    options.width = int(std::llround(options.height * target->shape().aspect()));
    Conversion made = run_work_for(progress, [&](const Progress& report) {
        options.progress = report;
        return value_of(convert(environment, *target, options));
    });
    const std::size_t charts = std::size_t(target->charts()), height = std::size_t(made.image.height()),
                      width = std::size_t(made.image.width());
    nb::dict told;
    told["power_before"] = tuple_of(made.power_before);
    told["power_after"] = tuple_of(made.power_after);
    told["method"] = made.method;
    told["array"] = charts == 1 ? numpy_of(std::move(made.image.pixels), {height, width, 3})
                                : numpy_of(std::move(made.image.pixels), {charts, height, width, 3});
    return told;
}

int channels_of(nb::handle array) {
    AnyArray any;
    if (!nb::try_cast(array, any, false) || any.ndim() < 3) return 1;
    return int(any.shape(any.ndim() - 1));
}

/// Bytes of a picture as they are.
bool write_bytes(const std::filesystem::path& file, nb::handle array) {
    nb::ndarray<const std::uint8_t, nb::c_contig, nb::device::cpu> bytes;
    if (!nb::try_cast(array, bytes, false)) return false;
    const std::size_t axes = bytes.ndim();
    const int channels = axes == 2 ? 1 : axes == 3 ? int(bytes.shape(2)) : 0;
    if (channels != 1 && channels != 3 && channels != 4)
        throw Failure({"expected bytes of shape (height, width), (height, width, 3) or (height, width, 4)",
                       field_place("image"), ""});
    if (!is_screen_picture(file))
        throw Failure({"eight bits a channel go into .png or .jpg", field_place("image"),
                       "Other formats hold radiance: pass float32."});
    const ImageView<const std::uint8_t> view(bytes.data(), int(bytes.shape(1)), int(bytes.shape(0)), channels);
    run_work(nb::none(), [&](const Progress&) { value_of(write_screen_picture(file, view)); });
    return true;
}

ExrWriteOptions exr_options(const Keywords& words) {
    ExrWriteOptions options;
    words.read("half", options.half);
    words.read("compression", options.compression);
    words.read("envmap", options.envmap);
    words.read("threads", options.threads);
    return options;
}

/// How a picture for a screen is shown.
struct ScreenWords {
    Tonemap tonemap = Tonemap::agx;
    std::optional<double> ev;
    int threads = 0;
    explicit ScreenWords(const Keywords& words) {
        words.read("tonemap", tonemap);
        words.read("ev", ev);
        words.read("threads", threads);
    }
};

void write_for_screen(const std::filesystem::path& file, ImageView<const float> view, const ScreenWords& words) {
    const Display display{words.tonemap, float(std::exp2(words.ev ? *words.ev : automatic_ev(view)))};
    value_of(write_screen_picture(file, screen_picture(view, {}, display, words.threads)));
}

/// An image of float numbers, in the format of the file's ending.
void write_floats(const std::filesystem::path& file, nb::handle array, const Keywords& words) {
    const int channels = channels_of(array);
    const std::string extension = lower_case_extension(file);
    const bool exr = extension == ".exr";
    const int wanted = exr ? std::min(channels, 4) : 3;
    const ArrayImage image(ArrayPixels::borrow(array, wanted, "image"));
    const ExrWriteOptions options = exr_options(words);
    const ScreenWords screen(words);
    run_work(nb::none(), [&](const Progress&) {
        if (exr) return value_of(write_exr(file, image.view(), options));
        if (extension == ".hdr") return value_of(write_hdr(file, image.view(), options.threads));
        write_for_screen(file, image.view(), screen);
    });
}

void write_image(const std::filesystem::path& file, nb::handle array, const nb::dict& dictionary) {
    const Keywords words(dictionary);
    const std::string extension = lower_case_extension(file);
    if (extension != ".exr" && extension != ".hdr" && !is_screen_picture(file))
        throw Failure({fmt::format("\"{}\" is not an ending of an image", extension), field_place("file"),
                       "Accepted: .hdr, .exr, .png, .jpg; for textures .ktx2, .ktx, .dds."});
    if (!write_bytes(file, array)) write_floats(file, array, words);
}

/// A chain of levels as one texture.
nb::list write_texture(const std::filesystem::path& file, nb::handle levels, const nb::dict& dictionary) {
    const Keywords words(dictionary);
    const std::vector<FilteredMap> maps = maps_of(levels, "image");
    for (std::size_t l = 1; l < maps.size(); ++l)
        if (maps[l].width() != std::max(1, maps[0].width() >> l))
            throw Failure({fmt::format("level {} is {} wide, expected {}", l, maps[l].width(),
                                       std::max(1, maps[0].width() >> l)),
                           field_place("image"), "Each level of a texture is half as large as the one before."});
    Encoding encoding = Encoding::rgba16f;
    EncodingQuality quality = EncodingQuality::standard;
    bool zstd = false;
    int threads = 0;
    words.read("encoding", encoding);
    words.read("encoding_quality", quality);
    words.read("zstd", zstd);
    words.read("threads", threads);
    if (encoding_channels(encoding) != 3)
        throw Failure({name_of(encoding) + " has no room for a colour", field_place("encoding"), ""});
    std::map<std::string, std::string> metadata;
    if (words.has("metadata")) metadata = nb::cast<std::map<std::string, std::string>>(words.find("metadata"));
    const std::string extension = lower_case_extension(file);
    std::vector<EncodingReport> reports;
    run_work(nb::none(), [&](const Progress&) {
        Texture texture = encode_texture(maps, encoding, threads, &reports, quality);
        texture.metadata = metadata;
        const Result<void> done =
            extension == ".ktx2"  ? write_ktx2(file, texture, zstd ? Supercompression::zstd : Supercompression::none)
            : extension == ".ktx" ? write_ktx1(file, texture)
                                  : write_dds(file, texture);
        if (!done) throw Failure(done.error().at(file.string()));
    });
    nb::list told;
    for (const EncodingReport& report : reports) {
        nb::dict of_level;
        of_level["clipped_texels"] = report.clipped_texels;
        of_level["clipped_energy"] = report.clipped_energy;
        of_level["rms_error"] = report.rms_error;
        of_level["log_psnr"] = report.log_psnr;
        told.append(of_level);
    }
    return told;
}

/// The levels of a texture as arrays, with its metadata.
nb::dict read_levels(const std::filesystem::path& file) {
    const Texture texture = run_work_for(nb::none(), [&](const Progress&) {
        auto read = read_texture(file);
        if (!read) throw Failure(read.error().at(file.string()));
        return *std::move(read);
    });
    if (encoding_channels(texture.encoding) != 3)
        throw Failure({"texture has fewer than three channels: no colour", file.string(), ""});
    if (texture.faces != 6 && texture.width != 2 * texture.height)
        throw Failure({fmt::format("{} x {} texels are not a cube, nor a lat-long map", texture.width, texture.height),
                       file.string(), ""});
    nb::list maps;
    for (int l = 0; l < int(texture.levels.size()); ++l) {
        const int width = texture.level_width(l), height = texture.level_height(l);
        auto image = ImageF::uninitialized(width, texture.faces * height, 3);
        for (int f = 0; f < texture.faces; ++f) {
            const ImageF face = decode_texture(texture, l, f);
            for (int y = 0; y < height; ++y)
                for (int x = 0; x < width; ++x) std::copy_n(face.at(x, y), 3, image.at(x, f * height + y));
        }
        maps.append(array_of({texture.faces == 6 ? Layout::cube : Layout::latlong, std::move(image)}));
    }
    nb::dict told;
    told["maps"] = maps;
    told["metadata"] = texture.metadata;
    told["layout"] = texture.faces == 6 ? "cube" : "latlong";
    return told;
}

}  // namespace

void declare_converting(nb::module_& module) {
    module.def("convert", &run_convert, nb::arg("environment"), nb::arg("to"), nb::arg("options"),
               nb::arg("progress") = nb::none());
    module.def("read_levels", &read_levels, nb::arg("file"));
    module.def("write_image", &write_image, nb::arg("file"), nb::arg("array").none(), nb::arg("options"));
    module.def("write_texture", &write_texture, nb::arg("file"), nb::arg("levels"), nb::arg("options"));
}

}  // namespace domelight::python
