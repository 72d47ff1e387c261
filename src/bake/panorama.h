#pragma once
// The environment as one image, for engines that filter or sample it themselves.

#include "domelight/base/result.h"
#include "domelight/image/image.h"

#include <string>

namespace domelight {

/// Height of the lat-long image in the default convention from which project_panorama() makes an image `size` texels
/// high: the same where texels only change their columns, else finer.
int panorama_rows(const std::string& projection, int size);

/// A lat-long image in the default convention in another projection (a name and convention as projections.h has them),
/// `size` texels high. Power is kept; lat-long images that are only turned keep their texels.
/// Errors: no such projection.
Result<ImageF> project_panorama(const ImageF& latlong, const std::string& projection, int size, int threads);

/// Where a projection's centre, right and top look, in one line: "lat-long, centre +X, right +Z, up +Y".
std::string projection_convention(const std::string& projection);

}  // namespace domelight
