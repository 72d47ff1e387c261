// HDR-FLIP: Andersson, Nilsson, Shirley, Akenine-Moeller 2021, "Visualizing errors in rendered high dynamic range
// images".
#include "domelight/base/parallel.h"
#include "domelight/compare/metrics.h"

#include "compare/flip_linear.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace domelight {
namespace {

// The filmic curve of ACES in Narkowicz's fit, with the input multiplied by 0.6 (section 3.2): (k0 x^2 + k1 x + k2) /
// (k3 x^2 + k4 x + k5).
constexpr double k0 = 0.36 * 2.51, k1 = 0.6 * 0.03, k2 = 0, k3 = 0.36 * 2.43, k4 = 0.6 * 0.59, k5 = 0.14;
constexpr double k_saturated = 0.85;  ///< the tone mapper counts as saturated from here on

float aces(float x) {
    const float y = (float(k0) * x * x + float(k1) * x + float(k2)) / (float(k3) * x * x + float(k4) * x + float(k5));
    return std::clamp(y, 0.0f, 1.0f);
}

/// The radiance that maps to k_saturated: the larger root of (k0 - t k3) x^2 + (k1 - t k4) x + (k2 - t k5).
double saturating_radiance() {
    const double a = k0 - k_saturated * k3, b = k1 - k_saturated * k4, c = k2 - k_saturated * k5;
    return (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a);
}

struct ExposureRange {
    double start = 0, stop = 0;
    int count = 2;
};

/// From the exposure at which the brightest pixel just saturates to the one at which the median pixel does (eq. 3 and
/// 4), at most a stop apart.
ExposureRange exposures_of(ImageView<const float> reference) {
    std::vector<float> luminance;
    luminance.reserve(std::size_t(reference.width) * reference.height);
    for (int y = 0; y < reference.height; ++y)
        for (int x = 0; x < reference.width; ++x) {
            const float* p = reference.at(x, y);
            luminance.push_back(0.2126f * p[0] + 0.7152f * p[1] + 0.0722f * p[2]);
        }
    // A black median would ask for infinitely many exposures.
    constexpr float least = std::numeric_limits<float>::epsilon();
    const auto middle = luminance.begin() + std::ptrdiff_t(luminance.size() / 2);
    std::nth_element(luminance.begin(), middle, luminance.end());
    const double median = *middle;  // of an even count the upper middle value, as in the authors' program
    const double brightest = *std::max_element(luminance.begin(), luminance.end());
    ExposureRange range;
    range.start = std::log2(saturating_radiance() / std::max(brightest, double(least)));
    range.stop = std::log2(saturating_radiance() / std::max(median, double(least)));
    range.count = std::max(2, int(std::ceil(range.stop - range.start)));
    return range;
}

ImageF exposed(ImageView<const float> image, double stops, int threads) {
    const float scale = float(std::exp2(stops));
    ImageF out(image.width, image.height, 3);
    parallel_for(image.height, threads, [&](int y) {
        for (int i = 0; i < 3 * image.width; ++i) out.row(y)[i] = aces(scale * std::max(image.row(y)[i], 0.0f));
    });
    return out;
}

}  // namespace

HdrFlip hdr_flip(ImageView<const float> test, ImageView<const float> reference, const FlipOptions& options,
                 int threads) {
    const ExposureRange range = exposures_of(reference);
    HdrFlip result;
    result.start = range.start, result.stop = range.stop, result.count = range.count;
    result.error = ImageF(test.width, test.height, 1);
    result.exposure = ImageF(test.width, test.height, 1, float(range.start));
    for (int i = 0; i < range.count; ++i) {
        const double stops = range.start + (range.stop - range.start) * i / (range.count - 1);
        const ImageF error = flip_linear(exposed(test, stops, threads).view(),
                                         exposed(reference, stops, threads).view(), options, threads);
        for (std::size_t p = 0; p < error.pixels().size(); ++p)
            if (error.pixels()[p] > result.error.pixels()[p]) {
                result.error.pixels()[p] = error.pixels()[p];
                result.exposure.pixels()[p] = float(stops);
            }
    }
    return result;
}

}  // namespace domelight
