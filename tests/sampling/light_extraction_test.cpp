#include "domelight/sampling/light_extraction.h"

#include "domelight/environment/sky/sky.h"
#include "domelight/filtering/prefilter.h"
#include "domelight/image/row_source.h"
#include "domelight/io/environment/open_environment.h"
#include "domelight/projection/projection.h"

#include "environment/sky/sky_model.h"
#include "preview/lights_sheet.h"
#include "sampling/harmonic_fill.h"
#include "scene/gltf/gltf_lights_writer.h"
#include "test.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

using namespace domelight;

namespace {

constexpr double k_deg = k_pi / 180;

ImageF constant(int height, const Vec3f& value) {
    ImageF image(2 * height, height, 3);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < 2 * height; ++x) {
            float* p = image.at(x, y);
            p[0] = value.x, p[1] = value.y, p[2] = value.z;
        }
    return image;
}

/// Adds a disc of constant radiance. The share of each texel is found by 16 x 64 points.
void add_disc(ImageF& image, const Vec3d& direction, double diameter_deg, const Vec3d& radiance) {
    const int w = image.width(), h = image.height();
    const double cosine = std::cos(diameter_deg / 2 * k_deg), near = std::cos((diameter_deg + 720.0 / w) * k_deg);
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x) {
            if (dot(latlong_direction({(x + 0.5) / w, (y + 0.5) / h}), direction) < near) continue;
            double inside = 0, all = 0;
            for (int k = 0; k < 1024; ++k) {
                const double v = (y + (k / 16 + 0.5) / 64) / h, area = std::sin(v * k_pi);
                inside += area * (dot(latlong_direction({(x + (k % 16 + 0.5) / 16) / w, v}), direction) >= cosine);
                all += area;
            }
            float* p = image.at(x, y);
            p[0] += float(radiance.x * inside / all);
            p[1] += float(radiance.y * inside / all);
            p[2] += float(radiance.z * inside / all);
        }
}

Vec3d at_angles(double azimuth_deg, double elevation_deg) {
    const double a = azimuth_deg * k_deg, e = elevation_deg * k_deg;
    return {std::cos(e) * std::cos(a), std::sin(e), std::cos(e) * std::sin(a)};
}

double angle_deg(const Vec3d& a, const Vec3d& b) {
    return std::atan2(length(cross(a, b)), dot(a, b)) / k_deg;
}

double disc_solid_angle(double diameter_deg) {
    return 2 * k_pi * (1 - std::cos(diameter_deg / 2 * k_deg));
}

LightExtraction extract(const ImageF& image, const LightExtractionOptions& options = {},
                        const Mat3& world_to_source = {}) {
    auto found = extract_lights(image.view(), options, world_to_source);
    REQUIRE(found);
    return *std::move(found);
}

/// Equal to a relative difference (doctest's Approx adds an absolute one).
bool close(double a, double b, double relative) {
    return std::abs(a - b) <= relative * std::abs(b);
}

/// What must hold of every result.
void check_sound(const ImageF& image, const LightExtraction& found) {
    Vec3d before, after, lights;
    bool fine = true;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            const float *a = image.at(x, y), *b = found.remainder.at(x, y);
            const double omega = latlong_solid_angle(y, image.width(), image.height());
            before += Vec3d{a[0], a[1], a[2]} * omega;
            after += Vec3d{b[0], b[1], b[2]} * omega;
            for (int c = 0; c < 3; ++c) fine = fine && b[c] >= 0 && std::isfinite(b[c]);
        }
    CHECK_MESSAGE(fine, "the remainder is finite and not negative");
    for (const ExtractedLight& l : found.lights) {
        lights += l.irradiance;
        CHECK(length(l.direction) == doctest::Approx(1).epsilon(1e-12));
        CHECK(std::max({l.colour.x, l.colour.y, l.colour.z}) == doctest::Approx(1));
        CHECK(std::min({l.irradiance.x, l.irradiance.y, l.irradiance.z}) >= 0);
        CHECK(l.angular_diameter_deg > 0);
        CHECK((l.share > 0 && l.share <= 1 + 1e-9));
        CHECK(std::isfinite(l.mean_radiance.x + l.mean_radiance.y + l.mean_radiance.z));
    }
    for (double Vec3d::*c : {&Vec3d::x, &Vec3d::y, &Vec3d::z}) {
        CHECK(std::abs(before.*c - lights.*c - after.*c) <= 1e-5 * before.*c);
        CHECK(after.*c <= before.*c * (1 + 1e-12));
        CHECK(found.report.original_power.*c == doctest::Approx(before.*c).epsilon(1e-9));
        CHECK(found.report.remainder_power.*c == doctest::Approx(after.*c).epsilon(1e-9));
        CHECK(found.report.light_power.*c == doctest::Approx(lights.*c).epsilon(1e-9));
    }
    CHECK(found.report.unaccounted < 1e-9);
}

/// E at the six axes and eight corners, of an environment.
std::vector<Vec3d> irradiance_of(const ImageF& image) {
    FilterOptions options;
    options.layout = Layout::latlong;
    options.irradiance_size = 24;
    options.sh_bands = 0;
    ImageRowSource rows(image.view());
    const auto filtered = prefilter(rows, options);
    REQUIRE(filtered);
    std::vector<Vec3d> out;
    const ImageF& map = filtered->irradiance_over_pi.image;
    for (int y = 0; y < map.height(); ++y)
        for (int x = 0; x < map.width(); ++x)
            out.push_back(Vec3d(map.at(x, y)[0], map.at(x, y)[1], map.at(x, y)[2]) * k_pi);
    return out;
}

/// Irradiance of lights and remainder together against that of the original, over all normals, relative to the
/// original's mean.
double irradiance_error(const ImageF& image, const LightExtraction& found) {
    const std::vector<Vec3d> before = irradiance_of(image), after = irradiance_of(found.remainder);
    double error = 0, mean = 0;
    for (std::size_t i = 0; i < before.size(); ++i) {
        const int w = 48, x = int(i) % w, y = int(i) / w;
        const Vec3d n = latlong_direction({(x + 0.5) / w, (y + 0.5) / 24});
        Vec3d sum = after[i];
        for (const ExtractedLight& l : found.lights) sum += l.irradiance * std::max(0.0, dot(n, l.direction));
        const Vec3d off = sum - before[i];
        error = std::max({error, std::abs(off.x), std::abs(off.y), std::abs(off.z)});
        mean += (before[i].x + before[i].y + before[i].z) / 3 / double(before.size());
    }
    return error / mean;
}

}  // namespace

TEST_SUITE_BEGIN("sampling");

TEST_CASE("extract_lights: the built-in sky's sun has the model's direction, irradiance and size") {
    for (const auto& [elevation, azimuth] : {std::pair{30.0, 30.0}, {8.0, -179.9}, {88.0, 100.0}, {55.5, 77.7}}) {
        CAPTURE(elevation);
        SkyOptions sky;
        sky.sun_elevation_deg = elevation;
        sky.sun_azimuth_deg = azimuth;
        const auto rows = make_sky(sky);
        const auto image = read_latlong(*rows);
        REQUIRE(image);
        const LightExtraction found = extract(*image);
        check_sound(*image, found);
        REQUIRE(found.lights.size() == 1);
        const ExtractedLight& sun = found.lights[0];
        CHECK(angle_deg(sun.direction, at_angles(azimuth, elevation)) < 0.05);
        const Vec3d truth = sky::SkyModel(sky).direct_normal_irradiance();
        CHECK(close(sun.irradiance.x, truth.x, 0.01));
        CHECK(close(sun.irradiance.y, truth.y, 0.01));
        CHECK(close(sun.irradiance.z, truth.z, 0.01));
        // 0.533 degrees, less what the darker limb takes from the second moment (some 6 %), on texels of 0.35 degrees.
        CHECK(sun.angular_diameter_deg > 0.44);
        CHECK(sun.angular_diameter_deg < 0.56);
        CHECK(sun.resolved);
    }
}

TEST_CASE("extract_lights: a disc's diameter, radiance and direction, where texels resolve it") {
    for (const double diameter : {1.0, 2.0, 4.5}) {
        CAPTURE(diameter);
        ImageF image = constant(256, {0.5f, 0.4f, 0.3f});
        const Vec3d towards = at_angles(12.3, 34.5);
        add_disc(image, towards, diameter, {900, 600, 300});
        const LightExtraction found = extract(image);
        check_sound(image, found);
        REQUIRE(found.lights.size() == 1);
        const ExtractedLight& light = found.lights[0];
        CHECK(angle_deg(light.direction, towards) < 0.05);
        CHECK(close(light.angular_diameter_deg, diameter, diameter < 2 ? 0.13 : 0.03));  // texels of 0.7 degrees
        if (diameter >= 2) CHECK(close(light.mean_radiance.x, 900, 0.06));  // as the square of the diameter
        CHECK(close(light.irradiance.x, 900 * disc_solid_angle(diameter), 0.02));
        CHECK(close(light.colour.y, 2.0 / 3, 1e-3));
        // The surroundings are constant, so what replaces the light must be constant too.
        CHECK(*std::max_element(found.remainder.pixels().begin(), found.remainder.pixels().end()) == 0.5f);
        CHECK(*std::min_element(found.remainder.pixels().begin(), found.remainder.pixels().end()) ==
              doctest::Approx(0.3f));
    }
}

TEST_CASE("extract_lights: two suns of different colour are two lights, the stronger first") {
    ImageF image = constant(256, {0.1f, 0.2f, 0.3f});
    const Vec3d red = at_angles(100, 20), blue = at_angles(104, 21);
    add_disc(image, red, 0.8, {5000, 500, 100});
    add_disc(image, blue, 0.8, {100, 400, 6000});
    const LightExtraction found = extract(image);
    check_sound(image, found);
    REQUIRE(found.lights.size() == 2);
    CHECK(angle_deg(found.lights[0].direction, red) < 0.05);
    CHECK(angle_deg(found.lights[1].direction, blue) < 0.05);
    CHECK(found.lights[0].colour.x == 1);
    CHECK(found.lights[1].colour.z == 1);
    CHECK(close(found.lights[0].colour.z, 0.02, 0.02));
    LightExtractionOptions one;
    one.max_lights = 1;
    const LightExtraction strongest = extract(image, one);
    check_sound(image, strongest);
    REQUIRE(strongest.lights.size() == 1);
    CHECK(strongest.report.left_out == 1);
    CHECK(angle_deg(strongest.lights[0].direction, red) < 0.05);
    LightExtractionOptions together;
    together.merge_deg = 5;
    together.largest_diameter_deg = 12;
    CHECK(extract(image, together).lights.size() == 1);
}

TEST_CASE("extract_lights: a sun on the seam and at the poles") {
    for (const Vec3d& towards : {at_angles(180, 10), at_angles(-179.7, -30), Vec3d{0, 1, 0}, Vec3d{0, -1, 0},
                                 at_angles(45, 89.5), at_angles(-120, -89)}) {
        CAPTURE(towards.y);
        ImageF image = constant(256, {0.3f, 0.3f, 0.3f});
        add_disc(image, towards, 2, {1000, 1000, 1000});
        const LightExtraction found = extract(image);
        check_sound(image, found);
        REQUIRE(found.lights.size() == 1);
        CHECK(angle_deg(found.lights[0].direction, towards) < 0.05);
        CHECK(close(found.lights[0].irradiance.y, 1000 * disc_solid_angle(2), 0.02));
        CAPTURE(found.lights[0].angular_diameter_deg);
        // A light three texels wide, centred on a pole: there the texels are rings, and the correction for their width
        // is least accurate.
        CHECK(close(found.lights[0].angular_diameter_deg, 2, std::abs(towards.y) == 1 ? 0.12 : 0.06));
        CHECK(*std::max_element(found.remainder.pixels().begin(), found.remainder.pixels().end()) <= 0.3f);
    }
}

TEST_CASE("extract_lights: one hot texel anywhere is a light below the resolution") {
    const int h = 64, w = 128;
    for (const auto& [x, y] : {std::pair{40, 20}, {0, 30}, {w - 1, 31}, {5, 0}, {77, h - 1}, {0, 0}, {64, 32}}) {
        CAPTURE(x);
        CAPTURE(y);
        ImageF image = constant(h, {1, 1, 1});
        for (int c = 0; c < 3; ++c) image.at(x, y)[c] = 1e6f;
        const LightExtraction found = extract(image);
        check_sound(image, found);
        REQUIRE(found.lights.size() == 1);
        const ExtractedLight& light = found.lights[0];
        CHECK(angle_deg(light.direction, latlong_direction({(x + 0.5) / w, (y + 0.5) / h})) < 1e-6);
        CHECK_FALSE(light.resolved);
        CHECK(light.angular_diameter_deg == doctest::Approx(180.0 / h));
        CHECK(close(light.irradiance.x, (1e6 - 1) * latlong_solid_angle(y, w, h), 1e-6));
        CHECK(light.texels == 1);
        CHECK(found.remainder.at(x, y)[1] == doctest::Approx(1));
    }
}

TEST_CASE("extract_lights: in front of black") {
    ImageF image(256, 128, 3);
    add_disc(image, at_angles(0, 0), 3, {10, 20, 30});
    const LightExtraction found = extract(image);
    check_sound(image, found);
    REQUIRE(found.lights.size() == 1);
    CHECK(found.lights[0].share == doctest::Approx(1));
    CHECK(std::isinf(found.lights[0].contrast));
    CHECK(*std::max_element(found.remainder.pixels().begin(), found.remainder.pixels().end()) == 0);
}

TEST_CASE("extract_lights: no light in constant, black, smooth, noisy or coarse environments, nor in a wide lamp") {
    std::vector<ImageF> images;
    images.push_back(constant(64, {2, 3, 4}));
    images.push_back(ImageF(128, 64, 3));
    ImageF smooth = constant(64, {1, 1, 1});
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 128; ++x)
            smooth.at(x, y)[1] =
                float(std::exp(3 * dot(latlong_direction({(x + 0.5) / 128, (y + 0.5) / 64}), at_angles(20, 20))));
    images.push_back(std::move(smooth));
    ImageF noise = constant(64, {1, 1, 1});
    std::mt19937 random(7);
    for (float& v : noise.pixels()) v = float(random() % 1000) / 1000;
    images.push_back(std::move(noise));
    ImageF lamp = constant(128, {0.1f, 0.1f, 0.1f});
    add_disc(lamp, at_angles(60, 10), 20, {50, 50, 50});
    images.push_back(std::move(lamp));
    ImageF coarse = constant(16, {1, 1, 1});
    coarse.at(3, 8)[0] = 1e6f;
    images.push_back(std::move(coarse));
    ImageF tiny(3, 2, 3);
    tiny.at(1, 1)[0] = 9;
    images.push_back(std::move(tiny));
    images.push_back(ImageF(1, 1, 3, 5.f));
    for (const ImageF& image : images) {
        const LightExtraction found = extract(image);
        CHECK(found.lights.empty());
        CHECK(std::equal(image.pixels().begin(), image.pixels().end(), found.remainder.pixels().begin()));
        CHECK(found.report.unaccounted < 1e-12);
    }
}

TEST_CASE("extract_lights: the fill stays within its surroundings and has no step at its rim") {
    // A sun before a gradient with a texture of 5 %.
    ImageF image = constant(256, {1, 1, 1});
    std::mt19937 random(3);
    for (int y = 0; y < 256; ++y)
        for (int x = 0; x < 512; ++x)
            for (int c = 0; c < 3; ++c) image.at(x, y)[c] = float(1 + x / 512.0 + (random() % 1000) / 20000.0);
    ImageF plain(512, 256, 3);
    std::copy(image.pixels().begin(), image.pixels().end(), plain.pixels().begin());
    add_disc(image, at_angles(-40, 5), 3, {3000, 2000, 1000});
    const LightExtraction found = extract(image);
    check_sound(image, found);
    REQUIRE(found.lights.size() == 1);
    float difference = 0;
    int filled = 0;
    for (int y = 0; y < 256; ++y)
        for (int x = 0; x < 512; ++x) {
            if (found.remainder.at(x, y)[0] == image.at(x, y)[0]) continue;
            ++filled;
            for (int c = 0; c < 3; ++c)
                difference = std::max(difference, std::abs(found.remainder.at(x, y)[c] - plain.at(x, y)[c]));
        }
    CHECK(filled > 10);
    CHECK(difference < 0.06f);  // the texture itself
}

TEST_CASE("extract_lights: the faint edge of a source goes with it, across a pole too") {
    ImageF image = constant(64, {1, 1, 1});
    for (int c = 0; c < 3; ++c) {
        image.at(30, 20)[c] = 1e5f;
        image.at(31, 20)[c] = 1.3f;  // like an edge that covers a small part of a texel
    }
    const LightExtraction edge = extract(image);
    REQUIRE(edge.lights.size() == 1);
    CHECK(edge.remainder.at(31, 20)[0] == doctest::Approx(1));
    CHECK(edge.lights[0].texels == 2);

    ImageF pole = constant(64, {1, 1, 1});
    for (const int x : {5, 5 + 64})
        for (int c = 0; c < 3; ++c) pole.at(x, 0)[c] = 1e5f;
    const LightExtraction one = extract(pole);
    REQUIRE(one.lights.size() == 1);
    CHECK(one.lights[0].direction.y == doctest::Approx(1).epsilon(1e-9));
}

TEST_CASE("extract_lights: a dark ring that an encoding left around a source goes too, and no channel gains power") {
    ImageF image = constant(128, {0.2f, 0.2f, 2});
    const Vec3d towards = at_angles(15, 25);
    for (int y = 0; y < 128; ++y)
        for (int x = 0; x < 256; ++x) {
            const double away = angle_deg(latlong_direction({(x + 0.5) / 256, (y + 0.5) / 128}), towards);
            float* p = image.at(x, y);
            if (away < 4.5) p[0] = p[1] = p[2] = 0;
            if (away < 2) p[0] = 900, p[1] = 100;  // red, without the blue of its surroundings
        }
    const LightExtraction found = extract(image);
    check_sound(image, found);
    REQUIRE(found.lights.size() == 1);
    for (int y = 0; y < 128; ++y)
        for (int x = 0; x < 256; ++x) REQUIRE(found.remainder.at(x, y)[0] == doctest::Approx(0.2));
    CHECK(found.lights[0].irradiance.z == 0);
}

TEST_CASE("extract_lights: a pane among panes is no light, the same pane alone is one") {
    const auto is_pane = [](int x, int y) { return x % 8 < 6 && y % 8 < 6; };  // 4 degrees wide, frames of 1.4
    ImageF many = constant(256, {0.1f, 0.1f, 0.1f}), alone = constant(256, {0.1f, 0.1f, 0.1f});
    for (int y = 96; y < 160; ++y)
        for (int x = 0; x < 512; ++x)
            for (int c = 0; c < 3; ++c) {
                if (is_pane(x, y)) many.at(x, y)[c] = 100;
                if (is_pane(x, y) && x / 8 == 28 && y / 8 == 16) alone.at(x, y)[c] = 100;
            }
    LightExtractionOptions any_share;
    any_share.least_share = 0;
    CHECK(extract(many, any_share).lights.size() == 0);
    CHECK(extract(alone).lights.size() == 1);
}

TEST_CASE("harmonic_fill: finds the harmonic function that its rim belongs to") {
    // tan(θ / 2) e^(i φ) is the stereographic map, whose real part solves Laplace's equation on the sphere away
    // from -Y.
    const int w = 256, h = 128;
    const TexelSphere sphere(w, h);
    ImageF truth(w, h, 3);
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x) {
            const double r = std::tan((y + 0.5) / h * k_pi / 2), phi = ((x + 0.5) / w - 0.5) * 2 * k_pi;
            truth.at(x, y)[0] = float(10 + r * std::cos(phi));
            truth.at(x, y)[1] = float(10 + r * r * std::sin(2 * phi));
            truth.at(x, y)[2] = float(10 - std::log(r + 1e-3));
        }
    for (const double elevation : {90.0, 80.0, 45.0, 0.0}) {
        CAPTURE(elevation);
        std::vector<std::int64_t> region;
        for (std::int64_t t = 0; t < sphere.size(); ++t)
            if (angle_deg(sphere.direction(t), at_angles(-179, elevation)) < 20) region.push_back(t);
        ImageF image = truth;
        for (const std::int64_t t : region)
            for (int c = 0; c < 3; ++c) image.at(sphere.column(t), sphere.row(t))[c] = 0;
        harmonic_fill(sphere, region, image.view());
        for (int c = 0; c < 3; ++c) {
            if (c == 2 && elevation > 60) continue;  // the singularity lies within
            double error = 0, least = 1e9, most = -1e9;
            for (const std::int64_t t : region) {
                const double value = truth.at(sphere.column(t), sphere.row(t))[c];
                error = std::max(error, std::abs(image.at(sphere.column(t), sphere.row(t))[c] - value));
                least = std::min(least, value);
                most = std::max(most, value);
            }
            CHECK(error < 0.015 * (most - least));  // of second order in the width of a texel, 1.4 degrees
        }
    }
}

TEST_CASE("extract_lights: lights and remainder light every surface as the original does") {
    SUBCASE("sky") {
        SkyOptions options;
        options.height = 256;
        const auto rows = make_sky(options);
        const auto image = read_latlong(*rows);
        REQUIRE(image);
        const LightExtraction found = extract(*image);
        REQUIRE(found.lights.size() == 1);
        CHECK(irradiance_error(*image, found) < 0.01);
    }
    SUBCASE("three lamps") {
        ImageF image = constant(128, {0.2f, 0.3f, 0.2f});
        add_disc(image, at_angles(10, 50), 3, {100, 300, 500});
        add_disc(image, at_angles(-178, -20), 4.5, {300, 100, 50});
        add_disc(image, at_angles(60, -70), 3, {200, 200, 200});
        const LightExtraction found = extract(image);
        CHECK(found.lights.size() == 3);
        CHECK(irradiance_error(image, found) < 0.01);
    }
}

TEST_CASE("extract_lights: directions are the world's, the remainder stays as the source") {
    ImageF image = constant(128, {1, 1, 1});
    const Vec3d towards = at_angles(20, 30);
    add_disc(image, towards, 3, {900, 900, 900});
    const LightExtraction plain = extract(image);
    // Light turned by +90 degrees about Y arrives from a direction 90 degrees further.
    const LightExtraction turned = extract(image, {}, rotation_y(k_pi / 2).transposed());
    REQUIRE((plain.lights.size() == 1 && turned.lights.size() == 1));
    CHECK(angle_deg(turned.lights[0].direction, at_angles(110, 30)) < 0.05);
    CHECK(turned.lights[0].u == plain.lights[0].u);
    CHECK(std::equal(plain.remainder.pixels().begin(), plain.remainder.pixels().end(),
                     turned.remainder.pixels().begin()));
}

TEST_CASE("extract_lights: the same bits on any number of threads") {
    const auto rows = make_sky({});
    const auto image = read_latlong(*rows);
    REQUIRE(image);
    LightExtractionOptions one, four;
    one.threads = 1;
    four.threads = 4;
    const LightExtraction a = extract(*image, one), b = extract(*image, four);
    REQUIRE(a.lights.size() == b.lights.size());
    CHECK(a.lights[0].irradiance == b.lights[0].irradiance);
    CHECK(a.lights[0].direction == b.lights[0].direction);
    CHECK(a.report.remainder_power == b.report.remainder_power);
    CHECK(std::equal(a.remainder.pixels().begin(), a.remainder.pixels().end(), b.remainder.pixels().begin()));
}

TEST_CASE("extract_lights: bad input is an error that names it") {
    ImageF image = constant(32, {1, 1, 1});
    CHECK_FALSE(extract_lights(ImageView<const float>{}));
    CHECK_FALSE(extract_lights(ImageF(4, 2, 1).view()));
    for (const float bad : {NAN, INFINITY, -1.f}) {
        image.at(5, 7)[2] = bad;
        const auto found = extract_lights(image.view());
        REQUIRE_FALSE(found);
        CHECK(found.error().what.find("(5, 7)") != std::string::npos);
    }
    image.at(5, 7)[2] = 1;
    LightExtractionOptions options;
    options.least_contrast = 1;
    const auto refused = extract_lights(image.view(), options);
    REQUIRE_FALSE(refused);
    CHECK(refused.error().where == "`least_contrast`");
    options = {};
    options.largest_diameter_deg = NAN;
    CHECK_FALSE(extract_lights(image.view(), options));
}

TEST_CASE("extract_lights: the suns of photographs") {
    struct Known {
        const char* file;
        double azimuth_deg, elevation_deg, least_share;
    };
    // Directions and diameters as the photographs show them; a sun is 0.53 degrees wide, a little more by the lens.
    for (const Known& k : {Known{"env_highres/spruit_sunrise_1k.hdr", 35.8, 8, 0.7},
                           Known{"env_latlong/kloppenheim_05_1k.hdr", 35.9, 74.5, 0.6},
                           Known{"env_latlong/noon_grass_1k.hdr", -71.1, 85.5, 0.5}}) {
        const auto folder = test::data_folder();
        if (!folder || !std::filesystem::exists(*folder / k.file)) {
            test::note_skip("DOMELIGHT_DATA has no photographs");
            return;
        }
        CAPTURE(k.file);
        auto environment = open_environment({*folder / k.file});
        REQUIRE(environment);
        const auto image = read_latlong(**environment->rows());
        REQUIRE(image);
        const LightExtraction found = extract(*image);
        check_sound(*image, found);
        REQUIRE(found.lights.size() == 1);
        CHECK(angle_deg(found.lights[0].direction, at_angles(k.azimuth_deg, k.elevation_deg)) < 0.15);
        CHECK(found.lights[0].angular_diameter_deg > 0.45);
        CHECK(found.lights[0].angular_diameter_deg < 0.65);
        CHECK(found.lights[0].share > k.least_share);
        CHECK(irradiance_error(*image, found) < 0.01);
    }
}

TEST_CASE("gltf_lights: a node's turn takes -Z to where the light travels") {
    const auto turned = [](const std::array<double, 4>& q, const Vec3d& v) {
        const Vec3d a{q[0], q[1], q[2]};
        return v + cross(a, cross(a, v) + v * q[3]) * 2.0;
    };
    for (const Vec3d& d :
         {Vec3d{0, 0, 1}, Vec3d{0, 0, -1}, Vec3d{0, 1, 0}, Vec3d{0, -1, 0}, Vec3d{1, 0, 0}, at_angles(33, -44),
          normalize(Vec3d{1e-7, 0, 1}), normalize(Vec3d{0, 1e-5, 1}), at_angles(-170, 5)}) {
        const auto q = turn_from_minus_z(d);
        CHECK(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3] == doctest::Approx(1).epsilon(1e-12));
        CHECK(length(turned(q, {0, 0, -1}) - d) < 2e-6);
    }
}

TEST_CASE("gltf_lights: colour times intensity is the irradiance in lux, and no light makes a valid document") {
    ImageF image = constant(64, {1, 1, 1});
    add_disc(image, at_angles(70, 40), 4, {800, 400, 200});
    const LightExtraction found = extract(image);
    REQUIRE(found.lights.size() == 1);
    const auto json = nlohmann::json::parse(gltf_lights(found.lights, 179, 30, "test"));
    CHECK(json["asset"]["version"] == "2.0");
    CHECK(json["asset"]["extras"]["lux_per_unit"] == 179);
    CHECK(json["asset"]["extras"]["rotate_y_deg"] == 30);
    CHECK(json["extensionsUsed"][0] == "KHR_lights_punctual");
    const auto& light = json["extensions"]["KHR_lights_punctual"]["lights"][0];
    CHECK(light["type"] == "directional");
    CHECK(light["extras"]["lux_per_unit"] == 179);
    const Vec3d& e = found.lights[0].irradiance;
    CHECK(light["intensity"].get<double>() * light["color"][0].get<double>() == doctest::Approx(179 * e.x));
    CHECK(light["intensity"].get<double>() * light["color"][2].get<double>() == doctest::Approx(179 * e.z));
    const auto& node = json["nodes"][json["scenes"][0]["nodes"][0].get<int>()];
    CHECK(node["extensions"]["KHR_lights_punctual"]["light"] == 0);
    const auto q = node["rotation"].get<std::array<double, 4>>();
    CHECK(q == turn_from_minus_z(-found.lights[0].direction));

    const auto empty = nlohmann::json::parse(gltf_lights({}, 1, 0, "test"));
    CHECK_FALSE(empty.contains("nodes"));
    CHECK_FALSE(empty.contains("extensionsUsed"));
    CHECK(empty["scenes"].size() == 1);
}

TEST_CASE(
    "lights_sheet: circles the light on the left picture, none on the right; the same bytes on any number of threads") {
    ImageF image = constant(64, {1, 1, 1});
    add_disc(image, at_angles(70, 40), 4, {800, 400, 200});
    const LightExtraction found = extract(image);
    LightsSheetInput input{"sun ☉.hdr", image.view(), found.remainder.view(), {}, found.lights, 800, 1};
    const auto sheet = lights_sheet(input);
    input.threads = 3;
    const auto again = lights_sheet(input);
    CHECK(std::equal(sheet.pixels().begin(), sheet.pixels().end(), again.pixels().begin()));
    int marked[2] = {0, 0};
    for (int y = 76; y < 76 + 180; ++y)  // the pictures, without title and list
        for (int x = 0; x < 800; ++x) {
            const std::uint8_t* p = sheet.at(x, y);
            marked[x >= 400] += p[0] > 200 && p[1] < 130 && p[2] < 100;
        }
    CHECK(marked[0] > 30);
    CHECK(marked[1] == 0);
}

TEST_SUITE_END();
