#include "domelight/area_resample.h"

#include "filtering/area_resample_plain.h"

namespace domelight {

std::unique_ptr<AreaResampler> area_resample_to_cube(int width, int height, int size, const Mat3& world_to_source,
                                                     int threads) {
    return area::plain_to_cube(width, height, size, world_to_source, threads);
}

std::unique_ptr<AreaResampler> area_resample_to_latlong(int width, int height, int out_height,
                                                        const Mat3& world_to_source, int threads) {
    return area::plain_to_latlong(width, height, out_height, world_to_source, threads);
}

}  // namespace domelight
