#pragma once
// The environment as one image, for engines that filter or sample it themselves.

#include "domelight/environment/environment.h"
#include "domelight/image/image.h"

#include <string>

namespace domelight {

/// What such an image is: its size in texels, and its projection with convention as projections.h names them.
struct PanoramaSpec {
    std::string projection;
    int width = 0, height = 0;
    bool operator==(const PanoramaSpec&) const = default;
};

/// An image of that projection, `height` texels high. The projection is one of projections.h with a single chart.
PanoramaSpec panorama_spec(const std::string& projection, int height);

/// The same, as fine as the environment: its own size where that is a lat-long image and the projection too.
PanoramaSpec panorama_like(const Environment& environment, const std::string& projection);

/// The image as a lat-long one in the default convention, at most `height` texels high, for looking at.
ImageF panorama_as_latlong(const ImageF& image, const std::string& projection, int height, int threads);

}  // namespace domelight
