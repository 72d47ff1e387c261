#pragma once

#include "domelight/filtering/resample/area_resample.h"
#include "domelight/projection/projections.h"

#include <memory>

namespace domelight {

/// How a lat-long image is converted to another projection while its rows are read.
struct RowConversion {
    std::unique_ptr<AreaResampler> rows;  ///< takes the rows; null where reproject() must have the whole image
    bool copies = false;                  ///< texels only change their places, and keep their bits
};

/// The conversion of lat-long rows.
///
/// width, height           of the lat-long image
/// target                  the projection of the result
/// out_width, out_height   of one chart of the result
/// world_to_source         as in Environment
/// threads                 0: all
/// sharp                   no averaging: `rows` is null unless texels only change their places
RowConversion convert_rows(int width, int height, const Projection& target, int out_width, int out_height,
                           const Mat3& world_to_source, int threads, bool sharp = false);

}  // namespace domelight
