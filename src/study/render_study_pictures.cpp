#include "domelight/study/render_study_pictures.h"

#include "domelight/compare/compare_sheet.h"
#include "domelight/image/colour.h"

#include "image/draw.h"
#include "preview/colour_map.h"
#include "preview/light_page.h"
#include "preview/plot.h"
#include "preview/tonemap.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace domelight {
namespace {

constexpr Colour8 k_best{0, 128, 92}, k_poor{200, 90, 0}, k_bad{190, 24, 40}, k_nothing{225, 227, 230};
constexpr int k_margin = 24, k_gap = 6, k_line = 20;

Image<std::uint8_t> page(int width, int height, const std::string& title, const std::vector<std::string>& below) {
    Image<std::uint8_t> image(width, height, 3);
    fill(image.view(), {0, 0, width, height}, k_paper);
    draw_text(image.view(), k_margin, 40, fit_text(title, FontSize::large, width - 2 * k_margin), FontSize::large,
              k_ink);
    int y = 64;
    for (const std::string& text : below) {
        draw_text(image.view(), k_margin, y, fit_text(text, FontSize::small, width - 2 * k_margin), FontSize::small,
                  k_faint_ink);
        y += k_line;
    }
    return image;
}

/// Stops that bring the log-average luminance of several pictures to a little above middle grey; darkness counts as a
/// twentieth of the mean, so that objects before a black background are not overexposed.
double common_ev(const std::vector<const ImageF*>& pictures) {
    double mean = 0, sum = 0, n = 0;
    const auto each = [&](const auto& use) {
        for (const ImageF* p : pictures)
            for (int y = 0; y < p->height(); ++y)
                for (int x = 0; x < p->width(); ++x) use(luminance(p->at(x, y)));
    };
    each([&](double l) { mean += l, n += 1; });
    if (!(mean > 0)) return 0;
    each([&](double l) { sum += std::log(std::max(l, 0.05 * mean / n)); });
    return std::log2(0.25 / std::exp(sum / n));
}

void draw_radiance(ImageView<std::uint8_t> page, int left, int top, const ImageF& picture, double ev) {
    const Display display{Tonemap::neutral, float(std::exp2(ev))};
    for (int y = 0; y < picture.height(); ++y)
        for (int x = 0; x < picture.width(); ++x) {
            const float* p = picture.at(x, y);
            const auto rgb = display.rgb8({p[0], p[1], p[2]});
            if (top + y < page.height && left + x < page.width)
                std::copy(rgb.begin(), rgb.end(), page.at(left + x, top + y));
        }
}

std::string error_text(double error) {
    return error >= 0.0995    ? fmt::format("{:.2f}", error)
           : error >= 0.00995 ? fmt::format("{:.3f}", error)
                              : fmt::format("{:.4f}", error);
}

const char* occlusion_text(bool occlusion) {
    return occlusion ? "With occlusion: the scene's own shadows" : "Without occlusion: no shadows, as a shader has it";
}

}  // namespace

Image<std::uint8_t> strategy_picture(const StrategyFigure& f, const std::string& scene) {
    constexpr LightStrategy order[] = {LightStrategy::brdf, LightStrategy::environment, LightStrategy::mis};
    const int size = f.cells.front().picture.width(), step = size + k_gap, row_step = size + 26,
              columns = int(f.lights.size()), rows = int(f.roughness.size());
    const int gutter = 54, block = columns * step, between = 26, head = 132, section = 72 + rows * row_step;
    const int width = k_margin + gutter + 3 * block + 2 * between + k_margin;
    auto image = page(width, head + 2 * section + k_margin, "Where should light directions come from?",
                      {fmt::format("{}. Rows: roughness. Columns: how wide the one light in the dark is; the last, a "
                                   "whole environment. {} samples a pixel.",
                                   scene, f.samples),
                       fmt::format("Below each: RMSE of L/(1+L){} against {} samples of MIS.",
                                   f.one_object ? " over the ball" : "", f.reference_samples),
                       "Green: the best of the three (within 10 %). Orange: more than twice its error. Red: more than "
                       "five times."});
    const auto view = image.view();
    std::vector<double> ev;
    for (int l = 0; l < columns; ++l) {
        std::vector<const ImageF*> shown;
        for (const StrategyCell& c : f.cells)
            if (c.light == l && c.strategy == LightStrategy::mis) shown.push_back(&c.picture);
        ev.push_back(common_ev(shown));
    }
    for (const bool occlusion : {false, true}) {
        const int top = head + (occlusion ? section : 0);
        draw_text(view, k_margin, top + 16, occlusion_text(occlusion), FontSize::small, k_ink);
        for (int s = 0; s < 3; ++s) {
            const int left = k_margin + gutter + s * (block + between);
            draw_text(view, left, top + 40, fmt::format("{} sampling", strategy_label(order[s])), FontSize::small,
                      k_ink);
            for (int l = 0; l < columns; ++l)
                draw_text(view, left + l * step + size / 2, top + 60,
                          fit_text(f.lights[std::size_t(l)].name, FontSize::small, step), FontSize::small, k_faint_ink,
                          Align::centre);
            for (int r = 0; r < rows; ++r) {
                const double roughness = f.roughness[std::size_t(r)];
                const int y = top + 68 + r * row_step;
                if (s == 0)
                    draw_text(view, k_margin + gutter - 10, y + size / 2 + 5, fmt::format("{:g}", roughness),
                              FontSize::small, k_faint_ink, Align::right);
                for (int l = 0; l < columns; ++l) {
                    const StrategyCell& cell = f.at(occlusion, roughness, l, order[s]);
                    double best = INFINITY;
                    for (const LightStrategy other : order)
                        best = std::min(best, f.at(occlusion, roughness, l, other).error);
                    const Colour8 colour = cell.error <= 1.1 * best ? k_best
                                           : cell.error > 5 * best  ? k_bad
                                           : cell.error > 2 * best  ? k_poor
                                                                    : k_ink;
                    draw_radiance(view, left + l * step, y, cell.picture, ev[std::size_t(l)]);
                    draw_text(view, left + l * step + size / 2, y + size + 17, error_text(cell.error), FontSize::small,
                              colour, Align::centre);
                }
            }
        }
    }
    return image;
}

Image<std::uint8_t> noise_picture(const NoiseFigure& f, const std::string& scene, const std::string& environment) {
    const auto& counts = f.lines.front().points;
    const int size = counts.front().picture.width(), step = size + k_gap, columns = int(counts.size());
    const int gutter = 104, strip = gutter + columns * step, plot_height = 400;
    const int half = std::max(strip, 620), head = 104, strips = 30 + 3 * (step + 2) + 24;
    const int width = 2 * k_margin + 2 * half + 30;
    auto image = page(width, head + k_line + plot_height + strips + k_margin, "Noise and the number of samples",
                      {fmt::format("{} under {}, roughness {:g}. Errors against {} samples of MIS.", scene, environment,
                                   f.roughness, f.reference_samples),
                       "Owen-scrambled Sobol points. Independent ones would follow the grey line: half the noise for "
                       "four times the samples."});
    const auto view = image.view();
    std::vector<const ImageF*> shown;
    double low = INFINITY, high = 0;
    for (const NoiseLine& line : f.lines)
        for (const auto& p : line.points) {
            low = std::min(low, p.error), high = std::max(high, p.error);
            if (line.strategy == LightStrategy::mis) shown.push_back(&p.picture);
        }
    const double ev = common_ev(shown);
    for (const bool occlusion : {false, true}) {
        const int left = k_margin + (occlusion ? half + 30 : 0);
        Plot plot;
        plot.subtitle = occlusion_text(occlusion);
        plot.x = {"samples a pixel", PlotScale::logarithmic, {}};
        plot.y = {"RMSE of L/(1+L)", PlotScale::logarithmic, std::array{low / 1.3, high * 1.3}};
        int row = 0;
        const int top = head + plot_height + k_line;
        for (int i = 0; i < columns; ++i)
            draw_text(view, left + gutter + i * step + size / 2, top + 20,
                      std::to_string(counts[std::size_t(i)].samples), FontSize::small, k_faint_ink, Align::centre);
        double start = 0;
        for (const NoiseLine& line : f.lines) {
            if (line.occlusion != occlusion) continue;
            PlotSeries series;
            series.name = fmt::format("{}, slope {:.2f}", strategy_label(line.strategy), line.slope);
            series.marks = true;
            for (const auto& p : line.points) series.points.push_back({double(p.samples), p.error});
            start = std::max(start, line.points.front().error);
            plot.series.push_back(std::move(series));
            const int y = top + 30 + row++ * (step + 2);
            draw_text(view, left, y + size / 2 + 5, strategy_label(line.strategy), FontSize::small, k_ink);
            for (int i = 0; i < columns; ++i)
                draw_radiance(view, left + gutter + i * step, y, line.points[std::size_t(i)].picture, ev);
        }
        PlotSeries guide;
        guide.name = "slope -0.50";
        guide.line = PlotLine::dotted;
        guide.colour = k_faint_ink;
        for (const auto& p : counts) guide.points.push_back({double(p.samples), start / std::sqrt(double(p.samples))});
        plot.series.push_back(std::move(guide));
        draw_plot(view, {left, head, half, plot_height}, plot);
    }
    return image;
}

namespace {

/// A table of numbers by NdotV (to the right) and roughness (upwards), with its axes and a scale below.
struct Table {
    const ImageF* values = nullptr;
    std::string title;
    double high = 1;
    bool is_signed = false;
};
constexpr int k_square = 30, k_table_gutter = 46;

Colour8 colour_of(const Table& t, double value) {
    if (std::isnan(value)) return k_nothing;
    return t.is_signed ? signed_colour(float(value / t.high)) : heat_colour(float(value / t.high));
}

void draw_table(ImageView<std::uint8_t> page, int left, int top, const Table& t, const std::vector<double>& roughness) {
    const int bins = t.values->width(), rows = t.values->height(), x0 = left + k_table_gutter, y0 = top + 30,
              width = bins * k_square, height = rows * k_square;
    draw_text(page, x0, top + 18, fit_text(t.title, FontSize::small, width), FontSize::small, k_ink);
    for (int r = 0; r < rows; ++r)
        for (int b = 0; b < bins; ++b)
            fill(page, {x0 + b * k_square, y0 + (rows - 1 - r) * k_square, k_square, k_square},
                 colour_of(t, *t.values->at(b, r)));
    frame(page, {x0 - 1, y0 - 1, width + 2, height + 2}, k_faint_ink);
    for (int r = 0; r < rows; ++r)
        draw_text(page, x0 - 8, y0 + (rows - 1 - r) * k_square + k_square / 2 + 5,
                  fmt::format("{:g}", roughness[std::size_t(r)]), FontSize::small, k_faint_ink, Align::right);
    for (int i = 0; i <= 4; ++i)
        draw_text(page, x0 + i * width / 4, y0 + height + 20, fmt::format("{:g}", i / 4.0), FontSize::small,
                  k_faint_ink, Align::centre);
    draw_text(page, x0 + width / 2, y0 + height + 42, "to the right: NdotV, grazing to head-on", FontSize::small, k_ink,
              Align::centre);
    draw_text(page, x0 + width / 2, y0 + height + 62, "upwards: roughness", FontSize::small, k_ink, Align::centre);
    const int scale = y0 + height + 78;
    for (int x = 0; x < width; ++x) {
        const double part = double(x) / (width - 1);
        fill(page, {x0 + x, scale, 1, 14}, colour_of(t, t.high * (t.is_signed ? 2 * part - 1 : part)));
    }
    frame(page, {x0, scale, width, 14}, k_faint_ink);
    for (int i = 0; i <= 2; ++i) {
        const double part = i / 2.0, value = t.high * (t.is_signed ? 2 * part - 1 : part);
        draw_text(page, x0 + i * width / 2, scale + 32,
                  fmt::format("{}{:.3g}", t.is_signed && value > 0 ? "+" : "", value), FontSize::small, k_faint_ink,
                  i == 0   ? Align::left
                  : i == 2 ? Align::right
                           : Align::centre);
    }
}

}  // namespace

Image<std::uint8_t> split_sum_picture(const SplitSumFigure& f, const std::string& scene,
                                      const std::string& environment) {
    const int size = f.pictures.front().width(), step = size + k_gap, rows = int(f.roughness.size());
    const int table = k_table_gutter + f.bins * k_square + 18, gutter = 210, head = 136;
    const int strips = 28 + 3 * step + 24, width = 2 * k_margin + std::max(4 * table, gutter + rows * step);
    const int table_height = 30 + rows * k_square + 78 + 44;
    const auto& off = f.parts[0];
    const auto& on = f.parts[1];
    auto image = page(
        width, head + strips + table_height + k_margin, "What split-sum shading costs",
        {fmt::format(
             "{} under {}. Split-sum from baked maps against path tracing of {} samples a pixel; tables over {} "
             "views.",
             scene, environment, f.samples, f.views),
         fmt::format("Without occlusion: the approximation alone, RMSE of L/(1+L) {:.4f} (noise of the truth {:.4f}).",
                     off.rmse, off.noise),
         fmt::format("With occlusion and bounces: the missing shadows and reflections of the scene besides, {:.4f} "
                     "(noise {:.4f}).",
                     on.rmse, on.noise)});
    const auto view = image.view();
    std::vector<const ImageF*> shown;
    for (const ImageF& p : off.pictures) shown.push_back(&p);
    const double ev = common_ev(shown);
    const struct {
        const char* name;
        const std::vector<ImageF>* pictures;
    } lines[] = {{"split-sum", &f.pictures}, {"truth without occlusion", &off.pictures}, {"truth", &on.pictures}};
    for (int i = 0; i < 3; ++i) {
        const int y = head + 28 + i * step;
        draw_text(view, k_margin, y + size / 2 + 5, lines[i].name, FontSize::small, k_ink);
        for (int r = 0; r < rows; ++r) {
            const int x = k_margin + gutter + r * step;
            if (i == 0)
                draw_text(view, x + size / 2, y - 8, fmt::format("{:g}", f.roughness[std::size_t(r)]), FontSize::small,
                          k_faint_ink, Align::centre);
            draw_radiance(view, x, y, (*lines[i].pictures)[std::size_t(r)], ev);
        }
    }
    draw_text(view, k_margin, head + 20, "roughness", FontSize::small, k_faint_ink);
    const double error_high = std::max(scale_for(off.error), scale_for(on.error)),
                 difference_high = std::max(scale_for(off.difference), scale_for(on.difference));
    const Table tables[] = {{&off.error, "error, without occlusion", error_high, false},
                            {&on.error, "error, with occlusion", error_high, false},
                            {&off.difference, "split-sum − truth, without", difference_high, true},
                            {&on.difference, "split-sum − truth, with", difference_high, true}};
    for (int i = 0; i < 4; ++i) draw_table(view, k_margin + i * table, head + strips, tables[i], f.roughness);
    return image;
}

Image<std::uint8_t> stacked(const std::vector<Image<std::uint8_t>>& pictures) {
    int width = 0, height = 0;
    for (const auto& p : pictures) width = std::max(width, p.width()), height += p.height();
    Image<std::uint8_t> image(width, height, 3);
    fill(image.view(), {0, 0, width, height}, k_paper);
    int top = 0;
    for (const auto& p : pictures) {
        for (int y = 0; y < p.height(); ++y) std::copy_n(p.row(y), std::size_t(3) * p.width(), image.row(top + y));
        top += p.height();
    }
    return image;
}

}  // namespace domelight
