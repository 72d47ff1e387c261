#include "bake/panorama.h"

#include "domelight/filtering/resample/reproject.h"
#include "domelight/io/environment/convert.h"
#include "domelight/projection/projections.h"

#include <algorithm>
#include <cmath>

namespace domelight {

PanoramaSpec panorama_spec(const std::string& projection, int height) {
    const double aspect = projection_from_name(projection)->shape().aspect();
    return {projection, int(std::lround(height * aspect)), height};
}

PanoramaSpec panorama_like(const Environment& environment, const std::string& projection) {
    return panorama_spec(projection, matched_height(environment, *projection_from_name(projection)));
}

ImageF panorama_as_latlong(const ImageF& image, const std::string& projection, int height, int threads) {
    height = std::min(height, image.height());
    const ProjectedImage source{*projection_from_name(projection), image};
    return std::move(reproject(source, *projection_from_name("latlong"), 2 * height, height, threads).pixels);
}

}  // namespace domelight
