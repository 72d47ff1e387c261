#pragma once
// The explanation of a sample as a labelled picture, 8-bit sRGB.

#include "domelight/image/image.h"
#include "domelight/study/sample_explanation.h"

#include <cstdint>
#include <string>

namespace domelight {

/// The environment with the row and the sample drawn on it, the marginal distribution beside it and the row's
/// conditional distribution below. The cumulative functions run along the image's edges, so that the lines from ξ to the
/// sample can be followed.
///
/// sampler      the one whose sample is explained
/// explanation  from explain_sample()
/// title        the headline
/// threads      0: all
Image<std::uint8_t> explanation_picture(const EnvironmentSampler& sampler, const SampleExplanation& explanation,
                                        const std::string& title, int threads = 0);

}  // namespace domelight
