#include "compare/audit_fit.h"

#include "domelight/base/parallel.h"
#include "domelight/base/random.h"
#include "domelight/filtering/resample/area_resample.h"
#include "domelight/image/colour.h"
#include "domelight/projection/projection.h"

#include "projection/cube_solid_angles.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace domelight {
namespace {

struct Ratio {
    float ratio;
    double weight;
};

double weighted_median(std::vector<Ratio>& ratios) {
    std::sort(ratios.begin(), ratios.end(), [](const Ratio& a, const Ratio& b) { return a.ratio < b.ratio; });
    double total = 0, sum = 0;
    for (const Ratio& r : ratios) total += r.weight;
    for (const Ratio& r : ratios)
        if ((sum += r.weight) >= total / 2) return r.ratio;
    return 1;
}

}  // namespace

const std::vector<Mat3>& cube_orientations() {
    static const std::vector<Mat3> all = [] {
        std::vector<Mat3> found;
        constexpr int permutations[6][3] = {{0, 1, 2}, {2, 1, 0}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}};
        for (const auto& p : permutations)
            for (int signs = 0; signs < 8; ++signs) {
                Mat3 m;
                for (int i = 0; i < 3; ++i) {
                    const double s = signs >> i & 1 ? -1 : 1;
                    m.row[std::size_t(i)] = {p[i] == 0 ? s : 0, p[i] == 1 ? s : 0, p[i] == 2 ? s : 0};
                }
                found.push_back(m);
            }
        return found;
    }();
    return all;
}

double mean_luminance(const Cubemap& cube, int threads) {
    const int n = cube.size();
    const std::vector<double> angles = cube_solid_angles(n, threads);
    double sum = 0, weight = 0;
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) {
            const double w = angles[std::size_t(y) * std::size_t(n) + std::size_t(x)];
            for (int f = 0; f < 6; ++f) {
                const float* p = cube.face(f).at(x, y);
                const float l = luminance(Vec3f{p[0], p[1], p[2]});
                if (std::isfinite(l)) sum += w * l, weight += w;
            }
        }
    return weight > 0 ? sum / weight : 0;
}

namespace {

Vec3f value_of(const Cubemap& cube, std::int64_t texel) {
    const float* p = cube.strip().row(int(texel / cube.size())) + 3 * (texel % cube.size());
    return {p[0], p[1], p[2]};
}

bool is_finite(const Vec3f& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// Marks the finite texels that are brighter than all but about `count`.
std::vector<char> brightest(const Cubemap& cube, std::int64_t count) {
    const std::int64_t all = std::int64_t(6) * cube.size() * cube.size();
    std::vector<float> values(static_cast<std::size_t>(all));
    for (std::int64_t i = 0; i < all; ++i) {
        const Vec3f v = value_of(cube, i);
        values[std::size_t(i)] = is_finite(v) ? luminance(v) : 0;
    }
    std::vector<float> sorted = values;
    const auto limit = sorted.begin() + count;
    std::nth_element(sorted.begin(), limit, sorted.end(), std::greater<>());
    std::vector<char> marks(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) marks[i] = values[i] > *limit;
    return marks;
}

void add_texel(TexelSample& sample, const Cubemap& cube, std::int64_t texel, double share) {
    Vec3f v = value_of(cube, texel);
    if (!is_finite(v)) return;
    v = {std::max(v.x, 0.0f), std::max(v.y, 0.0f), std::max(v.z, 0.0f)};
    const int n = cube.size();
    sample.texels.push_back(int(texel));
    sample.weights.push_back(share * cube_solid_angle(int(texel % n), int(texel / n) % n, n));
    sample.values.push_back(v);
    sample.luminance.push_back(luminance(v));
}

}  // namespace

TexelSample sample_texels(const Cubemap& cube, int most, int threads) {
    TexelSample sample;
    const int n = cube.size();
    sample.size = n;
    sample.mean = mean_luminance(cube, threads);
    const std::int64_t all = std::int64_t(6) * n * n;
    if (all <= most) {
        for (std::int64_t i = 0; i < all; ++i) add_texel(sample, cube, i, 1);
        return sample;
    }
    // The brightest texels decide the relative RMSE, and a few random ones would miss a sun.
    const std::vector<char> bright = brightest(cube, most / 4);
    const std::int64_t pieces = most - most / 4;
    std::vector<std::int64_t> others;
    for (std::int64_t k = 0; k < pieces; ++k) {
        others.clear();
        for (std::int64_t i = all * k / pieces; i < all * (k + 1) / pieces; ++i)
            if (bright[std::size_t(i)])
                add_texel(sample, cube, i, 1);
            else
                others.push_back(i);
        if (!others.empty())
            add_texel(sample, cube, others[mix_bits(std::uint64_t(k)) % others.size()], double(others.size()));
    }
    return sample;
}

namespace {

/// The mean of the finite texels, weighted by solid angle, of a square of `count`^2 texels of a face.
Vec3f mean_of_square(const Cubemap& cube, std::span<const double> angles, int face, int left, int top, int count) {
    Vec3d sum;
    double weight = 0;
    for (int y = top; y < top + count; ++y)
        for (int x = left; x < left + count; ++x) {
            const float* p = cube.face(face).at(x, y);
            const Vec3d value{p[0], p[1], p[2]};
            if (!std::isfinite(value.x + value.y + value.z)) continue;
            const double w = angles[std::size_t(y) * std::size_t(cube.size()) + std::size_t(x)];
            sum += value * w;
            weight += w;
        }
    return Vec3f(weight > 0 ? sum / weight : Vec3d{NAN, NAN, NAN});
}

/// Averages over squares of `count`^2 texels.
Cubemap reduced(const Cubemap& cube, int count, int threads) {
    Cubemap out(cube.size() / count);
    const std::vector<double> angles = cube_solid_angles(cube.size(), threads);
    parallel_for(6 * out.size(), threads, [&](int row) {
        const int face = row / out.size(), y = row % out.size();
        for (int x = 0; x < out.size(); ++x) {
            const Vec3f mean = mean_of_square(cube, angles, face, count * x, count * y, count);
            float* p = out.face(face).at(x, y);
            p[0] = mean.x, p[1] = mean.y, p[2] = mean.z;
        }
    });
    return out;
}

}  // namespace

Cubemap averaged_to(const Cubemap& cube, int size, int threads) {
    if (cube.size() <= size) return cube;
    if (cube.size() % size == 0) return reduced(cube, cube.size() / size, threads);
    return area_resample_cube(cube, size, {}, threads);
}

TexelSample sample_broadly(const Cubemap& cube, int most, int threads) {
    return sample_texels(averaged_to(cube, k_broad_size, threads), most, threads);
}

std::vector<int> turned_texels(const TexelSample& sample, const Mat3& m) {
    const int n = sample.size;
    std::vector<int> turned;
    turned.reserve(sample.texels.size());
    for (const int i : sample.texels) {
        const int x = i % n, row = i / n;
        const CubePoint p = cube_point(m * cube_direction(row / n, {(x + 0.5) / n, (row % n + 0.5) / n}));
        const int tx = std::clamp(int(p.uv.u * n), 0, n - 1), ty = std::clamp(int(p.uv.v * n), 0, n - 1);
        turned.push_back((p.face * n + ty) * n + tx);
    }
    return turned;
}

std::vector<Vec3f> values_at(const Cubemap& cube, std::span<const int> texels) {
    const float* const pixels = cube.pixels().data();
    std::vector<Vec3f> values;
    values.reserve(texels.size());
    for (const int texel : texels) {
        const float* p = pixels + 3 * std::size_t(texel);
        values.push_back({p[0], p[1], p[2]});
    }
    return values;
}

Fit fit_level(const TexelSample& sample, std::span<const Vec3f> exact, double scale, bool quick) {
    const std::size_t count = exact.size();
    Fit fit;
    if (scale > 0) {
        fit.scale = scale;
    } else if (quick) {
        double logs = 0, weight = 0;
        for (std::size_t k = 0; k < count; ++k)
            if (const float e = luminance(exact[k]), t = sample.luminance[k]; e > 0 && t > 0)
                logs += sample.weights[k] * std::log(t / e), weight += sample.weights[k];
        fit.scale = weight > 0 ? std::exp(logs / weight) : 1;
    } else {
        std::vector<Ratio> ratios;
        for (std::size_t k = 0; k < count; ++k)
            if (const float e = luminance(exact[k]); e > 0)
                ratios.push_back({sample.luminance[k] / e, sample.weights[k]});
        fit.scale = weighted_median(ratios);
    }
    if (!(fit.scale > 0)) fit.scale = 1;
    // Relative differences of nearly black values mean nothing: below a thousandth of the mean they count less.
    const double floor = 1e-3 * sample.mean;
    double squared = 0, weight = 0, difference = 0, power = 0;
    for (std::size_t k = 0; k < count; ++k) {
        const Vec3f e = exact[k], t = sample.values[k];
        const double w = sample.weights[k];
        for (const auto& [a, b] : {std::pair(t.x, e.x), std::pair(t.y, e.y), std::pair(t.z, e.z)}) {
            const double f = fit.scale * b, d = a - f, r = d / (std::max(double(a), f) + floor);
            squared += w * r * r;
            difference += w * d * d;
            power += w * f * f;
            fit.largest = std::max(fit.largest, std::abs(r));
        }
        weight += 3 * w;
    }
    fit.error = weight > 0 ? std::sqrt(squared / weight) : 1;
    fit.relative_rmse = power > 0 ? std::sqrt(difference / power) : 0;
    return fit;
}

}  // namespace domelight
