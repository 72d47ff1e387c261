#include "convert/converted_files.h"

#include "domelight/image/cube_layout.h"
#include "domelight/io/file/atomic_file.h"
#include "domelight/io/file/file_extension.h"
#include "domelight/io/write_image.h"

#include "base/field_place.h"
#include "io/file/input_guard.h"
#include "preview/screen_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

namespace domelight {
namespace {

std::vector<std::string> layouts_of(const Projection& projection, const std::string& file) {
    if (projection.charts() == 2) return {"side-by-side", "files"};
    if (projection.charts() == 1) return {"picture"};
    if (has_texture_ending(file)) return {"cube"};
    if (projection.grid() == SampleGrid::both_on_edges) return {"envmap"};
    std::vector<std::string> all = cube_layout_names();
    all.push_back("faces");
    return all;
}

std::vector<std::string> encodings_of(const std::string& file) {
    const std::string extension = lower_case_extension(file);
    if (extension == ".exr") return {"auto", "half", "float"};
    if (extension == ".hdr") return {"rgbe"};
    if (is_screen_picture(file)) return {"srgb"};
    std::vector<std::string> all;
    const auto add = [&](std::initializer_list<Encoding> encodings) {
        for (const Encoding encoding : encodings) all.push_back(name_of(encoding));
    };
    add({Encoding::rgba16f, Encoding::rgba32f, Encoding::rgb9e5, Encoding::r11g11b10f, Encoding::bc6h});
    if (extension != ".dds") add({Encoding::astc4x4_hdr, Encoding::astc6x6_hdr});
    if (extension == ".ktx2") add({Encoding::uastc_hdr, Encoding::rgbm, Encoding::rgbd, Encoding::rgbp});
    return all;
}

ImageF side_by_side(const ProjectedImage& image) {
    const int w = image.width(), h = image.height();
    ImageF out(2 * w, h, 3);
    for (int y = 0; y < h; ++y)
        for (int c = 0; c < 2; ++c) std::copy_n(image.pixels.row(c * h + y), 3 * w, out.at(c * w, y));
    return out;
}

/// What goes into one file: pixels that lie in the image, or are laid out anew.
struct Picture {
    std::string suffix;
    ImageF owned;
    ImageView<const float> pixels;
};

std::vector<Picture> pictures(const ProjectedImage& image, const std::string& layout) {
    std::vector<Picture> list;
    if (layout == "files" || layout == "faces") {
        static const std::vector<std::string> halves{"_front", "_back"},
            faces{"_px", "_nx", "_py", "_ny", "_pz", "_nz"};
        const auto& names = layout == "files" ? halves : faces;
        for (std::size_t c = 0; c < names.size(); ++c)
            list.push_back({names[c], {}, image.pixels.view().rows(int(c) * image.height(), image.height())});
        return list;
    }
    list.emplace_back();
    if (layout == "side-by-side") list[0].owned = side_by_side(image);
    if (image.projection.charts() == 6 && layout != "envmap")
        list[0].owned = cube_layout(Cubemap(image.pixels), layout);
    list[0].pixels = list[0].owned.empty() ? image.pixels.view() : std::as_const(list[0].owned).view();
    return list;
}

/// Turns directions about `axis` (of any length) by `angle`, in the sense of rotation_y. (Rodrigues' formula.)
Mat3 rotation(const Vec3d& axis, double angle) {
    const Vec3d k = normalize(axis);
    const double c = std::cos(angle), s = -std::sin(angle);
    const auto column = [&](const Vec3d& v) { return v * c + cross(k, v) * s + k * (dot(k, v) * (1 - c)); };
    return Mat3{{column({1, 0, 0}), column({0, 1, 0}), column({0, 0, 1})}}.transposed();
}

/// The picture as a level to encode.
FilteredMap as_level(const ProjectedImage& image) {
    if (image.projection.charts() == 6) return {Layout::cube, image.pixels};
    return {Layout::latlong, image.projection.charts() == 2 ? side_by_side(image) : image.pixels};
}

Result<void> write_picture(const std::string& file, ImageView<const float> picture, const ProjectedImage& image,
                           const ConvertOutput& output) {
    const std::string extension = lower_case_extension(file);
    if (extension == ".hdr") return write_hdr(file, picture, output.threads);
    if (is_screen_picture(file))
        return write_screen_picture(file, screen_picture(picture, {}, output.display, output.threads));
    ExrWriteOptions exr;
    exr.half = output.encoding == "half";
    exr.threads = output.threads;
    if (image.projection.grid() == SampleGrid::both_on_edges)
        exr.envmap = image.projection.charts() == 6 ? "cube" : "latlong";
    return write_exr(file, picture, exr);
}

}  // namespace

std::span<const std::string> converted_file_extensions() {
    static const std::vector<std::string> all{".hdr", ".exr", ".png", ".jpg", ".jpeg", ".ktx2", ".ktx", ".dds"};
    return all;
}

bool has_texture_ending(const std::string& file) {
    const std::string extension = lower_case_extension(file);
    return extension == ".ktx2" || extension == ".ktx" || extension == ".dds";
}

Result<std::pair<int, int>> chart_size(const Projection& target, int height) {
    const std::int64_t width = std::llround(height * target.shape().aspect());
    const std::int64_t bytes = width * height * target.charts() * 12;
    if (bytes > std::int64_t(4) << 30)
        return Error{
            fmt::format("{} x {} texels a picture need {} bytes, more than the limit of 4 GiB", width, height, bytes),
            field_place("size"), ""};
    return std::pair{int(width), height};
}

Result<Mat3> light_turn(std::span<const std::array<double, 4>> rotations, const std::string& mirror) {
    Mat3 turn;
    for (const auto& v : rotations) {
        const Vec3d axis{v[0], v[1], v[2]};
        if (!(length(axis) > 0) || !std::isfinite(length(axis)) || !std::isfinite(v[3]))
            return Error{fmt::format("({:g}, {:g}, {:g}), {:g} degrees has no axis", v[0], v[1], v[2], v[3]),
                         field_place("rotate"), "An axis and degrees: 0,0,1,90."};
        // Quarter turns about an axis of the world only exchange axes: exactly.
        Mat3 m = rotation(axis, v[3] * k_pi / 180);
        for (Vec3d& row : m.row)
            for (double* e : {&row.x, &row.y, &row.z})
                if (std::abs(*e - std::round(*e)) < 1e-14) *e = std::round(*e);
        turn = m * turn;
    }
    if (mirror.empty()) return turn;
    Mat3 mirrored;
    const std::size_t axis = std::string_view("xyzXYZ").find(mirror);
    if (mirror.size() != 1 || axis == std::string_view::npos)
        return Error{fmt::format("\"{}\" is not an axis", mirror), field_place("mirror"), "Accepted: x, y, z."};
    double* const diagonal[] = {&mirrored.row[0].x, &mirrored.row[1].y, &mirrored.row[2].z};
    *diagonal[axis % 3] = -1;
    return mirrored * turn;
}

double automatic_ev_of_sphere(const ProjectedImage& image) {
    ImageF weights(image.width(), image.height() * image.projection.charts(), 1);
    std::vector<double> row(std::size_t(image.width()));
    for (int y = 0; y < weights.height(); ++y) {
        image.projection.texel_solid_angles(y % image.height(), image.width(), image.height(), row);
        // Times the number of texels, so that the weights do not get small with the picture's size.
        for (int x = 0; x < image.width(); ++x)
            *weights.at(x, y) = float(row[std::size_t(x)] * image.width() * image.height());
    }
    return automatic_ev(image.pixels, weights);
}

Result<void> check_converted_files(ConvertOutput& output, const Projection& projection) {
    const std::string extension = lower_case_extension(output.file);
    const auto formats = converted_file_extensions();
    if (std::ranges::find(formats, extension) == formats.end())
        return Error{fmt::format("\"{}\" ends in none of the formats", output.file), "OUT",
                     fmt::format("Accepted: {}.", fmt::join(formats, ", "))};
    const auto check = [&](std::string& value, const char* field, const std::vector<std::string>& accepted,
                           const std::string& of) -> Result<void> {
        if (value.empty()) value = accepted[0];
        if (std::find(accepted.begin(), accepted.end(), value) != accepted.end()) return {};
        return Error{fmt::format("\"{}\" does not go with {}", value, of), field_place(field),
                     fmt::format("Accepted: {}.", fmt::join(accepted, ", "))};
    };
    if (auto ok = check(output.layout, "layout", layouts_of(projection, output.file),
                        fmt::format("{} in {}", projection.name(), extension));
        !ok)
        return ok;
    if (output.layout == "envmap" && extension != ".exr")
        return Error{"cube/openexr is OpenEXR's own", field_place("to"), "Write an .exr, or convert to cube."};
    return check(output.encoding, "encoding", encodings_of(output.file), extension);
}

Result<WrittenPicture> write_projected(const ProjectedImage& image, const ConvertOutput& asked) {
    const std::string extension = lower_case_extension(asked.file);
    WrittenPicture written;
    ConvertOutput output = asked;
    if (asked.encoding == "auto") {
        written.widened = !fits_half(image.pixels.view());
        output.encoding = written.widened ? "float" : "half";
    }
    written.encoding_name = output.encoding;
    if (has_texture_ending(asked.file)) {
        const FilteredMap level = as_level(image);
        std::vector<EncodingReport> reports;
        const Texture texture =
            encode_texture({&level, 1}, *from_name<Encoding>(output.encoding), output.threads, &reports);
        written.encoding = reports[0];
        written.files = {output.file};
        const auto ok = extension == ".ktx2"  ? write_ktx2(output.file, texture)
                        : extension == ".ktx" ? write_ktx1(output.file, texture)
                                              : write_dds(output.file, texture);
        if (!ok) return ok.error().at(output.file);
        return written;
    }
    if (extension == ".exr" && output.encoding == "half") {
        const FilteredMap level = as_level(image);
        std::vector<EncodingReport> reports;
        encode_texture({&level, 1}, Encoding::rgba16f, output.threads, &reports);
        written.encoding = reports[0];
    }
    const std::filesystem::path path = output.file;
    const std::vector<Picture> all = pictures(image, output.layout);
    const auto file_of = [&](const Picture& picture) {
        return (path.parent_path() / (path.stem().string() + picture.suffix + path.extension().string())).string();
    };
    for (const Picture& picture : all)
        if (!picture.suffix.empty())
            if (auto ok = check_not_an_input(file_of(picture), output.inputs); !ok) return ok.error();
    FileGroup group;
    for (const Picture& picture : all) {
        const auto write = [&](const std::filesystem::path& place) {
            return write_picture(place.string(), picture.pixels, image, output);
        };
        if (auto ok = group.write(file_of(picture), write); !ok) return ok.error();
        written.files.push_back(file_of(picture));
    }
    if (auto ok = group.commit(); !ok) return ok.error();
    return written;
}

}  // namespace domelight
