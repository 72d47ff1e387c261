#include "preview/exposure_meter.h"

#include "domelight/image/colour.h"

#include <algorithm>
#include <cmath>

namespace domelight {

void ExposureMeter::add(ImageView<const float> rgb, ImageView<const float> opacity, bool premultiplied) {
    const double pixels = double(rgb.width) * rgb.height;
    const int step = std::max(1, int(std::ceil(std::sqrt(pixels / 4e6))));
    for (int y = 0; y < rgb.height; y += step)
        for (int x = 0; x < rgb.width; x += step) {
            const double covered = opacity.width > 0 ? *opacity.at(x, y) : 1, shown = luminance(rgb.at(x, y));
            pixels_ += 1;
            if (!std::isfinite(shown)) continue;
            // Behind a part of the pixel nothing shows, so the rest of it shone the brighter.
            if (covered > 0)
                surfaces_.push_back({premultiplied ? shown / covered : shown, covered});
            else
                background_.push_back({shown, 1});
        }
}

double ExposureMeter::mean(const std::vector<Shown>& shown) {
    double sum = 0, weights = 0;
    for (const Shown& s : shown) sum += s.weight * s.luminance, weights += s.weight;
    return weights > 0 ? sum / weights : 0;
}

/// The luminance that `part` of what is brighter than `darkest` lies below; 0 where nothing is brighter.
double ExposureMeter::quantile(std::vector<Shown> shown, double part, double darkest) {
    std::erase_if(shown, [&](const Shown& s) { return !(s.luminance > darkest); });
    if (shown.empty()) return 0;
    std::ranges::sort(shown, {}, &Shown::luminance);
    double weights = 0, below = 0;
    for (const Shown& s : shown) weights += s.weight;
    for (const Shown& s : shown)
        if ((below += s.weight) >= part * weights) return s.luminance;
    return shown.back().luminance;
}

double ExposureMeter::ev() const {
    double covered = 0;
    for (const Shown& s : surfaces_) covered += s.weight;
    const bool any = covered > 1e-4 * pixels_;
    const std::vector<Shown>& shown = any ? surfaces_ : background_;
    const double average = mean(shown);
    if (!(average > 0)) return 0;
    const double floor = 1e-3 * average;
    double sum = 0, weights = 0;
    for (const Shown& s : shown) sum += s.weight * std::log(std::max(floor, s.luminance)), weights += s.weight;
    double exposure = 0.18 / std::exp(sum / weights);
    constexpr double most_shown = 4;
    if (const double bright = quantile(shown, 0.95, floor); bright > 0)
        exposure = std::min(exposure, most_shown / bright);
    if (const double behind = quantile(background_, 0.5, 0); any && behind > 0)
        exposure = std::min(exposure, most_shown / behind);
    return std::log2(exposure);
}

}  // namespace domelight
