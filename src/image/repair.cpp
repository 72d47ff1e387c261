#include "image/repair.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace domelight {

namespace {

/// Whether every value lies in [0, limit]; false for NaN. Written so that it vectorises.
bool all_within(std::span<const float> values, float limit) {
    int good = 1;
    for (const float v : values) good &= int(v >= 0) & int(v <= limit);
    return good;
}

bool has_nan(const float* texel) {
    return std::isnan(texel[0]) || std::isnan(texel[1]) || std::isnan(texel[2]);
}

/// Infinite channels of one texel; true if there were any. Beyond the format's own range counts as well.
bool limit_texel(float* texel, float largest) {
    bool found = false;
    for (int c = 0; c < 3; ++c) {
        if (!std::isinf(texel[c]) && !(texel[c] > largest)) continue;
        texel[c] = texel[c] > 0 ? largest : 0;
        found = true;
    }
    return found;
}

/// Fills texels with a NaN from their nearest neighbours without one.
void fill_not_a_number(std::span<float> rgb, bool wraps, RepairReport& report) {
    const int width = int(rgb.size() / 3);
    std::vector<int> good;
    for (int x = 0; x < width; ++x)
        if (!has_nan(&rgb[3 * x])) good.push_back(x);
    if (int(good.size()) == width) return;
    report.not_a_number += width - std::int64_t(good.size());

    std::size_t next = 0;  // first good texel right of x
    for (int x = 0; x < width; ++x) {
        while (next < good.size() && good[next] < x) ++next;
        if (next < good.size() && good[next] == x) continue;
        const int n = int(good.size());
        int left = int(next) - 1, right = int(next);
        if (wraps && n > 0) left = (left + n) % n, right %= n;
        double sum[3] = {}, count = 0;
        for (const int side : {left, right}) {
            if (side < 0 || side >= n) continue;
            for (int c = 0; c < 3; ++c) sum[c] += rgb[3 * good[side] + c];
            ++count;
        }
        for (int c = 0; c < 3; ++c) rgb[3 * x + c] = count ? float(sum[c] / count) : 0;
    }
}

void mend_row(std::span<float> rgb, const RepairOptions& options, RepairReport& report) {
    for (std::size_t i = 0; i < rgb.size(); i += 3)
        if (!has_nan(&rgb[i]) && limit_texel(&rgb[i], options.largest)) ++report.infinite;
    fill_not_a_number(rgb, options.wraps, report);
    for (std::size_t i = 0; i < rgb.size(); i += 3) {
        Vec3d v{rgb[i], rgb[i + 1], rgb[i + 2]};
        if (options.to_rec709) v = *options.to_rec709 * v;
        bool negative = false, over = false;
        const double channels[3] = {v.x, v.y, v.z};
        for (int c = 0; c < 3; ++c) {
            const double value = channels[c] * options.scale;
            negative |= value < 0;
            over |= value > k_largest_radiance;
            report.negative_radiance = std::min(report.negative_radiance, value);
            rgb[i + c] = value > 0 ? float(std::min(value, double(k_largest_radiance))) : 0.0f;
        }
        report.negative += negative;
        report.infinite += over;
    }
}

}  // namespace

void repair_row(std::span<float> rgb, const RepairOptions& options, RepairReport& report) {
    const float limit = std::min(options.largest, k_largest_radiance / std::max(options.scale, 1.0f));
    if (options.to_rec709 || !all_within(rgb, limit)) {
        mend_row(rgb, options, report);
    } else if (options.scale != 1) {
        for (float& v : rgb) v *= options.scale;
    }
}

void add_repairs(RepairReport& sum, const RepairReport& part) {
    sum.not_a_number += part.not_a_number;
    sum.infinite += part.infinite;
    sum.negative += part.negative;
    sum.negative_radiance = std::min(sum.negative_radiance, part.negative_radiance);
}

}  // namespace domelight
