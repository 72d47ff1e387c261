#pragma once

#include "domelight/sampling/light_extraction.h"

#include <cstdint>
#include <span>
#include <string>

namespace domelight {

/// The contents of a picture of extracted lights; only used during the call.
struct LightsSheetInput {
    std::string title;                   ///< the environment's file name, UTF-8
    ImageView<const float> environment;  ///< lat-long RGB, any size
    ImageView<const float> remainder;    ///< as large
    Mat3 world_to_source;
    std::span<const ExtractedLight> lights;
    int width = 1600;  ///< pixels, at least 800
    int threads = 0;
};

/// The environment with each light circled and numbered, the remainder beside it at the same exposure, and below them
/// the lights' directions, diameters and irradiances (8-bit sRGB, 3 channels, AgX). Both pictures show the world in the
/// default lat-long convention. The same bytes on any number of threads.
Image<std::uint8_t> lights_sheet(const LightsSheetInput& input);

}  // namespace domelight
