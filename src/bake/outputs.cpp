#include "bake/outputs.h"

#include "domelight/image/cube_layout.h"
#include "domelight/io/write_image.h"

#include "bake/engine_files.h"
#include "io/file/sha256.h"
#include "texture/chain_encoder.h"
#include "texture/container/texture_stream.h"

#include <fmt/core.h>

#include <exception>
#include <memory>
#include <new>

namespace domelight {

void Background::start(std::function<Result<void>()> task) {
    if (at_once_) {
        done(task());
    } else {
        tasks_.push_back(in_background<Result<void>>(std::move(task)));
    }
}

void Background::done(Result<void> result) {
    tasks_.push_back(finished_task(std::move(result)));
}

namespace {

/// What a task returned. A lack of memory in it is an error like any other.
Result<void> outcome_of(BackgroundTask<Result<void>>& task) {
    try {
        return task.get();
    } catch (const std::bad_alloc&) {
        return Error{"not enough memory", "", ""};
    } catch (const std::exception& e) {
        return Error{e.what(), "", ""};
    }
}

}  // namespace

Result<void> Background::wait() {
    Result<void> first;
    for (auto& task : tasks_) {
        Result<void> result = outcome_of(task);
        if (first && !result) first = result;
    }
    tasks_.clear();
    return first;
}

Result<void> hash_into(BakedFile& file, const std::filesystem::path& written, bool hashes) {
    if (!hashes) return {};
    auto hash = sha256_file(written);
    if (!hash) return hash.error();
    file.sha256 = *std::move(hash);
    return {};
}

std::string expand_stem(std::string name, const std::string& stem) {
    const auto at = name.find("{stem}");
    return at == std::string::npos ? name : name.replace(at, 6, stem);
}

void take_reports(BakedMap& report, const std::vector<EncodingReport>& encoded) {
    for (std::size_t l = 0; l < report.levels.size() && l < encoded.size(); ++l) report.levels[l].encoding = encoded[l];
}

Texture encode_chain(BakedMap& report, std::span<const FilteredMap> levels, const MapFormat& format,
                     const BakeOptions& options) {
    ChainEncoder encoder(levels, format.encoding, {}, EncodingQuality::standard, format.order);
    Texture texture = encode_in_memory(encoder, options.threads);
    take_reports(report, encoder.reports());
    return texture;
}

namespace {

const char* const k_face_names[] = {"px", "nx", "py", "ny", "pz", "nz"};

Result<TextureLayout> layout_of(const ChainEncoder& encoder, Container container) {
    const auto bytes = encoder.level_bytes();
    switch (container) {
        case Container::ktx1:
            return ktx1_layout(encoder.head(), bytes);
        case Container::dds:
            return dds_layout(encoder.head(), bytes);
        case Container::dds9:
            return dds9_layout(encoder.head(), bytes);
        default:
            return ktx2_layout(encoder.head(), bytes, Supercompression::none, bytes);
    }
}

/// Compressed levels must be complete before the position of the first byte is known, so they are encoded now; the rest
/// is done in the background.
void write_compressed_chain(BakedMap& report, std::span<const FilteredMap> levels, const MapFormat& format,
                            const BakeOptions& options, const std::filesystem::path& path, Background& background) {
    ChainEncoder encoder(levels, format.encoding, format.metadata, options.encoding_quality, format.order);
    auto texture = std::make_shared<Texture>(encode_in_memory(encoder, options.threads));
    take_reports(report, encoder.reports());
    background.start([texture, path, &file = report.file, hashes = options.hashes]() -> Result<void> {
        if (auto ok = write_ktx2(path, *texture, Supercompression::zstd); !ok) return ok;
        return hash_into(file, path, hashes);
    });
}

Result<void> write_plain_chain(BakedMap& report, std::span<const FilteredMap> levels, const MapFormat& format,
                               const BakeOptions& options, const std::filesystem::path& path) {
    ChainEncoder encoder(levels, format.encoding, format.metadata, options.encoding_quality, format.order);
    const auto layout = layout_of(encoder, format.container);
    if (!layout) return layout.error().at(path.string());
    auto hash = encode_to_file(path, encoder, *layout, options.threads, options.hashes);
    if (!hash) return hash.error();
    report.file.sha256 = *std::move(hash);
    take_reports(report, encoder.reports());
    return {};
}

void write_chain(BakedMap& report, std::span<const FilteredMap> levels, const MapFormat& format,
                 const BakeOptions& options, Staging& staging, Background& background) {
    report.file.file = format.name + container_extension(format.container);
    const auto path = staging.stage(report.file.file);
    if (is_engine_file(format.container))
        write_engine_file(report, levels, format, options, path, background);
    else if (format.container == Container::ktx2 && format.zstd)
        write_compressed_chain(report, levels, format, options, path, background);
    else
        background.done(write_plain_chain(report, levels, format, options, path));
}

/// One picture, written and hashed in the background.
void write_picture(BakedFile& file, ImageF picture, const MapFormat& format, const BakeOptions& options,
                   Staging& staging, Background& background) {
    const auto path = staging.stage(file.file);
    auto pixels = std::make_shared<ImageF>(std::move(picture));
    background.start([pixels, path, format, &file, hashes = options.hashes]() -> Result<void> {
        if (format.container == Container::hdr) {
            if (auto ok = write_hdr(path, pixels->view()); !ok) return ok;
        } else {
            ExrWriteOptions exr;
            exr.half = format.encoding == Encoding::rgba16f;
            exr.attributes = format.metadata;
            if (format.envmap == "latlong") exr.envmap = format.envmap;  // pictures of cubes are not OpenEXR's
            if (auto ok = write_exr(path, pixels->view(), exr); !ok) return ok;
        }
        return hash_into(file, path, hashes);
    });
}

ImageF copy_face(const FilteredMap& cube, int f) {
    const auto from = cube.face(f);
    ImageF face = ImageF::uninitialized(from.width, from.height, from.channels);
    std::copy_n(from.data, face.pixels().size(), face.pixels().begin());
    return face;
}

/// The pictures that one level becomes, with the suffix of each one's name.
std::vector<std::pair<std::string, ImageF>> level_pictures(FilteredMap level, CubePicture layout) {
    std::vector<std::pair<std::string, ImageF>> pictures;
    if (level.layout == Layout::latlong) {
        pictures.emplace_back("", std::move(level.image));
    } else if (layout == CubePicture::faces) {
        for (int f = 0; f < 6; ++f) pictures.emplace_back(std::string("_") + k_face_names[f], copy_face(level, f));
    } else {
        pictures.emplace_back("", cube_layout(std::move(level).cube(), name_of(layout)));
    }
    return pictures;
}

void write_pictures(BakedMap& report, std::span<const FilteredMap> levels, const MapFormat& format,
                    const BakeOptions& options, Staging& staging, Background& background) {
    if (format.container == Container::hdr)
        take_reports(report, rgbe_reports(levels, format.order));
    else if (format.encoding == Encoding::rgba16f)  // half floats clip alike in every container
        encode_chain(report, levels, format, options);
    for (std::size_t l = 0; l < levels.size(); ++l) {
        auto pictures = level_pictures(format.order.apply(levels[l]), format.cube_picture);
        report.levels[l].files.resize(pictures.size());
        const std::string number = levels.size() > 1 ? fmt::format("_{}", l) : "";
        for (std::size_t p = 0; p < pictures.size(); ++p) {
            BakedFile& file = report.levels[l].files[p];
            file.file = format.name + number + pictures[p].first + container_extension(format.container);
            write_picture(file, std::move(pictures[p].second), format, options, staging, background);
        }
    }
}

/// Whether the map's OpenEXR files are to hold floats, although halves were planned, because halves would clip.
bool is_widened(std::span<const FilteredMap> levels, const MapFormat& format) {
    const bool openexr = format.container == Container::exr || format.container == Container::exr_mip;
    if (!openexr || !format.widen_for_range || format.encoding != Encoding::rgba16f) return false;
    return !std::all_of(levels.begin(), levels.end(),
                        [](const FilteredMap& level) { return fits_half(level.image.view()); });
}

}  // namespace

void write_map(BakedMap& report, std::span<const FilteredMap> levels, const MapFormat& planned,
               const BakeOptions& options, Staging& staging, Background& background) {
    MapFormat format = planned;
    report.widened = is_widened(levels, planned);
    if (report.widened) format.encoding = Encoding::rgba32f;
    report.encoding = format.container == Container::hdr ? "rgbe" : name_of(format.encoding);
    report.container = name_of(format.container);
    report.zstd = format.zstd;
    if (format.container == Container::exr || format.container == Container::hdr) {
        write_pictures(report, levels, format, options, staging, background);
    } else {
        write_chain(report, levels, format, options, staging, background);
    }
}

}  // namespace domelight
