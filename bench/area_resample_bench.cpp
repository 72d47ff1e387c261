// Level 0: milliseconds (CPU and wall clock) and the relative error of the total light, by source size, face size and
// orientation; and a cube as a lat-long image.
#include "domelight/filtering/resample/area_resample.h"
#include "domelight/projection/projection.h"

#include "filtering/resample/area_resample_cube.h"
#include "filtering/resample/area_resample_plain.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>

namespace {

using namespace domelight;

/// Smooth light with a sun of one texel, 10^5 times as bright.
ImageF environment(int width, int height) {
    ImageF image(width, height, 3);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            float* p = image.at(x, y);
            for (int c = 0; c < 3; ++c) p[c] = 1.1f + std::sin(0.01f * x * (c + 1)) * std::cos(0.013f * y);
        }
    image.at(width / 3, height / 3)[1] = 1e5f;
    return image;
}

/// ∫ g dω of the green channel: the tent of each row is integrated against sin θ in closed form.
double light(ImageView<const float> image) {
    const double h = k_pi / image.height;
    double sum = 0;
    for (int y = 0; y < image.height; ++y) {
        const bool polar = y == 0 || y + 1 == image.height;
        const double tent = image.height == 1 ? 2
                            : polar           ? 1 - (std::sin(1.5 * h) - std::sin(0.5 * h)) / h
                                              : 4 * std::sin((y + 0.5) * h) * std::pow(std::sin(0.5 * h), 2) / h;
        double row = 0;
        for (int x = 0; x < image.width; ++x) row += image.at(x, y)[1];
        sum += row * tent;
    }
    return sum * 2 * k_pi / image.width;
}

double cube_light(ImageView<const float> strip) {
    const int n = strip.width;
    double sum = 0;
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) {
            double six = 0;
            for (int f = 0; f < 6; ++f) six += strip.at(x, f * n + y)[1];
            sum += six * cube_solid_angle(x, y, n);
        }
    return sum;
}

using Maker = std::unique_ptr<AreaResampler> (*)(int, int, int, const Mat3&, int);

/// Arguments: source width, source height, face size, rotation about Y (degrees), threads.
void to_cube(benchmark::State& state, Maker make) {
    const int width = int(state.range(0)), height = int(state.range(1)), size = int(state.range(2)),
              threads = int(state.range(4));
    const ImageF image = environment(width, height);
    const Mat3 m = rotation_y(double(state.range(3)) * k_pi / 180);
    ImageF out;
    for (auto _ : state) {
        out = ImageF();
        auto resampler = make(width, height, size, m, threads);
        for (int y = 0; y < height; y += 64) resampler->add_rows(image.view().rows(y, std::min(64, height - y)));
        out = resampler->finish();
    }
    const double truth = light(image);
    state.counters["energy_error"] = std::abs(cube_light(out) - truth) / truth;
}

using LatlongMaker = ImageF (*)(const Cubemap&, int, const Mat3&, int);

/// Arguments: face size, height of the lat-long image, rotation about Y (degrees), threads.
void to_latlong(benchmark::State& state, LatlongMaker make) {
    const int size = int(state.range(0)), height = int(state.range(1));
    auto faces = area_resample_to_cube(4 * size, 2 * size, size, {}, 0);
    faces->add_rows(environment(4 * size, 2 * size));
    const Cubemap cube(faces->finish());
    for (auto _ : state)
        benchmark::DoNotOptimize(
            make(cube, height, rotation_y(double(state.range(2)) * k_pi / 180), int(state.range(3))));
}

void common(benchmark::internal::Benchmark* b) {
    b->ArgNames({"w", "h", "n", "deg", "threads"})
        ->Unit(benchmark::kMillisecond)
        ->MeasureProcessCPUTime()
        ->UseRealTime();
}

void common_latlong(benchmark::internal::Benchmark* b) {
    b->ArgNames({"n", "h", "deg", "threads"})->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
}

}  // namespace

BENCHMARK_CAPTURE(to_cube, best, domelight::area_resample_to_cube)
    ->Apply(common)
    ->Args({4096, 2048, 1024, 0, 1})
    ->Args({4096, 2048, 1024, 0, 2})
    ->Args({4096, 2048, 1024, 30, 1})
    ->Args({4096, 2048, 512, 0, 1})
    ->Args({4096, 2048, 8, 0, 1})
    ->Args({2048, 1024, 256, 0, 1})
    ->Args({1024, 512, 1024, 0, 1})
    ->Args({4094, 2047, 1024, 0, 1})
    ->Args({4095, 2048, 1023, 0, 1})
    ->Args({16384, 8192, 1024, 0, 1});
BENCHMARK_CAPTURE(to_cube, plain, domelight::area::plain_to_cube)
    ->Apply(common)
    ->Args({1024, 512, 256, 30, 1})
    ->Iterations(1);

BENCHMARK_CAPTURE(to_latlong, best, domelight::area_resample_cube_to_latlong)
    ->Apply(common_latlong)
    ->Args({512, 1024, 0, 1})
    ->Args({512, 1024, 30, 1})
    ->Args({512, 256, 0, 1})
    ->Args({2048, 4096, 0, 1});
BENCHMARK_CAPTURE(to_latlong, plain, domelight::area::plain_cube_to_latlong)
    ->Apply(common_latlong)
    ->Args({128, 256, 0, 1})
    ->Iterations(1);
BENCHMARK_MAIN();
