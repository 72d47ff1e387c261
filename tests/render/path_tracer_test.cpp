#include "domelight/environment/sky/sky.h"
#include "domelight/filtering/reference.h"
#include "domelight/render/render.h"

#include "render/shapes.h"
#include "test.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

using namespace domelight;
using namespace domelight::test;

namespace {

RayScene trace(Scene scene) {
    auto traced = RayScene::build(std::move(scene));
    REQUIRE(traced);
    return std::move(*traced);
}

Scene one(Mesh mesh, Material material) {
    Scene scene;
    add(scene, std::move(mesh), std::move(material));
    return scene;
}

RenderOptions view(int size, int samples) {
    RenderOptions o;
    o.width = o.height = size;
    o.samples = samples;
    o.camera = look_at({0, 0, 4}, {0, 0, 0}, 0.6f);
    o.background = Background::transparent;
    return o;
}

RenderResult render(const RayScene& scene, const ImageF& environment, const RenderOptions& o) {
    auto sampler = EnvironmentSampler::build(environment, reference_sampler_options(o.strategy));
    REQUIRE(sampler);
    auto result = render_reference(scene, *sampler, o);
    REQUIRE(result);
    return std::move(*result);
}

/// The mean of a channel over the pixels that the surface covers completely.
double mean_inside(const RenderResult& r, const ImageF& image, int channel = 1) {
    double sum = 0;
    int n = 0;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x)
            if (*r.opacity.at(x, y) == 1) sum += image.at(x, y)[channel], ++n;
    REQUIRE(n > 0);
    return sum / n;
}

ImageF sky_with_sun() {
    SkyOptions options;
    options.height = 64;
    options.sun_elevation_deg = 40;
    options.sun_azimuth_deg = 60;
    ImageF image(128, 64, 3);
    REQUIRE(make_sky(options)->read(image.view()));
    for (float& p : image.pixels()) p /= 3000;
    return image;
}

}  // namespace

TEST_CASE("render: a white matte sphere vanishes in a white furnace") {
    const RayScene scene = trace(one(sphere_mesh(48), lambert_material(1)));
    for (const LightStrategy strategy : {LightStrategy::mis, LightStrategy::environment, LightStrategy::brdf}) {
        RenderOptions o = view(24, 64);
        o.strategy = strategy;
        const RenderResult r = render(scene, ImageF(32, 16, 3, 1.f), o);
        CHECK(mean_inside(r, r.radiance) == doctest::Approx(1).epsilon(2e-3));
        CHECK(mean_inside(r, r.diffuse) == doctest::Approx(mean_inside(r, r.radiance)).epsilon(1e-6));
        CHECK(mean_inside(r, r.indirect) == 0);
    }
}

TEST_CASE("render: rough metal keeps its light in a white furnace, with multiple scattering, and loses some without") {
    for (const float roughness : {0.3f, 0.6f, 1.f}) {
        const RayScene scene = trace(one(sphere_mesh(64), metal_material(roughness)));
        RenderOptions o = view(24, 256);
        o.multiple_scattering = true;
        const RenderResult r = render(scene, ImageF(32, 16, 3, 1.f), o);
        INFO("roughness " << roughness);
        CHECK(std::abs(mean_inside(r, r.radiance) - 1) < 1e-3);
        o.multiple_scattering = false;
        const RenderResult single = render(scene, ImageF(32, 16, 3, 1.f), o);
        CHECK(mean_inside(single, single.radiance) < (roughness > 0.5f ? 0.95 : 1));
        CHECK(mean_inside(single, single.specular) ==
              doctest::Approx(mean_inside(single, single.radiance)).epsilon(1e-6));
    }
}

TEST_CASE("render: Lambert on a sphere is the exact irradiance, pixel by pixel within its confidence interval") {
    const ImageF sky = sky_with_sun();
    const RayScene scene = trace(one(sphere_mesh(160), lambert_material(0.8f)));
    RenderOptions o = view(20, 512);
    const RenderResult r = render(scene, sky, o);
    double z2 = 0, ratio = 0;
    int n = 0;
    for (int y = 0; y < o.height; ++y)
        for (int x = 0; x < o.width; ++x) {
            if (*r.opacity.at(x, y) < 1) continue;
            const float* N = r.normal.at(x, y);
            const Vec3d normal = normalize(Vec3d{N[0], N[1], N[2]});
            const Vec3d truth = convolve_exactly(sky, ZonalKernel::cosine(), std::span(&normal, 1))[0] * 0.8;
            // The mean over the normals within a pixel differs a little from the value at its centre: 1 %.
            const double error = std::sqrt(r.variance.at(x, y)[1] + std::pow(0.01 * truth.y, 2)),
                         d = r.radiance.at(x, y)[1] - truth.y;
            z2 += d * d / (error * error);
            ratio += r.radiance.at(x, y)[1] / truth.y;
            ++n;
        }
    CHECK(ratio / n == doctest::Approx(1).epsilon(5e-3));
    CHECK(z2 / n < 1.6);
}

TEST_CASE("render: a sphere's shadow on the ground under an even sky is its form factor") {
    // Straight below a sphere of radius r whose centre is h above, (r / h)^2 of the sky is hidden.
    Scene scene = one(floor_mesh(50, -2.5f), lambert_material(0.5f));
    add(scene, sphere_mesh(96), lambert_material(0));
    RenderOptions o = view(3, 4096);
    o.camera = look_at({0.001f, -1.3f, 0}, {0, -2.5f, 0}, 0.02f);
    const RayScene traced = trace(std::move(scene));
    const RenderResult r = render(traced, ImageF(32, 16, 3, 1.f), o);
    CHECK(r.radiance.at(1, 1)[1] == doctest::Approx(0.5 * (1 - 1 / (2.5 * 2.5))).epsilon(4e-3));
    o.occlusion = false;
    const RenderResult open = render(traced, ImageF(32, 16, 3, 1.f), o);
    CHECK(open.radiance.at(1, 1)[1] == doctest::Approx(0.5).epsilon(4e-3));
}

TEST_CASE("render: light in a closed room is the sum over its bounces") {
    // Inside a sphere of emission e and albedo a: e (1 + a + ... + aⁿ).
    Material wall = lambert_material(0.6f);
    wall.emission = {1, 1, 1};
    const RayScene scene = trace(one(sphere_mesh(64), wall));
    RenderOptions o = view(8, 256);
    o.camera = look_at({0, 0, 0.2f}, {0, 0, -1}, 0.6f);
    for (const int bounces : {1, 3, 12}) {
        o.bounces = bounces;
        const RenderResult r = render(scene, ImageF(16, 8, 3), o);
        CHECK(mean_inside(r, r.radiance) == doctest::Approx((1 - std::pow(0.6, bounces + 1)) / 0.4).epsilon(5e-3));
    }
}

TEST_CASE("render: a directional light and a point light on a matte floor") {
    Scene scene = one(floor_mesh(10, 0), lambert_material(0.5f));
    PunctualLight sun;
    sun.direction = normalize(Vec3f{0, -1, -1});
    sun.intensity = {2, 2, 2};
    PunctualLight lamp;
    lamp.kind = PunctualLight::Kind::point;
    lamp.position = {0, 2, 0};
    lamp.intensity = {3, 0, 0};
    scene.lights = {sun, lamp};
    RenderOptions o = view(1, 4);
    o.camera = look_at({0, 3, 0.01f}, {0, 0, 0}, 0.001f);
    const RenderResult r = render(trace(std::move(scene)), ImageF(16, 8, 3), o);
    const double a = 0.5 / k_pi;
    CHECK(r.radiance.at(0, 0)[1] == doctest::Approx(a * 2 * std::sqrt(0.5)).epsilon(1e-4));
    CHECK(r.radiance.at(0, 0)[0] == doctest::Approx(a * (2 * std::sqrt(0.5) + 3 / 4.0)).epsilon(1e-4));
}

TEST_CASE("render: lights of the environment light a scene as its own do") {
    Scene scene = one(floor_mesh(10, 0), lambert_material(0.5f));
    PunctualLight sun;
    sun.direction = normalize(Vec3f{0, -1, -1});
    sun.intensity = {2, 1, 0};
    RenderOptions o = view(2, 4), with_lights = o;
    o.camera = with_lights.camera = look_at({0, 3, 0.01f}, {0, 0, 0}, 0.1f);
    with_lights.environment_lights = {sun};
    const RenderResult apart = render(trace(scene), ImageF(16, 8, 3), with_lights);
    CHECK(apart.radiance.at(0, 0)[0] == doctest::Approx(0.5 / k_pi * 2 * std::sqrt(0.5)).epsilon(1e-4));
    scene.lights = {sun};
    const RenderResult own = render(trace(scene), ImageF(16, 8, 3), o);
    CHECK(std::ranges::equal(apart.radiance.pixels(), own.radiance.pixels()));
}

TEST_CASE("render: samples that are not finite are counted, and count as black") {
    Scene scene = one(floor_mesh(10, 0), lambert_material(0.5f));
    RenderOptions o = view(4, 8);
    o.camera = look_at({0, 3, 0.01f}, {0, 0, 0}, 0.1f);
    const ImageF sky(16, 8, 3, 1.f);
    CHECK(render(trace(scene), sky, o).non_finite_samples == 0);
    for (const float wrong : {std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
        Scene bad = scene;
        bad.materials[0].emission = {wrong, 0, 0};
        const RenderResult r = render(trace(bad), sky, o);
        // NaN may be lost in a comparison before the sample is added; infinity is not.
        if (std::isinf(wrong)) CHECK(r.non_finite_samples == 4 * 4 * 8);
        for (const float p : r.radiance.pixels()) CHECK(std::isfinite(p));
    }
}

TEST_CASE("default_camera: the whole scene is in the picture and fills it, from every side of a turntable") {
    for (const std::string& name : built_in_scene_names())
        for (const float aspect : {0.5f, 1.f, 2.f}) {
            INFO(name << " in a picture of aspect " << aspect);
            auto scene = built_in_scene(name);
            REQUIRE(scene);
            scene->cameras.clear();
            const Camera camera = default_camera(*scene, aspect);
            const auto [low, high] = scene->bounds();
            const float tan_y = std::tan(0.5f * camera.fov_y);
            const auto farthest_after = [&](double turn) {
                double most = 0;
                for (const Instance& instance : scene->instances)
                    for (const Vec3f& local : scene->meshes[std::size_t(instance.mesh)].positions) {
                        const Vec3f middle = (low + high) * 0.5f,
                                    p = Vec3f(rotation_y(turn) * Vec3d(instance.to_world.point(local) - middle)) +
                                        middle - camera.to_world.translation;
                        const float depth = -dot(p, camera.to_world.z);
                        REQUIRE(depth > 0);
                        most = std::max<double>({most, std::abs(dot(p, camera.to_world.x)) / (depth * tan_y * aspect),
                                                 std::abs(dot(p, camera.to_world.y)) / (depth * tan_y)});
                    }
                return most;
            };
            double most = 0;
            for (int i = 0; i < 8; ++i) most = std::max(most, farthest_after(i * k_pi / 4));
            CHECK(most <= 1);
            CHECK(most > 0.9);
        }
}

TEST_CASE("camera_for: what a camera was made to show stays in pictures of other shapes") {
    Camera made;
    made.fov_y = 0.5f;
    made.aspect = 2;
    made.half_height = 3;
    const auto tan_x = [](const Camera& c, float aspect) { return std::tan(0.5f * c.fov_y) * aspect; };
    for (const float aspect : {0.5f, 1.f, 1.9f, 2.f, 3.f}) {
        INFO("a picture of aspect " << aspect);
        const Camera c = camera_for(made, aspect);
        CHECK(c.fov_y >= made.fov_y);
        CHECK(tan_x(c, aspect) >= tan_x(made, 2) * 0.9999f);
        CHECK((c.fov_y == made.fov_y || tan_x(c, aspect) == doctest::Approx(tan_x(made, 2))));
        CHECK(c.half_height == doctest::Approx(aspect < 2 ? 3 * 2 / aspect : 3));
    }
    made.aspect = 0;
    CHECK(camera_for(made, 0.5f).fov_y == made.fov_y);
    // The spheres span the picture of the first example.
    const auto spheres = built_in_scene("spheres");
    REQUIRE(spheres);
    RenderOptions o;
    o.width = 64, o.height = 32, o.samples = 4, o.background = Background::transparent;
    o.camera = camera_for(spheres->cameras.front(), 2);
    const RenderResult r = render(trace(*spheres), ImageF(16, 8, 3, 1.f), o);
    int first = 64, last = -1;
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 64; ++x)
            if (*r.opacity.at(x, y) > 0) first = std::min(first, x), last = std::max(last, x);
    CHECK(first < 4);
    CHECK(last >= 60);
}

TEST_CASE("render: masked and blended surfaces let light through, in the picture and in shadows") {
    const auto picture = [](Material::AlphaMode mode, float opacity) {
        // A black veil between the camera and a white floor that an even sky lights through the veil.
        Material veil = lambert_material(0);
        veil.alpha_mode = mode;
        veil.opacity = opacity;
        Scene scene = one(floor_mesh(200, -1), lambert_material(1));
        add(scene, floor_mesh(200, 1), veil);
        RenderOptions o = view(4, 1024);
        o.camera = look_at({0, 2, 0.01f}, {0, 0, 0}, 0.1f);
        const RenderResult r = render(trace(std::move(scene)), ImageF(16, 8, 3, 1.f), o);
        return mean_inside(r, r.radiance);
    };
    CHECK(picture(Material::AlphaMode::opaque, 0.5f) == 0);
    CHECK(picture(Material::AlphaMode::mask, 0.4f) == doctest::Approx(1).epsilon(0.02));
    CHECK(picture(Material::AlphaMode::mask, 0.6f) == 0);
    CHECK(picture(Material::AlphaMode::blend, 0.25f) == doctest::Approx(0.75 * 0.75).epsilon(0.03));
}

TEST_CASE("render: the same bits on any number of threads, other ones with another seed") {
    Scene scene = one(floor_mesh(3, -1), lambert_material(0.5f));
    add(scene, sphere_mesh(32), metal_material(0.4f));
    const RayScene traced = trace(std::move(scene));
    const ImageF sky = sky_with_sun();
    RenderOptions o = view(40, 5);
    o.bounces = 2;
    o.threads = 1;
    const RenderResult first = render(traced, sky, o);
    for (const int threads : {2, 3, 8}) {
        o.threads = threads;
        const RenderResult r = render(traced, sky, o);
        CHECK(std::ranges::equal(r.radiance.pixels(), first.radiance.pixels()));
        CHECK(std::ranges::equal(r.variance.pixels(), first.variance.pixels()));
    }
    o.seed = 5;
    CHECK(!std::ranges::equal(render(traced, sky, o).radiance.pixels(), first.radiance.pixels()));
}

TEST_CASE("render: samples go on until the noise is as low as asked, and no farther") {
    const RayScene scene = trace(one(sphere_mesh(32), lambert_material(0.8f)));
    RenderOptions o = view(24, 16);
    o.noise = 0.5 * render(scene, sky_with_sun(), o).noise;
    const RenderResult r = render(scene, sky_with_sun(), o);
    CHECK(r.noise < o.noise);
    CHECK(*std::ranges::min_element(r.samples.pixels()) == 16);
    CHECK(r.sample_count > 16);
}

TEST_CASE("render: an instanced, turned and mirrored mesh is lit as if it stood alone") {
    const ImageF sky = sky_with_sun();
    const auto picture = [&](int instances) {
        Scene scene;
        Affine mirror;
        mirror.x = {-1, 0, 0};
        add(scene, sphere_mesh(48), lambert_material(0.8f), mirror);
        // A second instance far behind the camera: because of it the mesh becomes an object of its own.
        if (instances == 2) {
            Affine away;
            away.translation = {0, 0, 1000};
            scene.instances.push_back({0, away, "other"});
        }
        const RenderResult r = render(trace(std::move(scene)), sky, view(16, 64));
        return mean_inside(r, r.radiance);
    };
    const double alone = picture(1);
    CHECK(picture(2) == doctest::Approx(alone).epsilon(2e-3));
    CHECK(alone > 0);
}

TEST_CASE("render: rays that leave the range of float meet nothing, and flattened instances are met") {
    // Two instances of one mesh: Embree transforms rays into its frame where it can.
    Scene scene;
    add(scene, sphere_mesh(16), lambert_material(1), {{1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {-1.5f, 0, 0}});
    for (const Affine& place : {Affine{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1.5f, 0, 0}},
                                Affine{{1e-20f, 0, 0}, {0, 1e-20f, 0}, {0, 0, 1e-20f}, {0, 0, 0}}})
        scene.instances.push_back({0, place, "again"});
    const RayScene traced = trace(scene);
    RenderOptions o = view(32, 4);
    o.camera.fov_y = 1.2f;
    const RenderResult r = render(traced, ImageF(32, 16, 3, 1.f), o);
    CHECK(*r.opacity.at(8, 16) == 1);
    CHECK(*r.opacity.at(24, 16) == 1);
    CHECK(*r.opacity.at(16, 2) == 0);

    const float infinity = std::numeric_limits<float>::infinity();
    for (const float far : {1e19f, infinity, std::nanf("")}) {
        o.camera.to_world.translation = {far, 0, 4};
        for (const bool orthographic : {false, true}) {
            o.camera.orthographic = orthographic;
            const RenderResult nothing = render(traced, ImageF(32, 16, 3, 1.f), o);
            CHECK(*nothing.opacity.at(16, 16) == 0);
        }
    }
}

TEST_CASE("render: wrong sizes, empty scenes and a cancelled one are errors") {
    CHECK(!RayScene::build(Scene()));
    const RayScene scene = trace(one(sphere_mesh(8), lambert_material(1)));
    const ImageF white(16, 8, 3, 1.f);
    auto sampler = EnvironmentSampler::build(white, reference_sampler_options());
    RenderOptions o = view(16, 4);
    o.progress = [](std::string_view, double) { return false; };
    auto cancelled = render_reference(scene, *sampler, o);
    REQUIRE(!cancelled);
    CHECK(cancelled.error().what == "cancelled");
    o = view(0, 1);
    CHECK(!render_reference(scene, *sampler, o));
    ImageF spot = white;
    spot.at(3, 3)[0] = 1e4f;
    auto compensated = EnvironmentSampler::build(spot, reference_sampler_options());
    o = view(4, 1);
    o.strategy = LightStrategy::environment;
    CHECK(!render_reference(scene, *compensated, o));
}
