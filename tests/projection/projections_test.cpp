#include "domelight/projection/projections.h"

#include "test.h"

#include <random>
#include <vector>

using namespace domelight;

namespace {

/// Every projection of the table, with various conventions and parameters.
const std::vector<std::string> k_all{"latlong",
                                     "latlong/usd",
                                     "latlong/mitsuba",
                                     "latlong/openexr",
                                     "latlong/materialx",
                                     "latlong/mod",
                                     "latlong/centre=+Y,right=-Z,up=+X",
                                     "cube",
                                     "cube/openexr",
                                     "cube/centre=+Z,right=-X",
                                     "sphere-map",
                                     "sphere-map/centre=-Z,right=-X",
                                     "mirror-ball/fov=5",
                                     "mirror-ball/fov=40",
                                     "mirror-ball/fov=120,centre=+X,right=-Z",
                                     "mirror-ball/fov=120/centre=+X,right=-Z",
                                     "angular",
                                     "angular/centre=+Z",
                                     "hemisphere",
                                     "hemisphere/centre=+Y,up=-Z",
                                     "paraboloid",
                                     "paraboloid-opposite",
                                     "dual-paraboloid",
                                     "octahedral",
                                     "octahedral/centre=+Z,up=+Y",
                                     "equal-area-octahedral",
                                     "pbrt",
                                     "equirectangular"};

/// Directions over the sphere, and on and close to axes, edges and corners.
std::vector<Vec3d> probes() {
    std::vector<Vec3d> list;
    for (const double e : {0.0, 1e-12, 1e-9, 1e-6, 1e-3})
        for (int x = -1; x <= 1; ++x)
            for (int y = -1; y <= 1; ++y)
                for (int z = -1; z <= 1; ++z)
                    if (x || y || z) list.push_back(normalize(Vec3d{x + e, y - 0.7 * e, z + 0.4 * e}));
    for (int k = 0; k < 3000; ++k) {  // Fibonacci's lattice
        const double z = 1 - (2 * k + 1) / 3000.0, r = std::sqrt(1 - z * z), phi = 2.399963229728653 * k;
        list.push_back({r * std::cos(phi), r * std::sin(phi), z});
    }
    return list;
}

Projection get(const std::string& name) {
    auto p = projection_from_name(name);
    REQUIRE_MESSAGE(p, p.error().format());
    return *p;
}

}  // namespace

TEST_CASE("projections: direction -> uv -> direction within 1e-6 everywhere, poles, seams and edges too") {
    for (const std::string& name : k_all) {
        INFO(name);
        const Projection p = get(name);
        double worst = 0;
        for (const Vec3d& d : probes()) {
            const ProjectionPoint at = p.locate(d * 3.0);
            CHECK((at.uv.u >= -1e-15 && at.uv.u <= 1 + 1e-15 && at.uv.v >= -1e-15 && at.uv.v <= 1 + 1e-15));
            CHECK((at.chart >= 0 && at.chart < p.charts()));
            if (!at.shown) continue;
            worst = std::max(worst, length(p.direction(at.chart, at.uv) - d));
        }
        CHECK(worst < 1e-6);
    }
}

TEST_CASE("projections: uv -> direction -> uv, and the picture goes on past its edges as the light does") {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(0.001, 0.999);
    for (const std::string& name : k_all) {
        INFO(name);
        const Projection p = get(name);
        for (int k = 0; k < 500; ++k) {
            const int chart = int(random() % unsigned(p.charts()));
            const UV uv{unit(random), unit(random)};
            if (!p.valid(uv)) continue;
            CHECK(std::abs(length(p.direction(chart, uv)) - 1) < 1e-12);
            const ProjectionPoint back = p.locate(p.direction(chart, uv));
            CHECK(back.shown);
            CHECK(back.chart == chart);
            CHECK(std::hypot(back.uv.u - uv.u, back.uv.v - uv.v) < 1e-6);
        }
    }
    // A step beyond the edge is also a step on the sphere. (The hemisphere and a near mirror ball end at their rims.)
    for (const char* name : {"latlong", "cube", "angular", "paraboloid", "dual-paraboloid", "octahedral", "pbrt"}) {
        INFO(name);
        const Projection p = get(name);
        for (double t = 0.013; t < 1; t += 0.07)
            for (const double e : {1e-7})
                for (const auto& [in, out] : std::vector<std::pair<UV, UV>>{
                         {{t, e}, {t, -e}}, {{t, 1 - e}, {t, 1 + e}}, {{e, t}, {-e, t}}, {{1 - e, t}, {1 + e, t}}})
                    CHECK(length(p.direction(0, in) - p.direction(0, out)) < 1e-5);
    }
}

TEST_CASE("projections: the Jacobian is that of the direction, by finite differences") {
    std::mt19937 random(4);
    std::uniform_real_distribution<double> unit(0.002, 0.998);
    for (const std::string& name : k_all) {
        INFO(name);
        const Projection p = get(name);
        for (int k = 0; k < 300; ++k) {
            const int chart = int(random() % unsigned(p.charts()));
            const UV uv{unit(random), unit(random)};
            const double r = std::hypot(2 * uv.u - 1, 2 * uv.v - 1), e = 1e-6;
            if (!p.valid(uv) || (r > 0.98 && !p.valid({0, 0}))) continue;
            // The octahedron may have a kink within the step.
            if (std::min({std::abs(uv.u - 0.5), std::abs(uv.v - 0.5),
                          std::abs(std::abs(uv.u - 0.5) + std::abs(uv.v - 0.5) - 0.5)}) < 2 * e)
                continue;
            const auto at = [&](double u, double v) { return p.direction(chart, {u, v}); };
            const Vec3d du = (at(uv.u + e, uv.v) - at(uv.u - e, uv.v)) / (2 * e),
                        dv = (at(uv.u, uv.v + e) - at(uv.u, uv.v - e)) / (2 * e);
            CHECK(std::abs(length(cross(du, dv)) / p.jacobian(uv) - 1) < 1e-5);
        }
    }
}

TEST_CASE("projections: solid angles of texels sum to 4 pi, or to what is shown, discs clipped at the rim") {
    for (const std::string& name : k_all) {
        const Projection p = get(name);
        for (const int height : {1, 2, 3, 8, 45}) {
            const int width = int(height * p.shape().aspect());
            INFO(name, " ", width, " x ", height);
            double sum = 0;
            std::vector<double> row(static_cast<std::size_t>(width));
            for (int y = 0; y < height; ++y) {
                p.texel_solid_angles(y, width, height, row);
                for (int x = 0; x < width; ++x) {
                    const double omega = p.texel_solid_angle(x, y, width, height);
                    CHECK(omega >= 0);
                    CHECK(std::abs(omega - row[std::size_t(x)]) < 1e-9);
                    CHECK(std::abs(omega - p.texel_solid_angle(x, height - 1 - y, width, height)) < 1e-9);
                    sum += p.charts() * omega;
                }
            }
            CHECK(std::abs(sum - p.shape().coverage()) < 1e-6);
            if (p.full()) CHECK(std::abs(sum - 4 * k_pi) < 1e-6);
        }
    }
    // A larger picture of each projection, in which errors of rounding and quadrature would add up.
    for (const char* name : {"sphere-map", "angular", "dual-paraboloid", "octahedral", "mirror-ball/fov=30"}) {
        INFO(name);
        const Projection p = get(name);
        double sum = 0;
        for (int y = 0; y < 200; ++y)
            for (int x = 0; x < 200; ++x) sum += p.charts() * p.texel_solid_angle(x, y, 200, 200);
        CHECK(std::abs(sum - p.shape().coverage()) < 1e-7);
    }
}

TEST_CASE("projections: a texel's solid angle is the integral of the Jacobian over it") {
    for (const std::string& name : k_all) {
        const Projection p = get(name);
        for (const auto& [x, y] : std::vector<std::pair<int, int>>{{0, 2}, {3, 3}, {5, 4}, {1, 5}, {6, 6}, {3, 0}}) {
            INFO(name, " ", x, " ", y);
            const UVBox b = p.texel_box(x, y, 7, 7);
            const int steps = 400;
            double sum = 0;
            bool rim = false;
            for (int j = 0; j < steps; ++j)
                for (int i = 0; i < steps; ++i) {
                    const UV uv{b.u0 + (b.u1 - b.u0) * (i + 0.5) / steps, b.v0 + (b.v1 - b.v0) * (j + 0.5) / steps};
                    if (p.valid(uv)) sum += p.jacobian(uv);
                    rim = rim || !p.valid(uv);
                }
            sum *= (b.u1 - b.u0) * (b.v1 - b.v0) / (steps * steps);
            // Midpoints resolve a rim only to the width of a step, and the density is steep at the rim of the
            // hemisphere.
            CHECK(std::abs(sum - p.texel_solid_angle(x, y, 7, 7)) < (rim ? 1e-2 : 1e-4) * (sum + 1e-3));
        }
    }
}

TEST_CASE("projections: where the axes lie") {
    struct {
        const char* name;
        int chart;
        UV uv;
        Vec3d shown;
    } const expected[] = {
        {"latlong", 0, {0.5, 0.5}, {1, 0, 0}},
        {"latlong/usd", 0, {0.75, 0.5}, {-1, 0, 0}},
        {"latlong/mod", 0, {0.5, 0.5}, {-1, 0, 0}},
        {"cube", 4, {0.5, 0.5}, {0, 0, 1}},
        {"cube", 1, {0.5, 0.5}, {-1, 0, 0}},
        {"cube/centre=+Z,right=-X", 0, {0.5, 0.5}, {-1, 0, 0}},
        {"sphere-map", 0, {0.5, 0.5}, {0, 0, 1}},
        {"sphere-map", 0, {0.5 + 0.5 * std::sqrt(0.5), 0.5}, {1, 0, 0}},
        {"angular", 0, {0.5, 0.5}, {0, 0, -1}},
        {"angular", 0, {0.75, 0.5}, {1, 0, 0}},
        {"angular", 0, {0.5, 0.25}, {0, 1, 0}},
        {"angular", 0, {1.0, 0.5}, {0, 0, 1}},
        {"hemisphere", 0, {1.0, 0.5}, {1, 0, 0}},
        {"hemisphere", 0, {0.5, 0.0}, {0, 1, 0}},
        {"dual-paraboloid", 0, {0.5, 0.5}, {0, 0, 1}},
        {"dual-paraboloid", 1, {0.5, 0.5}, {0, 0, -1}},
        {"dual-paraboloid", 1, {1.0, 0.5}, {1, 0, 0}},
        {"paraboloid-opposite", 0, {0.5, 0.5}, {0, 0, -1}},
        {"paraboloid-opposite", 0, {1.0, 0.5}, {-1, 0, 0}},
        {"octahedral", 0, {0.5, 0.5}, {0, 1, 0}},
        {"octahedral", 0, {1.0, 0.5}, {1, 0, 0}},
        {"octahedral", 0, {0.5, 1.0}, {0, 0, -1}},
        {"octahedral", 0, {0.0, 0.0}, {0, -1, 0}},
        {"pbrt", 0, {0.5, 0.5}, {0, 1, 0}},
        {"pbrt", 0, {0.5, 1.0}, {0, 0, -1}},
        {"mirror-ball/fov=90", 0, {0.5, 0.5}, {0, 0, 1}},
        {"mirror-ball/fov=90", 0, {1.0, 0.5}, {std::sqrt(0.5), 0, -std::sqrt(0.5)}},  // grazing: 45 degrees off -Z
    };
    for (const auto& e : expected) {
        INFO(e.name, " ", e.uv.u, " ", e.uv.v);
        CHECK(length(get(e.name).direction(e.chart, e.uv) - e.shown) < 1e-7);
    }
}

TEST_CASE("projections: each one's published formula") {
    for (const Vec3d& d : probes()) {
        // The courses' hemisphere: d = normalize(pos).xy, z = √(1 - d.d).
        if (d.z > 0.01) {
            const UV uv = get("hemisphere").locate(d * 2.0).uv;
            CHECK(std::hypot(2 * uv.u - 1 - d.x, 1 - 2 * uv.v - d.y) < 1e-12);
        }
        // Their paraboloid: d = xy / (z - 1) with z = 1/2 - 1/2 d.d finds the opposite direction.
        if (d.z < -0.01) {
            const UV uv = get("paraboloid-opposite").locate(d).uv;
            const double x = d.x / (d.z - 1), y = d.y / (d.z - 1);
            CHECK(std::hypot(2 * uv.u - 1 - x, 1 - 2 * uv.v - y) < 1e-12);
            CHECK(length(normalize(Vec3d{x, y, 0.5 - 0.5 * (x * x + y * y)}) + d) < 1e-12);
        }
        // Debevec: rotate (0, 0, -1) by φ = π |p| about y, then by θ = atan2(v, u) about -z.
        const UV uv = get("angular").locate(d).uv;
        const double u = 2 * uv.u - 1, v = 1 - 2 * uv.v, phi = k_pi * std::hypot(u, v), theta = std::atan2(v, u);
        CHECK(length(Vec3d{std::sin(phi) * std::cos(theta), std::sin(phi) * std::sin(theta), -std::cos(phi)} - d) <
              1e-9);
    }
    // A mirror ball seen from farther and farther away approaches the sphere map.
    for (const Vec3d& d : probes())
        if (d.z > -0.95) {
            const UV near = get("mirror-ball/fov=0.1").locate(d).uv, far = get("sphere-map").locate(d).uv;
            CHECK(std::hypot(near.u - far.u, near.v - far.v) < 1e-3);
        }
}

TEST_CASE("projections: a mirror ball's picture is that of a ray traced to it") {
    const double fov = 50 * k_pi / 180, distance = 1 / std::sin(fov / 2);
    const Projection p = get("mirror-ball/fov=50");
    for (double x = -0.95; x < 1; x += 0.19)
        for (double y = -0.95; y < 1; y += 0.19) {
            if (x * x + y * y > 0.97) continue;
            const Vec3d ray = normalize(Vec3d{x * std::tan(fov / 2), y * std::tan(fov / 2), -1}),
                        camera{0, 0, distance};
            const double b = dot(ray, camera), t = -b - std::sqrt(b * b - distance * distance + 1);
            const Vec3d n = camera + ray * t;
            CHECK(length(p.direction(0, disc_uv({x, y})) - (ray - n * (2 * dot(ray, n)))) < 1e-12);
        }
}

TEST_CASE("projections: wrong names say what is accepted") {
    for (const char* wrong :
         {"", "mercator", "latlong/sideways", "latlong/centre=+X,right=-X", "angular/usd", "cube/centre=+Q",
          "mirror-ball/fov=much", "mirror-ball/fov=-3", "mirror-ball/fov=180", "mirror-ball/fov=nan",
          "sphere-map/fov=20", "octahedral/centre", "angular/left=+X", "cube/px", "pbrt/usd"}) {
        INFO(wrong);
        const auto p = projection_from_name(wrong);
        REQUIRE_FALSE(p);
        CHECK(!p.error().what.empty());
        if (std::string(wrong) == "mercator") CHECK(p.error().hint.find("dual-paraboloid") != std::string::npos);
    }
}
