#include "compare/latlong_level.h"

#include <algorithm>

namespace domelight {

Cubemap cube_of_latlong_level(const ProjectedImage& level, int threads) {
    const int size = std::max(1, level.width() / 4);
    return Cubemap(reproject(level, *projection_from_name("cube"), size, size, threads).pixels);
}

}  // namespace domelight
