#pragma once
// The figures of a study as labelled pictures, sRGB.

#include "domelight/image/image.h"
#include "domelight/study/render_study.h"

#include <cstdint>
#include <string>
#include <vector>

namespace domelight {

/// The small pictures by strategy, roughness and size of the light, each with its error below it; colours mark the best
/// strategy and poor ones. `scene`, `environment`: names for the captions.
Image<std::uint8_t> strategy_picture(const StrategyFigure& figure, const std::string& scene);
/// The errors over the number of samples as a plot, with pictures below.
Image<std::uint8_t> noise_picture(const NoiseFigure& figure, const std::string& scene, const std::string& environment);
/// Split-sum shading beside path tracing, and tables of its errors by roughness and view angle.
Image<std::uint8_t> split_sum_picture(const SplitSumFigure& figure, const std::string& scene,
                                      const std::string& environment);

/// Pictures one below the other, from the left edge on white.
Image<std::uint8_t> stacked(const std::vector<Image<std::uint8_t>>& pictures);

}  // namespace domelight
