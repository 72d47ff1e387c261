#include "render/environment_map.h"

#include "domelight/base/parallel.h"
#include "domelight/filtering/resample/area_resample.h"

#include "projection/bilinear.h"

#include <algorithm>
#include <cmath>

namespace domelight {
namespace {

ImageF area_resampled(AreaResampler& resampler, ImageView<const float> source) {
    resampler.add_rows(source);
    return resampler.finish();
}

/// A square picture whose texels are the means of 8 x 8 points of the source; direction_of(uv) in the world.
template <typename DirectionOf>
ImageF resampled(const EnvironmentSampler& source, int size, int threads, DirectionOf&& direction_of) {
    constexpr int points = 8;
    ImageF out(size, size, 3);
    parallel_for(size, threads, [&](int y) {
        for (int x = 0; x < size; ++x) {
            Vec3d sum;
            for (int k = 0; k < points * points; ++k)
                sum += Vec3d(source.radiance(Vec3f(direction_of(UV{(x + (k % points + 0.5) / points) / size,
                                                                        (y + (k / points + 0.5) / points) / size}))));
            const Vec3f mean(sum / (points * points));
            std::copy_n(&mean.x, 3, out.at(x, y));
        }
    });
    return out;
}

}  // namespace

EnvironmentMap::EnvironmentMap(const EnvironmentSampler& source, MapLookup lookup, int size, int threads)
    : source_(source), lookup_(lookup) {
    const ImageView<const float> image = source.image();
    switch (lookup) {
        case MapLookup::environment:
            break;
        case MapLookup::cube: {
            const auto to_cube =
                area_resample_to_cube(image.width, image.height, size, source.world_to_source(), threads);
            cube_.emplace(Cubemap(area_resampled(*to_cube, image)));
            break;
        }
        case MapLookup::latlong:
            image_ = area_resampled(
                *area_resample_to_latlong(image.width, image.height, size, source.world_to_source(), threads), image);
            break;
        case MapLookup::sphere_map:
            image_ = resampled(source, size, threads, [](UV uv) { return sphere_map_direction(uv); });
            break;
        case MapLookup::dual_paraboloid:
            image_ =
                resampled(source, size, threads, [](UV uv) { return paraboloid_direction(ParaboloidHalf::front, uv); });
            back_ =
                resampled(source, size, threads, [](UV uv) { return paraboloid_direction(ParaboloidHalf::back, uv); });
            break;
    }
}

Vec3f EnvironmentMap::radiance(const Vec3f& direction) const {
    switch (lookup_) {
        case MapLookup::environment:
            break;
        case MapLookup::cube:
            return look_up(*cube_, direction);
        case MapLookup::latlong:
            return bilinear(image_, latlong_uv(Vec3d(direction)), true);
        case MapLookup::sphere_map:
            return bilinear(image_, sphere_map_uv(Vec3d(direction)), false);
        case MapLookup::dual_paraboloid: {
            const ParaboloidPoint p = dual_paraboloid_point(Vec3d(direction));
            return bilinear(p.half == ParaboloidHalf::front ? image_ : back_, p.uv, false);
        }
    }
    return source_.radiance(direction);
}

}  // namespace domelight
