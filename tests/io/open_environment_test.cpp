#include "domelight/io/environment/open_environment.h"

#include "domelight/environment/environment.h"
#include "domelight/image/row_source.h"
#include "domelight/projection/projection.h"

#include "io/file/printable.h"
#include "io/reader_samples.h"
#include "test.h"

#include <ImfChannelList.h>
#include <ImfEnvmap.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>

#include <algorithm>
#include <cmath>

using namespace domelight;
using namespace domelight::test;

namespace {

void write_exr(const std::filesystem::path& file, ImageF image, std::optional<Imf::Envmap> envmap = std::nullopt) {
    Imf::Header header(image.width(), image.height());
    if (envmap) Imf::addEnvmap(header, *envmap);
    Imf::FrameBuffer buffer;
    for (int c = 0; c < 3; ++c) {
        const char* name[3] = {"R", "G", "B"};
        header.channels().insert(name[c], Imf::Channel(Imf::FLOAT));
        buffer.insert(name[c], Imf::Slice::Make(Imf::FLOAT, image.pixels().data() + c, Imath::V2i(0, 0), image.width(),
                                                image.height(), 3 * sizeof(float),
                                                3 * sizeof(float) * std::size_t(image.width())));
    }
    Imf::OutputFile out(file.c_str(), header);
    out.setFrameBuffer(buffer);
    out.writePixels(image.height());
}

ImageF direction_latlong(int height) {
    ImageF image(2 * height, height, 3);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < 2 * height; ++x) {
            const Vec3d d = latlong_direction({(x + 0.5) / (2 * height), (y + 0.5) / height});
            image.at(x, y)[0] = float(2 + d.x), image.at(x, y)[1] = float(2 + d.y), image.at(x, y)[2] = float(2 + d.z);
        }
    return image;
}

/// Radiance from a world direction: bilinear, without care for the seam, poles and edges.
Vec3d look(const ImageF& latlong, const Mat3& world_to_source, const Vec3d& world) {
    const UV uv = latlong_uv(world_to_source * world);
    const double px = std::clamp(uv.u * latlong.width() - 0.5, 0.0, latlong.width() - 1.0);
    const double py = std::clamp(uv.v * latlong.height() - 0.5, 0.0, latlong.height() - 1.0);
    const int x = std::min(int(px), latlong.width() - 2), y = std::min(int(py), latlong.height() - 2);
    const auto at = [&](int i, int j) { return Vec3d(latlong.at(i, j)[0], latlong.at(i, j)[1], latlong.at(i, j)[2]); };
    const double s = px - x, t = py - y;
    return (at(x, y) * (1 - s) + at(x + 1, y) * s) * (1 - t) + (at(x, y + 1) * (1 - s) + at(x + 1, y + 1) * s) * t;
}

Vec3d look(const Cubemap& cube, const Vec3d& direction) {
    const CubePoint p = cube_point(direction);
    const int n = cube.size();
    const float* texel = cube.face(p.face).at(std::min(int(p.uv.u * n), n - 1), std::min(int(p.uv.v * n), n - 1));
    return {texel[0], texel[1], texel[2]};
}

/// Directions spread evenly (a Fibonacci spiral).
std::vector<Vec3d> directions(int count) {
    std::vector<Vec3d> all;
    for (int i = 0; i < count; ++i) {
        const double y = 1 - (2 * i + 1.0) / count, phi = i * k_pi * (3 - std::sqrt(5.0));
        all.emplace_back(std::sqrt(1 - y * y) * std::cos(phi), y, std::sqrt(1 - y * y) * std::sin(phi));
    }
    return all;
}

/// The direction whose colour the environment shows, assuming direction_latlong.
Vec3d seen(const ImageF& image, const Environment& environment, const Vec3d& world) {
    return look(image, environment.world_to_source, world) - Vec3d{2, 2, 2};
}

}  // namespace

TEST_CASE("environment: turning moves the light from +X towards +Z, up says where the image's top goes") {
    TemporaryFolder folder;
    write_exr(folder / "d.exr", direction_latlong(64));
    const auto check = [&](const EnvironmentOptions& options, const Vec3d& world, const Vec3d& shown) {
        auto environment = open_environment({folder / "d.exr"}, options);
        REQUIRE_MESSAGE(environment, environment.error().format());
        const auto image = read_latlong(**environment->rows());
        REQUIRE(image);
        CHECK(length(seen(*image, *environment, world) - shown) < 0.03);  // half a texel at the poles
    };
    const Vec3d x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
    check({}, x, x);
    check({}, z, z);
    check({.rotate_y_deg = 90}, z, x);  // what was at +X is now at +Z
    check({.rotate_y_deg = 90}, -x, z);
    check({.rotate_y_deg = 90}, y, y);
    check({.rotate_y_deg = -450}, -z, x);
    check({.rotate_y_deg = 30}, {std::cos(k_pi / 6), 0, std::sin(k_pi / 6)}, x);
    check({.up = "+Z"}, z, y);
    check({.up = "+Z"}, x, x);   // as in Blender: the centre stays at +X
    check({.up = "+Z"}, -y, z);  // and to its right lies -Y
    check({.up = "-Z"}, -z, y);
    check({.up = "+X"}, x, y);
    check({.up = "-x"}, -x, y);
    check({.up = "-Y"}, -y, y);
    check({.latlong = "usd"}, z, x);  // the image's centre, which is red, is at +Z
    check({.latlong = "usd"}, -x, z);
    check({.latlong = "centre=+X,right=-Z"}, -z, z);
    check({.latlong = "usd", .rotate_y_deg = 90}, -x, x);  // +Z turns to -X
}

TEST_CASE("environment: every turn is orthogonal, and exact at quarter turns") {
    TemporaryFolder folder;
    write_exr(folder / "d.exr", direction_latlong(2));
    for (const char* up : {"+X", "-X", "+Y", "-Y", "+Z", "-Z"})
        for (const double angle : {0.0, 90.0, 180.0, 270.0, -90.0, 360.0, 33.0}) {
            const auto environment = open_environment({folder / "d.exr"}, {.rotate_y_deg = angle, .up = up});
            REQUIRE(environment);
            const Mat3& m = environment->world_to_source;
            const Mat3 product = m * m.transposed();
            for (int i = 0; i < 3; ++i) CHECK(length(product.row[i] - Mat3().row[i]) < 1e-15);
            CHECK(std::abs(dot(m.row[0], cross(m.row[1], m.row[2])) - 1) < 1e-15);
            if (angle != 33)
                for (const Vec3d& row : m.row) CHECK(std::abs(row.x) + std::abs(row.y) + std::abs(row.z) == 1);
        }
}

TEST_CASE("environment: exposure is in stops, of every projection") {
    TemporaryFolder folder;
    write_exr(folder / "l.exr", ImageF(4, 2, 3, 3.0f));
    write_exr(folder / "c.exr", ImageF(6, 1, 3, 3.0f));
    auto latlong = open_environment({folder / "l.exr"}, {.exposure = -1});
    REQUIRE(latlong);
    CHECK(read_latlong(**latlong->rows())->at(0, 0)[1] == 1.5f);
    const auto cube = open_environment({folder / "c.exr"}, {.exposure = 2});
    REQUIRE(cube);
    CHECK(cube->cube()->face(5).at(0, 0)[1] == 12);
}

TEST_CASE("environment: bad texels are mended and counted as rows pass") {
    TemporaryFolder folder;
    ImageF image(8, 4, 3, 1.0f);
    image.at(0, 0)[1] = std::nanf("");
    image.at(3, 1)[0] = -2;
    image.at(4, 1)[2] = HUGE_VALF;
    write_exr(folder / "b.exr", image);
    auto environment = open_environment({folder / "b.exr"});
    REQUIRE(environment);
    CHECK(environment->report().repaired() == 0);
    const auto rows = read_latlong(**environment->rows());
    REQUIRE(rows);
    CHECK(rows->at(0, 0)[1] == 1);
    CHECK(rows->at(3, 1)[0] == 0);
    CHECK(environment->report().not_a_number == 1);
    CHECK(environment->report().negative == 1);
    CHECK(environment->report().infinite == 1);
    CHECK(environment->report().negative_radiance == -2);
}

TEST_CASE("environment: a lat-long map of another shape is read where one says that it is one, with a warning") {
    TemporaryFolder folder;
    for (const auto& [width, height] : {std::pair{66, 32}, {128, 32}, {7, 5}, {32, 32}, {8, 6}}) {
        CAPTURE(width);
        // The upper half is bright and the lower one dark, whatever the shape.
        ImageF image(width, height, 3, 1.0f);
        for (int y = 0; y < height / 2; ++y) std::fill_n(image.row(y), 3 * width, 3.0f);
        write_exr(folder / "e.exr", image);
        for (const EnvironmentOptions& options : {EnvironmentOptions{.projection = "latlong"}, {.latlong = "usd"}}) {
            if (!options.latlong.empty() && width * 3 == height * 4) continue;  // the shape of a cube cross
            const auto environment = open_environment({folder / "e.exr"}, options);
            REQUIRE_MESSAGE(environment, environment.error().format());
            REQUIRE(environment->report().warnings.size() == 1);
            CHECK(environment->report().warnings[0].find("not twice as wide as high") != std::string::npos);
            CHECK(environment->radiance({0.3, 0.9, 0.1})->x == doctest::Approx(3));
            CHECK(environment->radiance({0.3, -0.9, 0.1})->x == doctest::Approx(1));
            CHECK(environment->report().warnings.size() == 1);  // after the image has been read, too
        }
    }
}

TEST_CASE("environment: wrong shapes and options say what is wrong, where, and what to do") {
    TemporaryFolder folder;
    const auto error_for = [&](int width, int height, const EnvironmentOptions& options = {}) {
        write_exr(folder / "e.exr", ImageF(width, height, 3, 1.0f));
        const auto environment = open_environment({folder / "e.exr"}, options);
        REQUIRE_FALSE(environment);
        return environment.error().format();
    };
    CHECK(error_for(1000, 600) == (folder / "e.exr").string() +
                                      ": image is 1000 x 600, but a lat-long map is twice as wide as high\n"
                                      "       If it is one all the same, stretched, pass `projection` latlong.");
    CHECK(error_for(8, 8).find("give all six") != std::string::npos);
    CHECK(error_for(8, 4, {.projection = "cube-cross"}).find("4:3") != std::string::npos);
    CHECK(error_for(8, 4, {.projection = "cube-strip"}).find("6:1") != std::string::npos);
    CHECK(error_for(8, 4, {.projection = "cube-faces"}).find("six files") != std::string::npos);
    CHECK(error_for(8, 4, {.projection = "sphere"}).find("Accepted: auto, latlong") != std::string::npos);
    CHECK(error_for(8, 4, {.latlong = "west"}).find("Accepted: default, usd") != std::string::npos);
    CHECK(error_for(8, 4, {.up = "Q"}).find("Accepted: +X") != std::string::npos);
    CHECK(error_for(8, 4, {.exposure = 1000}).find("64 stops") != std::string::npos);
    CHECK(error_for(600, 100, {.max_bytes = 100000}).find("limit") != std::string::npos);

    for (const int width : {15, 16, 17}) {
        write_exr(folder / "o.exr", ImageF(width, 8, 3, 1.0f));
        CHECK(open_environment({folder / "o.exr"}));
    }
    CHECK(open_environment({folder / "none.hdr"}).error().format() ==
          (folder / "none.hdr").string() + ": no such file");
    save(folder / "empty.hdr", {});
    CHECK(open_environment({folder / "empty.hdr"}).error().what == "file is empty");
    save(folder / "text.hdr", bytes_of("hello, world"));
    CHECK(open_environment({folder / "text.hdr"}).error().hint.find("Radiance") != std::string::npos);
    CHECK_FALSE(open_environment({}));
}

TEST_CASE("environment: an OpenEXR cube lies as the OpenEXR library says, orientation and samples") {
    TemporaryFolder folder;
    const int n = 9;
    const Imath::Box2i window({0, 0}, {n - 1, 6 * n - 1});
    ImageF image(n, 6 * n, 3);
    for (int f = 0; f < 6; ++f)
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x) {
                const auto face = Imf::CubeMapFace(f);
                const Imath::V2f at = Imf::CubeMap::pixelPosition(face, window, Imath::V2f(float(x), float(y)));
                const Imath::V3f d = Imf::CubeMap::direction(face, window, Imath::V2f(float(x), float(y)));
                // The values are linear on each face, so that resampling is exact.
                const float largest = std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)});
                for (int c = 0; c < 3; ++c) image.at(int(at.x + 0.5f), int(at.y + 0.5f))[c] = 2 + d[c] / largest;
            }
    write_exr(folder / "c.exr", image, Imf::ENVMAP_CUBE);
    const auto environment = open_environment({folder / "c.exr"});
    REQUIRE_MESSAGE(environment, environment.error().format());
    REQUIRE(environment->cube()->size() == n);
    for (int f = 0; f < 6; ++f)
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x) {
                const Vec3d d = cube_direction(f, {(x + 0.5) / n, (y + 0.5) / n});
                const float* seen = environment->cube()->face(f).at(x, y);
                CHECK(length(Vec3d(seen[0], seen[1], seen[2]) - Vec3d(2, 2, 2) - d) < 1e-6);  // float rounding
            }
}

TEST_CASE("environment: an OpenEXR lat-long lies as the OpenEXR library says, orientation and samples") {
    TemporaryFolder folder;
    const int width = 32, height = 16;
    const Imath::Box2i window({0, 0}, {width - 1, height - 1});
    ImageF image(width, height, 3, 1.0f);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const Imath::V2f l =
                Imf::LatLongMap::latLong(window, Imath::V2f(float(x), float(y)));  // latitude, longitude
            image.at(x, y)[0] = 4 + l.x, image.at(x, y)[1] = 4 + l.y;
        }
    write_exr(folder / "l.exr", image, Imf::ENVMAP_LATLONG);
    auto environment = open_environment({folder / "l.exr"});
    REQUIRE_MESSAGE(environment, environment.error().format());
    const auto rows = read_latlong(**environment->rows());
    REQUIRE(rows);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const Vec3d source = latlong_direction({(x + 0.5) / width, (y + 0.5) / height});
            const Vec3d world = environment->world_to_source.transposed() * source;
            const Imath::V2f l = Imf::LatLongMap::latLong(Imath::V3f(float(world.x), float(world.y), float(world.z)));
            CHECK(std::abs(rows->at(x, y)[0] - 4 - l.x) < 1e-5);
            CHECK(std::abs(rows->at(x, y)[1] - 4 - l.y) < 1e-5);
        }
}

TEST_CASE("environment: OpenEXR's cube and lat-long of one place agree on every face") {
    DOMELIGHT_DATA_FILE(orientation, "env_projections/OrientationCube.exr");
    const auto root = orientation.parent_path();
    for (const auto& [latlong_name, cube_name] : {std::pair("OrientationLatLong.exr", "OrientationCube.exr"),
                                                  std::pair("KernerEnvLatLong.exr", "KernerEnvCube.exr")}) {
        auto latlong = open_environment({root / latlong_name});
        const auto cube = open_environment({root / cube_name});
        REQUIRE_MESSAGE(latlong, latlong.error().format());
        REQUIRE_MESSAGE(cube, cube.error().format());
        const auto image = read_latlong(**latlong->rows());
        REQUIRE(image);
        // The differences as they are, compared with those of mirrored faces: the picture must be distinguished from
        // its mirror image.
        double as_it_is[6] = {}, mirrored[6] = {};
        for (const Vec3d& d : directions(6000)) {
            const Vec3d seen = look(*image, latlong->world_to_source, d);
            CubePoint p = cube_point(cube->world_to_source * d);
            const auto difference = [&] {
                return std::min(0.5, length(seen - look(*cube->cube(), cube_direction(p.face, p.uv))));
            };
            as_it_is[p.face] += difference();
            p.uv.u = 1 - p.uv.u;
            mirrored[p.face] += difference();
        }
        for (int f = 0; f < 6; ++f)
            CHECK_MESSAGE(as_it_is[f] < 0.4 * mirrored[f], cube_name, " face ", f, ": ", as_it_is[f], " against ",
                          mirrored[f]);
    }
}

TEST_CASE("environment: the same photograph as EXR and as Radiance agrees") {
    DOMELIGHT_DATA_FILE(hdr, "hdr_crops/hdr-rgb-arboretum.hdr");
    DOMELIGHT_DATA_FILE(exr, "hdr_crops/hdr-rgb-arboretum.exr");
    const auto a = read_bytes(load(hdr)), b = read_bytes(load(exr));
    REQUIRE(a);
    REQUIRE(b);
    REQUIRE(a->width() == b->width());
    double sum_a[3] = {}, sum_b[3] = {};
    double largest = 0;
    for (int y = 0; y < a->height(); ++y)
        for (int x = 0; x < a->width(); ++x) {
            const float *p = a->at(x, y), *q = b->at(x, y);
            const float brightest = std::max({p[0], p[1], p[2]});
            for (int c = 0; c < 3; ++c) {
                sum_a[c] += p[c], sum_b[c] += q[c];
                largest = std::max(largest, double(std::abs(p[c] - q[c]) / brightest));
            }
        }
    CHECK(largest < 0x1p-7);  // a mantissa of eight bits cut off, and half's rounding
    for (int c = 0; c < 3; ++c) CHECK(std::abs(sum_a[c] / sum_b[c] - 1) < 1e-3);
}

TEST_CASE("environment: every malformed file opens properly or gives one error that names it") {
    DOMELIGHT_DATA_FILE(malformed, "malformed");
    const std::set<std::string> hints{"", "The file is truncated or damaged.",
                                      "The file is truncated, or its header is wrong."};
    int opened = 0, refused = 0;
    for (const char* folder : {"exr_damaged", "exr_invalid", "exr_special", "exr_tinyexr", "hdr_variants", "oiio"})
        for (const auto& entry : std::filesystem::directory_iterator(malformed / folder)) {
            // Opened in two ways: as an environment, and as an image of any shape.
            const auto environment = open_environment({entry.path()}, {.max_bytes = 64 << 20, .threads = 2});
            if (!environment) {
                CHECK(environment.error().where == entry.path().string());
                CHECK(!environment.error().what.empty());
                CHECK(escaped(environment.error().what) == environment.error().what);
            }
            const auto reader = open_bytes(load(entry.path()), {.max_bytes = 64 << 20, .threads = 2});
            bool good = bool(reader);
            if (reader) {
                const auto& facts = (*reader)->facts();
                ImageF rows(facts.width, 64, 3);
                for (int y = 0; good && y < facts.height; y += 64)
                    good = bool((*reader)->read(rows.view().rows(0, std::min(64, facts.height - y))));
            }
            ++(good ? opened : refused);
        }
    MESSAGE(opened, " opened, ", refused, " refused");
    CHECK(opened > 20);
    CHECK(refused > 60);
}
