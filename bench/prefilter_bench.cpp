// The exact filter's time from float rows in memory to float maps, with level 0 and irradiance: 4096 x 2048 to 1024^2
// and 11 levels, and smaller jobs. CPU time of the whole process. In the rows "/AVX2" the kernels use at most AVX2.

#include "domelight/environment/sky/sky.h"
#include "domelight/filtering/prefilter.h"

#include "base/instruction_set.h"

#include <benchmark/benchmark.h>

#include <map>

using namespace domelight;

namespace {

const ImageF& sky(int height) {
    static std::map<int, ImageF> images;
    ImageF& image = images[height];
    if (image.empty()) {
        SkyOptions options;
        options.height = height;
        image = ImageF(2 * height, height, 3);
        (void)make_sky(options)->read(image.view());
    }
    return image;
}

void prefilter_chain(benchmark::State& state, const char* set) {
    const int height = int(state.range(0)), size = int(state.range(1)), levels = int(state.range(2));
    const ImageF& image = sky(height);
    FilterOptions options;
    options.threads = int(state.range(3));
    options.irradiance_size = 32;
    for (int l = 0; l < levels; ++l)
        options.specular.push_back({std::max(1, size >> l), l == 0, ZonalKernel::ggx(double(l) / (levels - 1))});
    simd::limit_instruction_set(set);
    for (auto _ : state) {
        ImageRowSource source(image);
        auto result = prefilter(source, options);
        benchmark::DoNotOptimize(result);
    }
    simd::limit_instruction_set("");
    state.SetLabel(*set ? set : simd::instruction_set());
}

void jobs(benchmark::internal::Benchmark* b) {
    b->ArgNames({"height", "size", "levels", "threads"})
        ->Unit(benchmark::kMillisecond)
        ->MeasureProcessCPUTime()
        ->UseRealTime();
    b->Args({2048, 1024, 11, 1})->Args({2048, 1024, 11, 2})->Args({1024, 256, 5, 1})->Args({512, 512, 7, 1});
}

BENCHMARK_CAPTURE(prefilter_chain, best, "")->Apply(jobs);
BENCHMARK_CAPTURE(prefilter_chain, AVX2, "AVX2")->Apply(jobs);

}  // namespace

BENCHMARK_MAIN();
