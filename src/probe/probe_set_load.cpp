#include "io/file/path_inside.h"
#include "probe/probe_record.h"
#include "probe/probe_set_builder.h"
#include "texture/container/cube_array.h"

#include <fmt/core.h>

namespace domelight {
namespace {

namespace fs = std::filesystem;

/// Opens a file that probes.json names, and holds it against what is said of it there.
///
/// size   of a face of level 0
Result<CubeArrayReader> open_cubes(const fs::path& folder, const ProbeMapRecord& map, std::size_t probes,
                                   std::size_t levels, int channels) {
    const auto path = path_inside(folder / map.file, folder, map.file);
    if (!path) return path.error().at((folder / k_probes_json).string());
    auto cubes = CubeArrayReader::open(*path);
    if (!cubes) return cubes.error();
    const CubeArrayShape& shape = cubes->shape();
    if (shape.size != map.size || shape.cubes != int(probes) || shape.levels != int(levels) ||
        encoding_channels(shape.encoding) != channels)
        return Error{
            fmt::format("holds {} cubes of {} texels a face, {} levels and {} channels, but {} says {}, {}, {} "
                        "and {}",
                        shape.cubes, shape.size, shape.levels, encoding_channels(shape.encoding), k_probes_json, probes,
                        map.size, levels, channels),
            path->string(), "The files of the folder belong to different sets."};
    return cubes;
}

}  // namespace

Result<ProbeSet> ProbeSet::load(const fs::path& folder) {
    auto record = read_probe_record(folder);
    if (!record) return record.error();
    const std::size_t count = record->probes.size();
    auto specular = open_cubes(folder, record->specular, count, record->roughness.size(), 3);
    if (!specular) return specular.error();
    auto irradiance = open_cubes(folder, record->irradiance, count, 1, 3);
    if (!irradiance) return irradiance.error();
    std::optional<CubeArrayReader> distance;
    if (record->distance) {
        auto opened = open_cubes(folder, *record->distance, count, 1, 2);
        if (!opened) return opened.error();
        distance.emplace(*std::move(opened));
    }
    if (auto ok = check_set(record->grid, count, record->roughness); !ok)
        return Error{ok.error().format(), (folder / k_probes_json).string(), ""};

    ProbeMapSizes sizes{{}, irradiance->shape().size, distance ? distance->shape().size : 0};
    const int levels = int(record->roughness.size());
    for (int l = 0; l < levels; ++l) sizes.specular.push_back(specular->shape().level_size(l));
    ProbeSetBuilder builder(record->probes, record->grid, record->roughness, sizes);
    for (int i = 0; i < int(count); ++i) {
        ProbeMaps maps;
        const auto read = [&](CubeArrayReader& file, int level, Cubemap& into) -> Result<void> {
            auto cube = file.decode(i, level);
            if (!cube) return cube.error();
            into = *std::move(cube);
            return {};
        };
        for (int l = 0; l < levels; ++l)
            if (auto ok = read(*specular, l, maps.specular.emplace_back()); !ok) return ok.error();
        if (auto ok = read(*irradiance, 0, maps.irradiance_over_pi); !ok) return ok.error();
        if (distance)
            if (auto ok = read(*distance, 0, maps.distance); !ok) return ok.error();
        maps.harmonics = record->harmonics[std::size_t(i)];
        builder.set(i, maps);
    }
    builder.set_sources(record->scene, record->environment);
    ProbeSet set = builder.take();
    set.set_tetrahedra(std::move(record->tetrahedra));
    return set;
}

}  // namespace domelight
