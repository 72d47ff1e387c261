// Time to draw a direction with its density and weight, and to draw a point of each sequence; for BRDFs also the share
// of samples below the horizon, and the variance of the weight over all view angles (0 for perfect sampling of a BRDF
// whose albedo does not depend on the view).
#include "domelight/sampling/brdf.h"
#include "domelight/sampling/sequences.h"

#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

namespace {

using namespace domelight;

constexpr int k_points = 4096;

std::vector<UnitPoint> random_points() {
    std::vector<UnitPoint> out;
    for (std::uint32_t i = 0; i < k_points; ++i) out.push_back(random_point(1, i));
    return out;
}

/// Views at all angles, uniform in the cosine.
std::vector<Vec3f> views() {
    std::vector<Vec3f> out;
    for (std::uint32_t i = 0; i < k_points; ++i) out.push_back(uniform_hemisphere(random_point(2, i)));
    return out;
}

template <typename Brdf>
void draw(benchmark::State& state, Brdf brdf) {
    const std::vector<UnitPoint> u = random_points();
    const std::vector<Vec3f> V = views();
    for (auto _ : state)
        for (int i = 0; i < k_points; ++i) benchmark::DoNotOptimize(brdf.sample(V[i], u[i]));
    double lost = 0, sum = 0, squares = 0;
    for (int i = 0; i < k_points; ++i) {
        const BrdfSample s = brdf.sample(V[i], u[i]);
        lost += s.pdf_solid_angle == 0, sum += s.weight.x, squares += s.weight.x * s.weight.x;
    }
    state.SetItemsProcessed(state.iterations() * k_points);
    state.counters["each"] = benchmark::Counter(double(state.iterations()) * k_points,
                                                benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
    state.counters["lost"] = lost / k_points;
    state.counters["weight_variance"] = squares / k_points - sum * sum / k_points / k_points;
}

void ggx(benchmark::State& state) {
    const float alpha = float(state.range(1)) / 100;
    switch (state.range(0)) {
        case 0:
            state.SetLabel("half vectors");
            return draw(state, BasicGgxBrdf<GgxNormals::half_vectors>{alpha});
        case 1:
            state.SetLabel("Heitz 2018");
            return draw(state, BasicGgxBrdf<GgxNormals::heitz>{alpha});
        case 2:
            state.SetLabel("caps");
            return draw(state, BasicGgxBrdf<GgxNormals::caps>{alpha});
        default:
            state.SetLabel("bounded caps");
            return draw(state, GgxBrdf{alpha});
    }
}
BENCHMARK(ggx)->ArgNames({"form", "alpha_percent"})->ArgsProduct({{0, 1, 2, 3}, {9, 36, 100}});

/// Only the normals, whose times the papers state.
template <typename Draw>
void normals(benchmark::State& state, const Draw& draw) {
    const std::vector<UnitPoint> u = random_points();
    const std::vector<Vec3f> V = views();
    for (auto _ : state)
        for (int i = 0; i < k_points; ++i) benchmark::DoNotOptimize(draw(V[i], u[i]));
    state.counters["each"] = benchmark::Counter(double(state.iterations()) * k_points,
                                                benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK_CAPTURE(normals, half_vectors, [](const Vec3f&, UnitPoint u) { return ggx_half_vector(0.36f, u); });
BENCHMARK_CAPTURE(normals, heitz, [](const Vec3f& V, UnitPoint u) { return ggx_visible_normal_heitz(V, 0.36f, u); });
BENCHMARK_CAPTURE(normals, caps, [](const Vec3f& V, UnitPoint u) { return ggx_visible_normal_cap(V, 0.36f, u); });
BENCHMARK_CAPTURE(normals, bounded_caps, [](const Vec3f& V, UnitPoint u) {
    return ggx_visible_normal_cap(V, 0.36f, u, ggx_cap_bound(V, 0.36f));
});

void others(benchmark::State& state) {
    switch (state.range(0)) {
        case 0:
            state.SetLabel("lambert");
            return draw(state, LambertBrdf{});
        case 1:
            state.SetLabel("phong 40");
            return draw(state, PhongBrdf{40});
        default:
            state.SetLabel("charlie 0.25");
            return draw(state, CharlieBrdf{0.25f});
    }
}
BENCHMARK(others)->DenseRange(0, 2);

void sequence(benchmark::State& state) {
    const auto which = Sequence(state.range(0));
    const auto pair = std::uint32_t(state.range(1));
    state.SetLabel(name_of(which));
    std::uint64_t seed = 1;
    for (auto _ : state) {
        ++seed;
        for (std::uint32_t i = 0; i < 1024; ++i) benchmark::DoNotOptimize(unit_point(which, seed, i, 1024, pair));
    }
    state.counters["each"] = benchmark::Counter(double(state.iterations()) * 1024.0,
                                                benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(sequence)->ArgNames({"", "pair"})->ArgsProduct({{0, 1, 2, 3, 4, 5}, {0, 2}});

}  // namespace

BENCHMARK_MAIN();
