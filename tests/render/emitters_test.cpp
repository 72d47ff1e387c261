// Light from surfaces that emit it: by points drawn on them, by the BRDF's rays that meet them, and by both.

#include "render/emitters.h"

#include "domelight/render/render.h"
#include "domelight/sampling/sequences.h"

#include "render/shapes.h"
#include "test.h"

#include <cmath>
#include <functional>

using namespace domelight;
using namespace domelight::test;

namespace {

Material glowing(float radiance) {
    Material m = lambert_material(0);
    m.emission = {radiance, radiance, radiance};
    return m;
}

/// The mean radiance and its standard error, of green, of a floor's middle below `lamp`, in the dark.
struct Seen {
    double mean = 0, error = 0;
};
Seen floor_below(const std::function<void(Scene&)>& lamp, LightStrategy strategy, int samples) {
    Scene scene;
    add(scene, floor_mesh(3, 0), lambert_material(0.5f));
    lamp(scene);
    auto traced = RayScene::build(std::move(scene));
    REQUIRE(traced);
    RenderOptions o;
    o.width = o.height = 4;
    o.samples = samples;
    o.strategy = strategy;
    o.bounces = 4;
    o.background = Background::transparent;
    o.camera = look_at({0.02f, 0.3f, 0}, {0, 0, 0}, 0.02f);
    const ImageF dark(16, 8, 3, 0.f);
    const auto sampler = EnvironmentSampler::build(dark, reference_sampler_options(strategy));
    REQUIRE(sampler);
    const auto r = render_reference(*traced, *sampler, o);
    REQUIRE(r);
    Seen out;
    for (int i = 0; i < 16; ++i) {
        out.mean += r->radiance.at(i % 4, i / 4)[1] / 16;
        out.error += r->variance.at(i % 4, i / 4)[1] / 256;
    }
    out.error = std::sqrt(out.error);
    return out;
}

Mesh square(float half, float height) {
    Mesh mesh = floor_mesh(half, height);
    mesh.texcoords[0] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    return mesh;
}

/// The lamps of the test of strategies: every way in which emission is more than a number.
struct Lamp {
    const char* name;
    std::function<void(Scene&)> add_to;
};
std::vector<Lamp> lamps() {
    const auto changed = [](const std::function<void(Scene&, Material&)>& change) {
        return [change](Scene& scene) {
            Material m = glowing(3);
            change(scene, m);
            add(scene, square(0.5f, 1), std::move(m));
        };
    };
    return {
        {"plain", changed([](Scene&, Material&) {})},
        {"a texture that is black but for a corner", changed([](Scene& scene, Material& m) {
             Rgba8Image image{"corner", 4, 4, std::vector<std::uint8_t>(64, 0)};
             for (int k = 0; k < 4; ++k) image.rgba[std::size_t(k)] = 255;
             scene.images.push_back(image);
             m.emission_texture.image = 0;
             m.emission_texture.nearest = true;
         })},
        {"half transparent", changed([](Scene&, Material& m) {
             m.alpha_mode = Material::AlphaMode::blend;
             m.opacity = 0.5f;
         })},
        {"unlit", changed([](Scene&, Material& m) {
             m.unlit = true;
             m.base_color = {0.2f, 0.4f, 0.6f};
         })},
        {"under a coat", changed([](Scene&, Material& m) {
             m.lambert = false;
             m.clearcoat = 1;
         })},
        {"many lamps, of which one is bright",
         [](Scene& scene) {
             for (int k = 0; k < 9; ++k) {
                 Affine place;
                 place.translation = {0.4f * float(k % 3 - 1), 0.1f * float(k), 0.4f * float(k / 3 - 1)};
                 add(scene, floor_mesh(0.1f, 0.7f), glowing(k == 4 ? 20.f : 0.1f), place);
             }
         }},
        {"mirrored, turned and flattened",
         [](Scene& scene) {
             Affine place;
             place.x = {-0.4f, 0.1f, 0}, place.y = {0, 0.001f, 0}, place.translation = {0, 0.8f, 0};
             add(scene, sphere_mesh(8), glowing(3), place);
             place.translation.z = 2.5f;
             scene.instances.push_back({1, place, "again"});
         }},
        {"an ellipsoid",
         [](Scene& scene) {
             Affine place;
             place.x.x = place.y.y = 0.4f, place.translation.y = 0.8f;
             add(scene, sphere_mesh(8), glowing(3), place);
         }},
        {"in a ball of tinted glass",
         [](Scene& scene) {
             Affine place;
             place.x.x = place.y.y = place.z.z = 0.3f;
             place.translation.y = 0.6f;
             Material glass;
             glass.metalness = 0;
             glass.roughness = 0.5f;
             glass.transmission = 1;
             glass.thickness = 1;
             glass.attenuation_color = {0.5f, 0.5f, 0.5f};
             glass.attenuation_distance = 0.5f;
             add(scene, sphere_mesh(16), glass, place);
             place.x.x = place.y.y = place.z.z = 0.15f;
             add(scene, sphere_mesh(12), glowing(8), place);
         }},
        {"behind a shade of thin frosted glass",
         [](Scene& scene) {
             Material shade;
             shade.metalness = 0;
             shade.roughness = 0.7f;
             shade.transmission = 1;
             add(scene, floor_mesh(1, 0.6f), shade);
             add(scene, floor_mesh(0.3f, 0.9f), glowing(4));
         }},
    };
}

}  // namespace

TEST_CASE("emitters: the reciprocal densities of drawn points integrate to the solid angle of what emits") {
    Scene scene;
    add(scene, floor_mesh(3, -2), lambert_material(0.5f));
    add(scene, sphere_mesh(32), glowing(2));
    const Emitters emitters(scene);
    const auto solid_angle = [&](const Vec3f& place) {
        constexpr int n = 1 << 15;
        double sum = 0;
        for (int i = 0; i < n; ++i) {
            const EmitterSample s = emitters.sample(scene, place, unit_point(Sequence::sobol, 1, i, n));
            if (s.hit.instance < 0) continue;
            CHECK_MESSAGE(s.hit.instance == 1, i);
            sum += 1 / double(s.pdf_solid_angle);
        }
        return sum / n;
    };
    CHECK(solid_angle({0.2f, -0.3f, 0.1f}) == doctest::Approx(4 * k_pi).epsilon(0.01));
    // From outside every direction passes the sphere twice.
    CHECK(solid_angle({0, 2, 0}) == doctest::Approx(4 * k_pi * (1 - std::sqrt(0.75))).epsilon(0.01));
    CHECK(Emitters(Scene{}).empty());
    Scene dark;
    add(dark, floor_mesh(1, 0), lambert_material(1));
    CHECK(Emitters(dark).empty());
}

TEST_CASE("render: a small square lamp lights a floor by its form factor, with little noise") {
    // A differential area below the middle of a parallel square (Howell's catalogue, B-4: four corners).
    constexpr double x = 0.05, root = 1.0012492197250393;  // half a side over the height; sqrt(1 + x^2)
    const double factor = 4 / (2 * k_pi) * 2 * x / root * std::atan(x / root);
    const auto lamp = [](Scene& scene) { add(scene, floor_mesh(0.05f, 1), glowing(100)); };
    const Seen seen = floor_below(lamp, LightStrategy::mis, 16);
    CHECK(seen.mean == doctest::Approx(0.5 * 100 * factor).epsilon(3e-3));
    // The BRDF's rays alone: a pixel has an error of about 100 % with so few samples.
    CHECK(seen.error < 0.02 * floor_below(lamp, LightStrategy::brdf, 256).error * 16);
}

TEST_CASE("render: every strategy finds the same light of every emitting surface") {
    for (const Lamp& lamp : lamps()) {
        INFO(std::string(lamp.name));
        const Seen truth = floor_below(lamp.add_to, LightStrategy::brdf, 4096);
        REQUIRE(truth.mean > 0.003);
        for (const LightStrategy strategy : {LightStrategy::mis, LightStrategy::environment}) {
            if (strategy == LightStrategy::environment && std::string(lamp.name).find("glass") != std::string::npos)
                continue;  // no point of the lamp can be drawn through glass that refracts
            const Seen seen = floor_below(lamp.add_to, strategy, 1024);
            const double z = (seen.mean - truth.mean) / std::hypot(seen.error, truth.error);
            CHECK_MESSAGE(std::abs(z) < 4,
                          seen.mean << " ± " << seen.error << ", " << truth.mean << " ± " << truth.error);
            CHECK(seen.mean == doctest::Approx(truth.mean).epsilon(0.05));
        }
    }
}
