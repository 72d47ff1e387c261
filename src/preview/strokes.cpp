#include "preview/strokes.h"

#include <algorithm>
#include <cmath>

namespace domelight {

void stroke(ImageView<std::uint8_t> image, double x0, double y0, double x1, double y1, double width, Colour8 colour,
            double opacity) {
    const double r = width / 2, reach = r + 1, dx = x1 - x0, dy = y1 - y0, length2 = dx * dx + dy * dy;
    // Clamped while still in double: far outside is no reason for a large loop or an integer that overflows.
    const auto pixel = [](double at, int end) { return int(std::clamp(at, -1.0, double(end))); };
    const int left = std::max(0, pixel(std::floor(std::min(x0, x1) - reach), image.width));
    const int right = std::min(image.width - 1, pixel(std::ceil(std::max(x0, x1) + reach), image.width));
    const int top = std::max(0, pixel(std::floor(std::min(y0, y1) - reach), image.height));
    const int bottom = std::min(image.height - 1, pixel(std::ceil(std::max(y0, y1) + reach), image.height));
    for (int y = top; y <= bottom; ++y)
        for (int x = left; x <= right; ++x) {
            const double px = x + 0.5 - x0, py = y + 0.5 - y0;
            const double t = length2 > 0 ? std::clamp((px * dx + py * dy) / length2, 0.0, 1.0) : 0;
            const double apart = std::hypot(px - t * dx, py - t * dy);
            const double covered = std::clamp(r + 0.5 - apart, 0.0, 1.0);
            if (covered > 0) blend(image, x, y, colour, float(covered * opacity));
        }
}

void disc(ImageView<std::uint8_t> image, double x, double y, double radius, Colour8 colour, double opacity) {
    stroke(image, x, y, x, y, 2 * radius, colour, opacity);
}

}  // namespace domelight
