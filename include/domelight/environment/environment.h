#pragma once

#include "domelight/base/result.h"
#include "domelight/base/vec.h"
#include "domelight/filtering/resample/reproject.h"
#include "domelight/image/image.h"
#include "domelight/image/repair_report.h"
#include "domelight/image/row_source.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace domelight {

/// An environment opened for reading: a lat-long image handed on by rows, or a cube in memory.
struct Environment {
    std::filesystem::path file;
    std::string format;                     ///< "Radiance HDR", "OpenEXR", "PNG", "JPEG", "sky"
    std::string projection;                 ///< "latlong", "cube", or the name of another in projections.h
    int width = 0, height = 0;              ///< of the image as stored
    std::unique_ptr<RowSource> latlong;     ///< set for lat-long; in the default convention up to `world_to_source`
    Cubemap cube;                           ///< set for cubes
    std::optional<ProjectedImage> picture;  ///< set for the others with EnvironmentOptions::keep_projection, else they
                                            ///< are in `latlong`
    /// Where to look in the source for light from a world direction: convention, up axis and rotation together
    /// (orthogonal, may mirror).
    Mat3 world_to_source;
    std::shared_ptr<RepairReport> report;
};

}  // namespace domelight
