#include "preview/plot.h"

#include "preview/light_page.h"
#include "preview/strokes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace domelight {
namespace {

constexpr Colour8 k_grid{218, 221, 226}, k_fine_grid{238, 240, 243};
/// Colours that people with any colour vision can distinguish, the most distinct first (Okabe and Ito 2008, without the
/// yellow, which is invisible on white paper, and with three more).
constexpr Colour8 k_palette[] = {{213, 94, 0},   {0, 114, 178}, {0, 158, 115}, {204, 121, 167}, {230, 159, 0},
                                 {86, 180, 233}, {0, 0, 0},     {130, 90, 60}, {130, 136, 144}};
constexpr int k_line_pixels = 20;

/// An axis whose ends are determined.
struct Scale {
    bool logarithmic = false;
    double low = 0, high = 1;  ///< of the values; of their base-10 logarithms if logarithmic
    double from = 0, to = 1;   ///< pixels
    bool has(double v) const { return std::isfinite(v) && (!logarithmic || v > 0); }
    double at(double v) const {
        const double x = logarithmic ? std::log10(v) : v;
        return from + (x - low) / (high - low) * (to - from);
    }
};

Scale settle(const PlotAxis& axis, const std::vector<PlotSeries>& series, int coordinate) {
    Scale s;
    s.logarithmic = axis.scale == PlotScale::logarithmic;
    double low = INFINITY, high = -INFINITY;
    const auto widen = [&](double v) {
        if (!s.has(v)) return;
        low = std::min(low, s.logarithmic ? std::log10(v) : v);
        high = std::max(high, s.logarithmic ? std::log10(v) : v);
    };
    if (axis.range) {
        for (const double v : *axis.range) widen(v);
    } else {
        for (const PlotSeries& line : series)
            for (const auto& p : line.points) widen(p[coordinate]);
    }
    if (!(low <= high)) low = 0, high = 1;
    if (!(high - low > 1e-12 * std::max(1.0, std::abs(high)))) low -= 0.5, high += 0.5;
    if (!axis.range) {
        const double room = 0.04 * (high - low);
        low -= room;
        high += room;
    }
    s.low = low;
    s.high = high;
    return s;
}

struct Tick {
    double value;
    std::string text;      ///< empty: a line without a number
    std::string exponent;  ///< raised
};

std::vector<Tick> logarithmic_ticks(const Scale& s) {
    std::vector<Tick> ticks;
    const int first = int(std::floor(s.low)), last = int(std::ceil(s.high)), decades = last - first;
    const int step = std::max(1, (decades + 7) / 8);
    for (int k = first; k <= last; ++k) {
        const double base = std::pow(10.0, k);
        if (k % step == 0) {
            if (k >= -2 && k <= 3)
                ticks.push_back({base, fmt::format("{:.{}f}", base, std::max(0, -k)), ""});
            else
                ticks.push_back({base, "10", k < 0 ? fmt::format("−{}", -k) : fmt::format("{}", k)});
        }
        if (decades <= 8)
            for (int m = 2; m < 10; ++m) {
                // Less than one decade: the multiples need numbers, because otherwise the axis has none.
                const bool number = s.high - s.low < 1.2 && (m == 2 || m == 5);
                ticks.push_back({m * base, number ? fmt::format("{:.3g}", m * base) : "", ""});
            }
    }
    return ticks;
}

std::vector<Tick> linear_ticks(const Scale& s, int most) {
    const double span = s.high - s.low, raw = span / most, base = std::pow(10.0, std::floor(std::log10(raw)));
    double step = 10 * base;
    for (const double m : {1, 2, 5})
        if (m * base >= raw) {
            step = m * base;
            break;
        }
    std::vector<Tick> ticks;
    const int digits = std::max(0, -int(std::floor(std::log10(step) + 1e-9)));
    for (double k = std::ceil(s.low / step - 1e-9); k * step <= s.high + 1e-9 * span; ++k) {
        const double v = k * step;
        ticks.push_back({v,
                         std::abs(v) >= 1e6 || (digits > 6) ? fmt::format("{:.7g}", v)
                                                            : fmt::format("{:.{}f}", k == 0 ? 0.0 : v, digits),
                         ""});
    }
    return ticks;
}

std::vector<Tick> ticks_of(const Scale& s, int most) {
    auto ticks = s.logarithmic ? logarithmic_ticks(s) : linear_ticks(s, most);
    std::erase_if(ticks, [&](const Tick& t) {
        const double at = s.logarithmic ? std::log10(t.value) : t.value, slack = 1e-9 * (s.high - s.low);
        return at < s.low - slack || at > s.high + slack;
    });
    return ticks;
}

int tick_width(const Tick& t) {
    return text_width(t.text, FontSize::small) + text_width(t.exponent, FontSize::small);
}
void draw_tick(ImageView<std::uint8_t> image, int x, int baseline, const Tick& t) {
    draw_text(image, x, baseline, t.text, FontSize::small, k_faint_ink);
    draw_text(image, x + text_width(t.text, FontSize::small), baseline - 6, t.exponent, FontSize::small, k_faint_ink);
}

/// A part of a picture as a separate picture, so that nothing is drawn outside it.
ImageView<std::uint8_t> part(ImageView<std::uint8_t> image, Rect r) {
    const int x0 = std::clamp(r.x, 0, image.width), y0 = std::clamp(r.y, 0, image.height);
    const int x1 = std::clamp(r.x + r.width, x0, image.width), y1 = std::clamp(r.y + r.height, y0, image.height);
    return {image.data + y0 * image.stride + std::ptrdiff_t(x0) * image.channels, x1 - x0, y1 - y0, image.channels,
            image.stride};
}

void draw_segment(ImageView<std::uint8_t> image, PlotLine line, double& walked, double x0, double y0, double x1,
                  double y1, Colour8 colour) {
    if (line == PlotLine::solid) return stroke(image, x0, y0, x1, y1, 2.2, colour);
    // Numbers of pixels on and off, continued from the segment before
    const double length = std::hypot(x1 - x0, y1 - y0), on = line == PlotLine::dotted ? 1 : 7, period = on + 5;
    double at = 0;
    while (at < length && length < 1e5) {
        const double phase = std::fmod(walked + at, period);
        const double next = std::min(length, at + (phase < on ? on - phase : period - phase) + 1e-6);
        if (phase < on) {
            const double a = at / length, b = next / length;
            stroke(image, x0 + a * (x1 - x0), y0 + a * (y1 - y0), x0 + b * (x1 - x0), y0 + b * (y1 - y0), 1.8, colour);
        }
        at = next;
    }
    walked += length;
}

void draw_series(ImageView<std::uint8_t> area, const PlotSeries& series, const Scale& x, const Scale& y,
                 Colour8 colour) {
    const auto shown = [&](const std::array<double, 2>& p) { return x.has(p[0]) && y.has(p[1]); };
    if (series.filled)
        for (int i = 0; i < area.width; ++i) {
            // The value over a column's middle, by the line through the points (in x order).
            for (std::size_t k = 0; k + 1 < series.points.size(); ++k) {
                const auto &a = series.points[k], &b = series.points[k + 1];
                if (!shown(a) || !shown(b)) continue;
                const double ax = x.at(a[0]), bx = x.at(b[0]), c = i + 0.5;
                if (!(ax <= c && c < bx)) continue;
                const double top = y.at(a[1]) + (y.at(b[1]) - y.at(a[1])) * (c - ax) / (bx - ax);
                for (int j = std::max(0, int(top)); j < area.height; ++j) blend(area, i, j, colour, 0.16f);
            }
        }
    double walked = 0;
    for (std::size_t k = 0; series.line != PlotLine::none && k + 1 < series.points.size(); ++k) {
        const auto &a = series.points[k], &b = series.points[k + 1];
        if (shown(a) && shown(b))
            draw_segment(area, series.line, walked, x.at(a[0]), y.at(a[1]), x.at(b[0]), y.at(b[1]), colour);
    }
    for (const auto& p : series.points)
        if (series.marks && shown(p)) disc(area, x.at(p[0]), y.at(p[1]), 4, colour);
}

}  // namespace

Colour8 plot_colour(std::size_t i) {
    return k_palette[i % std::size(k_palette)];
}

void draw_plot(ImageView<std::uint8_t> image, Rect where, const Plot& plot) {
    ImageView<std::uint8_t> page = part(image, where);
    fill(page, {0, 0, page.width, page.height}, k_paper);
    Scale x = settle(plot.x, plot.series, 0), y = settle(plot.y, plot.series, 1);
    const auto y_ticks = ticks_of(y, std::max(2, page.height / 70)),
               x_ticks = ticks_of(x, std::max(2, page.width / 110));

    int legend = 0, left = 24;
    for (const PlotSeries& s : plot.series)
        if (!s.name.empty()) legend = std::max(legend, text_width(s.name, FontSize::small) + 56);
    for (const Tick& t : y_ticks) left = std::max(left, tick_width(t) + 18);
    int top = 14;
    if (!plot.title.empty()) {
        draw_text(page, 16, top + 20, fit_text(plot.title, FontSize::large, page.width - 32), FontSize::large, k_ink);
        top += 30;
    }
    if (!plot.subtitle.empty()) {
        draw_text(page, 16, top + 14, fit_text(plot.subtitle, FontSize::small, page.width - 32), FontSize::small,
                  k_faint_ink);
        top += k_line_pixels;
    }
    if (!plot.y.label.empty()) {
        draw_text(page, 16, top + 18, plot.y.label, FontSize::small, k_ink);
        top += k_line_pixels + 4;
    }
    const Rect area{left, top + 6, std::max(10, page.width - left - 18 - legend),
                    std::max(10, page.height - top - 6 - (plot.x.label.empty() ? 30 : 52))};
    x.from = 0, x.to = area.width, y.from = area.height, y.to = 0;

    ImageView<std::uint8_t> inside = part(page, area);
    for (const bool numbered : {false, true}) {  // fine lines first
        for (const Tick& t : x_ticks)
            if (!t.text.empty() == numbered) {
                const int at = int(std::lround(x.at(t.value)));
                fill(inside, {std::min(at, area.width - 1), 0, 1, area.height}, numbered ? k_grid : k_fine_grid);
                if (numbered) draw_tick(page, area.x + at - tick_width(t) / 2, area.y + area.height + 20, t);
            }
        for (const Tick& t : y_ticks)
            if (!t.text.empty() == numbered) {
                const int at = int(std::lround(y.at(t.value)));
                fill(inside, {0, std::min(at, area.height - 1), area.width, 1}, numbered ? k_grid : k_fine_grid);
                if (numbered) draw_tick(page, area.x - 8 - tick_width(t), area.y + at + 5, t);
            }
    }
    draw_text(page, area.x + area.width / 2, area.y + area.height + 44, plot.x.label, FontSize::small, k_ink,
              Align::centre);

    std::size_t next = 0;
    int key = area.y + 12;
    for (const PlotSeries& s : plot.series) {
        const Colour8 colour = s.colour ? *s.colour : plot_colour(next++);
        draw_series(inside, s, x, y, colour);
        if (s.name.empty()) continue;
        const int kx = area.x + area.width + 16;
        double walked = 0;
        if (s.line != PlotLine::none) draw_segment(page, s.line, walked, kx, key, kx + 26, key, colour);
        if (s.marks) disc(page, kx + 13, key, 4, colour);
        draw_text(page, kx + 34, key + 5, s.name, FontSize::small, k_ink);
        key += k_line_pixels + 2;
    }
    frame(page, {area.x - 1, area.y - 1, area.width + 2, area.height + 2}, k_faint_ink);
}

Image<std::uint8_t> draw_plot(const Plot& plot, int width, int height) {
    Image<std::uint8_t> image(width, height, 3);
    draw_plot(image.view(), {0, 0, width, height}, plot);
    return image;
}

}  // namespace domelight
