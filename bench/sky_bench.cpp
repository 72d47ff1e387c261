// The sky: milliseconds to set it up, texels a second, and its photometric figures; and the milliseconds of the contact
// sheet.
#include "domelight/environment/sky/sky.h"
#include "domelight/preview/preview.h"

#include "environment/sky/sky_model.h"

#include <benchmark/benchmark.h>

#include <vector>

namespace {

using namespace domelight;

double lux(const Vec3d& v) {
    return 179 * (0.2126 * v.x + 0.7152 * v.y + 0.0722 * v.z);
}

/// Arguments: sun elevation (degrees), turbidity in tenths. Counters: lux facing the sun and from the sky on level
/// ground, cd / m^2 at the zenith.
void sky_setup(benchmark::State& state) {
    SkyOptions options;
    options.sun_elevation_deg = double(state.range(0));
    options.turbidity = double(state.range(1)) / 10;
    options.threads = 1;
    for (auto _ : state) {
        const sky::SkyModel model(options);
        state.counters["direct_normal_lx"] = lux(model.direct_normal_irradiance());
        state.counters["sky_lx"] = lux(model.sky_irradiance());
        state.counters["zenith_cd_m2"] = lux(Vec3d(model.radiance(k_pi / 2, 0)));
    }
}
BENCHMARK(sky_setup)->ArgsProduct({{60, 30, 10, 2, 0, -6, -12, -18}, {20, 25, 30, 60}})->Unit(benchmark::kMillisecond);

/// Arguments: rows of the image, threads. Only reading is timed, 32 rows at a time.
void sky_rows(benchmark::State& state) {
    SkyOptions options;
    options.height = int(state.range(0));
    options.threads = int(state.range(1));
    ImageF rows(2 * options.height, 32, 3);
    for (auto _ : state) {
        state.PauseTiming();
        const auto sky = make_sky(options);
        state.ResumeTiming();
        for (int y = 0; y < options.height; y += 32) (void)sky->read(rows.view());
    }
    state.counters["texels"] =
        benchmark::Counter(2.0 * options.height * options.height, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(sky_rows)->ArgsProduct({{512, 2048, 8192}, {1, 2}})->Unit(benchmark::kMillisecond)->UseRealTime();

/// Argument: threads. The default bake's sheet: a 4096 x 2048 environment, seven cubes from 512 down, irradiance and
/// harmonics.
void preview(benchmark::State& state) {
    SkyOptions options;
    options.height = 2048;
    const auto source = make_sky(options);
    ImageF sky(4096, 2048, 3);
    (void)source->read(sky.view());
    std::vector<FilteredMap> levels;
    for (int size = 512; size >= 8; size /= 2) {
        FilteredMap level = Cubemap(size);
        for (std::size_t i = 0; i < level.pixels().size(); ++i) level.pixels()[i] = sky.pixels()[i];
        levels.push_back(std::move(level));
    }
    const std::vector<Vec3d> sh(9, Vec3d(1, 1, 1));
    const ImageF brdf(128, 128, 3, 0.5f);
    PreviewInput input;
    input.environment = sky.view();
    for (const FilteredMap& level : levels) input.specular.push_back({&level, 0, 0, ""});
    input.irradiance_over_pi = &levels[3];
    input.sh = sh;
    input.brdf = brdf.view();
    input.threads = int(state.range(0));
    for (auto _ : state) benchmark::DoNotOptimize(contact_sheet(input));
}
BENCHMARK(preview)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
