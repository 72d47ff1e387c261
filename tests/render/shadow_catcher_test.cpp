#include "domelight/base/parallel.h"
#include "domelight/environment/sky/sky.h"
#include "domelight/image/row_source.h"
#include "domelight/render/shading/shading.h"

#include "render/shapes.h"
#include "test.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <memory>

using namespace domelight;
using namespace domelight::test;

namespace {

constexpr float k_high = 2.5f;  ///< of the ball's middle above the ground

struct World {
    std::unique_ptr<ImageF> environment;  ///< which the sampler reads
    RayScene scene;
    EnvironmentSampler sampler;
    RenderOptions options;
};

/// A black ball over the ground y = 0, from a camera that looks down past it.
World ball_above(ImageF image, std::vector<PunctualLight> lights = {}, float opacity = 1) {
    Scene scene;
    Material black = lambert_material(0);
    black.opacity = opacity;
    if (opacity < 1) black.alpha_mode = Material::AlphaMode::blend;
    add(scene, sphere_mesh(48), black, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, k_high, 0}});
    scene.lights = std::move(lights);
    auto traced = RayScene::build(std::move(scene));
    REQUIRE(traced);
    auto environment = std::make_unique<ImageF>(std::move(image));
    auto sampler = EnvironmentSampler::build(*environment, reference_sampler_options());
    REQUIRE(sampler);
    RenderOptions o;
    o.width = 96, o.height = 64;
    o.samples = 64;
    o.camera = look_at({0, 6, 9}, {0, 0.5f, 0}, 0.9f);
    o.background = Background::transparent;
    return {std::move(environment), std::move(*traced), std::move(*sampler), o};
}

RenderResult caught(const World& w, Background background) {
    auto picture = render_reference(w.scene, w.sampler, w.options);
    REQUIRE(picture);
    RenderOptions o = w.options;
    o.background = background;
    o.background_colour = {0.5f, 0.25f, 2};
    REQUIRE(catch_shadow(*picture, w.scene, w.sampler, {0, o.samples}, o));
    return std::move(*picture);
}

/// Where the middle of a pixel looks on the ground y = 0; nothing above the horizon.
std::optional<Vec3f> ground_at(const RenderOptions& o, int x, int y) {
    const float half = std::tan(0.5f * o.camera.fov_y), aspect = float(o.width) / float(o.height);
    const Affine& m = o.camera.to_world;
    const Vec3f d = m.vector({(2 * (float(x) + 0.5f) / float(o.width) - 1) * half * aspect,
                              (1 - 2 * (float(y) + 0.5f) / float(o.height)) * half, -1});
    if (d.y >= -0.05f) return std::nullopt;
    return m.translation - d * (m.translation.y / d.y);
}

/// Looks at the ground beside the ball, where its shadow is deepest.
void look_close(World& w, int size, int samples) {
    w.options.width = w.options.height = size;
    w.options.samples = samples;
    w.options.camera = look_at({0, 3, 7}, {0, 0, 1.2f}, 0.2f);
}

ImageF constant(float value) {
    return ImageF(16, 8, 3, value);
}

}  // namespace

TEST_CASE("catch_shadow: under a constant sky a ball takes its form factor from the ground") {
    World w = ball_above(constant(0.7f));
    look_close(w, 32, 256);
    const RenderResult r = caught(w, Background::transparent);
    double caught_sum = 0, exact_sum = 0;
    int n = 0;
    for (int y = 0; y < w.options.height; ++y)
        for (int x = 0; x < w.options.width; ++x) {
            const auto p = ground_at(w.options, x, y);
            // The ball itself hides the ground here.
            if (!p || *r.depth.at(x, y) < 1e9f) continue;
            // The form factor of a sphere entirely above the horizon: R² cos θ / d² (Howell's catalogue, B-43).
            const float d = length(Vec3f{0, k_high, 0} - *p), factor = k_high / (d * d * d);
            const double difference = *r.opacity.at(x, y) - factor;
            CHECK(std::abs(difference) < 0.06);  // 256 samples
            caught_sum += *r.opacity.at(x, y), exact_sum += factor, ++n;
            for (int c = 0; c < 3; ++c) CHECK(r.radiance.at(x, y)[c] == 0);
        }
    REQUIRE(n > 1000);
    CHECK(caught_sum / exact_sum == doctest::Approx(1).epsilon(0.008));
}

TEST_CASE("catch_shadow: under a sky the ground darkens as a white Lambert floor does") {
    SkyOptions sky;
    sky.height = 32;
    sky.sun_elevation_deg = 50;
    const auto rows = make_sky(sky);
    auto image = read_latlong(*rows);
    REQUIRE(image);
    World w = ball_above(*image);
    look_close(w, 32, 256);
    const RenderResult r = caught(w, Background::colour);
    const auto floor = [&](bool ball) {
        Scene scene;
        add(scene, floor_mesh(200, 0), lambert_material(1));
        if (ball) add(scene, sphere_mesh(48), lambert_material(0), {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, k_high, 0}});
        const auto traced = RayScene::build(std::move(scene));
        REQUIRE(traced);
        RenderOptions o = w.options;
        o.bounces = 0;
        o.seed = 1;
        auto picture = render_reference(*traced, w.sampler, o);
        REQUIRE(picture);
        return std::move(*picture);
    };
    const RenderResult with = floor(true), without = floor(false);
    double caught_sum[3] = {}, floor_sum[3] = {};
    int n = 0;
    for (int y = 0; y < w.options.height; ++y)
        for (int x = 0; x < w.options.width; ++x) {
            if (!ground_at(w.options, x, y) || *r.depth.at(x, y) < 1e9f) continue;
            const float colour[] = {0.5f, 0.25f, 2};
            for (int c = 0; c < 3; ++c) {
                caught_sum[c] += 1 - r.radiance.at(x, y)[c] / colour[c];
                floor_sum[c] += 1 - with.radiance.at(x, y)[c] / without.radiance.at(x, y)[c];
            }
            ++n;
        }
    REQUIRE(n > 900);
    // The share of the light that is taken away.
    for (int c = 0; c < 3; ++c) CHECK(caught_sum[c] / floor_sum[c] == doctest::Approx(1).epsilon(0.012));
}

TEST_CASE("catch_shadow: with few samples the shadow is noisy, but not too light") {
    SkyOptions sky;
    sky.height = 32;
    const auto rows = make_sky(sky);
    const auto image = read_latlong(*rows);
    REQUIRE(image);
    World w = ball_above(*image);
    const auto mean = [&](int size, int samples) {
        look_close(w, size, samples);
        const RenderResult r = caught(w, Background::transparent);
        double sum = 0;
        for (const float o : r.opacity.pixels()) sum += o;
        return sum / double(r.opacity.pixels().size());
    };
    const double many = mean(32, 256);
    CHECK(mean(128, 4) == doctest::Approx(many).epsilon(0.02));
}

TEST_CASE("catch_shadow: a lamp's shadow is where the ball stands before it, and nowhere else") {
    PunctualLight sun;
    sun.direction = normalize(Vec3f{1, -2, 0});
    sun.intensity = {3, 3, 3};
    const World w = ball_above(constant(0), {sun});
    const RenderResult r = caught(w, Background::colour);
    int dark = 0;
    for (int y = 0; y < w.options.height; ++y)
        for (int x = 0; x < w.options.width; ++x) {
            const auto p = ground_at(w.options, x, y);
            if (!p || *r.opacity.at(x, y) > 0) continue;
            // Distance of the ball's middle from the line to the sun.
            const float off = length(cross(Vec3f{0, k_high, 0} - *p, -sun.direction));
            const float* c = r.radiance.at(x, y);
            if (off < 0.6f) {
                CHECK(c[2] == 0);
                ++dark;
            }
            if (off > 1.6f) {
                CHECK(c[0] == 0.5f);
                CHECK(c[1] == 0.25f);
                CHECK(c[2] == 2);
            }
        }
    CHECK(dark > 10);
}

TEST_CASE("catch_shadow: samples whose light is not finite are counted, and leave no trace in the picture") {
    PunctualLight sun;
    sun.direction = {0, -1, 0};
    sun.intensity = {1, 1, 1};
    const auto lost = [](const World& w, Background background) {
        auto picture = render_reference(w.scene, w.sampler, w.options);
        REQUIRE(picture);
        const std::int64_t before = picture->non_finite_samples;
        RenderOptions o = w.options;
        o.background = background;
        REQUIRE(catch_shadow(*picture, w.scene, w.sampler, {0, o.samples}, o));
        for (const float v : picture->radiance.pixels()) CHECK(std::isfinite(v));
        for (const float v : picture->opacity.pixels()) CHECK(std::isfinite(v));
        return picture->non_finite_samples - before;
    };
    constexpr int k_size = 8, k_samples = 4;
    for (const float wrong : {std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()})
        for (const Background background : {Background::transparent, Background::environment}) {
            PunctualLight glare = sun;
            glare.intensity = {1, wrong, 1};
            World w = ball_above(constant(1), {sun, glare});
            look_close(w, k_size, k_samples);
            // The camera sees nothing but the ground: every sample meets both lamps.
            CHECK(lost(w, background) == k_size * k_size * k_samples);
        }
    World fine = ball_above(constant(1), {sun});
    look_close(fine, k_size, k_samples);
    CHECK(lost(fine, Background::environment) == 0);
}

TEST_CASE("catch_shadow: half a ball's opacity is half its shadow; ground without shadow stays as it was") {
    PunctualLight sun;
    sun.direction = {0, -1, 0};
    sun.intensity = {1, 1, 1};
    const World w = ball_above(constant(0), {sun}, 0.5f);
    const RenderResult r = caught(w, Background::transparent);
    int inside = 0;
    for (int y = 0; y < w.options.height; ++y)
        for (int x = 0; x < w.options.width; ++x) {
            const auto p = ground_at(w.options, x, y);
            if (!p || *r.depth.at(x, y) < 1e9f) continue;
            const float off = std::hypot(p->x, p->z);
            // The light passes through both sides of the ball, so a quarter remains.
            if (off < 0.6f) {
                CHECK(*r.opacity.at(x, y) == doctest::Approx(0.75).epsilon(1e-4));
                ++inside;
            }
            if (off > 1.6f) CHECK(*r.opacity.at(x, y) == 0);
        }
    CHECK(inside > 5);
}

TEST_CASE("catch_shadow: over the environment it only darkens, and is the same on any number of threads") {
    SkyOptions sky;
    sky.height = 32;
    const auto rows = make_sky(sky);
    const auto image = read_latlong(*rows);
    REQUIRE(image);
    World w = ball_above(*image);
    w.options.samples = 8;
    const RenderResult one = caught(w, Background::environment);
    RenderOptions plain = w.options;
    plain.background = Background::environment;
    const auto whole = render_reference(w.scene, w.sampler, plain);
    REQUIRE(whole);
    int darker = 0;
    for (std::size_t i = 0; i < one.radiance.pixels().size(); ++i) {
        const float a = one.radiance.pixels()[i], b = whole->radiance.pixels()[i];
        CHECK(a <= b * 1.00001f);
        darker += a < 0.5f * b;
    }
    CHECK(darker > 20);
    for (const int threads : {1, 3}) {
        w.options.threads = threads;
        const RenderResult again = caught(w, Background::environment);
        CHECK(std::memcmp(again.radiance.pixels().data(), one.radiance.pixels().data(),
                          one.radiance.pixels().size_bytes()) == 0);
    }
}

TEST_CASE("background: a colour, the blurred environment, and an error where its maps are missing") {
    SkyOptions sky;
    sky.height = 32;
    const auto rows = make_sky(sky);
    const auto image = read_latlong(*rows);
    REQUIRE(image);
    World w = ball_above(*image);
    w.options.samples = 2;
    RenderOptions& o = w.options;
    o.background = Background::colour;
    o.background_colour = {1, 0.5f, 0.25f};
    auto maps = LightMaps::bake(*image, {});
    REQUIRE(maps);
    const auto both = [&](const auto& check) {
        for (const bool shaded : {false, true}) {
            INFO(shaded);
            const auto r =
                shaded ? render_shaded(w.scene, *maps, w.sampler, {}, o) : render_reference(w.scene, w.sampler, o);
            REQUIRE(r);
            check(*r);
        }
    };
    both([](const RenderResult& r) {
        CHECK(r.radiance.at(0, 0)[0] == 1);
        CHECK(r.radiance.at(0, 0)[2] == 0.25f);
        CHECK(*r.opacity.at(0, 0) == 0);
    });
    o.background = Background::blurred;
    CHECK(!render_reference(w.scene, w.sampler, o));
    CHECK(!render_shaded(w.scene, *maps, w.sampler, {}, o));
    o.background_maps = &*maps;
    o.background_roughness = 1;
    both([&](const RenderResult& r) {
        const auto p = ground_at(o, 0, 63);
        REQUIRE(p);
        const Vec3f there = maps->specular(normalize(*p - o.camera.to_world.translation), 1);
        CHECK(r.radiance.at(0, 63)[1] == doctest::Approx(there.y).epsilon(0.02));  // a pixel is a few degrees wide
    });
}

TEST_CASE("render_reference: pictures on the way leave the final one as it is; cancelled, the last of them is told") {
    SkyOptions sky;
    sky.height = 32;
    const auto rows = make_sky(sky);
    const auto image = read_latlong(*rows);
    REQUIRE(image);
    World w = ball_above(*image);
    w.options.samples = 40;
    const auto plain = render_reference(w.scene, w.sampler, w.options);
    REQUIRE(plain);
    std::vector<float> counts;
    w.options.checkpoint = [&](const RenderResult& r) { counts.push_back(*r.samples.at(20, 20)); };
    double noise = 1, samples = 0;
    w.options.status = [&](const RenderStatus& s) { noise = s.noise, samples = s.samples; };
    w.options.progress = [](std::string_view, double) { return true; };
    const auto watched = render_reference(w.scene, w.sampler, w.options);
    REQUIRE(watched);
    CHECK(std::memcmp(plain->radiance.pixels().data(), watched->radiance.pixels().data(),
                      plain->radiance.pixels().size_bytes()) == 0);
    CHECK(counts == std::vector<float>{8, 16, 24, 32});
    CHECK(samples == 40);
    CHECK(noise == doctest::Approx(watched->noise).epsilon(1e-6));

    counts.clear();
    w.options.progress = [&](std::string_view, double done) { return done < 0.45; };
    const auto stopped = render_reference(w.scene, w.sampler, w.options);
    REQUIRE(!stopped);
    CHECK(stopped.error().what == "cancelled");
    REQUIRE(counts.size() == 3);
    CHECK(counts.back() >= 16);
    CHECK(counts.back() <= 24);
}
