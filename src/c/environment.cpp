// Environments from pixels, and what can be read of any.
#include "c/environment.h"

#include "c/pixels.h"

using namespace domelight;

namespace {

domelight_environment_info info_of(const Environment& environment) {
    domelight_environment_info info{};
    info.struct_size = sizeof info;
    info.format = environment.format.c_str();
    info.projection = environment.projection.c_str();
    info.convention = environment.convention.c_str();
    info.width = environment.width;
    info.height = environment.height;
    info.latlong_width = environment.latlong_width();
    info.latlong_height = environment.latlong_height();
    for (int i = 0; i < 3; ++i) {
        const Vec3d& row = environment.world_to_source.row[i];
        info.world_to_source[3 * i] = row.x, info.world_to_source[3 * i + 1] = row.y;
        info.world_to_source[3 * i + 2] = row.z;
    }
    return info;
}

}  // namespace

extern "C" {

domelight_error* domelight_environment_from_pixels(const domelight_pixels* pixels, const double* world_to_source,
                                                   domelight_environment** environment) {
    return c::guarded([&]() -> Result<void> {
        if (auto ok = c::check_given({{pixels, "pixels"}, {environment, "environment"}}); !ok) return ok;
        const auto given = c::read_struct(pixels, {});
        if (!given) return given.error();
        const auto turn = c::read_turn(world_to_source);
        if (!turn) return turn.error();
        auto image = c::copy_pixels(*given, 3);
        if (!image) return image.error();
        if (auto ok = c::check_faces(*image, given->faces); !ok) return ok;
        return c::hand_out(environment, given->faces == 6 ? Environment::from_cube(Cubemap(*std::move(image)), *turn)
                                                          : Environment::from_latlong(*std::move(image), *turn));
    });
}

void domelight_environment_free(domelight_environment* environment) {
    delete environment;
}

domelight_error* domelight_environment_get_info(const domelight_environment* environment,
                                                domelight_environment_info* info) {
    return c::guarded([&]() -> Result<void> {
        if (auto ok = c::check_given({{environment, "environment"}, {info, "info"}}); !ok) return ok;
        return c::write_struct(info, info_of(environment->environment));
    });
}

size_t domelight_environment_warning_count(domelight_environment* environment) {
    if (!environment) return 0;
    domelight_error_free(c::guarded([&]() -> Result<void> {
        environment->warnings = environment->environment.report().lines();
        return {};
    }));
    return environment->warnings.size();
}

const char* domelight_environment_warning(const domelight_environment* environment, size_t index) {
    return environment && index < environment->warnings.size() ? environment->warnings[index].c_str() : "";
}

domelight_error* domelight_environment_radiance(const domelight_environment* environment, const double direction[3],
                                                float rgb[3]) {
    return c::guarded([&]() -> Result<void> {
        if (auto ok = c::check_given({{environment, "environment"}, {direction, "direction"}, {rgb, "rgb"}}); !ok)
            return ok;
        const auto wanted = c::read_direction(direction);
        if (!wanted) return wanted.error();
        const auto radiance = environment->environment.radiance(*wanted);
        if (!radiance) return radiance.error();
        rgb[0] = radiance->x, rgb[1] = radiance->y, rgb[2] = radiance->z;
        return {};
    });
}

domelight_error* domelight_environment_latlong(const domelight_environment* environment, domelight_image** image) {
    return c::guarded([&]() -> Result<void> {
        if (auto ok = c::check_given({{environment, "environment"}, {image, "image"}}); !ok) return ok;
        auto latlong = environment->environment.latlong();
        if (!latlong) return latlong.error();
        return c::hand_out(image, *std::move(latlong), 1);
    });
}

}  // extern "C"
