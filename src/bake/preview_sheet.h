#pragma once

#include "domelight/bake/bake.h"

#include "bake/filter_job.h"

#include <string>

namespace domelight {

/// The contact sheet of an engine's maps, 8-bit sRGB.
Image<std::uint8_t> draw_preview(const EnginePlan& plan, const FilterJob::Maps& maps, const EngineReport& report,
                                 const std::string& title, const ImageF& brdf, int threads);

}  // namespace domelight
