#include "domelight/capture/placement.h"
#include "domelight/capture/probe_plan.h"
#include "domelight/capture/probe_rooms.h"

#include "capture/rooms.h"
#include "test.h"

#include <algorithm>
#include <cmath>

namespace domelight {
namespace {

/// A room of 8 x 3 x 4 metres with a pillar, lit by a lamp near one end.
RayScene lit_room() {
    Scene scene;
    test::add(scene, test::room_mesh({0, 0, 0}, {8, 3, 4}), test::lambert_material(0.6f));
    test::add(scene, test::box_mesh({3.5f, 0, 1.5f}, {4.5f, 3, 2.5f}), test::lambert_material(0.6f));
    PunctualLight lamp;
    lamp.kind = PunctualLight::Kind::point, lamp.position = {1, 1.5f, 1}, lamp.intensity = {5, 5, 5};
    scene.lights.push_back(lamp);
    return *RayScene::build(std::move(scene));
}

EnvironmentSampler darkness() {
    static const ImageF black(8, 4, 3);
    return *EnvironmentSampler::build(black.view(), reference_sampler_options());
}

AutoPlacementOptions in_room(int count) {
    AutoPlacementOptions options;
    options.count = count;
    options.region = {{0, 0, 0}, {8, 3, 4}};
    return options;
}

TEST_CASE("auto_places: as many as asked for, in the open, and denser where the light changes") {
    const RayScene scene = lit_room();
    const auto probes = auto_places(scene, darkness(), in_room(70));
    REQUIRE(probes);
    CHECK(probes->size() == 70);
    int near = 0, far = 0;
    for (const Probe& p : *probes) {
        CHECK(p.valid);
        const Vec3f& at = p.position;
        CHECK((at.x > 0 && at.x < 8 && at.y > 0 && at.y < 3 && at.z > 0 && at.z < 4));
        CHECK_FALSE((at.x > 3.5f && at.x < 4.5f && at.z > 1.5f && at.z < 2.5f));
        near += at.x<2, far += at.x> 6;
    }
    CHECK(near > 2 * far);
    CHECK(far > 0);
}

TEST_CASE("auto_places: the same places on any number of threads") {
    const RayScene scene = lit_room();
    AutoPlacementOptions one = in_room(40), three = in_room(40);
    one.threads = 1, three.threads = 3;
    const auto a = auto_places(scene, darkness(), one), b = auto_places(scene, darkness(), three);
    REQUIRE(a);
    REQUIRE(b);
    REQUIRE(a->size() == b->size());
    for (std::size_t i = 0; i < a->size(); ++i) CHECK((*a)[i].position == (*b)[i].position);
}

TEST_CASE("auto_places: uniform light needs no more than the first places") {
    Scene scene;
    Material glow = test::lambert_material(0);
    glow.emission = {1, 1, 1};
    test::add(scene, test::room_mesh({0, 0, 0}, {8, 3, 4}), glow);
    const auto probes = auto_places(*RayScene::build(std::move(scene)), darkness(), in_room(60));
    REQUIRE(probes);
    CHECK(probes->size() <= 20);
}

TEST_CASE("auto_places: errors name the field, and cancelling ends it") {
    const RayScene scene = lit_room();
    CHECK(auto_places(scene, darkness(), in_room(7)).error().where == "`auto`");
    AutoPlacementOptions wrong = in_room(20);
    wrong.region.high.y = 0;
    CHECK(auto_places(scene, darkness(), wrong).error().where == "`region`");
    wrong = in_room(20), wrong.bounces = -1;
    CHECK(auto_places(scene, darkness(), wrong).error().where == "`bounces`");
    wrong = in_room(20), wrong.progress = [](std::string_view, double) { return false; };
    CHECK(auto_places(scene, darkness(), wrong).error().what == "cancelled");
    // All of it inside the pillar.
    wrong = in_room(20), wrong.region = {{3.8f, 1, 1.8f}, {4.2f, 2, 2.2f}};
    CHECK(auto_places(scene, darkness(), wrong).error().where == "`region`");
}

TEST_CASE("room_around: the walls, whatever stands in front of a small part of them") {
    Scene scene;
    test::add(scene, test::room_mesh({-2, 0, -3}, {4, 2.5f, 5}), test::lambert_material(0.6f));
    test::add(scene, test::box_mesh({2, 0, 0.8f}, {2.2f, 0.5f, 1.4f}), test::lambert_material(0.6f));
    const RayScene traced = *RayScene::build(std::move(scene));
    const auto box = room_around(traced, {0.5f, 1.2f, 1});
    REQUIRE(box);
    const float found[] = {box->low.x, box->low.y, box->low.z, box->high.x, box->high.y, box->high.z};
    const float walls[] = {-2, 0, -3, 4, 2.5f, 5};
    for (int i = 0; i < 6; ++i) CHECK(found[i] == doctest::Approx(walls[i]).epsilon(1e-4));
}

TEST_CASE("room_around: an open side is that of the scene's box, and in the open there is no room") {
    Scene scene;
    test::add(scene, test::floor_mesh(10, 0), test::lambert_material(0.6f));
    test::add(scene, test::box_mesh({-3, 0, -20}, {-2, 9, 20}), test::lambert_material(0.6f));
    test::add(scene, test::box_mesh({2, 0, -20}, {3, 9, 20}), test::lambert_material(0.6f));
    const RayScene traced = *RayScene::build(std::move(scene));
    const auto street = room_around(traced, {0, 1, 0});
    REQUIRE(street);
    CHECK(street->low.x == doctest::Approx(-2));
    CHECK(street->high.x == doctest::Approx(2));
    CHECK(street->low.y == doctest::Approx(0));
    CHECK(street->high.y == doctest::Approx(9));
    CHECK(street->high.z == doctest::Approx(20));
    CHECK_FALSE(room_around(traced, {0, 30, 0}));
}

TEST_CASE("set_proxies: a probe that was filled has the walls of the probe that it was filled from") {
    const RayScene scene = lit_room();
    std::vector<Probe> probes(2);
    probes[0].position = {1, 1.5f, 1};
    probes[1].position = {4, 1.5f, 2}, probes[1].valid = false, probes[1].filled_from = 0;
    set_proxies(scene, probes);
    REQUIRE(probes[0].proxy);
    REQUIRE(probes[1].proxy);
    CHECK(probes[1].proxy->high == probes[0].proxy->high);
}

TEST_CASE("plan_probes: each way of placing, with boxes and influence") {
    const RayScene scene = lit_room();
    ProbePlanOptions options;
    options.region = {{0, 0, 0}, {8, 3, 4}};
    CHECK(plan_probes(scene, darkness(), options).error().where == "`at`");
    options.grid = {4, 1, 2};
    const auto grid = plan_probes(scene, darkness(), options);
    REQUIRE(grid);
    REQUIRE(grid->grid);
    CHECK(grid->grid->count() == 8);
    CHECK(grid->how == "grid");
    CHECK(grid->probes[0].proxy->high.y == doctest::Approx(3));
    CHECK(grid->probes[0].influence.shape == ProbeInfluence::Shape::everywhere);
    options.density = 1;
    CHECK(plan_probes(scene, darkness(), options).error().where == "`at`");
    options.grid = {0, 0, 0};
    options.proxy = ProbeBox{{0, 0, 0}, {8, 3, 4}};
    options.influence = ProbeInfluence::Shape::box;
    const auto dense = plan_probes(scene, darkness(), options);
    REQUIRE(dense);
    CHECK(dense->probes.size() == 8 * 3 * 4);
    CHECK(dense->probes[5].influence.fade == doctest::Approx(0.3));
    options.density = 0, options.auto_count = 10, options.proxy = std::nullopt, options.walls = false;
    options.influence = ProbeInfluence::Shape::sphere;
    CHECK(plan_probes(scene, darkness(), options).error().where == "`radius`");
    options.radius = 2;
    const auto automatic = plan_probes(scene, darkness(), options);
    REQUIRE(automatic);
    CHECK(automatic->how == "auto 10");
    CHECK_FALSE(automatic->probes[0].proxy);
    CHECK(automatic->probes[0].influence.fade == doctest::Approx(0.2));
    options.auto_count = 0, options.at = {{1, 1, 1}, {2, 1, 1}};
    const auto places = plan_probes(scene, darkness(), options);
    REQUIRE(places);
    CHECK(places->probes.size() == 2);
    CHECK_FALSE(places->grid);
}

}  // namespace
}  // namespace domelight
