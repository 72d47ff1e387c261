#pragma once

#include "domelight/study/render_study.h"

#include <cstdint>

namespace domelight::cli {

/// The figures of a study as pictures, sRGB, labelled.
Image<std::uint8_t> strategy_picture(const StrategyFigure& figure, const std::string& scene);
Image<std::uint8_t> noise_picture(const NoiseFigure& figure, const std::string& scene, const std::string& environment);
Image<std::uint8_t> split_sum_picture(const SplitSumFigure& figure, const std::string& scene,
                                      const std::string& environment);
/// One below the other.
Image<std::uint8_t> stacked(const std::vector<Image<std::uint8_t>>& pictures);

}  // namespace domelight::cli
