// The BRDF table: its time, and its error against a much finer quadrature.
#include "domelight/filtering/brdf/brdf_table.h"

#include "filtering/brdf/brdf_quadrature.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>

namespace {

using namespace domelight;

constexpr int k_size = 128;

/// Largest error of scale and bias, over every seventh texel in both directions.
double worst_error(const ImageF& table) {
    double worst = 0;
    for (int y = 0; y < k_size; y += 7)
        for (int x = 0; x < k_size; x += 7) {
            const double roughness = (y + 0.5) / k_size;
            const BrdfTerms truth = integrate_brdf((x + 0.5) / k_size, roughness * roughness, BrdfG::smith, {64, 300});
            worst =
                std::max({worst, std::abs(table.at(x, y)[0] - truth.scale), std::abs(table.at(x, y)[1] - truth.bias)});
        }
    return worst;
}

// Smith's separable form: for the default form the embedded table would be returned.
void quadrature(benchmark::State& state) {
    ImageF table;
    for (auto _ : state) table = brdf_table({k_size, BrdfG::smith, 1});
    state.counters["max_error"] = worst_error(table);
}
BENCHMARK(quadrature)->Unit(benchmark::kMillisecond);

void montecarlo(benchmark::State& state) {
    ImageF table;
    for (auto _ : state) table = brdf_table_montecarlo({k_size, BrdfG::smith, 1}, {.count = int(state.range(0))});
    state.counters["max_error"] = worst_error(table);
}
BENCHMARK(montecarlo)->Arg(64)->Arg(1024)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
