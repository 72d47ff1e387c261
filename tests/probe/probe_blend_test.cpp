#include "domelight/probe/probe_blend.h"

#include "domelight/base/random.h"

#include "probe/two_rooms.h"
#include "test.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

using namespace domelight;
using domelight::test::TwoRooms;

namespace {

const Vec3f k_normals[] = {{0, 1, 0}, {0, -1, 0}, {1, 0, 0}, {-1, 0, 0}, {0, 0, 1}};

float green(const ProbeBlender& blender, const Vec3f& point, const Vec3f& normal) {
    return blender.irradiance_over_pi(blender.at(point, normal), normal).y;
}

/// Calls a function with every point of lines across the wall, on one side of it: on the floor, in the air, below the
/// ceiling.
void across(const TwoRooms& rooms, bool dark_side, const std::function<void(const Vec3f& point)>& call) {
    for (const float y : {0.f, 0.3f, 1.5f, 2.2f, 3.f})
        for (const float z : {-2.9f, -0.37f, 1.f})
            for (int k = 0; k <= 100; ++k) {
                const float depth = rooms.thickness / 2 + (3.95f - rooms.thickness / 2) * float(k) / 100;
                call({dark_side ? depth : -depth, y, z});
            }
}

struct Leak {
    float behind = 0, in_front = 1e30f;  ///< the most and the least E / pi
};
Leak leak(const TwoRooms& rooms, const ProbeBlender& blender) {
    Leak out;
    for (const Vec3f& n : k_normals) {
        across(rooms, true, [&](const Vec3f& p) { out.behind = std::max(out.behind, green(blender, p, n)); });
        across(rooms, false, [&](const Vec3f& p) { out.in_front = std::min(out.in_front, green(blender, p, n)); });
    }
    return out;
}

}  // namespace

TEST_SUITE("probe") {
    TEST_CASE("blend: weights are above 0 and sum to 1") {
        for (const bool with_grid : {true, false}) {
            const auto set = TwoRooms().set(with_grid);
            REQUIRE(set);
            for (const int most : {1, 3, 8}) {
                const ProbeBlender blender(*set, {.most = most});
                across({}, false, [&](const Vec3f& p) {
                    const ProbeBlend blend = blender.at(p, {0, 1, 0});
                    REQUIRE(blend.count >= 1);
                    REQUIRE(blend.count <= std::max(most, 1));
                    float sum = 0;
                    for (const auto& part : blend.all()) {
                        REQUIRE(part.weight > 0);
                        sum += part.weight;
                    }
                    REQUIRE(sum == doctest::Approx(1).epsilon(1e-5));
                });
            }
        }
    }

    TEST_CASE("blend: a closed wall lets less than 1 % of the light through, at every point of lines across it") {
        // The light in front is 0.65 or more for each normal. Probes are a metre apart. Between tetrahedra they are
        // further from the wall, which must be thicker.
        for (const auto& [thickness, size, with_grid] :
             {std::tuple{0.02f, 32, true}, {0.05f, 16, true}, {0.1f, 32, false}}) {
            const TwoRooms rooms{thickness, size};
            const auto set = rooms.set(with_grid);
            const Leak with = leak(rooms, ProbeBlender(*set)),
                       without = leak(rooms, ProbeBlender(*set, {.visibility = false}));
            CAPTURE(thickness);
            CAPTURE(with_grid);
            CHECK(with.behind <= 0.01f * 0.65f);
            CHECK(with.in_front >= 0.65f);
            CHECK(without.behind > 0.3f);
        }
    }

    TEST_CASE("blend: no step in the light as a point crosses cells") {
        for (const bool with_grid : {true, false}) {
            const TwoRooms rooms{0.2f, 32};
            const auto set = rooms.set(with_grid);
            const ProbeBlender blender(*set);
            double largest = 0;
            for (int line = 0; line < 20; ++line) {
                const auto number = [&](int k) {
                    return float(derive_key(std::uint64_t(line), std::uint64_t(k)) >> 40) * 0x1p-24f;
                };
                // In the lit room, where a step could be as large as the differences between its probes: 0.6.
                const Vec3f a{-3.9f + 3.7f * number(0), 3 * number(1), -2.9f + 5.8f * number(2)},
                    b{-3.9f + 3.7f * number(3), 3 * number(4), -2.9f + 5.8f * number(5)};
                float before = 0, last = 0;
                constexpr int steps = 4000;  // of about a millimetre
                for (int k = 0; k <= steps; ++k) {
                    const float v = green(blender, a + (b - a) * (float(k) / steps), {0, 0, 1});
                    if (k > 1) largest = std::max(largest, std::abs(double(v) - 2.0 * double(last) + double(before)));
                    before = last, last = v;
                }
            }
            // 0.0003 on the grid and 0.0018 between tetrahedra.
            CHECK(largest < 0.003);
        }
    }

    TEST_CASE("blend: probes in walls, and cells without a valid one") {
        TwoRooms rooms;
        const auto whole = rooms.set();
        std::vector<Probe> probes(whole->probes().begin(), whole->probes().end());
        std::vector<ProbeMaps> maps;
        for (Probe& p : probes) {
            maps.push_back(rooms.maps(p.position));
            p.valid = p.position.z > -1;
        }
        for (const bool with_grid : {true, false}) {
            const auto set =
                ProbeSet::from_maps(probes, with_grid ? whole->grid() : std::optional<ProbeGrid>(), {0, 1}, maps);
            const ProbeBlender blender(*set);
            across(rooms, false, [&](const Vec3f& p) {
                const ProbeBlend blend = blender.at(p, {0, 1, 0});
                for (const auto& part : blend.all()) REQUIRE(set->probes()[std::size_t(part.probe)].valid);
                REQUIRE(blender.irradiance_over_pi(blend, {0, 1, 0}).y > 1.2f);
            });
        }
    }

    TEST_CASE("blend: a local probe counts inside of its influence, and fades to nothing at the boundary") {
        TwoRooms rooms;
        const auto whole = rooms.set();
        std::vector<Probe> probes(whole->probes().begin(), whole->probes().end());
        std::vector<ProbeMaps> maps;
        for (const Probe& p : probes) maps.push_back(rooms.maps(p.position));
        const int local = whole->grid()->index(1, 1, 3);
        probes[std::size_t(local)].influence = {ProbeInfluence::Shape::sphere, {}, 0.5f, 0.2f};
        const auto set = ProbeSet::from_maps(probes, whole->grid(), {0, 1}, maps);
        const ProbeBlender blender(*set);
        const auto weight = [&](float away) {
            const ProbeBlend blend = blender.at(probes[std::size_t(local)].position + Vec3f{away, 0, 0}, {0, 1, 0});
            for (const auto& part : blend.all())
                if (part.probe == local) return part.weight;
            return 0.f;
        };
        CHECK(weight(0.01f) > 0.9f);
        CHECK(weight(0.45f) < weight(0.35f));
        CHECK(weight(0.45f) > 0);
        CHECK(weight(0.499f) < 0.01f * weight(0.29f));
        CHECK(weight(0.51f) == 0);
    }

    TEST_CASE("blend: a point that is not finite is no reason to read beyond the probes") {
        for (const bool with_grid : {true, false}) {
            const auto set = TwoRooms().set(with_grid);
            const ProbeBlender blender(*set);
            for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                                    -std::numeric_limits<float>::infinity()})
                for (const Vec3f& p : {Vec3f{bad, 1, 0}, Vec3f{0, bad, 0}, Vec3f{0, 1, bad}, Vec3f{bad, bad, bad}}) {
                    const ProbeBlend blend = blender.at(p, {0, 1, 0});
                    for (const auto& part : blend.all()) CHECK(part.probe < 144);
                }
        }
    }

    TEST_CASE("blend: with fewer probes, one enters and leaves with weight 0") {
        const auto set = TwoRooms().set();
        const ProbeBlender blender(*set, {.most = 4});
        std::array<float, 256> last{};
        double largest = 0;
        for (int k = 0; k <= 3000; ++k) {
            const Vec3f p = Vec3f{-3.4f, 0.7f, -2.2f} + Vec3f{2.7f, 0, 0} * (float(k) / 3000);
            std::array<float, 256> now{};
            const ProbeBlend blend = blender.at(p, {0, 1, 0});
            for (const auto& part : blend.all()) now[std::size_t(part.probe)] = part.weight;
            for (std::size_t i = 0; i < now.size(); ++i)
                if (k) largest = std::max(largest, std::abs(double(now[i]) - double(last[i])));
            last = now;
        }
        // Steps of a millimetre; a probe that left with its whole weight would leave a step of a tenth or more.
        CHECK(largest < 0.02);
    }

    TEST_CASE("blend: a probe behind the surface has the weight of its cosine") {
        // Without distances there is no visibility. The point is in the middle between two probes.
        TwoRooms rooms;
        std::vector<ProbeMaps> maps{rooms.maps({-1, 1, 0}), rooms.maps({-1, 1, 1})};
        for (ProbeMaps& m : maps) m.distance = {};
        std::vector<Probe> probes{{.place = {-1, 1, 0}, .position = {-1, 1, 0}},
                                  {.place = {-1, 1, 1}, .position = {-1, 1, 1}}};
        const auto set = ProbeSet::from_maps(probes, ProbeGrid{{-1, 1, 0}, {1, 1, 1}, 1, 1, 2}, {0, 1}, maps);
        REQUIRE(set);
        const auto behind = [&](const BlendOptions& options, double cosine) {
            const Vec3f normal{float(std::sqrt(1 - cosine * cosine)), 0, float(cosine)};
            const ProbeBlend blend = ProbeBlender(*set, options).at({-1, 1, 0.5f}, normal);
            return double(blend.all()[0].probe == 0 ? blend.all()[0].weight : 1 - blend.all()[0].weight);
        };
        for (const double c : {1.0, 0.5, 0.0}) {
            const double front = (1 + c) / 2 * (1 + c) / 2 + 0.02, back = (1 - c) / 2 * (1 - c) / 2 + 0.02;
            CHECK(behind({}, c) == doctest::Approx(back / (front + back)).epsilon(1e-5));
            CHECK(behind({.visibility = false}, c) == doctest::Approx(0.5));
        }
    }

    TEST_CASE("blend: the offset moves the point along the normal, by the spacing of each axis") {
        const auto set = TwoRooms().set();
        const ProbeBlender moved(*set, {.visibility = false, .normal_offset = 0.5f}),
            plain(*set, {.visibility = false});
        const Vec3f point{-2.2f, 1.1f, 0.3f};
        for (const Vec3f& n : k_normals) {
            const ProbeBlend a = moved.at(point, n), b = plain.at(point + n * 0.5f, n);
            REQUIRE(a.count == b.count);
            for (std::size_t i = 0; i < std::size_t(a.count); ++i) {
                CHECK(a.parts[i].probe == b.parts[i].probe);
                CHECK(a.parts[i].weight == doctest::Approx(b.parts[i].weight));
            }
        }
    }

    TEST_CASE("parallax: the lookup meets the wall where the point sees it") {
        const ProbeBox room{{-2, 0, -3}, {2, 3, 3}};
        const Vec3f probe{1, 1.5f, 0}, point{-1, 0, 2};
        for (int i = 0; i < 200; ++i) {
            const auto number = [&](int k) {
                return float(derive_key(std::uint64_t(i), std::uint64_t(k)) >> 40) * 0x1p-23f - 1;
            };
            const Vec3f direction = normalize(Vec3f{number(0), std::abs(number(1)) + 0.01f, number(2)});
            // Where each of the two rays meets the walls, in double precision.
            const Vec3d seen =
                Vec3d(point) + Vec3d(direction) * domelight::test::distance_in_box(room, point, Vec3d(direction));
            const Vec3d looked_up = normalize(Vec3d(parallax_direction(room, probe, point, direction)));
            const Vec3d found = Vec3d(probe) + looked_up * domelight::test::distance_in_box(room, probe, looked_up);
            CHECK(length(found - seen) < 1e-5);
        }
        // At the probe itself nothing changes, and a point outside counts as the nearest one on the box.
        CHECK(length(normalize(parallax_direction(room, probe, probe, {0, 0, 1})) - Vec3f{0, 0, 1}) < 1e-6f);
        CHECK(parallax_direction(room, probe, {5, 1, 0}, {0, 0, 1}) ==
              parallax_direction(room, probe, {2, 1, 0}, {0, 0, 1}));
        // A box without a size is the point itself.
        CHECK(parallax_direction({probe, probe}, probe, point, {0, 0, 1}) == Vec3f{0, 0, 1});
    }
}
