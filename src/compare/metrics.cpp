#include "domelight/compare/metrics.h"

#include "domelight/base/parallel.h"

#include "compare/mask.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <map>

namespace domelight {
namespace {

float tone_mapped(float v) {
    return v > 0 ? v / (1 + v) : 0;
}

/// Adds up the results of `row(y)`: rows are computed in parallel and added in order.
template <typename Sums, typename Row>
Sums sum_rows(int height, int threads, Row row) {
    std::vector<Sums> rows(std::size_t(height), Sums{});
    parallel_for(height, threads, [&](int y) { rows[std::size_t(y)] = row(y); });
    Sums total{};
    for (const Sums& sums : rows) total += sums;
    return total;
}

struct ErrorSums {
    double squared = 0, reference_squared = 0, tone_mapped_squared = 0, test = 0, reference = 0, largest = 0;
    std::int64_t pixels = 0;
    int x = 0, y = 0;
    void add(const float* a, const float* b, int px, int py) {
        for (int c = 0; c < 3; ++c) {
            const double d = double(a[c]) - b[c], t = double(tone_mapped(a[c])) - tone_mapped(b[c]);
            squared += d * d;
            tone_mapped_squared += t * t;
            reference_squared += double(b[c]) * b[c];
            test += a[c];
            reference += b[c];
            if (std::abs(d) > largest) largest = std::abs(d), x = px, y = py;
        }
        ++pixels;
    }
    void operator+=(const ErrorSums& b) {
        squared += b.squared, reference_squared += b.reference_squared, tone_mapped_squared += b.tone_mapped_squared;
        test += b.test, reference += b.reference, pixels += b.pixels;
        if (b.largest > largest) largest = b.largest, x = b.x, y = b.y;
    }
};

/// All figures except the structural similarity.
Errors errors_of(const ErrorSums& s) {
    Errors e;
    e.pixels = s.pixels;
    if (s.pixels == 0) return e;
    constexpr double infinite = std::numeric_limits<double>::infinity();
    const double values = 3 * double(s.pixels);
    e.rmse = std::sqrt(s.squared / values);
    if (s.squared > 0)
        e.relative_rmse = s.reference_squared > 0 ? std::sqrt(s.squared / s.reference_squared) : infinite;
    e.tone_mapped_rmse = std::sqrt(s.tone_mapped_squared / values);
    e.mean_ratio = s.test == s.reference ? 1 : s.test / s.reference;
    e.largest = s.largest;
    e.largest_x = s.x, e.largest_y = s.y;
    e.psnr = e.tone_mapped_rmse > 0 ? -20 * std::log10(e.tone_mapped_rmse) : infinite;
    return e;
}

}  // namespace

Errors compare_images(ImageView<const float> test, ImageView<const float> reference, Mask mask, int threads) {
    assert(test.width == reference.width && test.height == reference.height);
    assert(test.channels == 3 && reference.channels == 3);
    Errors e = errors_of(sum_rows<ErrorSums>(test.height, threads, [&](int y) {
        ErrorSums row;
        for (int x = 0; x < test.width; ++x)
            if (counts(mask, x, y)) row.add(test.at(x, y), reference.at(x, y), x, y);
        return row;
    }));
    if (e.pixels > 0) e.ssim = mean_of(ssim(test, reference, mask, threads).view(), mask);
    return e;
}

std::vector<ObjectErrors> compare_objects(ImageView<const float> test, ImageView<const float> reference,
                                          ImageView<const float> objects, Mask mask, int threads) {
    struct Object {
        ErrorSums sums;
        double ssim = 0;
    };
    std::map<int, Object> found;
    const ImageF similarity = ssim(test, reference, mask, threads);
    for (int y = 0; y < test.height; ++y)
        for (int x = 0; x < test.width; ++x) {
            const float id = objects.at(x, y)[0];
            if (!counts(mask, x, y) || !(id >= 0 && id < 1e9f)) continue;
            Object& object = found[int(std::lround(id))];
            object.sums.add(test.at(x, y), reference.at(x, y), x, y);
            object.ssim += *similarity.at(x, y);
        }
    std::vector<ObjectErrors> result;
    for (const auto& [index, object] : found) {
        result.push_back({index, errors_of(object.sums)});
        result.back().errors.ssim = object.ssim / double(object.sums.pixels);
    }
    return result;
}

namespace {

struct NoiseSums {
    double z = 0, z2 = 0, test = 0, reference = 0, test_variance = 0, reference_variance = 0;
    std::int64_t values = 0, above = 0, without = 0;
    void operator+=(const NoiseSums& b) {
        z += b.z, z2 += b.z2, test += b.test, reference += b.reference;
        test_variance += b.test_variance, reference_variance += b.reference_variance;
        values += b.values, above += b.above, without += b.without;
    }
};

}  // namespace

NoiseSummary compare_noisy(ImageView<const float> test, ImageView<const float> reference,
                           ImageView<const float> test_variance, ImageView<const float> reference_variance, Mask mask,
                           int threads) {
    const NoiseSums s = sum_rows<NoiseSums>(test.height, threads, [&](int y) {
        NoiseSums row;
        for (int x = 0; x < test.width; ++x) {
            if (!counts(mask, x, y)) continue;
            for (int c = 0; c < 3; ++c) {
                const double a = test.at(x, y)[c], b = reference.at(x, y)[c];
                const double va = test_variance.data ? test_variance.at(x, y)[c] : 0;
                const double vb = reference_variance.data ? reference_variance.at(x, y)[c] : 0;
                row.test += a, row.reference += b, row.test_variance += va, row.reference_variance += vb;
                if (!(va + vb > 0)) {
                    row.without += a != b;
                    continue;
                }
                const double z = (a - b) / std::sqrt(va + vb);
                row.z += z, row.z2 += z * z;
                row.above += std::abs(z) > 2;
                ++row.values;
            }
        }
        return row;
    });
    NoiseSummary n;
    n.values = s.values;
    n.without_noise = s.without;
    if (s.values > 0) {
        n.mean_z = s.z / double(s.values);
        n.chi2 = s.z2 / double(s.values);
        n.share_above_2 = double(s.above) / double(s.values);
    }
    const double variance = s.test_variance + s.reference_variance;
    if (variance > 0) n.total_z = (s.test - s.reference) / std::sqrt(variance);
    n.mean_ratio = s.test == s.reference ? 1 : s.test / s.reference;
    // For r = A / B: var r = (var A + r² var B) / B².
    const double error = std::sqrt(s.test_variance + n.mean_ratio * n.mean_ratio * s.reference_variance) /
                         std::max(std::abs(s.reference), std::numeric_limits<double>::min());
    constexpr double k_95 = 1.959964;
    n.ratio_low = n.mean_ratio - k_95 * error;
    n.ratio_high = n.mean_ratio + k_95 * error;
    return n;
}

BadPixels find_bad_pixels(ImageView<const float> image, Mask mask) {
    BadPixels bad;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const float* p = image.at(x, y);
            if (std::all_of(p, p + image.channels, [](float v) { return std::isfinite(v); }) || !counts(mask, x, y))
                continue;
            if (bad.count++ == 0) bad.x = x, bad.y = y;
        }
    return bad;
}

double mean_of(ImageView<const float> error, Mask mask) {
    double sum = 0;
    std::int64_t pixels = 0;
    for (int y = 0; y < error.height; ++y)
        for (int x = 0; x < error.width; ++x)
            if (counts(mask, x, y)) sum += error.at(x, y)[0], ++pixels;
    return pixels ? sum / double(pixels) : 0;
}

}  // namespace domelight
