#pragma once

#include "domelight/image/image.h"
#include "domelight/filtering/resample/reproject.h"
#include "domelight/base/result.h"
#include "domelight/image/row_source.h"
#include "domelight/base/vec.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace domelight {

/// What a reader found and mended. Complete once all rows have been read.
struct RepairReport {
    std::int64_t not_a_number =
        0;  ///< texels with a NaN channel: set to the mean of their finite neighbours on the row, else 0
    std::int64_t infinite = 0;     ///< texels with an infinite channel: set to the largest finite value of the format
    std::int64_t negative = 0;     ///< texels with a negative channel: the channel set to 0
    double negative_radiance = 0;  ///< most negative value met
    std::vector<std::string> warnings;  ///< "PNG is not HDR: values above 1 are clipped", ...
    std::int64_t repaired() const { return not_a_number + infinite + negative; }
};

/// How to understand an environment's file where it does not say so itself.
struct EnvironmentOptions {
    /// auto | latlong | cube-cross | cube-strip | cube-faces, or any other of projections.h, with its convention:
    /// "angular/centre=+Z", "mirror-ball/fov=20". Those are turned into a lat-long image on opening.
    std::string projection = "auto";
    /// Lat-long convention: default, usd, mitsuba, openexr, materialx, mod, or "centre=+X,right=+Z[,up=+Y]", or pbrt
    /// (the equal-area octahedral square); empty: what the file says, else default.
    std::string latlong = "";
    /// PNG, JPEG and DDS of eight bits a channel: auto (= srgb) | srgb | gamma22 | linear; DDS also rgbm | rgbd | rgbp
    std::string decode = "auto";
    double rotate_y_deg = 0;  ///< turns the light about +Y: +X moves towards +Z
    std::string up = "+Y";    ///< the world axis (of the file's author) that the image's top shows: +Y, +Z, ...
    double exposure = 0;      ///< stops: radiance is multiplied by 2^exposure
    std::int64_t max_bytes = std::int64_t(1) << 30;  ///< refuses images whose decoding would need more memory than this
    int threads = 0;                                 ///< for decoding; 0: all
    bool keep_projection = false;                    ///< leaves other projections as they are, in Environment::picture
};

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

/// Opens an environment. `files` is one image, the six faces of a cube in any order (recognised by name), or the
/// front and the back of a dual paraboloid.
/// Errors: no such file, unknown or broken format, wrong shape, over `max_bytes`; each names the file.
Result<Environment> open_environment(const std::vector<std::filesystem::path>& files,
                                     const EnvironmentOptions& options = {});

/// All rows of a lat-long environment in memory.
Result<ImageF> read_latlong(RowSource& source);

}  // namespace domelight
