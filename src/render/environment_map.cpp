#include "render/environment_map.h"

#include "domelight/filtering/resample/area_resample.h"
#include "domelight/base/parallel.h"

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
                sum = sum + Vec3d(source.radiance(Vec3f(direction_of(UV{(x + (k % points + 0.5) / points) / size,
                                                                        (y + (k / points + 0.5) / points) / size}))));
            const Vec3f mean(sum / (points * points));
            std::copy_n(&mean.x, 3, out.at(x, y));
        }
    });
    return out;
}

/// Bilinear; v clamps, u clamps or wraps.
Vec3f bilinear(const ImageF& image, UV uv, bool wrap) {
    const int width = image.width(), height = image.height();
    const double x = uv.u * width - 0.5, y = std::clamp(uv.v * height - 0.5, 0.0, double(height - 1));
    const auto column = [&](int i) { return wrap ? (i + width) % width : std::clamp(i, 0, width - 1); };
    const int i = int(std::floor(x)), j = int(y), below = std::min(j + 1, height - 1);
    const float s = float(x - i), t = float(y - j);
    const float *a = image.at(column(i), j), *b = image.at(column(i + 1), j), *c = image.at(column(i), below),
                *d = image.at(column(i + 1), below);
    const auto mix = [&](int k) {
        const float upper = a[k] + s * (b[k] - a[k]), lower = c[k] + s * (d[k] - c[k]);
        return upper + t * (lower - upper);
    };
    return {mix(0), mix(1), mix(2)};
}

}  // namespace

Vec3f look_up(const BorderedCube& cube, const Vec3f& direction) {
    const CubePoint p = cube_point(Vec3d(direction));
    const int n = cube.size();
    const float x = float(p.uv.u * n) - 0.5f, y = float(p.uv.v * n) - 0.5f;
    const int i = std::clamp(int(std::floor(x)), -1, n - 1), j = std::clamp(int(std::floor(y)), -1, n - 1);
    const float s = x - float(i), t = y - float(j);
    const float *a = cube.texel(p.face, i, j), *b = cube.texel(p.face, i + 1, j), *c = cube.texel(p.face, i, j + 1),
                *d = cube.texel(p.face, i + 1, j + 1);
    const auto mix = [&](int k) {
        const float upper = a[k] + s * (b[k] - a[k]), lower = c[k] + s * (d[k] - c[k]);
        return upper + t * (lower - upper);
    };
    return {mix(0), mix(1), mix(2)};
}

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

std::string map_lookup_name(MapLookup lookup) {
    switch (lookup) {
        case MapLookup::environment:
            return "environment";
        case MapLookup::cube:
            return "cube";
        case MapLookup::latlong:
            return "latlong";
        case MapLookup::sphere_map:
            return "sphere-map";
        case MapLookup::dual_paraboloid:
            break;
    }
    return "dual-paraboloid";
}

}  // namespace domelight
