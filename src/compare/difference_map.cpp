#include "domelight/compare/difference_map.h"

#include "domelight/compare/compare_sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>

namespace domelight {
namespace {

/// A value for each pixel of the two pictures.
ImageF map_of(const PicturePair& pair,
              const std::function<double(const float* a, const float* b, int x, int y)>& value) {
    const ImageF &test = pair.test.rgb, &reference = pair.reference.rgb;
    ImageF out(test.width(), test.height(), 1);
    for (int y = 0; y < out.height(); ++y)
        for (int x = 0; x < out.width(); ++x) *out.at(x, y) = float(value(test.at(x, y), reference.at(x, y), x, y));
    return out;
}

/// The largest over the channels of each pixel.
ImageF largest_of(const PicturePair& pair, const std::function<double(double a, double b)>& value) {
    return map_of(pair, [&](const float* a, const float* b, int, int) {
        double most = 0;
        for (int c = 0; c < 3; ++c) most = std::max(most, value(double(a[c]), double(b[c])));
        return most;
    });
}

double tone(double v) {
    return v > 0 ? v / (1 + v) : 0;
}

/// A - B in the luminance that a display would show: of L / (1 + L) at the sheet's exposure.
ImageF signed_difference(const PicturePair& pair, double exposure_ev) {
    const double scale = std::exp2(exposure_ev);
    const auto shown_luminance = [scale](const float* p) {
        return 0.2126 * tone(scale * p[0]) + 0.7152 * tone(scale * p[1]) + 0.0722 * tone(scale * p[2]);
    };
    return map_of(pair,
                  [&](const float* a, const float* b, int, int) { return shown_luminance(a) - shown_luminance(b); });
}

/// (A - B) / standard error, of the channels' sums.
ImageF standard_scores(const PicturePair& pair) {
    const auto variance = [&](int x, int y) {
        double v = 0;
        for (const ImageF* image : {&pair.test.variance, &pair.reference.variance})
            if (!image->empty()) v += image->at(x, y)[0] + image->at(x, y)[1] + image->at(x, y)[2];
        return v;
    };
    return map_of(pair, [&](const float* a, const float* b, int x, int y) {
        const double v = variance(x, y), d = double(a[0]) + a[1] + a[2] - b[0] - b[1] - b[2];
        return v > 0 ? d / std::sqrt(v) : 0;
    });
}

ImageF dissimilarity(const PicturePair& pair, int threads) {
    ImageF map = ssim(pair.test.rgb.view(), pair.reference.rgb.view(), pair.mask_view(), threads);
    for (float& v : map.pixels()) v = 1 - v;
    return map;
}

HeatMap heat_map(const DifferenceMap& map, Mask mask, double high) {
    const double own = map.high > 0 ? map.high : scale_for(map.values.view(), mask);
    return {map.values.view(), map.title, high > 0 ? high : own, map.is_signed};
}

std::string file_name(const std::string& path) {
    return std::filesystem::path(path).filename().string();
}

}  // namespace

const std::vector<std::string>& difference_maps() {
    static const std::vector<std::string> names = {"auto",        "hdr-flip", "flip", "difference",
                                                   "tone-mapped", "relative", "ssim", "z"};
    return names;
}

std::optional<DifferenceMap> difference_map(const PicturePair& pair, const PictureComparison& c, std::string_view name,
                                            int threads) {
    if (name == "auto") name = c.hdr_flip ? "hdr-flip" : c.flip ? "flip" : "tone-mapped";
    if (name == "hdr-flip" && c.hdr_flip)
        return DifferenceMap{c.hdr.error, fmt::format("HDR-FLIP, mean {:.4g}", *c.hdr_flip), 1, false};
    if (name == "flip" && c.flip)
        return DifferenceMap{c.flip_map, fmt::format("FLIP at {:+.2f} EV, mean {:.4g}", c.exposure_ev, *c.flip), 1,
                             false};
    if (name == "difference")
        return DifferenceMap{signed_difference(pair, c.exposure_ev),
                             fmt::format("A - B, luminance of L / (1 + L) at {:+.2f} EV", c.exposure_ev), 0, true};
    if (name == "tone-mapped")
        return DifferenceMap{largest_of(pair, [](double a, double b) { return std::abs(tone(a) - tone(b)); }),
                             "|A - B| of L / (1 + L), largest channel", 0, false};
    if (name == "relative")
        return DifferenceMap{
            largest_of(pair, [](double a, double b) { return a == b ? 0 : std::abs(a - b) / (std::abs(b) + 1e-6); }),
            "|A - B| / B, largest channel", 0, false};
    if (name == "ssim") return DifferenceMap{dissimilarity(pair, threads), "1 - SSIM", 1, false};
    if (name == "z" && c.noise)
        return DifferenceMap{standard_scores(pair), "z = (A - B) / standard error, of the channels' sum", 4, true};
    return std::nullopt;
}

Image<std::uint8_t> heat_picture(const DifferenceMap& map, Mask mask, double high) {
    return heat_picture(heat_map(map, mask, high), mask);
}

Image<std::uint8_t> comparison_sheet(const PicturePair& pair, const PictureComparison& c, const std::string& test_name,
                                     const std::string& reference_name, int threads) {
    const auto difference = difference_map(pair, c, "difference", threads),
               perceived = difference_map(pair, c, "auto", threads);
    CompareSheet sheet;
    sheet.title = fmt::format("{} against {}", file_name(test_name), file_name(reference_name));
    sheet.subtitle = fmt::format(
        "relative RMSE {:.3g} %   ·   RMSE of L / (1 + L) {:.3g}   ·   SSIM {:.4f}   ·   mean A / mean B {:.5g}",
        100 * c.errors.relative_rmse, c.errors.tone_mapped_rmse, c.errors.ssim, c.errors.mean_ratio);
    sheet.test_name = test_name, sheet.reference_name = reference_name;
    sheet.test = pair.test.rgb.view(), sheet.reference = pair.reference.rgb.view();
    sheet.exposure_ev = c.exposure_ev;
    sheet.tone_map = pair.high_dynamic_range();
    sheet.mask = pair.mask_view();
    sheet.difference = heat_map(*difference, sheet.mask, 0);
    sheet.perceived = heat_map(*perceived, sheet.mask, 0);
    return compare_sheet(sheet, threads);
}

}  // namespace domelight
