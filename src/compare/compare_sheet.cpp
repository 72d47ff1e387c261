#include "domelight/compare/compare_sheet.h"

#include "domelight/base/parallel.h"

#include "compare/mask.h"
#include "image/draw.h"
#include "preview/colour_map.h"
#include "preview/dark_page.h"
#include "preview/tonemap.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace domelight {
namespace {

constexpr Colour8 k_edge{52, 54, 60}, k_masked{70, 72, 78};
constexpr int k_border = 24,
              k_scale_height = 44;  ///< pixels; the height of a colour scale with its numbers

Colour8 colour_of(const HeatMap& map, float value) {
    const float t = float(value / map.high);
    return map.is_signed ? signed_colour(t) : heat_colour(t);
}

/// How a picture is fitted into a rectangle: enlarged by a whole number, or reduced by averaging boxes of pixels.
struct Fit {
    int width = 0, height = 0;
    Fit(int w, int h, int room) {
        if (w <= room) {
            const int times = std::max(1, room / w);
            width = w * times, height = h * times;
        } else {
            width = room, height = std::max(1, int(std::lround(double(h) * room / w)));
        }
    }
};

/// The pixels of `image` under pixel (x, y) of a picture of the fit's size: [x0, x1) x [y0, y1).
struct Box {
    int x0, x1, y0, y1;
    Box(int x, int y, const Fit& fit, int width, int height) {
        const auto range = [](int i, int out, int in, int& a, int& b) {
            a = int(std::int64_t(i) * in / out);
            b = std::max(a + 1, int(std::int64_t(i + 1) * in / out));
        };
        range(x, fit.width, width, x0, x1);
        range(y, fit.height, height, y0, y1);
    }
};

template <typename F>
void draw_boxes(ImageView<std::uint8_t> image, int left, int top, const Fit& fit, int width, int height, int threads,
                F colour) {
    parallel_for(fit.height, threads, [&](int y) {
        for (int x = 0; x < fit.width; ++x) {
            const Colour8 c = colour(Box(x, y, fit, width, height));
            std::uint8_t* p = image.at(left + x, top + y);
            p[0] = c.r, p[1] = c.g, p[2] = c.b;
        }
    });
}

/// Radiance is averaged before the tone map is applied, as a camera further away would do.
void draw_picture(ImageView<std::uint8_t> image, int left, int top, const Fit& fit, ImageView<const float> picture,
                  const Display& display, int threads) {
    draw_boxes(image, left, top, fit, picture.width, picture.height, threads, [&](const Box& b) -> Colour8 {
        Vec3f sum;
        for (int y = b.y0; y < b.y1; ++y)
            for (int x = b.x0; x < b.x1; ++x) {
                const float* p = picture.at(x, y);
                sum += Vec3f{p[0], p[1], p[2]};
            }
        const auto c = display.rgb8(sum / float((b.x1 - b.x0) * (b.y1 - b.y0)));
        return {c[0], c[1], c[2]};
    });
}

void draw_map(ImageView<std::uint8_t> image, int left, int top, const Fit& fit, const HeatMap& map, Mask mask,
              int threads) {
    draw_boxes(image, left, top, fit, map.values.width, map.values.height, threads, [&](const Box& b) -> Colour8 {
        float sum = 0;
        int count = 0;
        for (int y = b.y0; y < b.y1; ++y)
            for (int x = b.x0; x < b.x1; ++x)
                if (counts(mask, x, y)) sum += map.values.at(x, y)[0], ++count;
        return count ? colour_of(map, sum / float(count)) : k_masked;
    });
}

/// The colours from one end to the other with five numbers below.
void draw_scale(ImageView<std::uint8_t> image, int left, int top, int width, const HeatMap& map) {
    for (int x = 0; x < width; ++x) {
        const double t = double(x) / std::max(1, width - 1);
        fill(image, {left + x, top, 1, 16}, colour_of(map, float(map.high * (map.is_signed ? 2 * t - 1 : t))));
    }
    frame(image, {left, top, width, 16}, k_edge);
    constexpr int k_ticks = 5;
    for (int i = 0; i < k_ticks; ++i) {
        const double t = double(i) / (k_ticks - 1), value = map.high * (map.is_signed ? 2 * t - 1 : t);
        const int x = left + int(std::lround(t * (width - 1)));
        fill(image, {x, top + 16, 1, 4}, k_quiet);
        const std::string sign = map.is_signed && value > 0 ? "+" : "";
        draw_text(image, x, top + 36, sign + fmt::format("{:.3g}", value), FontSize::small, k_quiet,
                  i == 0             ? Align::left
                  : i + 1 == k_ticks ? Align::right
                                     : Align::centre);
    }
}

}  // namespace

double scale_for(ImageView<const float> values, Mask mask) {
    std::vector<float> sizes;
    for (int y = 0; y < values.height; ++y)
        for (int x = 0; x < values.width; ++x)
            if (counts(mask, x, y) && std::isfinite(values.at(x, y)[0])) sizes.push_back(std::abs(values.at(x, y)[0]));
    if (sizes.empty()) return 1;
    const auto place = sizes.begin() + std::ptrdiff_t(double(sizes.size() - 1) * 0.995);
    std::nth_element(sizes.begin(), place, sizes.end());
    const double wanted = *place > 0 ? *place : *std::max_element(sizes.begin(), sizes.end());
    if (!(wanted > 0)) return 1;
    const double ten = std::pow(10.0, std::floor(std::log10(wanted)));
    for (const double step : {1.0, 2.0, 5.0})
        if (wanted <= step * ten) return step * ten;
    return 10 * ten;
}

Image<std::uint8_t> heat_picture(const HeatMap& map, Mask mask) {
    const int times = std::max(1, 400 / map.values.width);
    const int width = map.values.width * times, height = map.values.height * times;
    const int sheet_width = std::max(width, 400), top = 34;
    Image<std::uint8_t> image(sheet_width, top + height + 10 + k_scale_height, 3);
    fill(image.view(), {0, 0, image.width(), image.height()}, k_background);
    draw_text(image.view(), 8, 22, fit_text(map.title, FontSize::small, sheet_width - 16), FontSize::small, k_bright);
    Fit fit(map.values.width, map.values.height, map.values.width);
    fit.width = width, fit.height = height;
    draw_map(image.view(), (sheet_width - width) / 2, top, fit, map, mask, 0);
    draw_scale(image.view(), 8, top + height + 8, sheet_width - 16, map);
    return image;
}

Image<std::uint8_t> compare_sheet(const CompareSheet& sheet, int threads) {
    const int w = sheet.test.width, h = sheet.test.height;
    const int columns = w > 1.6 * h ? 2 : 4, room = columns == 2 ? 760 : 440;
    const Fit fit(w, h, room);
    const int cell = std::max(fit.width, 300), cell_height = fit.height + 34 + k_scale_height + 8, header = 76;
    Image<std::uint8_t> image(2 * k_border + columns * cell + (columns - 1) * k_gap,
                              header + (4 / columns) * cell_height + k_border, 3);
    const auto view = image.view();
    fill(view, {0, 0, image.width(), image.height()}, k_background);
    const int inner = image.width() - 2 * k_border;
    draw_text(view, k_border, 38, fit_text(sheet.title, FontSize::large, inner), FontSize::large, k_bright);
    draw_text(view, k_border, 62, fit_text(sheet.subtitle, FontSize::small, inner), FontSize::small, k_quiet);

    const Display display{sheet.tone_map ? Tonemap::neutral : Tonemap::none, float(std::exp2(sheet.exposure_ev))};
    const auto at = [&](int i) {
        return std::pair(k_border + i % columns * (cell + k_gap), header + i / columns * cell_height);
    };
    const auto label = [&](int i, const std::string& text) {
        const auto [x, y] = at(i);
        draw_text(view, x, y + 20, fit_text(text, FontSize::small, cell), FontSize::small, k_text);
    };
    const int inset = (cell - fit.width) / 2;
    for (int i = 0; i < 2; ++i) {
        const auto [x, y] = at(i);
        label(i, i == 0 ? "A   " + sheet.test_name : "B   " + sheet.reference_name);
        draw_picture(view, x + inset, y + 30, fit, i == 0 ? sheet.test : sheet.reference, display, threads);
        draw_text(
            view, x, y + 30 + fit.height + 22,
            sheet.tone_map ? fmt::format("exposure {:+.2f} EV, Khronos neutral, sRGB", sheet.exposure_ev) : "as stored",
            FontSize::small, k_quiet);
    }
    for (int i = 2; i < 4; ++i) {
        const auto [x, y] = at(i);
        const HeatMap& map = i == 2 ? sheet.difference : sheet.perceived;
        label(i, map.title);
        draw_map(view, x + inset, y + 30, fit, map, sheet.mask, threads);
        draw_scale(view, x, y + 30 + fit.height + 8, cell, map);
    }
    return image;
}

}  // namespace domelight
