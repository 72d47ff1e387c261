#include "preview/plot.h"

#include "domelight/base/vec.h"

#include "preview/strokes.h"
#include "test.h"

#include <algorithm>
#include <cmath>
#include <limits>

using namespace domelight;

namespace {

bool is(const std::uint8_t* p, Colour8 c) {
    return p[0] == c.r && p[1] == c.g && p[2] == c.b;
}

/// The mean row of the pixels of a colour in each column; -1 if there are none.
std::vector<double> rows_of(const Image<std::uint8_t>& image, Colour8 colour) {
    std::vector<double> rows(image.width(), -1);
    for (int x = 0; x < image.width(); ++x) {
        double sum = 0;
        int count = 0;
        for (int y = 0; y < image.height(); ++y)
            if (is(image.at(x, y), colour)) sum += y, ++count;
        if (count) rows[x] = sum / count;
    }
    return rows;
}

Plot power_law(double slope) {
    Plot plot;
    plot.x = {"N", PlotScale::logarithmic, {}};
    plot.y = {"error", PlotScale::logarithmic, {}};
    PlotSeries series;
    for (double n = 1; n < 2e6; n *= 4) series.points.push_back({n, std::pow(n, slope)});
    series.colour = Colour8{200, 0, 0};
    plot.series.push_back(series);
    return plot;
}

}  // namespace

TEST_CASE("stroke: covers width times length of pixels, and nothing outside the image") {
    Image<std::uint8_t> image(100, 60, 3);
    stroke(image.view(), 10, 30, 90, 30, 4, {255, 255, 255});
    double sum = 0;
    for (const std::uint8_t v : image.pixels()) sum += v / 255.0 / 3;
    CHECK(sum == doctest::Approx(80 * 4 + k_pi * 4).epsilon(0.02));
    Image<std::uint8_t> dot(40, 40, 3);
    disc(dot.view(), 20, 20, 10, {255, 255, 255});
    sum = 0;
    for (const std::uint8_t v : dot.pixels()) sum += v / 255.0 / 3;
    CHECK(sum == doctest::Approx(k_pi * 100).epsilon(0.02));
    stroke(image.view(), -1e12, -1e12, 1e12, 1e12, 3, {255, 0, 0});
    stroke(image.view(), -50, 70, 150, 500, 3, {255, 0, 0});
    disc(image.view(), -4, 1e9, 8, {255, 0, 0});
}

TEST_CASE("draw_plot: on logarithmic axes a power law is a straight line through the whole plot") {
    const auto rows = rows_of(draw_plot(power_law(-0.5)), {200, 0, 0});
    const auto seen = [&](double r) { return r >= 0; };
    const int first = int(std::find_if(rows.begin(), rows.end(), seen) - rows.begin());
    const int last = int(rows.rend() - std::find_if(rows.rbegin(), rows.rend(), seen)) - 1;
    REQUIRE(last - first > 500);
    const double slope = (rows[last - 20] - rows[first + 20]) / (last - first - 40);
    CHECK(slope > 0.3);  // smaller is further down
    for (int x = first + 20; x <= last - 20; ++x) {
        REQUIRE(rows[x] >= 0);
        CHECK(std::abs(rows[x] - (rows[first + 20] + slope * (x - first - 20))) < 1.5);
    }
}

TEST_CASE("draw_plot: what an axis cannot show is left out and changes nothing else") {
    const Plot plain = power_law(-1);
    Plot plot = plain;
    PlotSeries odd;
    odd.name = "";
    odd.marks = true;
    odd.colour = Colour8{0, 200, 0};
    const double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
    odd.points = {{0, 1}, {10, 0}, {-3, 1}, {nan, 1}, {10, nan}, {inf, 1}, {10, inf}};
    plot.series.push_back(odd);
    const auto a = draw_plot(plain), b = draw_plot(plot);
    CHECK(std::equal(a.pixels().begin(), a.pixels().end(), b.pixels().begin()));
}

TEST_CASE("draw_plot: nothing, one point, a flat line, tiny places") {
    Plot plot;
    CHECK(draw_plot(plot).width() == 1000);
    plot.series.push_back({"a", {{3, 3}}, PlotLine::dashed, true, true, {}});
    for (const PlotScale scale : {PlotScale::linear, PlotScale::logarithmic}) {
        plot.x.scale = plot.y.scale = scale;
        CHECK(rows_of(draw_plot(plot), plot_colour(0)) != std::vector<double>(1000, -1));
        plot.series[0].points.push_back({7, 3});
        for (const int size : {1, 7, 60, 300}) CHECK(draw_plot(plot, size, size).width() == size);
    }
}
