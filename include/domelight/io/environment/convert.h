#pragma once

#include "domelight/base/progress.h"
#include "domelight/environment/environment.h"
#include "domelight/filtering/resample/reproject.h"

namespace domelight {

struct ConvertOptions {
    Mat3 turn;           ///< turns the light: what came from direction d then comes from turn * d (orthogonal, may
                         ///< mirror)
    int width = 0;       ///< of a chart of the target, in texels
    int height = 0;      ///< likewise
    bool sharp = false;  ///< uses reproject() even where "exact" is possible: a conversion there and back has a PSNR
                         ///< that is 1.4 to 4.3 dB higher (docs/convert.md), but takes about 14 times as long
    int threads = 0;
    Progress progress = {};
};

struct Conversion {
    ProjectedImage image;
    /// radiant_power of the image made, and of the source as its file has it: before bad texels were repaired.
    Vec3d power_before, power_after;
    std::string method;  ///< "copy" (the same texels, moved), "exact" (area_resample.h, by rows), "conservative"
                         ///< (reproject.h)
};

/// Converts an environment of any projection to the projection `target`. From lat-long rows to a cube, or to a lat-long
/// map about the same axis, the rows are streamed (unless `sharp`): the source is never in memory as a whole. If texels
/// only change places, their values are copied. Everything else is done by reproject().
/// Errors: those of reading the environment; "cancelled", which can happen only while rows are streamed.
Result<Conversion> convert(const Environment& environment, const Projection& target, const ConvertOptions& options);

/// The height of the target's charts at which its finest texels are as fine as the source's.
int matched_height(const Environment& environment, const Projection& target);

}  // namespace domelight
