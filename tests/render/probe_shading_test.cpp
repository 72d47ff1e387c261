#include "domelight/render/shading/shading.h"

#include "probe/two_rooms.h"
#include "render/shading/probe_light.h"
#include "render/shading/shading_models.h"
#include "render/shapes.h"
#include "test.h"

#include <algorithm>
#include <cmath>

using namespace domelight;
using namespace domelight::test;

namespace {

EnvironmentSampler no_light() {
    auto sampler = EnvironmentSampler::build(ImageF(2, 1, 3), reference_sampler_options());
    REQUIRE(sampler);
    return std::move(*sampler);
}

/// A floor through both rooms, seen from above.
RayScene floor_scene(std::vector<PunctualLight> lights = {}) {
    Scene scene;
    add(scene, floor_mesh(4, 0), lambert_material(0.5f));
    scene.lights = std::move(lights);
    auto traced = RayScene::build(std::move(scene));
    REQUIRE(traced);
    return std::move(*traced);
}

RenderOptions from_above() {
    RenderOptions o;
    o.width = 64, o.height = 16;
    o.samples = 4;
    o.camera = look_at({0, 3, 0.001f}, {0, 0, 0}, 0.6f);
    o.background = Background::transparent;
    return o;
}

/// The mean of the green channel over a part of the columns.
double mean(const RenderResult& r, double from, double to) {
    double sum = 0;
    int n = 0;
    for (int y = 0; y < r.radiance.height(); ++y)
        for (int x = int(from * r.radiance.width()); x < int(to * r.radiance.width()); ++x)
            sum += double(r.radiance.at(x, y)[1]), ++n;
    return sum / n;
}

}  // namespace

TEST_CASE("render_shaded: probes light each point by the room that it lies in") {
    const auto set = TwoRooms().set();
    const RayScene scene = floor_scene();
    const EnvironmentSampler dark = no_light();
    for (const ShadingModel model : {ShadingModel::split_sum, ShadingModel::stretched, ShadingModel::phong}) {
        const auto picture = render_shaded(scene, ProbeBlender(*set), dark, {.model = model}, from_above());
        REQUIRE(picture);
        // The probes at x = -1.5 and nearer to the wall see E / pi = 1.3 above the floor, whose albedo is 1/2.
        CHECK(mean(*picture, 0, 0.45) == doctest::Approx(0.65).epsilon(0.01));
        CHECK(mean(*picture, 0.55, 1) < 0.0065);
    }
    CHECK(!render_shaded(scene, ProbeBlender(*set), dark, {.model = ShadingModel::mirror}, from_above()));
}

TEST_CASE("render_shaded: a set of the same light everywhere shades like the maps of one environment") {
    ImageF white(64, 32, 3);
    std::ranges::fill(white.pixels(), 1.f);
    const auto maps = LightMaps::bake(white, {});
    REQUIRE(maps);
    const auto ones = [](const Vec3d&, float* p) { p[0] = p[1] = p[2] = 1; };
    ProbeMaps probe;
    probe.specular = {cube_of(8, 3, ones), cube_of(4, 3, ones)};
    probe.irradiance_over_pi = cube_of(4, 3, ones);
    probe.harmonics[0] = Vec3d{1, 1, 1} * std::sqrt(4 * k_pi);
    const std::vector<ProbeMaps> all(3, probe);
    const auto set =
        ProbeSet::from_maps({{}, {.place = {1, 0, 0}, .position = {1, 0, 0}}, {}}, std::nullopt, {0, 1}, all);
    REQUIRE(set);
    const ProbeBlender blender(*set);
    for (const float roughness : {0.05f, 0.3f, 0.9f})
        for (const float NdotV : {0.1f, 0.5f, 1.f}) {
            SurfacePoint s;
            s.position = {0.3f, 2, 1};
            s.normal = s.geometric_normal = {0, 0, 1};
            s.bsdf.kind = Bsdf::Kind::metallic_roughness;
            s.bsdf.diffuse = {0.2f, 0.5f, 0.1f};
            s.bsdf.f0 = {0.04f, 0.5f, 0.9f};
            s.bsdf.f90 = {1, 1, 1};
            s.bsdf.alpha = roughness * roughness;
            const Vec3f V{std::sqrt(1 - NdotV * NdotV), 0, NdotV};
            for (const bool sh : {false, true}) {
                const ShadingOptions o{.sh_irradiance = sh};
                const ShadedLight a = shade_split_sum(s, V, 1, ProbeLight(blender, s), o),
                                  b = shade_split_sum(s, V, 1, *maps, o);
                CHECK(length(a.diffuse - b.diffuse) < 1e-3f);
                CHECK(length(a.specular - b.specular) < 1e-3f);
            }
        }
}

TEST_CASE("render_shaded: with probes, lights cast shadows") {
    PunctualLight lamp;
    lamp.kind = PunctualLight::Kind::point;
    lamp.intensity = {1, 1, 1};
    lamp.position = {0, 1, 0};
    const auto set = TwoRooms().set();
    const EnvironmentSampler dark = no_light();
    const auto lit_by = [&](float height, bool occlusion) {
        lamp.position.y = height;
        const RayScene scene = floor_scene({lamp});
        RenderOptions o = from_above();
        o.occlusion = occlusion;
        const auto picture = render_shaded(scene, ProbeBlender(*set), dark, {}, o);
        REQUIRE(picture);
        return mean(*picture, 0.55, 1);
    };
    CHECK(lit_by(1, true) > 0.02);
    CHECK(lit_by(1, true) == lit_by(1, false));
    // A small roof between the lamp and the floor.
    Scene scene;
    add(scene, floor_mesh(4, 0), lambert_material(0.5f));
    add(scene, floor_mesh(2, 0.5f), lambert_material(0.5f));
    lamp.position.y = 0.51f;
    scene.lights = {lamp};
    const auto traced = RayScene::build(std::move(scene));
    RenderOptions o = from_above();
    o.camera = look_at({0, 0.4f, 0.001f}, {0, 0, 0}, 0.6f);
    const auto shadowed = render_shaded(*traced, ProbeBlender(*set), dark, {}, o);
    o.occlusion = false;
    const auto through = render_shaded(*traced, ProbeBlender(*set), dark, {}, o);
    CHECK(mean(*shadowed, 0.55, 1) < 0.0065);
    CHECK(mean(*through, 0.55, 1) > 0.02);
}
