#include "domelight/sampling/light_extraction.h"

#include "c/environment.h"

using namespace domelight;

struct domelight_lights {
    LightExtraction found;
    Mat3 world_to_source;
};

namespace {

constexpr domelight_lights_options defaults() {
    const LightExtractionOptions o;
    domelight_lights_options options{};
    options.least_share = o.least_share;
    options.least_contrast = o.least_contrast;
    options.largest_diameter_deg = o.largest_diameter_deg;
    options.merge_deg = o.merge_deg;
    options.max_lights = o.max_lights;
    return options;
}

Result<LightExtractionOptions> read_options(const domelight_lights_options* options) {
    const auto given = c::read_struct(options, defaults());
    if (!given) return given.error();
    if (auto ok = c::check_threads(given->threads); !ok) return ok.error();
    LightExtractionOptions read;
    read.max_lights = given->max_lights;
    read.least_share = given->least_share;
    read.least_contrast = given->least_contrast;
    read.largest_diameter_deg = given->largest_diameter_deg;
    read.merge_deg = given->merge_deg;
    read.threads = given->threads;
    return read;
}

void copy(const Vec3d& from, double to[3]) {
    to[0] = from.x, to[1] = from.y, to[2] = from.z;
}

domelight_light light_of(const ExtractedLight& found) {
    domelight_light light{};
    copy(found.direction, light.direction);
    light.u = found.u;
    light.v = found.v;
    light.angular_diameter_deg = found.angular_diameter_deg;
    copy(found.irradiance, light.irradiance);
    copy(found.mean_radiance, light.mean_radiance);
    copy(found.colour, light.colour);
    light.share = found.share;
    light.contrast = found.contrast;
    light.texels = found.texels;
    light.resolved = found.resolved;
    return light;
}

}  // namespace

extern "C" {

void domelight_lights_options_init_sized(domelight_lights_options* options, size_t struct_size) {
    c::init_struct(options, struct_size, defaults());
}

domelight_error* domelight_extract_lights(const domelight_environment* environment,
                                          const domelight_lights_options* options, domelight_lights** lights) {
    return c::guarded([&]() -> Result<void> {
        if (auto ok = c::check_given({{environment, "environment"}, {lights, "lights"}}); !ok) return ok;
        const auto wanted = read_options(options);
        if (!wanted) return wanted.error();
        const auto image = environment->environment.latlong();
        if (!image) return image.error();
        const Mat3& world_to_source = environment->environment.world_to_source;
        auto found = extract_lights(**image, *wanted, world_to_source);
        if (!found) return found.error();
        return c::hand_out(lights, *std::move(found), world_to_source);
    });
}

size_t domelight_lights_count(const domelight_lights* lights) {
    return lights ? lights->found.lights.size() : 0;
}

domelight_error* domelight_lights_get(const domelight_lights* lights, size_t index, domelight_light* light) {
    return c::guarded([&]() -> Result<void> {
        if (auto ok = c::check_given({{lights, "lights"}, {light, "light"}}); !ok) return ok;
        const auto& all = lights->found.lights;
        if (auto ok = c::check_index(index, all.size(), "index"); !ok) return ok;
        return c::write_struct(light, light_of(all[index]));
    });
}

domelight_error* domelight_lights_remainder(const domelight_lights* lights, domelight_environment** environment) {
    return c::guarded([&]() -> Result<void> {
        if (auto ok = c::check_given({{lights, "lights"}, {environment, "environment"}}); !ok) return ok;
        return c::hand_out(environment, Environment::from_latlong(lights->found.remainder, lights->world_to_source));
    });
}

void domelight_lights_free(domelight_lights* lights) {
    delete lights;
}

}  // extern "C"
