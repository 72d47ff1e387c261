#include "domelight/study/explanation_picture.h"

#include "preview/light_page.h"
#include "preview/sample_picture.h"
#include "preview/strokes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace domelight {
namespace {

constexpr Colour8 k_grid{225, 228, 232}, k_row{0, 114, 178}, k_column{213, 94, 0}, k_point{255, 226, 40};
constexpr Rect k_image{24, 70, 900, 450}, k_marginal{948, 70, 310, 450}, k_conditional{24, 574, 900, 220};

/// Maps a value of a panel to pixels: places run along the image's edge, the cumulative function across it.
struct Panel {
    Rect where;
    bool vertical;  ///< true: the place runs down and the function to the right; false: to the right and up
    std::array<double, 2> at(double place, double value) const {
        if (vertical) return {where.x + value * where.width, where.y + place * where.height};
        return {where.x + place * where.width, where.y + (1 - value) * where.height};
    }
};

void line(ImageView<std::uint8_t> image, const std::array<double, 2>& a, const std::array<double, 2>& b, double width,
          Colour8 colour, double opacity = 1) {
    stroke(image, a[0], a[1], b[0], b[1], width, colour, opacity);
}

/// A line with an arrow's head at its end.
void arrow(ImageView<std::uint8_t> image, const std::array<double, 2>& a, const std::array<double, 2>& b,
           Colour8 colour) {
    line(image, a, b, 2, colour);
    const double dx = b[0] - a[0], dy = b[1] - a[1], l = std::hypot(dx, dy);
    if (!(l > 12)) return;
    for (const double side : {-1.0, 1.0})
        line(image, b, {b[0] - 10 * dx / l + side * 4.5 * dy / l, b[1] - 10 * dy / l - side * 4.5 * dx / l}, 2, colour);
}

void draw_cumulative(ImageView<std::uint8_t> image, const Panel& p, const CumulativeSearch& f, Colour8 colour) {
    for (int k = 0; k <= 4; ++k) line(image, p.at(0, k / 4.0), p.at(1, k / 4.0), 1, k_grid);
    // The density is drawn behind, scaled to its largest value: the cumulative function is steep where the density is
    // large.
    const int n = int(f.places.size()) - 1, pixels = p.vertical ? p.where.height : p.where.width;
    std::vector<double> bins(pixels);
    // The cumulative function at a place. The pieces may wrap around. It is taken as linear within a piece, which is
    // accurate enough for a picture.
    const auto below = [&](double x) {
        const double y = x < f.places[0] ? x + 1 : x;
        const int i =
            std::clamp(int(std::upper_bound(f.places.begin(), f.places.end(), y) - f.places.begin()) - 1, 0, n - 1);
        const double t = std::clamp((y - f.places[i]) / (f.places[i + 1] - f.places[i]), 0.0, 1.0);
        return f.cumulative[i] + t * (f.cumulative[i + 1] - f.cumulative[i]) - (x < f.places[0] ? 1 : 0);
    };
    for (int i = 0; i < pixels; ++i) bins[i] = std::max(0.0, below((i + 1.0) / pixels) - below(double(i) / pixels));
    const double largest = *std::max_element(bins.begin(), bins.end());
    for (std::size_t i = 0; i < bins.size(); ++i)
        if (bins[i] > 0)
            line(image, p.at((double(i) + 0.5) / double(bins.size()), 0),
                 p.at((double(i) + 0.5) / double(bins.size()), bins[i] / largest), 1, colour, 0.22);
    for (int i = 0; i < n; ++i)
        line(image, p.at(std::min(1.0, f.places[i]), f.cumulative[i]),
             p.at(std::min(1.0, f.places[i + 1]), f.cumulative[i + 1]), 2, colour);
    frame(image, {p.where.x - 1, p.where.y - 1, p.where.width + 2, p.where.height + 2}, k_faint_ink);
}

}  // namespace

Image<std::uint8_t> explanation_picture(const EnvironmentSampler& sampler, const SampleExplanation& e,
                                        const std::string& title, int threads) {
    Image<std::uint8_t> picture(k_marginal.x + k_marginal.width + 24, k_conditional.y + k_conditional.height + 44, 3);
    const auto image = picture.view();
    fill(image, {0, 0, picture.width(), picture.height()}, k_paper);
    draw_text(image, 24, 32, fit_text(title, FontSize::large, 900), FontSize::large, k_ink);
    const std::string rows = e.row_above == e.row_below ? fmt::format("row {}", e.row_above)
                                                        : fmt::format("rows {} and {}", e.row_above, e.row_below);
    draw_text(image, 24, 56,
              fmt::format("from the point ({:g}, {:g}) of the unit square to {}, then to the column", e.point[0],
                          e.point[1], rows),
              FontSize::small, k_faint_ink);
    draw_text(image, k_marginal.x, 56, "C(v), share of the weight above v", FontSize::small, k_row);
    draw_text(
        image, k_conditional.x, k_conditional.y - 12,
        fmt::format("C(u | v), share of {} left of u", e.row_above == e.row_below ? "this row" : "these rows' mixture"),
        FontSize::small, k_column);

    draw_environment(image, k_image, sampler, 0.9, threads);
    const Panel marginal{k_marginal, true}, conditional{k_conditional, false};
    draw_cumulative(image, marginal, e.row, k_row);
    draw_cumulative(image, conditional, e.column, k_column);

    // A line from ξ on the upper edge down to the curve and from there to the row; another from ξ on the left edge to
    // the curve and up to the sample.
    const double u = e.column.position, v = e.row.position;
    const std::array<double, 2> on_marginal = marginal.at(v, e.row.xi), on_conditional = conditional.at(u, e.column.xi);
    const std::array<double, 2> point{k_image.x + u * k_image.width, k_image.y + v * k_image.height};
    arrow(image, marginal.at(0, e.row.xi), {on_marginal[0], on_marginal[1] - 6}, k_row);
    line(image, on_marginal, {double(k_image.x), on_marginal[1]}, 2, k_row, 0.85);
    arrow(image, conditional.at(0, e.column.xi), {on_conditional[0] - 6, on_conditional[1]}, k_column);
    arrow(image, on_conditional, {point[0], point[1] + 7}, k_column);
    disc(image, on_marginal[0], on_marginal[1], 4.5, k_row);
    disc(image, on_conditional[0], on_conditional[1], 4.5, k_column);
    disc(image, point[0], point[1], 6, {20, 10, 10});
    disc(image, point[0], point[1], 4.5, k_point);
    for (const double edge : {0.0, 0.5, 1.0}) {
        const std::string label = fmt::format("{:g}", edge);
        draw_text(image, int(marginal.at(1, edge)[0]), k_marginal.y + k_marginal.height + 20, label, FontSize::small,
                  k_faint_ink, Align::centre);
        draw_text(image, int(conditional.at(edge, 0)[0]), k_conditional.y + k_conditional.height + 20, label,
                  FontSize::small, k_faint_ink, Align::centre);
    }

    int y = k_conditional.y + 4;
    const auto say = [&](const std::string& text, Colour8 colour) {
        draw_text(image, k_marginal.x, y += 22, text, FontSize::small, colour);
    };
    say(fmt::format("v = {:.5f}   p(v) = {:.4g}", v, e.row.pdf), k_row);
    say(fmt::format("u = {:.5f}   p(u | v) = {:.4g}", u, e.column.pdf), k_column);
    say(fmt::format("pdf_uv = {:.4g}", e.pdf_uv), k_ink);
    say(fmt::format("2π² sin(π v) = {:.4g}", e.jacobian), k_ink);
    say(fmt::format("pdf_solid_angle = {:.4g}", e.pdf_uv / e.jacobian), k_ink);
    const LightSample& s = e.sample;
    say(fmt::format("direction {:.3f}  {:.3f}  {:.3f}", s.direction.x, s.direction.y, s.direction.z), k_ink);
    say(fmt::format("radiance {:.3g}  {:.3g}  {:.3g}", s.radiance.x, s.radiance.y, s.radiance.z), k_ink);
    say("shaded: the density itself", k_faint_ink);
    return picture;
}

}  // namespace domelight
