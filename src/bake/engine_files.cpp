#include "bake/engine_files.h"

#include "domelight/base/version.h"
#include "domelight/io/write_image.h"
#include "domelight/texture/container/babylon_env.h"

#include "scene/gltf/gltf_image_light.h"
#include "texture/container/playcanvas_atlas.h"

#include <fmt/core.h>

#include <memory>
#include <utility>

namespace domelight {
namespace {

/// Lets `write` make the file in the background, then hashes it.
void start_writing(BakedMap& report, const BakeOptions& options, const std::filesystem::path& path,
                   Background& background, std::function<Result<void>(const std::filesystem::path&)> write) {
    background.start([write = std::move(write), path, &file = report.file, hashes = options.hashes]() -> Result<void> {
        if (auto ok = write(path); !ok) return ok;
        return hash_into(file, path, hashes);
    });
}

void write_babylon(BakedMap& report, std::span<const FilteredMap> levels, const MapFormat& format,
                   const BakeOptions& options, const std::filesystem::path& path, Background& background) {
    auto env = std::make_shared<BabylonEnv>();
    env->cube = encode_chain(report, levels, format, options);
    env->irradiance = babylon_polynomial(format.radiance_sh);
    start_writing(report, options, path, background,
                  [env, threads = options.threads](const auto& file) { return write_env(file, *env, threads); });
}

void write_gltf(BakedMap& report, std::span<const FilteredMap> levels, const MapFormat& format,
                const BakeOptions& options, const std::filesystem::path& path, Background& background) {
    auto light = std::make_shared<GltfImageLightFile>();
    light->cube = encode_chain(report, levels, format, options);
    light->name = std::filesystem::path(format.name).filename().string();
    light->generator = fmt::format("Domelight {}", version());
    for (const Vec3d& v : sh_irradiance_over_pi(format.radiance_sh)) light->irradiance.push_back(v * k_pi);
    light->irradiance.resize(9);
    start_writing(report, options, path, background, [light, threads = options.threads](const auto& file) {
        return write_gltf_image_light(file, *light, threads);
    });
}

void write_playcanvas(BakedMap& report, std::span<const FilteredMap> levels, const MapFormat& format,
                      const BakeOptions& options, const std::filesystem::path& path, Background& background) {
    std::vector<EncodingReport> encoded;
    auto atlas = std::make_shared<Image<std::uint8_t>>(
        make_playcanvas_atlas(levels, *format.irradiance_over_pi, format.order, options.threads, &encoded));
    take_reports(report, encoded);
    start_writing(report, options, path, background,
                  [atlas](const auto& file) { return write_playcanvas_atlas(file, *atlas); });
}

void write_openexr(BakedMap& report, std::span<const FilteredMap> levels, const MapFormat& format,
                   const BakeOptions& options, const std::filesystem::path& path, Background& background) {
    ExrWriteOptions exr;
    exr.half = format.encoding == Encoding::rgba16f;
    exr.attributes = format.metadata;
    exr.threads = options.threads;
    exr.envmap = format.envmap;
    if (exr.half) encode_chain(report, levels, format, options);  // half floats clip alike in every container
    auto pictures = std::make_shared<std::vector<ImageF>>();
    for (const FilteredMap& level : levels) pictures->push_back(format.order.apply(level).image);
    start_writing(report, options, path, background, [pictures, exr](const auto& file) {
        std::vector<ImageView<const float>> views(pictures->begin(), pictures->end());
        return write_exr_levels(file, views, exr);
    });
}

}  // namespace

bool is_engine_file(Container container) {
    return container == Container::env || container == Container::gltf || container == Container::playcanvas_atlas ||
           container == Container::exr_mip;
}

void write_engine_file(BakedMap& report, std::span<const FilteredMap> levels, const MapFormat& format,
                       const BakeOptions& options, const std::filesystem::path& path, Background& background) {
    switch (format.container) {
        case Container::env:
            return write_babylon(report, levels, format, options, path, background);
        case Container::gltf:
            return write_gltf(report, levels, format, options, path, background);
        case Container::playcanvas_atlas:
            return write_playcanvas(report, levels, format, options, path, background);
        default:
            return write_openexr(report, levels, format, options, path, background);
    }
}

}  // namespace domelight
