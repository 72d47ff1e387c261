// CPU time until an estimate of the reflection integral is within 1 % (one standard deviation), for each strategy and
// surface.
//
//   estimate_bench [ENVIRONMENT ...]
//
// Without files: the built-in sky and, under DOMELIGHT_DATA, a sunrise, a square at noon without sun and a studio. Time
// per sample and variance are measured in the same run, with independent random points; "Sobol" is the time with
// Owen-scrambled Sobol points, by the number of them at which the error over 16 randomisations falls below 1 %.

#include "domelight/environment/sky/sky.h"
#include "domelight/image/colour.h"
#include "domelight/image/row_source.h"
#include "domelight/io/environment/open_environment.h"
#include "domelight/projection/projection.h"
#include "domelight/sampling/reflection_estimate.h"

#include "measure.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <vector>

using namespace domelight;

namespace {

struct Samplers {
    EnvironmentSampler plain, compensated;
};

Samplers make_samplers(const ImageF& image) {
    EnvironmentSamplerOptions options;
    auto plain = EnvironmentSampler::build(image, options);
    options.compensate = true;
    auto compensated = EnvironmentSampler::build(image, options);
    if (!plain || !compensated) {
        fmt::print(stderr, "{}\n", (plain ? compensated : plain).error().format());
        std::exit(1);
    }
    return {std::move(*plain), std::move(*compensated)};
}

struct Row {
    std::string name;
    Strategy strategy;
    bool compensated;
};

const std::vector<Row> k_rows = {{"uniform", Strategy::uniform, false},
                                 {"cosine", Strategy::cosine, false},
                                 {"brdf", Strategy::brdf, false},
                                 {"environment", Strategy::environment, false},
                                 {"mis-balance", Strategy::mis_balance, false},
                                 {"mis-power", Strategy::mis_power, false},
                                 {"mis-balance, compensated", Strategy::mis_balance, true},
                                 {"product of 8", Strategy::product, false}};

void report(const Surface& surface, const std::string& name, const Samplers& samplers) {
    EstimateOptions o;
    o.samples = 1 << 20;
    o.sequence = Sequence::sobol;
    const double truth =
        luminance(estimate_reflection(surface, samplers.compensated, Strategy::mis_balance, o).radiance);
    fmt::print("  {}: {:.5g}\n    {:<26}{:>10}{:>14}{:>14}{:>14}\n", name, truth, "strategy", "ns/sample",
               "samples to 1%", "ms to 1%", "Sobol, ms");
    for (const Row& row : k_rows) {
        const EnvironmentSampler& sampler = row.compensated ? samplers.compensated : samplers.plain;
        o.sequence = Sequence::random;
        o.samples = 1 << 16;
        std::vector<double> times;
        double square = 0;
        for (int seed = 1; seed <= 5; ++seed) {
            o.seed = seed;
            const double start = cpu_seconds();
            const Estimate e = estimate_reflection(surface, sampler, row.strategy, o);
            times.push_back((cpu_seconds() - start) / e.samples);
            const double error =
                luminance(e.standard_error) / truth;  // of the sum of the channels, which vary almost alike
            square += error * error * e.samples / 5;
        }
        std::nth_element(times.begin(), times.begin() + 2, times.end());
        const double samples = square / 1e-4;
        // The number of points is doubled until the error over the randomisations is small enough.
        o.sequence = Sequence::sobol;
        int n = 16;
        for (; n < 1 << 18; n *= 2) {
            double sum = 0;
            o.samples = n;
            for (int seed = 1; seed <= 16; ++seed) {
                o.seed = seed;
                const double e = luminance(estimate_reflection(surface, sampler, row.strategy, o).radiance) / truth - 1;
                sum += e * e / 16;
            }
            if (sum < 1e-4) break;
        }
        fmt::print("    {:<26}{:>10.0f}{:>14.0f}{:>14.3g}{:>13}{:.3g}\n", row.name, times[2] * 1e9, samples,
                   samples * times[2] * 1e3, n >= 1 << 18 ? ">" : "", n * times[2] * 1e3);
    }
}

void report(const std::string& name, const ImageF& image) {
    fmt::print("\n{} ({} x {})\n", name, image.width(), image.height());
    const Samplers samplers = make_samplers(image);
    const Vec3d normal = normalize(Vec3d{0.3, 0.9, 0.2}), view = normalize(Vec3d{-0.5, 0.6, 0.4});
    report(make_surface(normal, view, LambertBrdf{}), "Lambert", samplers);
    for (const float roughness : {0.1f, 0.3f, 0.6f, 1.f})
        report(make_surface(normal, view, GgxBrdf{roughness * roughness}), fmt::format("GGX, roughness {}", roughness),
               samplers);
}

}  // namespace

int main(int argc, char** argv) {
    std::vector<std::filesystem::path> files(argv + 1, argv + argc);
    if (files.empty()) {
        SkyOptions options;
        options.height = 512;
        ImageF sky(1024, 512, 3);
        if (make_sky(options)->read(sky.view())) report("built-in sky", sky);
        if (const char* data = std::getenv("DOMELIGHT_DATA"))
            for (const char* name : {"env_highres/spruit_sunrise_1k.hdr", "env_latlong/potsdamer_platz_1k.hdr",
                                     "env_latlong/studio_small_03_1k.hdr"})
                files.push_back(std::filesystem::path(data) / name);
    }
    for (const auto& file : files) {
        auto environment = open_environment({file});
        auto image = environment && !environment->cube() ? read_latlong(**environment->rows())
                                                         : Result<ImageF>(Error{"not a lat-long", "", ""});
        if (image)
            report(file.filename().string(), *image);
        else
            fmt::print("\n{}: {}\n", file.filename().string(), image.error().format());
    }
}
