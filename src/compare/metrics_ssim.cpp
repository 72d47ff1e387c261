// Structural similarity: Wang, Bovik, Sheikh, Simoncelli 2004, "Image quality assessment: from error visibility to
// structural similarity".
#include "domelight/base/parallel.h"
#include "domelight/compare/metrics.h"

#include "compare/plane_filter.h"

#include <algorithm>
#include <cmath>

namespace domelight {
namespace {

constexpr int k_reach = 5;
constexpr double k_sigma = 1.5, k_c1 = 0.01 * 0.01, k_c2 = 0.03 * 0.03;  ///< (K1 peak)^2, (K2 peak)^2, peak 1

Taps window() {
    Taps taps;
    for (int i = -k_reach; i <= k_reach; ++i) taps.push_back(float(std::exp(-i * i / (2 * k_sigma * k_sigma))));
    return taps;
}

float shown_luminance(const float* rgb) {
    const auto shown = [](float v) { return v > 0 ? v / (1 + v) : 0; };
    return 0.2126f * shown(rgb[0]) + 0.7152f * shown(rgb[1]) + 0.0722f * shown(rgb[2]);
}

/// An image with a border of zeros as wide as the window, so that the filter's repeated pixels are zeros too.
ImageF bordered(int width, int height) {
    return ImageF(width + 2 * k_reach, height + 2 * k_reach, 1);
}

}  // namespace

ImageF ssim(ImageView<const float> test, ImageView<const float> reference, Mask mask, int threads) {
    const int width = test.width, height = test.height;
    // Weighted moments: the weight m (1 inside the mask and the image), m a, m b, m a^2, m b^2, m a b. 1/2 is
    // subtracted from the luminances before they are squared, so that the variance of nearly equal pixels survives the
    // rounding to float.
    ImageF planes[6];
    for (ImageF& plane : planes) plane = bordered(width, height);
    parallel_for(height, threads, [&](int y) {
        for (int x = 0; x < width; ++x) {
            if (mask.data && !(mask.at(x, y)[0] > 0)) continue;
            const float a = shown_luminance(test.at(x, y)) - 0.5f, b = shown_luminance(reference.at(x, y)) - 0.5f;
            const float values[6] = {1, a, b, a * a, b * b, a * b};
            for (int i = 0; i < 6; ++i) *planes[i].at(x + k_reach, y + k_reach) = values[i];
        }
    });
    const Taps taps = window();
    for (ImageF& plane : planes) plane = filter_plane(plane.view(), taps, taps, threads);

    ImageF result(width, height, 1);
    parallel_for(height, threads, [&](int y) {
        for (int x = 0; x < width; ++x) {
            if (mask.data && !(mask.at(x, y)[0] > 0)) continue;
            double m[6];
            for (int i = 0; i < 6; ++i) m[i] = *planes[i].at(x + k_reach, y + k_reach);
            const double a = m[1] / m[0], b = m[2] / m[0];
            const double aa = std::max(m[3] / m[0] - a * a, 0.0), bb = std::max(m[4] / m[0] - b * b, 0.0);
            // In flat windows the covariance is nothing but rounding error. It is limited by the variances, so that
            // equal images give exactly 1.
            const double most = std::sqrt(aa * bb), ab = std::clamp(m[5] / m[0] - a * b, -most, most), mean_a = a + 0.5,
                         mean_b = b + 0.5;
            *result.at(x, y) = float((2 * mean_a * mean_b + k_c1) * (2 * ab + k_c2) /
                                     ((mean_a * mean_a + mean_b * mean_b + k_c1) * (aa + bb + k_c2)));
        }
    });
    return result;
}

}  // namespace domelight
