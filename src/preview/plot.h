#pragma once

#include "image/draw.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace domelight {

enum class PlotScale { linear, logarithmic };

struct PlotAxis {
    std::string label;
    PlotScale scale = PlotScale::linear;
    /// Ends of the axis; empty: determined by the series.
    std::optional<std::array<double, 2>> range;
};

enum class PlotLine { solid, dashed, dotted, none };

/// A line through points. Those that are not finite, and on a logarithmic axis those that are not positive, are left
/// out and the line is broken there.
struct PlotSeries {
    std::string name;  ///< in the legend, UTF-8; empty: not in the legend
    std::vector<std::array<double, 2>> points;
    PlotLine line = PlotLine::solid;
    bool marks = false;             ///< a dot on each point
    bool filled = false;            ///< shaded down to the axis
    std::optional<Colour8> colour;  ///< empty: the next of the palette
};

/// A line plot with both axes, a grid and a legend.
struct Plot {
    std::string title, subtitle;
    PlotAxis x, y;
    std::vector<PlotSeries> series;
};

/// The palette's colours, repeated: they can be distinguished with any colour vision, the first eight best.
Colour8 plot_colour(std::size_t i);

/// Draws into a part of an image (3 channels), which is cleared to white first. About 240 x 160 pixels are needed at
/// least.
void draw_plot(ImageView<std::uint8_t> image, Rect where, const Plot& plot);
/// A picture of its own. The same bytes everywhere.
Image<std::uint8_t> draw_plot(const Plot& plot, int width = 1000, int height = 640);

}  // namespace domelight
