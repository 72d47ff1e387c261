#include "domelight/environment/sky/sky.h"
#include "domelight/preview/preview.h"
#include "domelight/projection/projection.h"

#include "preview/preview_map.h"
#include "preview/tonemap.h"
#include "test.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

using namespace domelight;

namespace {

FilteredMap cube_of(const ImageF& latlong, int size) {
    FilteredMap map = Cubemap(size);
    for (int f = 0; f < 6; ++f)
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x) {
                const UV uv = latlong_uv(cube_direction(f, {(x + 0.5) / size, (y + 0.5) / size}));
                std::copy_n(latlong.at(std::min(int(uv.u * latlong.width()), latlong.width() - 1),
                                       std::min(int(uv.v * latlong.height()), latlong.height() - 1)),
                            3, map.face(f).at(x, y));
            }
    return map;
}

std::array<int, 3> pixel(const Image<std::uint8_t>& image, double x, double y) {
    const std::uint8_t* p = image.at(int(x), int(y));
    return {p[0], p[1], p[2]};
}

void check_near(const std::array<int, 3>& got, const Vec3f& radiance) {
    const Vec3f shown = tonemap(radiance, Tonemap::agx_punchy);
    const int expected[] = {to_byte(srgb_encode(shown.x)), to_byte(srgb_encode(shown.y)),
                            to_byte(srgb_encode(shown.z))};
    for (int c = 0; c < 3; ++c) CHECK(std::abs(got[c] - expected[c]) <= 4);
}

}  // namespace

TEST_CASE(
    "contact_sheet: a chrome ball seen along -Z shows +Z at its middle, +X right, +Y above, and the environment's own "
    "way round") {
    const ImageF axes = make_axes_environment(256);
    const FilteredMap level = cube_of(axes, 128);
    PreviewInput input;
    input.specular = {{&level, 0, 0, ""}};
    input.exposure_ev = 0;
    input.width = 800;
    input.threads = 1;
    const Image<std::uint8_t> sheet = contact_sheet(input);
    // The layout of an 800 px sheet: environment 424 x 212 at (32, 100), one ball of 300 px at (32, 386), its cross of
    // 75 px faces below.
    const auto ball = [&](const Vec3d& direction) {
        const Vec3d d = normalize(direction), n = normalize(d + Vec3d(0, 0, 1));
        return pixel(sheet, 32 + 150 + 149.5 * n.x, 386 + 150 - 149.5 * n.y);
    };
    // A place on each disc that no letter covers: below the name, as seen from inside; on the discs overhead and
    // underfoot it is shifted in the same way.
    const Vec3f red{0.80f, 0.06f, 0.05f}, cyan{0.05f, 0.55f, 0.60f}, green{0.10f, 0.60f, 0.08f},
        magenta{0.50f, 0.08f, 0.45f}, blue{0.07f, 0.16f, 0.85f};
    check_near(ball({1, -0.4, 0}), red);
    check_near(ball({-1, -0.4, 0}), cyan);
    check_near(ball({0.4, 1, 0}), green);
    check_near(ball({-0.4, -1, 0}), magenta);
    check_near(ball({0, -0.4, 1}), blue);
    // Lat-long: +X at the centre, +Z a quarter to the right.
    check_near(pixel(sheet, 32 + 212, 100 + 106 + 424 * 22 / 360), red);
    check_near(pixel(sheet, 32 + 318, 100 + 106 + 424 * 22 / 360), blue);
    // Cross: -X +Z +X -Z in the middle row, +Y above +Z; 0.4 on the face's plane below the middle.
    const double top = 386 + 310;
    check_near(pixel(sheet, 32 + 75 * 0.5, top + 75 * 1.7), cyan);
    check_near(pixel(sheet, 32 + 75 * 1.5, top + 75 * 1.7), blue);
    check_near(pixel(sheet, 32 + 75 * 2.5, top + 75 * 1.7), red);
    check_near(pixel(sheet, 32 + 75 * 1.7, top + 75 * 0.5), green);
}

TEST_CASE("contact_sheet: the same bytes on any number of threads, with everything on it") {
    SkyOptions options;
    options.height = 64;
    auto source = make_sky(options);
    ImageF sky(128, 64, 3);
    REQUIRE(bool(source->read(sky.view())));
    std::vector<FilteredMap> maps;
    for (int size : {64, 32, 16, 8, 4, 2, 1}) maps.push_back(cube_of(sky, size));
    const FilteredMap latlong(Layout::latlong, sky);
    std::vector<Vec3d> sh(9, Vec3d(1, 2, 3));
    ImageF brdf(16, 16, 2, 0.4f);
    PreviewInput input;
    input.title = "sky_with_a_very_long_name_that_does_not_fit_on_the_sheet_at_all_and_must_be_shortened_somewhere.hdr";
    input.subtitle = "128 × 64 · GGX";
    input.environment = sky.view();
    for (const auto& m : maps) input.specular.push_back({&m, 0.5, 0.25, ""});
    input.specular.push_back({&latlong, 0, 0, "exponent 64"});
    input.irradiance_over_pi = &maps[3];
    input.sh = sh;
    input.brdf = brdf.view();
    input.width = 900;
    input.threads = 1;
    const auto one = contact_sheet(input);
    input.threads = 3;
    input.world_to_source = rotation_y(0);
    const auto three = contact_sheet(input);
    REQUIRE(one.height() == three.height());
    CHECK(std::equal(one.pixels().begin(), one.pixels().end(), three.pixels().begin()));
}

TEST_CASE("contact_sheet: world_to_source turns the environment's picture") {
    const ImageF axes = make_axes_environment(256);
    PreviewInput input;
    input.environment = axes.view();
    input.exposure_ev = 0;
    input.width = 800;
    input.world_to_source = rotation_y(k_pi / 2);  // what stands at +X in the world is the source's +Z
    const auto sheet = contact_sheet(input);
    check_near(pixel(sheet, 32 + 212, 100 + 106 + 424 * 22 / 360), {0.07f, 0.16f, 0.85f});
}

TEST_CASE("contact_sheet: nothing, black and one-texel inputs still give a sheet") {
    CHECK(contact_sheet({}).width() == 1600);
    const ImageF black(4, 2, 3);
    FilteredMap tiny = Cubemap(1);
    const std::vector<Vec3d> sh(1);
    const ImageF brdf(1, 1, 2);
    PreviewInput input;
    input.environment = black.view();
    input.specular = {{&tiny, 1, 1, ""}};
    input.irradiance_over_pi = &tiny;
    input.sh = sh;
    input.brdf = brdf.view();
    input.width = 10;
    CHECK(contact_sheet(input).width() == 800);
}

TEST_CASE("PreviewMap: a constant stays constant across edges, and a direction finds its texel") {
    FilteredMap map = Cubemap(5, 3);
    std::fill(map.pixels().begin(), map.pixels().end(), 2.5f);
    const PreviewMap constant(map, 4);
    for (const Vec3f& d : {Vec3f{1, 1, 1}, Vec3f{1, 1, 0}, Vec3f{-1, 0.999f, -1}, Vec3f{0, 0, 1}})
        CHECK(constant.sample(d).y == doctest::Approx(2.5));
    const ImageF axes = make_axes_environment(64);
    const PreviewMap latlong(axes.view(), 64);
    const Vec3d d = latlong_direction({10.5 / 128, 20.5 / 64});
    CHECK(latlong.sample(Vec3f(d)).x == doctest::Approx(axes.at(10, 20)[0]).epsilon(1e-3));
}

TEST_CASE("contact_sheet: sheen levels have a row of their own below the others") {
    const ImageF axes = make_axes_environment(256);
    const FilteredMap level = cube_of(axes, 128);
    PreviewInput input;
    input.specular = {{&level, 0, 0}};
    input.exposure_ev = 0;
    input.width = 800;
    const int without = contact_sheet(input).height();
    input.sheen = {{&level, 1, 1}};
    const Image<std::uint8_t> sheet = contact_sheet(input);
    const int row = 300 + 10 + 225 + 3 * 20 + 8 + 24;  // ball, cross, three lines
    CHECK(sheet.height() == without + row);
    const Vec3d n = normalize(Vec3d{1, -0.4, 0} * (1 / std::sqrt(1.16)) + Vec3d{0, 0, 1});
    check_near(pixel(sheet, 32 + 150 + 149.5 * n.x, 386 + row + 150 - 149.5 * n.y), {0.80f, 0.06f, 0.05f});
}

TEST_CASE("contact_sheet: the BRDF table shows as many channels as it is said to hold") {
    const ImageF brdf(16, 16, 3, 0.4f);
    PreviewInput input;
    input.brdf = brdf.view();
    input.width = 800;
    const int code = to_byte(srgb_encode(0.4f));
    CHECK(pixel(contact_sheet(input), 32 + 150, 386 + 150) == std::array{code, code, 0});
    input.brdf_channels = 3;
    CHECK(pixel(contact_sheet(input), 32 + 150, 386 + 150) == std::array{code, code, code});
}
