#include "cli/convert/convert_output.h"

#include "domelight/image/cube_layout.h"
#include "domelight/io/file/atomic_file.h"
#include "domelight/io/file/file_extension.h"
#include "domelight/io/write_image.h"

#include "cli/console/arguments.h"
#include "cli/console/output_endings.h"
#include "io/file/input_guard.h"
#include "preview/screen_picture.h"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <utility>

namespace domelight::cli {
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

Result<void> check_output(ConvertOutput& output, const Projection& projection) {
    const std::string extension = lower_case_extension(output.file);
    static const std::vector<std::string> formats{".hdr", ".exr", ".png", ".jpg", ".jpeg", ".ktx2", ".ktx", ".dds"};
    if (auto ok = check_ending("OUT", output.file, formats); !ok) return ok;
    const auto check = [&](std::string& value, const char* option, const std::vector<std::string>& accepted,
                           const std::string& of) -> Result<void> {
        if (value.empty()) value = accepted[0];
        if (std::find(accepted.begin(), accepted.end(), value) != accepted.end()) return {};
        return Error{fmt::format("\"{}\" does not go with {}", value, of), option,
                     "Accepted: " + join(accepted, ", ") + "."};
    };
    if (auto ok = check(output.layout, "--layout", layouts_of(projection, output.file),
                        fmt::format("{} in {}", projection.name(), extension));
        !ok)
        return ok;
    if (output.layout == "envmap" && extension != ".exr")
        return Error{"cube/openexr is OpenEXR's own", "--to", "Write an .exr, or convert to cube."};
    return check(output.encoding, "--encoding", encodings_of(output.file), extension);
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

}  // namespace domelight::cli
