// A room with a window: blended probes against one environment, both against the path-traced truth.

#include "domelight/capture/probe_bake.h"
#include "domelight/compare/metrics.h"
#include "domelight/render/shading/shading.h"

#include "render/shapes.h"
#include "test.h"

namespace domelight {
namespace {

/// Two triangles, counter-clockwise from the side from which they are seen.
void add_quad(Scene& scene, const Vec3f& a, const Vec3f& b, const Vec3f& c, const Vec3f& d, const Material& material) {
    Mesh mesh;
    mesh.positions = {a, b, c, d};
    mesh.normals.assign(4, normalize(cross(b - a, c - a)));
    mesh.indices = {0, 1, 2, 0, 2, 3};
    test::add(scene, mesh, material);
}

/// 4 x 2.5 x 3 m, seen from inside, with a window of 1.6 x 1 m in the wall at z = 3.
Scene room() {
    Material plaster, red;
    plaster.base_color = {0.8f, 0.8f, 0.75f}, plaster.roughness = 0.8f, plaster.metalness = 0;
    red = plaster, red.base_color = {0.7f, 0.1f, 0.1f};
    Scene scene;
    const auto wall = [&](const Vec3f& a, const Vec3f& u, const Vec3f& v, const Material& m) {
        add_quad(scene, a, a + u, a + u + v, a + v, m);
    };
    wall({0, 0, 0}, {0, 0, 3}, {4, 0, 0}, plaster);
    wall({0, 2.5f, 0}, {4, 0, 0}, {0, 0, 3}, plaster);
    wall({0, 0, 0}, {0, 2.5f, 0}, {0, 0, 3}, red);
    wall({4, 0, 0}, {0, 0, 3}, {0, 2.5f, 0}, plaster);
    wall({0, 0, 0}, {4, 0, 0}, {0, 2.5f, 0}, plaster);
    wall({0, 0, 3}, {0, 2.5f, 0}, {1, 0, 0}, plaster);
    wall({2.6f, 0, 3}, {0, 2.5f, 0}, {1.4f, 0, 0}, plaster);
    wall({1, 0, 3}, {0, 0.9f, 0}, {1.6f, 0, 0}, plaster);
    wall({1, 1.9f, 3}, {0, 0.6f, 0}, {1.6f, 0, 0}, plaster);
    return scene;
}

TEST_CASE("probes: a room with a window has less than half of the error that one environment has") {
    const auto scene = RayScene::build(room());
    REQUIRE(scene);
    ImageF sky(32, 16, 3);
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 32; ++x)
            for (int c = 0; c < 3; ++c) sky.at(x, y)[c] = y < 8 ? 2.f + 0.5f * float(c) : 0.5f;
    const auto sampler = EnvironmentSampler::build(sky.view(), reference_sampler_options());
    REQUIRE(sampler);
    RenderOptions o;
    o.width = 48, o.height = 32;
    o.samples = 128;
    o.bounces = 4;
    o.camera = look_at({3.7f, 1.5f, 0.3f}, {0, 0.9f, 2}, 1.1f);
    const auto truth = render_reference(*scene, *sampler, o);
    REQUIRE(truth);

    const auto grid = grid_over({{0, 0, 0}, {4, 2.5f, 3}}, 4, 2, 3);
    REQUIRE(grid);
    auto probes = place_probes(*scene, places_of(*grid));
    REQUIRE(probes);
    for (Probe& p : *probes) p.proxy = ProbeBox{{0, 0, 0}, {4, 2.5f, 3}};
    ProbeBakeOptions bake;
    bake.capture.size = 16;
    bake.capture.bounces = 4;
    const auto set = bake_probes(*scene, *sampler, *probes, *grid, bake);
    REQUIRE(set);

    o.samples = 4;
    const auto lit = render_shaded(*scene, ProbeBlender(*set), *sampler, {}, o);
    REQUIRE(lit);
    o.occlusion = false;
    const auto maps = LightMaps::bake(sampler->image(), sampler->world_to_source());
    REQUIRE(maps);
    const auto outdoors = render_shaded(*scene, *maps, *sampler, {}, o);
    REQUIRE(outdoors);
    const double with = compare_images(lit->radiance, truth->radiance).tone_mapped_rmse,
                 without = compare_images(outdoors->radiance, truth->radiance).tone_mapped_rmse;
    MESSAGE("tone-mapped RMSE: probes " << with << ", one environment " << without);
    CHECK(with <= 0.5 * without);
}

}  // namespace
}  // namespace domelight
