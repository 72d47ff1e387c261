#include "domelight/filtering/resample/reproject.h"

#include "domelight/filtering/resample/area_resample.h"

#include "base/instruction_set.h"
#include "filtering/resample/area_resample_plain.h"
#include "filtering/resample/reproject_plain.h"
#include "test.h"

#include <algorithm>
#include <random>
#include <vector>

using namespace domelight;

namespace {

Projection get(const std::string& name) {
    auto p = projection_from_name(name);
    REQUIRE_MESSAGE(p, p.error().format());
    return *p;
}

/// A picture `height` high whose texels are `radiance` at their centres.
template <typename Radiance>
ProjectedImage picture(const std::string& name, int height, const Radiance& radiance) {
    const Projection p = get(name);
    const int width = int(height * p.shape().aspect());
    ProjectedImage image{p, ImageF(width, height * p.charts(), 3)};
    for (int c = 0; c < p.charts(); ++c)
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const UVBox b = p.texel_box(x, y, width, height);
                const Vec3d g = radiance(p.direction(c, {0.5 * (b.u0 + b.u1), 0.5 * (b.v0 + b.v1)}));
                float* to = image.pixels.at(x, c * height + y);
                to[0] = float(g.x), to[1] = float(g.y), to[2] = float(g.z);
            }
    return image;
}

ProjectedImage to(const ProjectedImage& source, const std::string& name, int height, int threads = 1) {
    const Projection p = get(name);
    return reproject(source, p, int(height * p.shape().aspect()), height, threads);
}

Vec3d direction_colour(const Vec3d& d) {
    return Vec3d{2, 2, 2} + d;
}

const std::vector<std::string> k_full{"latlong",
                                      "latlong/usd",
                                      "latlong/mitsuba",
                                      "latlong/openexr",
                                      "cube",
                                      "cube/openexr",
                                      "sphere-map",
                                      "angular",
                                      "dual-paraboloid",
                                      "octahedral",
                                      "equal-area-octahedral",
                                      "latlong/centre=+Y,right=+Z,up=-X"};

double relative(const Vec3d& a, const Vec3d& b) {
    return std::max({std::abs(a.x / b.x - 1), std::abs(a.y / b.y - 1), std::abs(a.z / b.z - 1)});
}

}  // namespace

TEST_CASE("reproject: a constant stays constant, between any two projections") {
    for (const std::string& from : k_full) {
        const ProjectedImage grey = picture(from, 12, [](const Vec3d&) { return Vec3d{0.3, 1, 7}; });
        for (const std::string& name : k_full)
            for (const int height : {1, 5, 24}) {
                INFO(from, " to ", name, " ", height);
                const ProjectedImage out = to(grey, name, height);
                double worst = 0;
                for (int y = 0; y < out.pixels.height(); ++y)
                    for (int x = 0; x < out.pixels.width(); ++x) {
                        if (out.projection.texel_solid_angle(x, y % out.height(), out.width(), out.height()) < 1e-9)
                            continue;  // outside the disc
                        const float* p = out.pixels.at(x, y);
                        worst =
                            std::max({worst, std::abs(p[0] / 0.3 - 1), std::abs(p[1] - 1.0), std::abs(p[2] / 7.0 - 1)});
                    }
                CHECK(worst < 1e-6);
            }
    }
}

TEST_CASE("reproject: light arrives from where it came, between any two projections") {
    for (const std::string& from : k_full) {
        const ProjectedImage source = picture(from, 48, direction_colour);
        for (const std::string& name : k_full) {
            INFO(from, " to ", name);
            const ProjectedImage out = to(source, name, 24), truth = picture(name, 24, direction_colour);
            double sum = 0, weight = 0, worst = 0;
            for (int y = 0; y < out.pixels.height(); ++y)
                for (int x = 0; x < out.pixels.width(); ++x) {
                    const double omega =
                        out.projection.texel_solid_angle(x, y % out.height(), out.width(), out.height());
                    const float *p = out.pixels.at(x, y), *q = truth.pixels.at(x, y);
                    // At the rims of sphere and angular maps, a few texels hold everything around the back.
                    const UVBox b = out.projection.texel_box(x, y % out.height(), out.width(), out.height());
                    const bool rim =
                        !out.projection.valid({0, 0}) && std::hypot(b.u0 + b.u1 - 1, b.v0 + b.v1 - 1) > 0.8;
                    const double off = std::hypot(std::hypot(p[0] - q[0], p[1] - q[1]), p[2] - q[2]);
                    sum += omega * off, weight += omega;
                    if (!rim && omega > 1e-9) worst = std::max(worst, off);
                }
            CHECK(sum / weight < 0.04);  // a texel of these is 0.13 wide
            CHECK(worst < 0.35);
        }
    }
}

TEST_CASE("reproject: power is kept, that of a small sun too") {
    std::mt19937 random(2);
    for (const std::string from : {"latlong", "cube", "octahedral", "dual-paraboloid"}) {
        ProjectedImage source = picture(from, 40, direction_colour);
        for (int k = 0; k < 6; ++k) {
            float* p = source.pixels.at(int(10 + random() % 20), int(10 + random() % 20));
            p[1] = 5e3f;
        }
        const Vec3d before = radiant_power(source);
        for (const std::string name : {"latlong", "cube", "octahedral", "equal-area-octahedral"})
            for (const int height : {20, 40, 64}) {
                INFO(from, " to ", name, " ", height);
                // Some of the suns lie on seams, where texels are sampled.
                CHECK(relative(radiant_power(to(source, name, height)), before) < 1e-2);
            }
    }
    // At a common size.
    ProjectedImage source = picture("latlong", 256, direction_colour);
    for (int k = 0; k < 20; ++k) source.pixels.at(int(random() % 512), int(random() % 256))[1] = 1e4f;
    const Vec3d before = radiant_power(source);
    for (const char* name : {"cube", "octahedral"}) {
        INFO(name);
        CHECK(relative(radiant_power(to(source, name, 128, 2)), before) < 2e-4);
    }
}

TEST_CASE("reproject: the same grid returns the texels, nothing negative appears, extremes are kept") {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(0, 1);
    for (const std::string name : {"latlong", "cube", "octahedral", "equal-area-octahedral"}) {
        INFO(name);
        const ProjectedImage source = picture(name, 16, [&](const Vec3d&) {
            return Vec3d{unit(random), std::pow(unit(random), 30) * 1e5, 0};
        });
        const ProjectedImage same = to(source, name, 16);
        double worst = 0;
        for (std::size_t i = 0; i < source.pixels.pixels().size(); ++i)
            worst = std::max(worst, std::abs(double(same.pixels.pixels()[i]) - source.pixels.pixels()[i]) /
                                        (source.pixels.pixels()[i] + 1e-3));
        CHECK(worst < (name == "octahedral" ? 0.15 : 0.05));  // texels at seams and folds are integrated by samples
        const ProjectedImage larger = to(source, "cube", 40);
        CHECK(*std::min_element(larger.pixels.pixels().begin(), larger.pixels.pixels().end()) >= 0);
    }
}

TEST_CASE("reproject: agrees with the exact overlap of a smooth picture") {
    const ProjectedImage source = picture("latlong", 128, direction_colour);
    auto plain = area::plain_to_cube(256, 128, 24, rotation_y(0.4), 1);
    plain->add_rows(source.pixels);
    const ImageF truth = plain->finish();
    ProjectedImage turned{get("latlong").turned(rotation_y(0.4)), source.pixels};
    const ProjectedImage out = to(turned, "cube", 24);
    double worst = 0;
    for (std::size_t i = 0; i < truth.pixels().size(); ++i)
        worst = std::max(worst, double(std::abs(truth.pixels()[i] - out.pixels.pixels()[i])));
    CHECK(worst < 1e-3);
}

TEST_CASE("reproject: agrees with its plain form, which integrates every outline in scalar doubles") {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> unit(0, 1);
    const Mat3 turn = get("latlong/centre=+Y,right=+Z,up=-X").world_to_picture() * rotation_y(0.7);
    const auto difference = [&](const std::string& from, int from_height, const std::string& name, int height) {
        ProjectedImage source = picture(from, from_height, [&](const Vec3d& d) {
            return Vec3d{0.2 + unit(random), unit(random) < 0.01 ? 1000.0 : 1.0, 2 + d.y};
        });
        source.projection = source.projection.turned(turn);
        const Projection p = get(name);
        const int width = int(height * p.shape().aspect());
        const ProjectedImage fast = reproject(source, p, width, height, 2),
                             plain = reproject_detail::reproject_plain(source, p, width, height, 2);
        const Vec3d power = radiant_power(plain);
        CHECK(relative(radiant_power(fast), power) < 1e-7);
        double worst[3] = {};
        for (std::size_t i = 0; i < plain.pixels.pixels().size(); ++i)
            worst[i % 3] = std::max(worst[i % 3], std::abs(double(fast.pixels.pixels()[i]) - plain.pixels.pixels()[i]));
        return std::max({worst[0], worst[1] / 1000, worst[2]});
    };
    // The same outlines: floats may round differently.
    for (const std::string from : {"latlong", "latlong/mitsuba", "cube", "octahedral"})
        for (const std::string name : {"latlong", "cube"}) {
            INFO(from, " to ", name);
            CHECK(difference(from, 24, name, 21) < 1e-6);
        }
    // Blocks small enough that corners are interpolated, with errors up to 1e-6 of a texel.
    CHECK(difference("latlong", 256, "latlong", 192) < 1e-5);
    for (const char* set : {"AVX2", "SSE4", "SCALAR", ""}) {
        INFO(set);
        simd::limit_instruction_set(set);
        CHECK(difference("latlong", 256, "cube", 64) < 1e-5);
    }
    simd::limit_instruction_set("");
}

TEST_CASE("reproject: partial projections leave black, a mirror ball repeats its rim") {
    const ProjectedImage half = picture("hemisphere", 32, [](const Vec3d&) { return Vec3d{1, 1, 1}; });
    const ProjectedImage cube = to(half, "cube", 8);
    CHECK(std::abs(radiant_power(cube).x - 2 * k_pi) < 0.02);
    CHECK(cube.pixels.at(4, 4 * 8 + 4)[0] > 0.999f);  // +Z
    CHECK(cube.pixels.at(4, 5 * 8 + 4)[0] == 0);      // -Z
    const ProjectedImage ball = picture("mirror-ball/fov=60", 32, [](const Vec3d&) { return Vec3d{1, 1, 1}; });
    CHECK(std::abs(radiant_power(to(ball, "cube", 8)).x - 4 * k_pi) < 1e-4);
    CHECK(std::abs(radiant_power(ball).x - 2 * k_pi * (1 + std::cos(k_pi / 6))) < 1e-5);
}

TEST_CASE("reproject: the same bytes on any number of threads") {
    const ProjectedImage source = picture("cube", 20, direction_colour);
    for (const char* name : {"latlong", "angular"}) {
        const ProjectedImage one = to(source, name, 70, 1), many = to(source, name, 70, 5);
        CHECK(std::ranges::equal(one.pixels.pixels(), many.pixels.pixels()));
    }
}

TEST_CASE("reproject: reducing does not alias") {
    // Every other row: stripes far finer than the target's texels become their mean.
    const ProjectedImage stripes = picture("latlong", 256, [](const Vec3d& d) {
        return Vec3d{1, 1, 1} * (int(latlong_uv(d).v * 256) % 2 == 0 ? 2 : 0);
    });
    const Vec3d mean = radiant_power(stripes) / (4 * k_pi);
    const ProjectedImage small = to(stripes, "cube", 4);
    for (const float v : small.pixels.pixels()) CHECK(std::abs(v / mean.x - 1) < 0.03);  // at a pole a stripe is a disc
}
