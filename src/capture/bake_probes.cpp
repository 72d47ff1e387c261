#include "domelight/base/version.h"
#include "domelight/capture/probe_bake.h"
#include "domelight/io/environment/open_environment.h"
#include "domelight/io/file/atomic_file.h"
#include "domelight/probe/scene_hash.h"
#include "domelight/probe/tetrahedra.h"

#include "bake/staging.h"
#include "base/field_place.h"
#include "io/file/sha256.h"
#include "probe/probe_map_files.h"
#include "probe/probe_record.h"

#include <fmt/core.h>
#include <time.h>

#include <algorithm>
#include <atomic>

namespace domelight {
namespace {

namespace fs = std::filesystem;

/// Processor time of this thread, seconds.
double thread_seconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

double process_seconds() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

bool has_light(const RayScene& scene, const EnvironmentSampler& sampler, const CaptureOptions& o) {
    if (!scene.scene().lights.empty() || !o.environment_lights.empty()) return true;
    for (const Material& m : scene.scene().materials)
        if (m.unlit || m.emission.x > 0 || m.emission.y > 0 || m.emission.z > 0) return true;
    const ImageView<const float> image = sampler.image();
    for (int y = 0; y < image.height; ++y)
        if (std::any_of(image.row(y), image.row(y) + image.width * image.channels, [](float v) { return v > 0; }))
            return true;
    return false;
}

/// What is captured, and which probes get the maps of each.
struct Sharing {
    std::vector<int> numbers;
    std::vector<Vec3f> positions;
    std::vector<std::vector<int>> users;  ///< of each captured probe: itself, and those filled from it
};

Result<Sharing> shared(const std::vector<Probe>& probes) {
    Sharing sharing;
    if (probes.empty()) return Error{"is empty", field_place("probes"), ""};
    std::vector<int> place(probes.size(), -1);
    for (std::size_t i = 0; i < probes.size(); ++i) {
        if (!probes[i].valid && probes[i].filled_from >= 0) continue;
        place[i] = int(sharing.numbers.size());
        sharing.numbers.push_back(int(i));
        sharing.positions.push_back(probes[i].position);
        sharing.users.push_back({int(i)});
    }
    for (std::size_t i = 0; i < probes.size(); ++i) {
        if (place[i] >= 0) continue;
        const int from = probes[i].filled_from;
        if (from >= int(probes.size()) || place[std::size_t(from)] < 0)
            return Error{fmt::format("number {} is filled from {}, which has no light of its own", i, from),
                         field_place("probes"), ""};
        sharing.users[std::size_t(place[std::size_t(from)])].push_back(int(i));
    }
    return sharing;
}

/// Between the positions of the probes that are valid, of which a blend is made; they fill the convex hull.
std::vector<std::array<int, 4>> tetrahedra_of(const std::vector<Probe>& probes) {
    std::vector<Vec3f> positions;
    std::vector<int> numbers;
    for (std::size_t i = 0; i < probes.size(); ++i) {
        if (!probes[i].valid) continue;
        positions.push_back(probes[i].position);
        numbers.push_back(int(i));
    }
    if (positions.empty()) return {};
    const Tetrahedra tetrahedra(positions, Tetrahedra::Outside::nothing);
    std::vector<std::array<int, 4>> cells(tetrahedra.cells().begin(), tetrahedra.cells().end());
    for (auto& cell : cells)
        for (int& corner : cell) corner = numbers[std::size_t(corner)];
    return cells;
}

Result<ProbeBaker> make_filter(const ProbeBakeOptions& options) {
    ProbeBakerOptions filter = options.filter;
    filter.size = options.capture.size;
    return ProbeBaker::make(filter);
}

ProbeMapSizes sizes_of(const ProbeBaker& filter) {
    ProbeMapSizes sizes{{}, filter.options().irradiance_size, filter.options().distance_size};
    for (int l = 0; l < filter.options().levels; ++l) sizes.specular.push_back(filter.options().size >> l);
    return sizes;
}

/// Captures and filters; `use` gets each probe's maps, from several threads at once.
Result<ProbeBakeReport> run(const RayScene& scene, const EnvironmentSampler& sampler, const std::vector<Probe>& probes,
                            const ProbeBakeOptions& options, const ProbeBaker& filter,
                            const std::function<void(int probe, const ProbeMaps& maps)>& use) {
    const auto sharing = shared(probes);
    if (!sharing) return sharing.error();
    if (!has_light(scene, sampler, options.capture))
        return Error{"the environment is black, and the scene neither has lights nor emits light", "",
                     "Probes of it would be black everywhere."};
    std::atomic<std::int64_t> rays{0}, non_finite{0};
    std::atomic<double> filter_seconds{0}, use_seconds{0};
    const double start = process_seconds();
    const auto captured = capture(scene, sampler, sharing->positions, sharing->numbers, options.capture,
                                  [&](int index, CapturedCube cube) -> Result<void> {
                                      const double begin = thread_seconds();
                                      rays += cube.rays;
                                      non_finite += cube.non_finite_samples;
                                      const auto maps = filter(cube);
                                      if (!maps) return maps.error();
                                      const double filtered = thread_seconds();
                                      for (const int user : sharing->users[std::size_t(index)]) use(user, *maps);
                                      filter_seconds += filtered - begin;
                                      use_seconds += thread_seconds() - filtered;
                                      return {};
                                  });
    if (!captured) return captured.error();
    ProbeBakeReport report;
    report.size = options.capture.size;
    report.rays = rays;
    report.non_finite_samples = non_finite;
    report.filter_seconds = filter_seconds;
    report.capture_seconds = process_seconds() - start - filter_seconds - use_seconds;
    return report;
}

Json options_json(const ProbeBakeOptions& o, const ProbeBaker& filter) {
    Json json{{"size", o.capture.size},
              {"levels", filter.options().levels},
              {"irradiance_size", filter.options().irradiance_size},
              {"distance_size", filter.options().distance_size},
              {"spp", o.capture.samples},
              {"bounces", o.capture.bounces},
              {"seed", o.capture.seed},
              {"encoding", name_of(o.encoding)},
              {"placement", o.placement}};
    if (o.capture.noise > 0) json["noise"] = o.capture.noise, json["most_samples"] = o.capture.most_samples;
    return json;
}

Result<ProbeMapRecord> map_record(const fs::path& file, const std::string& name, Encoding encoding, int size,
                                  std::uint64_t& bytes) {
    auto hash = sha256_file(file);
    if (!hash) return hash.error();
    std::error_code ignored;
    bytes += fs::file_size(file, ignored);
    return ProbeMapRecord{name, *std::move(hash), name_of(encoding), size};
}

}  // namespace

Result<void> set_sources(ProbeBakeOptions& options, const std::string& name, const Scene& scene,
                         const Environment& environment) {
    const auto hash = environment_sha256(environment);
    if (!hash) return hash.error();
    options.scene = {fs::path(name).filename().string(), scene_sha256(scene)};
    options.environment = {environment.file.filename().string(), *hash};
    options.inputs.insert(options.inputs.end(), environment.files.begin(), environment.files.end());
    options.inputs.push_back(name);
    const Scene::Box bounds = scene.bounds();
    options.filter.farthest = std::max(1e-3f, length(bounds.high - bounds.low));
    return {};
}

Result<ProbeBakeReport> bake_probes(const RayScene& scene, const EnvironmentSampler& sampler,
                                    const std::vector<Probe>& probes, const std::optional<ProbeGrid>& grid,
                                    const ProbeBakeOptions& options, const fs::path& folder) {
    if (options.encoding != Encoding::rgb9e5 && options.encoding != Encoding::rgba16f &&
        options.encoding != Encoding::rgba32f)
        return Error{fmt::format("{} is not one of rgb9e5, rgba16f, rgba32f", name_of(options.encoding)),
                     field_place("encoding"), ""};
    const auto filter = make_filter(options);
    if (!filter) return filter.error();
    if (auto ok = check_set(grid, probes.size(), filter->roughness()); !ok) return ok.error();
    auto staging = Staging::open(folder, options.inputs);
    if (!staging) return staging.error();
    const ProbeMapFilePaths paths{staging->stage("specular.ktx2"), staging->stage("irradiance.ktx2"),
                                  filter->options().distance_size > 0 ? staging->stage("distance.ktx2") : fs::path()};
    auto writer =
        ProbeMapWriter::open(paths, int(probes.size()), sizes_of(*filter), filter->roughness(), options.encoding);
    if (!writer) return writer.error();

    ProbeSetRecord record;
    record.version = version();
    record.scene = options.scene, record.environment = options.environment;
    record.options = options_json(options, *filter);
    record.grid = grid;
    record.probes = probes;
    record.harmonics.resize(probes.size());
    record.roughness = filter->roughness();
    if (!grid) record.tetrahedra = tetrahedra_of(probes);
    std::atomic<std::int64_t> clipped{0};
    auto report = run(scene, sampler, probes, options, *filter, [&](int i, const ProbeMaps& maps) {
        record.harmonics[std::size_t(i)] = maps.harmonics;
        clipped += writer->write(i, maps);
    });
    if (!report) return report.error();
    if (auto ok = writer->finish(); !ok) return ok.error().at(folder.string());
    report->clipped_texels = clipped;

    const auto add = [&](const fs::path& file, const char* name, Encoding encoding, int size,
                         ProbeMapRecord& into) -> Result<void> {
        auto map = map_record(file, name, encoding, size, report->bytes);
        if (!map) return map.error();
        into = *std::move(map);
        return {};
    };
    const ProbeBakerOptions& f = filter->options();
    if (auto ok = add(paths.specular, "specular.ktx2", options.encoding, f.size, record.specular); !ok)
        return ok.error();
    if (auto ok = add(paths.irradiance, "irradiance.ktx2", options.encoding, f.irradiance_size, record.irradiance); !ok)
        return ok.error();
    if (f.distance_size > 0) {
        record.farthest = f.farthest;
        if (auto ok = add(paths.distance, "distance.ktx2", Encoding::rg32f, f.distance_size, record.distance.emplace());
            !ok)
            return ok.error();
    }
    const std::string text = probe_record_text(record);
    report->bytes += text.size();
    if (auto ok = write_file_atomically(staging->stage(k_probes_json), text); !ok) return ok.error();
    if (auto ok = staging->commit(k_probes_json); !ok) return ok.error();
    return report;
}

Result<ProbeSet> bake_probes(const RayScene& scene, const EnvironmentSampler& sampler, const std::vector<Probe>& probes,
                             const std::optional<ProbeGrid>& grid, const ProbeBakeOptions& options) {
    const auto filter = make_filter(options);
    if (!filter) return filter.error();
    if (auto ok = check_set(grid, probes.size(), filter->roughness()); !ok) return ok.error();
    ProbeSetBuilder builder(probes, grid, filter->roughness(), sizes_of(*filter));
    const auto report =
        run(scene, sampler, probes, options, *filter, [&](int i, const ProbeMaps& maps) { builder.set(i, maps); });
    if (!report) return report.error();
    builder.set_sources(options.scene, options.environment);
    ProbeSet set = builder.take();
    if (!grid) set.set_tetrahedra(tetrahedra_of(probes));
    return set;
}

}  // namespace domelight
