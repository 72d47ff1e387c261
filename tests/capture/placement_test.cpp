#include "domelight/capture/placement.h"

#include "capture/rooms.h"
#include "test.h"

#include <algorithm>
#include <cmath>

namespace domelight {
namespace {

using test::box_mesh;
using test::room_mesh;

RayScene scene_of(std::vector<Mesh> meshes) {
    Scene scene;
    for (Mesh& mesh : meshes) test::add(scene, std::move(mesh), test::lambert_material(0.5f));
    return *RayScene::build(std::move(scene));
}

TEST_CASE("grid_over: places fill the box, half a spacing from its sides") {
    const auto grid = grid_over({{-1, 0, 2}, {3, 2, 4}}, 4, 1, 2);
    REQUIRE(grid);
    CHECK(grid->spacing == Vec3f{1, 2, 1});
    CHECK(grid->place(0) == Vec3f{-0.5f, 1, 2.5f});
    CHECK(grid->place(grid->count() - 1) == Vec3f{2.5f, 1, 3.5f});
    CHECK(places_of(*grid)[5] == grid->place(5));
}

TEST_CASE("grid_over: a density gives neighbours at most 1 / sqrt(density) apart, no more probes than allowed") {
    const ProbeBox box{{0, 0, 0}, {5, 3, 4}};
    const auto grid = grid_over(box, {.density = 4});
    REQUIRE(grid);
    CHECK(grid->nx == 10);
    CHECK(grid->ny == 6);
    CHECK(grid->nz == 8);
    const auto dense = grid_over(box, {.density = 1e4});
    REQUIRE_FALSE(dense);
    CHECK(dense.error().where == "`density`");
    // The density that the hint names is allowed.
    const std::string hint = dense.error().hint;
    CHECK(grid_over(box, {.density = std::stod(hint.substr(hint.find_first_of("0123456789")))}));
}

TEST_CASE("grid_over: errors") {
    CHECK(grid_over({{0, 0, 0}, {0, 0, 0}}, 1, 1, 1).error().where == "`region`");
    CHECK(grid_over({{0, 0, 0}, {-1, 1, 1}}, 1, 1, 1).error().where == "`region`");
    CHECK(grid_over({{0, 0, 0}, {NAN, 1, 1}}, 1, 1, 1).error().where == "`region`");
    CHECK(grid_over({{0, 0, 0}, {1, 0, 1}}, 1, 2, 1).error().where == "`grid`");
    CHECK(grid_over({{0, 0, 0}, {1, 0, 1}}, 2, 1, 2));
    CHECK(grid_over({{0, 0, 0}, {1, 1, 1}}, 0, 1, 1).error().where == "`grid`");
    CHECK(grid_over({{0, 0, 0}, {1, 1, 1}}, {.density = NAN}).error().where == "`density`");
    CHECK(grid_over({{0, 0, 0}, {1, 1, 1}}, {.density = 0}).error().where == "`density`");
}

TEST_CASE("place_probes: a place in open space stays, one inside a body is moved out, one near a wall away from it") {
    const RayScene scene = scene_of({room_mesh({-5, 0, -5}, {5, 3, 5}), box_mesh({0, 0, 0}, {1, 1, 1})});
    const auto probes = place_probes(scene, std::vector<Vec3f>{{-2, 1.5f, -2}, {0.5f, 0.9f, 0.5f}, {-4.98f, 1.5f, 0}});
    REQUIRE(probes);
    CHECK((*probes)[0].position == Vec3f{-2, 1.5f, -2});
    CHECK_FALSE((*probes)[0].moved);
    CHECK((*probes)[1].moved);
    CHECK((*probes)[1].valid);
    CHECK((*probes)[1].position.y > 1.05f);  // through the top, which is the nearest side
    CHECK((*probes)[1].place == Vec3f{0.5f, 0.9f, 0.5f});
    CHECK((*probes)[2].moved);
    CHECK((*probes)[2].position.x > -4.92f);
}

TEST_CASE("place_probes: deep inside a body, or with nowhere to go, a probe is not valid and stays") {
    const RayScene scene = scene_of({room_mesh({-5, 0, -5}, {5, 3, 5}), box_mesh({-1.5f, 0, -1.5f}, {1.5f, 3, 1.5f})});
    const auto probes = place_probes(scene, std::vector<Vec3f>{{0, 1.5f, 0}, {1.4f, 1.5f, 0}}, {.farthest = 0});
    REQUIRE(probes);
    for (const Probe& p : *probes) {
        CHECK_FALSE(p.valid);
        CHECK_FALSE(p.moved);
        CHECK(p.position == p.place);
    }
}

TEST_CASE(
    "place_probes: a gap narrower than twice the distance that probes keep leaves the probe where it was asked for") {
    const RayScene scene = scene_of({room_mesh({-5, 0, -5}, {5, 0.1f, 5})});
    const auto probes = place_probes(scene, std::vector<Vec3f>{{0, 0.05f, 0}});
    REQUIRE(probes);
    CHECK((*probes)[0].valid);
    CHECK((*probes)[0].position == Vec3f{0, 0.05f, 0});
}

TEST_CASE("place_probes: with light, the dark inside of a double-sided body is noticed, and a lit one is not") {
    Scene scene;
    test::add(scene, room_mesh({-5, 0, -5}, {5, 3, 5}), test::lambert_material(0.5f));
    Material sheet = test::lambert_material(0.5f);
    sheet.double_sided = true;
    test::add(scene, box_mesh({0, 0, 0}, {1, 1, 1}), sheet);
    Material lamp = sheet;
    lamp.emission = {1, 1, 1};
    test::add(scene, box_mesh({-3, 0, 0}, {-2, 1, 1}), lamp);
    const RayScene traced = *RayScene::build(std::move(scene));
    const ImageF black(8, 4, 3);
    const EnvironmentSampler sky = *EnvironmentSampler::build(black.view(), reference_sampler_options());
    const std::vector<Vec3f> places{{0.5f, 0.5f, 0.5f}, {0.5f, 0.9f, 0.5f}, {-2.5f, 0.5f, 0.5f}, {3, 1.5f, 3}};
    const auto plain = place_probes(traced, places, {.farthest = 0.3f});
    REQUIRE(plain);
    for (const Probe& p : *plain) CHECK(p.valid);
    const auto probes = place_probes(traced, places, {.farthest = 0.3f, .light = &sky});
    REQUIRE(probes);
    CHECK_FALSE((*probes)[0].valid);
    CHECK((*probes)[1].valid);
    CHECK((*probes)[1].position.y > 1.05f);
    CHECK((*probes)[2].valid);
    CHECK_FALSE((*probes)[2].moved);
    CHECK((*probes)[3].valid);
}

TEST_CASE("fill_invalid: an invalid probe gets the light of its own side of a wall, though one behind it is nearer") {
    // Two rooms with a thick wall between, from x = 0 to x = 1. Probe 0 lies in the wall.
    const RayScene scene = scene_of(
        {room_mesh({-4, 0, -2}, {0, 3, 2}), room_mesh({1, 0, -2}, {5, 3, 2}), box_mesh({0.2f, 0, -2}, {0.25f, 3, 2})});
    std::vector<Probe> probes(3);
    probes[0].position = {0.1f, 1.5f, 0};
    probes[0].valid = false;
    probes[1].position = {-1.5f, 1.5f, 0};  // one surface between
    probes[2].position = {1.3f, 1.5f, 0};   // nearer, but three surfaces between
    REQUIRE(fill_invalid(scene, probes));
    CHECK(probes[0].filled_from == 1);
    CHECK(probes[1].filled_from == -1);
    for (Probe& p : probes) p.valid = false;
    CHECK(fill_invalid(scene, probes).error().what.starts_with("all probes lie inside bodies"));
}

TEST_CASE("place_probes: errors name the field and the place") {
    const RayScene scene = scene_of({box_mesh({0, 0, 0}, {1, 1, 1})});
    const std::vector<Vec3f> places{{2, 2, 2}, {0, NAN, 0}};
    const auto wrong = place_probes(scene, places);
    REQUIRE_FALSE(wrong);
    CHECK(wrong.error().where == "`places`");
    CHECK(wrong.error().what.starts_with("number 1,"));
    const std::vector<Vec3f> one{{2, 2, 2}};
    CHECK(place_probes(scene, one, {.nearest = 0}).error().where == "`nearest`");
    CHECK(place_probes(scene, one, {.farthest = -1}).error().where == "`farthest`");
    CHECK(place_probes(scene, one, {.rays = 4}).error().where == "`rays`");
}

}  // namespace
}  // namespace domelight
