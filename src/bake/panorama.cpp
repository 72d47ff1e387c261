#include "bake/panorama.h"

#include "domelight/filtering/resample/reproject.h"
#include "domelight/io/environment/convert.h"
#include "domelight/projection/projections.h"

#include <fmt/core.h>

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

std::string projection_convention(const std::string& name) {
    const auto projection = projection_from_name(name);
    if (!projection) return name;
    const auto axis = [](const Vec3d& d) -> std::string {
        const double largest = std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)});
        const double value = std::abs(d.x) == largest ? d.x : std::abs(d.y) == largest ? d.y : d.z;
        const char letter = std::abs(d.x) == largest ? 'X' : std::abs(d.y) == largest ? 'Y' : 'Z';
        return {value < 0 ? '-' : '+', letter};
    };
    // The picture's own frame: x to the right, y up, z out of the centre.
    const Mat3 to_world = projection->world_to_picture().transposed();
    const char* grid = projection->grid() == SampleGrid::rows_on_poles   ? ", the first and last row on the poles"
                       : projection->grid() == SampleGrid::both_on_edges ? ", samples from edge to edge"
                                                                         : "";
    return fmt::format(
        "{}, centre {}, right {}, up {}{}", projection->name() == "latlong" ? "lat-long" : projection->name(),
        axis(to_world * Vec3d{0, 0, 1}), axis(to_world * Vec3d{1, 0, 0}), axis(to_world * Vec3d{0, 1, 0}), grid);
}

}  // namespace domelight
