// Sampling an environment, by method: millions of samples a second including their densities, with random and with
// stratified points, also relative to plain binary search in the same run; the time and memory of the tables; the error
// of an estimate with 4096 low-discrepancy points.
//
//   distribution_bench [--quick] [--set AVX2|SSE4|SCALAR] [FILE.hdr]
//
// --quick: 4096 x 2048 only. --set: no better instruction set than this one.
// Without a file: the 4k environment under DOMELIGHT_DATA, else the built-in sky. CPU time of this thread, medians of
// interleaved rounds.

#include "domelight/environment/sky/sky.h"
#include "domelight/image/row_source.h"
#include "domelight/io/environment/open_environment.h"
#include "domelight/projection/projection.h"
#include "domelight/sampling/distribution/distribution.h"

#include "base/instruction_set.h"
#include "measure.h"

#include <fmt/core.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <map>
#include <random>

using namespace domelight;

namespace {

/// Luminance times sin θ of an environment resized to `height` rows: means of blocks where it is reduced, bilinear
/// interpolation where it is enlarged.
ImageF weights_of(const ImageF& rgb, int height) {
    ImageF weights(2 * height, height, 1);
    const auto luminance = [&](int x, int y) {
        const float* p = rgb.at(((x % rgb.width()) + rgb.width()) % rgb.width(), std::clamp(y, 0, rgb.height() - 1));
        return 0.2126f * p[0] + 0.7152f * p[1] + 0.0722f * p[2];
    };
    const int step = std::max(1, rgb.height() / height);
    const double scale = double(rgb.height()) / height;
    for (int y = 0; y < height; ++y) {
        const double sine = std::sin((y + 0.5) / height * k_pi);
        for (int x = 0; x < 2 * height; ++x) {
            double sum = 0;
            if (scale >= 1) {
                for (int j = 0; j < step; ++j)
                    for (int i = 0; i < step; ++i) sum += luminance(x * step + i, y * step + j) / (step * step);
            } else {
                const double fx = (x + 0.5) * scale - 0.5, fy = (y + 0.5) * scale - 0.5, ix = std::floor(fx),
                             iy = std::floor(fy), s = fx - ix, t = fy - iy;
                const auto row = [&](int j) { return luminance(int(ix), j) * (1 - s) + luminance(int(ix) + 1, j) * s; };
                sum = row(int(iy)) * (1 - t) + row(int(iy) + 1) * t;
            }
            *weights.at(x, y) = float(sum * sine);
        }
    }
    return weights;
}

Result<ImageF> load(const std::string& file) {
    if (file.empty()) {
        SkyOptions options;
        options.height = 2048;
        auto sky = make_sky(options);
        ImageF image(sky->width(), sky->height(), 3);
        if (auto read = sky->read(image.view()); !read) return read.error();
        return image;
    }
    auto environment = open_environment({file});
    if (!environment) return environment.error();
    if (environment->cube()) return Error{"not a lat-long", file, ""};
    return read_latlong(**environment->rows());
}

std::vector<UnitPoint> random_points(int count) {
    std::mt19937_64 random(1);
    std::vector<UnitPoint> points(count);
    for (auto& p : points) {
        const std::uint64_t bits = random();
        p = {std::uint32_t(bits), std::uint32_t(bits >> 32)};
    }
    return points;
}

/// One point in each cell of a square grid, row by row, as a renderer's stratified sampler gives them.
std::vector<UnitPoint> stratified_points(int count) {
    const int n = int(std::lround(std::sqrt(count)));
    std::mt19937_64 random(2);
    std::vector<UnitPoint> points(std::size_t(n) * n);
    const double cell = 0x1p32 / n;
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) {
            const std::uint64_t bits = random();
            points[std::size_t(y) * n + x] = {std::uint32_t((x + std::uint32_t(bits) * 0x1p-32) * cell),
                                              std::uint32_t((y + std::uint32_t(bits >> 32) * 0x1p-32) * cell)};
        }
    return points;
}

/// Hammersley points, shifted around the square by `shift`.
std::vector<UnitPoint> hammersley(int count, UnitPoint shift) {
    std::vector<UnitPoint> points(count);
    for (int i = 0; i < count; ++i) {
        std::uint32_t bits = std::uint32_t(i), reversed = 0;
        for (int b = 0; b < 32; ++b, bits >>= 1) reversed = reversed << 1 | (bits & 1);
        points[i] = {std::uint32_t((std::uint64_t(i) << 32) / count) + shift.x, reversed + shift.y};
    }
    return points;
}

/// Root mean square of the relative error of an integral over the square by 4096 points, over 32 shifts of them: the
/// integrand is the weight times a smooth function (a cosine lobe), and the weight is read as the density is, constant
/// in each texel or bilinear.
double relative_error(const Distribution2D& d, const Distribution2D& exact, bool random) {
    const auto integrand = [&](double u, double v) {
        return exact.pdf_uv(u, v) *
               std::max(0.0, std::sin(k_pi * v) * std::cos(2 * k_pi * (u - 0.3)) * 0.6 + std::cos(k_pi * v) * 0.8);
    };
    constexpr int k_points = 4096, k_shifts = 32;
    std::mt19937_64 bits(9);
    std::vector<double> estimates;
    for (int s = 0; s < k_shifts; ++s) {
        const std::uint64_t b = bits();
        auto points = hammersley(k_points, {std::uint32_t(b), std::uint32_t(b >> 32)});
        if (random)
            for (auto& p : points) {
                const std::uint64_t r = bits();
                p = {std::uint32_t(r), std::uint32_t(r >> 32)};
            }
        double sum = 0;
        for (const UnitPoint& p : points) {
            const auto sample = d.sample(p);
            sum += integrand(sample.u, sample.v) / sample.pdf_uv;
        }
        estimates.push_back(sum / k_points);
    }
    double mean = 0, square = 0;
    for (double e : estimates) mean += e / k_shifts;
    for (double e : estimates) square += (e - mean) * (e - mean) / (k_shifts - 1);
    return std::sqrt(square) / mean;
}

constexpr DistributionMethod k_methods[] = {DistributionMethod::binary, DistributionMethod::guided,
                                            DistributionMethod::alias, DistributionMethod::hierarchical,
                                            DistributionMethod::bilinear};

struct Figures {
    double build_ms = 0, megabytes = 0, random = 0, random_one = 0, stratified = 0, stratified_one = 0, error = 0,
           error_random = 0;
};

/// Seconds for each point: in batches, and one at a time.
double seconds_batched(const Distribution2D& d, std::span<const UnitPoint> points, std::vector<float>* out) {
    const std::size_t chunk = 4096;  // as in a renderer, where results stay in the cache
    const double start = cpu_seconds();
    for (std::size_t i = 0; i < points.size(); i += chunk) {
        const std::size_t n = std::min(chunk, points.size() - i);
        d.sample(points.subspan(i, n), {out[0].data(), n}, {out[1].data(), n}, {out[2].data(), n});
    }
    return (cpu_seconds() - start) / points.size();
}
double seconds_single(const Distribution2D& d, std::span<const UnitPoint> points, std::vector<float>* out) {
    const double start = cpu_seconds();
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto s = d.sample(points[i]);
        out[0][i & 4095] = float(s.u), out[1][i & 4095] = float(s.v), out[2][i & 4095] = float(s.pdf_uv);
    }
    return (cpu_seconds() - start) / points.size();
}

int g_short = 0;
/// " short" after a figure for 4096 x 2048 that misses its target.
const char* judge(bool asked, bool reached) {
    g_short += asked && !reached;
    return asked ? reached ? "  ok" : "  short" : "";
}

void run(const ImageF& weights, int rounds, int count) {
    const bool asked = weights.height() == 2048;
    fmt::print("\n{} x {}\n", weights.width(), weights.height());
    std::map<DistributionMethod, std::unique_ptr<Distribution2D>> all;
    std::map<DistributionMethod, Figures> figures;
    for (auto method : k_methods) {
        std::vector<double> build;
        for (int k = 0; k < 5; ++k) {
            all.erase(method);
            const double start = cpu_seconds();
            auto d = make_distribution(Weights::of(weights.view()), method);
            build.push_back(1e3 * (cpu_seconds() - start));
            if (!d) return fmt::print("{}: {}\n", name_of(method), d.error().format());
            all[method] = std::move(*d);
        }
        figures[method].build_ms = median(build);
        figures[method].megabytes = all[method]->memory_bytes() * 1e-6;
    }

    // Each round measures every method, so that a slow moment of the machine affects all of them.
    const auto random = random_points(count), stratified = stratified_points(count);
    std::map<DistributionMethod, std::vector<double>> times[4];
    std::vector<float> out[3];
    for (auto& o : out) o.resize(4096);
    for (int round = 0; round < rounds; ++round)
        for (auto method : k_methods) {
            const Distribution2D& d = *all[method];
            const std::size_t n = method == DistributionMethod::hierarchical ? count / 8 : count;
            times[0][method].push_back(seconds_batched(d, std::span(random).first(n), out));
            times[1][method].push_back(seconds_single(d, std::span(random).first(n), out));
            times[2][method].push_back(
                seconds_batched(d, std::span(stratified).first(std::min(n, stratified.size())), out));
            times[3][method].push_back(
                seconds_single(d, std::span(stratified).first(std::min(n, stratified.size())), out));
        }
    for (auto method : k_methods) {
        Figures& f = figures[method];
        f.random = 1e-6 / median(times[0][method]);
        f.random_one = 1e-6 / median(times[1][method]);
        f.stratified = 1e-6 / median(times[2][method]);
        f.stratified_one = 1e-6 / median(times[3][method]);
        const bool continuous = all[method]->continuous();
        const Distribution2D& exact = *all[continuous ? DistributionMethod::bilinear : DistributionMethod::guided];
        f.error = relative_error(*all[method], exact, false);
        f.error_random = relative_error(*all[method], exact, true);
    }

    fmt::print("  million samples a second with density: batched (one at a time)\n");
    fmt::print("  {:<14} {:>16} {:>16} {:>8} {:>8} {:>10} {:>8} {:>12} {:>12}\n", "method", "random", "stratified",
               "ratio", "ratio", "table ms", "MB", "RMSE Hamm.", "RMSE random");
    const Figures plain = figures[DistributionMethod::binary];
    for (auto method : k_methods) {
        const Figures& f = figures[method];
        fmt::print(
            "  {:<14} {:>8.1f} ({:>5.1f}) {:>8.1f} ({:>5.1f}) {:>8.2f} {:>8.2f} {:>10.1f} {:>8.2f} {:>12.2e} "
            "{:>12.2e}\n",
            name_of(method), f.random, f.random_one, f.stratified, f.stratified_one, f.random / plain.random,
            f.stratified / plain.stratified, f.build_ms, f.megabytes, f.error, f.error_random);
    }
    // The reference is the faster of the two forms of binary search.
    const double binary_random = std::max(plain.random, plain.random_one),
                 binary_stratified = std::max(plain.stratified, plain.stratified_one);
    const Figures guided = figures[DistributionMethod::guided], alias = figures[DistributionMethod::alias],
                  bilinear = figures[DistributionMethod::bilinear];
    const auto line = [&](const char* what, double is, const char* sign, double aim, bool reached) {
        fmt::print("  {:<52} {:>8.2f}  ({} {}){}\n", what, is, sign, aim, judge(asked, reached));
    };
    const auto at_least = [&](const char* what, double is, double aim) { line(what, is, ">=", aim, is >= aim); };
    const auto at_most = [&](const char* what, double is, double aim) { line(what, is, "<=", aim, is <= aim); };
    at_least("guided / binary search, random", guided.random / binary_random, 4);
    at_least("guided / binary search, stratified", guided.stratified / binary_stratified, 3);
    at_least("alias / binary search, random", alias.random / binary_random, 8);
    at_least("bilinear / guided, random", bilinear.random / guided.random, 0.6);
    at_least("bilinear / guided, stratified", bilinear.stratified / guided.stratified, 0.6);
    at_most("RMSE with 4096 Hammersley points, guided / binary", guided.error / plain.error, 1.02);
    at_most("RMSE with 4096 Hammersley points, bilinear / binary", bilinear.error / plain.error, 1.02);
    at_most("guided table, ms", guided.build_ms, 60);
    at_most("guided, MB", guided.megabytes, 64);
    at_most("alias, MB", alias.megabytes, 80);
    at_most("bilinear, MB", bilinear.megabytes, 84);
}

}  // namespace

int main(int argc, char** argv) {
    bool quick = false;
    std::string file;
    for (int i = 1; i < argc; ++i) {
        if (!std::strcmp(argv[i], "--quick"))
            quick = true;
        else if (!std::strcmp(argv[i], "--set") && i + 1 < argc)
            simd::limit_instruction_set(argv[++i]);
        else
            file = argv[i];
    }
    const char* data = std::getenv("DOMELIGHT_DATA");
    if (file.empty() && data) file = std::string(data) + "/env_highres/spruit_sunrise_4k_from_ultrahdr.hdr";
    const auto image = load(file);
    if (!image) {
        fmt::print(stderr, "error: {}\n", image.error().format());
        return 1;
    }
    fmt::print("{}, kernels on {}\n", file.empty() ? "built-in sky" : file.substr(file.rfind('/') + 1),
               simd::instruction_set());
    for (int height : {512, 2048, 4096}) {
        if (quick && height != 2048) continue;
        run(weights_of(*image, height), quick ? 5 : 9, 1 << 20);
    }
    fmt::print("\n{} figures short\n", g_short);
    return 0;
}
