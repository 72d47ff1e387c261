// Environment: rows, texels and directions of the same light can be read again and again, however it is stored.

#include "domelight/environment/environment.h"

#include "domelight/filtering/prefilter.h"
#include "domelight/io/environment/convert.h"
#include "domelight/io/environment/open_environment.h"
#include "domelight/io/write_image.h"
#include "domelight/projection/projection.h"
#include "domelight/sampling/environment_sampler.h"

#include "oriented.h"
#include "test.h"

#include <cmath>
#include <thread>
#include <vector>

using namespace domelight;

namespace {

constexpr int k_height = 64;

/// The largest error, over all directions, of the direction that a lookup returns.
double worst_lookup(const Environment& environment) {
    double worst = 0;
    for (int i = 0; i < 500; ++i) {
        const double y = (i + 0.5) / 250 - 1, phi = 2.4 * i, r = std::sqrt(1 - y * y);
        const Vec3d d{r * std::cos(phi), y, r * std::sin(phi)};
        const auto light = environment.radiance(d);
        REQUIRE(light);
        worst = std::max(worst, length(Vec3d(*light) - Vec3d{2, 2, 2} - d));
    }
    return worst;
}

/// The same by the rows, and by the sampler, both through world_to_source.
double worst_row(const Environment& environment) {
    const auto image = read_latlong(**environment.rows());
    REQUIRE(image);
    double worst = 0;
    for (int y = 0; y < image->height(); ++y)
        for (int x = 0; x < image->width(); ++x) {
            const Vec3d source = latlong_direction({(x + 0.5) / image->width(), (y + 0.5) / image->height()});
            const Vec3d world = environment.world_to_source.transposed() * source;
            worst = std::max(worst, length(test::direction_of(image->at(x, y)) - world));
        }
    return worst;
}

Environment turned_cube() {
    // A cube that is turned by a third of a turn: its texels hold world directions.
    const Mat3 world_to_source = rotation_y(2 * k_pi / 3);
    Cubemap cube(32);
    for (int f = 0; f < 6; ++f)
        for (int y = 0; y < cube.size(); ++y)
            for (int x = 0; x < cube.size(); ++x) {
                const Vec3d source = normalize(cube_direction(f, {(x + 0.5) / 32, (y + 0.5) / 32}));
                const Vec3d d = world_to_source.transposed() * source;
                float* p = cube.face(f).at(x, y);
                p[0] = float(2 + d.x), p[1] = float(2 + d.y), p[2] = float(2 + d.z);
            }
    return Environment::from_cube(std::move(cube), world_to_source);
}

Environment turned_picture() {
    const ProjectedImage latlong{*projection_from_name("latlong"), test::direction_image(k_height)};
    const Mat3 turn = rotation_y(0.5);
    // Written in the picture's own frame, the world is turned.
    return Environment::from_picture(reproject({latlong.projection.turned(turn.transposed()), latlong.pixels},
                                               *projection_from_name("octahedral"), 128, 128),
                                     turn);
}

/// Everything that must be the same for a second reader as for the first.
void check_readable_again(const Environment& environment, double tolerance) {
    CHECK(environment.latlong_width() == 2 * environment.latlong_height());
    for (int reading = 0; reading < 2; ++reading) {
        CHECK(worst_row(environment) < tolerance);
        CHECK(worst_lookup(environment) < tolerance);
        FilterOptions options;
        options.irradiance_size = 4;
        const auto filtered = prefilter(environment, options);
        REQUIRE(filtered);
        // The harmonics of 2 + (x, y, z): a_00 = 2 √(4π), and √(4π / 3) of each axis.
        CHECK(filtered->sh[0].x == doctest::Approx(2 * std::sqrt(4 * k_pi)).epsilon(0.002));
        CHECK(std::abs(filtered->sh[3].x) == doctest::Approx(std::sqrt(4 * k_pi / 3)).epsilon(0.01));
        CHECK(std::abs(filtered->sh[3].y) < 0.02);
        const auto sampler = EnvironmentSampler::build(environment);
        REQUIRE(sampler);
        CHECK(length(Vec3d(sampler->radiance({0, 0.6f, 0.8f})) - Vec3d{2, 2.6, 2.8}) < tolerance);
    }
}

}  // namespace

TEST_CASE("environment: rows, texels and directions agree, of every storage, again and again") {
    SUBCASE("a lat-long image in memory") {
        check_readable_again(Environment::from_latlong(test::direction_image(k_height)), 0.08);
    }
    SUBCASE("a cube") {
        check_readable_again(turned_cube(), 0.08);
    }
    SUBCASE("another projection") {
        check_readable_again(turned_picture(), 0.08);
    }
    SUBCASE("files: a convention of their own") {
        const test::TemporaryFolder folder;
        const auto file = folder / "d.exr";
        REQUIRE(write_exr(file, test::direction_image(k_height), {.half = false}));
        const auto environment = open_environment({file});
        REQUIRE(environment);
        CHECK(environment->storage() == Environment::Storage::rows);
        check_readable_again(*environment, 0.08);
    }
}

TEST_CASE("environment: OpenEXR's own lat-long convention is not turned by a quarter and a half") {
    const test::TemporaryFolder folder;
    const ProjectedImage latlong{*projection_from_name("latlong"), test::direction_image(k_height)};
    const auto environment = Environment::from_latlong(test::direction_image(k_height));
    const auto openexr = *projection_from_name("latlong/openexr");
    ConvertOptions size;
    size.width = 2 * k_height;
    size.height = k_height;
    const auto made = convert(environment, openexr, size);
    REQUIRE(made);
    const auto file = folder / "o.exr";
    REQUIRE(write_exr(file, made->image.pixels, {.half = false}));
    const auto opened = open_environment({file}, {.latlong = "openexr"});
    REQUIRE(opened);
    check_readable_again(*opened, 0.15);
}

TEST_CASE("environment: readers at the same time find the same rows and one report") {
    const test::TemporaryFolder folder;
    ImageF image = test::direction_image(k_height);
    image.at(5, 7)[1] = -3;
    image.at(9, 40)[0] = std::nanf("");
    const auto file = folder / "bad.exr";
    REQUIRE(write_exr(file, image, {.half = false}));
    const auto environment = open_environment({file});
    REQUIRE(environment);
    CHECK(environment->report().repaired() == 0);
    std::vector<ImageF> read(4);
    {
        std::vector<std::jthread> readers;
        for (ImageF& into : read) readers.emplace_back([&] { into = *read_latlong(**environment->rows()); });
    }
    for (const ImageF& one : read)
        CHECK(std::equal(one.pixels().begin(), one.pixels().end(), read[0].pixels().begin(), read[0].pixels().end()));
    CHECK(environment->report().negative == 1);
    CHECK(environment->report().not_a_number == 1);
}

TEST_CASE("environment: without light it says so") {
    const Environment none;
    CHECK(none.rows().error().what == "the environment holds no light");
    CHECK_FALSE(none.latlong());
    CHECK_FALSE(none.radiance({0, 1, 0}));
    CHECK_FALSE(prefilter(none, {}));
    CHECK_FALSE(EnvironmentSampler::build(none));
}
