#include "preview/sample_picture.h"

#include "domelight/base/parallel.h"
#include "domelight/projection/projection.h"

#include "preview/dark_page.h"
#include "preview/preview_map.h"
#include "preview/strokes.h"
#include "preview/tonemap.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace domelight {
namespace {

constexpr Colour8 k_caption{150, 155, 163};
constexpr int k_border = 16, k_head = 66, k_foot = 52;

/// A dark page with space for a lat-long picture, its title above and a part below.
struct Page {
    Image<std::uint8_t> image;
    Rect where;
};

Page make_page(const SamplePictureOptions& o) {
    const int width = std::clamp(o.width, 256, 8192), height = width / 2;
    Page page{Image<std::uint8_t>(width + 2 * k_border, height + k_head + k_foot, 3),
              {k_border, k_head, width, height}};
    fill(page.image.view(), {0, 0, page.image.width(), page.image.height()}, k_background);
    draw_text(page.image.view(), k_border, 32, fit_text(o.title, FontSize::large, width), FontSize::large, k_bright);
    draw_text(page.image.view(), k_border, 54, fit_text(o.subtitle, FontSize::small, width), FontSize::small,
              k_caption);
    return page;
}

/// Where u and v are 0, a quarter, ... : small ticks along the edges.
void draw_scale(Page& page) {
    const Rect& r = page.where;
    for (int k = 0; k <= 4; ++k) {
        fill(page.image.view(), {r.x + k * (r.width - 1) / 4, r.y + r.height, 1, 5}, k_caption);
        fill(page.image.view(), {r.x - 5, r.y + k * (r.height - 1) / 4, 5, 1}, k_caption);
    }
}

// Dark blue over violet and orange to pale yellow, lightness rising evenly.
Colour8 heat(double t) {
    constexpr double stops[][3] = {{12, 10, 38},   {66, 18, 110},  {140, 36, 118}, {206, 62, 82},
                                   {246, 122, 36}, {252, 190, 60}, {252, 252, 190}};
    const double x = std::clamp(t, 0.0, 1.0) * (std::size(stops) - 1);
    const int i = std::min(int(x), int(std::size(stops)) - 2);
    const auto mix = [&](int c) { return std::uint8_t(stops[i][c] + (stops[i + 1][c] - stops[i][c]) * (x - i) + 0.5); };
    return {mix(0), mix(1), mix(2)};
}

/// The density averaged over each pixel (solid-angle density by its own measure's mean over the square: its rows differ
/// little within a pixel).
std::vector<float> densities(const EnvironmentSampler& sampler, DensityMeasure measure, int width, int height,
                             int threads) {
    const int nx = std::clamp(sampler.image().width / width, 1, 16),
              ny = std::clamp(sampler.image().height / height, 1, 16);
    const double share = sampler.options().uniform_share;
    std::vector<float> out(std::size_t(width) * height);
    parallel_ranges(height, 4, threads, [&](int begin, int end) {
        for (int y = begin; y < end; ++y)
            for (int x = 0; x < width; ++x) {
                double sum = 0;
                for (int j = 0; j < ny; ++j)
                    for (int i = 0; i < nx; ++i) {
                        const double u = (x + (i + 0.5) / nx) / width, v = (y + (j + 0.5) / ny) / height;
                        const double jacobian = 2 * k_pi * k_pi * std::sin(k_pi * v);
                        const double p =
                            (1 - share) * sampler.distribution().pdf_uv(u, v) + share * jacobian / (4 * k_pi);
                        sum += measure == DensityMeasure::uv ? p : p / jacobian;
                    }
                out[std::size_t(y) * width + x] = float(sum / (nx * ny));
            }
    });
    return out;
}

void draw_legend(Page& page, double low, double high, const std::string& unit) {
    const Rect& r = page.where;
    const int y = r.y + r.height + 12, unit_width = text_width(unit, FontSize::small) + 16;
    const Rect bar{r.x + unit_width, y, r.width - unit_width - 30, 12};
    draw_text(page.image.view(), r.x, y + 11, unit, FontSize::small, k_bright);
    for (int i = 0; i < bar.width; ++i)
        fill(page.image.view(), {bar.x + i, bar.y, 1, bar.height}, heat(double(i) / (bar.width - 1)));
    const int first = int(std::ceil(low - 1e-9)), last = int(std::floor(high + 1e-9));
    // Labels must not overlap.
    const double apart = bar.width / std::max(high - low, 1e-9);
    const int step = std::max(1, int(std::ceil(46 / apart)));
    for (int k = first; k <= last; ++k) {
        if (k % step) continue;
        const int x = bar.x + int((k - low) / std::max(high - low, 1e-9) * (bar.width - 1));
        fill(page.image.view(), {x, bar.y + bar.height, 1, 5}, k_caption);
        const std::string text = k >= -1 && k <= 2 ? fmt::format("{:g}", std::pow(10.0, k)) : "10";
        const std::string exponent = text != "10" || k == 1 ? ""
                                     : k < 0                ? fmt::format("−{}", -k)
                                                            : fmt::format("{}", k);
        const int left = x - (text_width(text, FontSize::small) + text_width(exponent, FontSize::small)) / 2;
        draw_text(page.image.view(), left, bar.y + 36, text, FontSize::small, k_caption);
        draw_text(page.image.view(), left + text_width(text, FontSize::small), bar.y + 30, exponent, FontSize::small,
                  k_caption);
    }
}

}  // namespace

void draw_environment(ImageView<std::uint8_t> image, Rect where, const EnvironmentSampler& sampler, double brightness,
                      int threads) {
    const double average = log_average_luminance(sampler.image());
    const float exposure = average > 0 ? float(std::clamp(0.18 / average, 0x1p-60, 0x1p60)) : 1;
    const PreviewMap map(sampler.image(), where.height / 2);
    parallel_ranges(where.height, 8, threads, [&](int begin, int end) {
        for (int y = begin; y < end; ++y)
            for (int x = 0; x < where.width; ++x) {
                const MapPlace place{0, (float(x) + 0.5f) / float(where.width),
                                     (float(y) + 0.5f) / float(where.height)};
                const Vec3f rgb = tonemap(map.at(place).rgb() * exposure, Tonemap::agx_punchy);
                std::uint8_t* p = image.at(where.x + x, where.y + y);
                p[0] = to_byte(srgb_encode(rgb.x) * float(brightness));
                p[1] = to_byte(srgb_encode(rgb.y) * float(brightness));
                p[2] = to_byte(srgb_encode(rgb.z) * float(brightness));
            }
    });
}

Image<std::uint8_t> sample_picture(const EnvironmentSampler& sampler, std::span<const LightSample> samples,
                                   const SamplePictureOptions& options) {
    Page page = make_page(options);
    draw_environment(page.image.view(), page.where, sampler, 0.8, options.threads);
    // Dots as large as their number leaves room for; all rims first, so that no dot is hidden under another's rim. If
    // there are too many to be distinguished they become a haze.
    const double each =
        page.where.width * std::sqrt(0.5 / std::max<double>(1, double(samples.size())));  // pixels from one to the next
    const double scale = std::max(1.0, page.where.width / 1024.0);
    const double radius = std::clamp(0.09 * each, 0.5, 3.2 * scale), opacity = std::clamp(0.35 * each, 0.06, 1.0);
    ImageView<std::uint8_t> inside{page.image.at(page.where.x, page.where.y), page.where.width, page.where.height, 3,
                                   std::ptrdiff_t(3) * page.image.width()};
    const auto dots = [&](double r, Colour8 colour, double strength) {
        for (const LightSample& s : samples)
            disc(inside, double(s.u) * page.where.width, double(s.v) * page.where.height, r, colour, strength);
    };
    const double dot = each > 12 ? std::max(radius, 1.4) : radius;
    if (each > 6) dots(dot + 1.1, {20, 10, 10}, 0.75);
    dots(dot, {255, 226, 40}, opacity);
    draw_scale(page);
    draw_text(page.image.view(), page.where.x, page.where.y + page.where.height + 24, "u = 0", FontSize::small,
              k_caption);
    draw_text(page.image.view(), page.where.x + page.where.width, page.where.y + page.where.height + 24, "u = 1",
              FontSize::small, k_caption, Align::right);
    return std::move(page.image);
}

Image<std::uint8_t> density_picture(const EnvironmentSampler& sampler, DensityMeasure measure,
                                    const SamplePictureOptions& options) {
    Page page = make_page(options);
    const Rect& r = page.where;
    const std::vector<float> values = densities(sampler, measure, r.width, r.height, options.threads);
    double least = INFINITY, largest = 0;
    for (const float v : values) {
        if (v > 0) least = std::min<double>(least, v);
        largest = std::max<double>(largest, v);
    }
    double high = std::log10(largest), low = std::max(std::log10(least), high - 8);
    if (!(high - low > 0.5)) {  // constant: half a decade around it, so that the legend has a range
        const double middle = (high + low) / 2;
        high = middle + 0.5;
        low = middle - 0.5;
    }
    for (int y = 0; y < r.height; ++y)
        for (int x = 0; x < r.width; ++x) {
            const double v = values[std::size_t(y) * r.width + x];
            const Colour8 c = v > 0             ? heat((std::log10(v) - low) / (high - low))
                              : (x + y) % 8 < 2 ? Colour8{60, 62, 68}
                                                : Colour8{36, 38, 42};
            fill(page.image.view(), {r.x + x, r.y + y, 1, 1}, c);
        }
    draw_scale(page);
    if (std::find(values.begin(), values.end(), 0.f) != values.end())
        draw_text(page.image.view(), r.x + r.width, 32, "hatched: never drawn", FontSize::small, k_caption,
                  Align::right);
    draw_legend(page, low, high, measure == DensityMeasure::uv ? "density over (u, v)" : "density per sr");
    return std::move(page.image);
}

}  // namespace domelight
