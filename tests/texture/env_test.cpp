#include "texture/container/env.h"

#include "domelight/bake/bake.h"
#include "domelight/image/row_source.h"
#include "domelight/io/environment/open_environment.h"
#include "domelight/texture/container/babylon_env.h"
#include "domelight/texture/texture.h"

#include "io/io_helpers.h"
#include "io/picture/texture_image.h"
#include "oriented.h"
#include "test.h"
#include "texture/texel/rgba8_ranges.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

using namespace domelight;
using namespace domelight::test;

namespace {

BabylonEnv sample_env(int size, int levels) {
    BabylonEnv env;
    env.cube = sample_texture(Encoding::rgbd, size, 6, levels);
    env.cube.metadata.clear();
    env.irradiance = QuadraticPolynomial{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}, {0.5, 0, 0}, {}, {}, {}, {}, {-1, -2, -3}};
    return env;
}

/// A file's JSON and where its pictures start.
nlohmann::json header_of(const std::vector<std::uint8_t>& bytes, std::size_t& data) {
    const auto zero = std::find(bytes.begin() + 8, bytes.end(), 0);
    data = std::size_t(zero - bytes.begin()) + 1;
    return nlohmann::json::parse(bytes.begin() + 8, zero);
}

/// A file with another header before the same pictures.
std::vector<std::uint8_t> with_header(const std::vector<std::uint8_t>& bytes, const nlohmann::json& header) {
    std::size_t data = 0;
    header_of(bytes, data);
    std::vector<std::uint8_t> out(bytes.begin(), bytes.begin() + 8);
    const std::string text = header.dump();
    out.insert(out.end(), text.begin(), text.end());
    out.push_back(0);
    out.insert(out.end(), bytes.begin() + std::ptrdiff_t(data), bytes.end());
    return out;
}

std::string error_of(const std::vector<std::uint8_t>& bytes) {
    MemorySource source(bytes);
    const auto env = env_file(source);
    return env ? "" : env.error().what;
}

BakeOptions babylon_options(int size) {
    BakeOptions options;
    options.engines = {"babylon"};
    options.size = size;
    options.preview = false;
    options.threads = 2;
    return options;
}

}  // namespace

TEST_CASE("env: what was written is read back, as a texture too") {
    const TemporaryFolder folder;
    for (const int size : {1, 2, 16}) {
        const BabylonEnv env = sample_env(size, int(std::bit_width(unsigned(size))));
        REQUIRE(write_env(folder / "a.env", env));
        const auto back = read_env(folder / "a.env");
        REQUIRE(back);
        CHECK(same_texels(back->cube, env.cube));
        REQUIRE(back->irradiance);
        CHECK(back->irradiance->z == Vec3d{7, 8, 9});
        CHECK(back->irradiance->xy == Vec3d{-1, -2, -3});
        CHECK(back->lod_scale == doctest::Approx(0.8));
        const auto texture = read_texture(folder / "a.env");
        REQUIRE(texture);
        CHECK(same_texels(*texture, env.cube));
        const auto info = read_texture_info(folder / "a.env");
        REQUIRE(info);
        CHECK(info->container == "Babylon .env version 2");
        CHECK(info->decodable);
    }
}

TEST_CASE("env: the layout that Babylon's loader expects") {
    const TemporaryFolder folder;
    const BabylonEnv env = sample_env(4, 3);
    REQUIRE(write_env(folder / "a.env", env));
    const auto bytes = file_bytes(folder / "a.env");
    const std::vector<std::uint8_t> magic{0x86, 0x16, 0x87, 0x96, 0xf6, 0xd6, 0x96, 0x36};
    CHECK(std::equal(magic.begin(), magic.end(), bytes.begin()));
    std::size_t data = 0;
    const auto json = header_of(bytes, data);
    CHECK(json["version"] == 2);
    CHECK(json["imageType"] == "image/png");
    CHECK(json["specular"]["lodGenerationScale"] == 0.8);
    const auto& mipmaps = json["specular"]["mipmaps"];
    REQUIRE(mipmaps.size() == 18);
    std::size_t at = 0;
    for (const auto& picture : mipmaps) {
        CHECK(picture["position"] == at);
        at += picture["length"].get<std::size_t>();
    }
    CHECK(data + at == bytes.size());
    // Level 1, face -X: its picture's first row is the face's last.
    const auto& place = mipmaps[7];
    const auto image = decode_texture_image(
        std::span(bytes).subspan(data + place["position"].get<std::size_t>(), place["length"].get<std::size_t>()));
    REQUIRE(image);
    CHECK(image->width == 2);
    const std::uint8_t* face = env.cube.levels[1].data() + 16;
    CHECK(std::equal(image->rgba.begin(), image->rgba.begin() + 8, face + 8));
    CHECK(std::equal(image->rgba.begin() + 8, image->rgba.end(), face));
}

TEST_CASE("env: what cannot be a .env file is refused") {
    const TemporaryFolder folder;
    const auto what = [&](const BabylonEnv& env) {
        const auto written = write_env(folder / "a.env", env);
        return written ? std::string() : written.error().what;
    };
    CHECK(what(sample_env(12, 4)).find("power of two") != std::string::npos);
    CHECK(what(sample_env(16, 2)).find("5 levels") != std::string::npos);
    BabylonEnv env = sample_env(4, 3);
    env.cube.encoding = Encoding::rgbm;
    CHECK(what(env).find("rgbd") != std::string::npos);
    CHECK_FALSE(std::filesystem::exists(folder / "a.env"));
}

TEST_CASE("env: damaged files are errors that say what is wrong") {
    const TemporaryFolder folder;
    REQUIRE(write_env(folder / "a.env", sample_env(8, 4)));
    const auto bytes = file_bytes(folder / "a.env");
    std::size_t data = 0;
    const auto json = header_of(bytes, data);
    CHECK(error_of(with_header(bytes, json)).empty());

    for (std::size_t size = 0; size < bytes.size(); size += 7)
        CHECK_FALSE(error_of({bytes.begin(), bytes.begin() + std::ptrdiff_t(size)}).empty());

    const auto changed = [&](auto change) {
        auto copy = json;
        change(copy);
        return error_of(with_header(bytes, copy));
    };
    CHECK(changed([](auto& j) { j["version"] = 3; }).find("version") != std::string::npos);
    CHECK(changed([](auto& j) { j.erase("width"); }).find("width: is missing") != std::string::npos);
    CHECK(changed([](auto& j) { j["width"] = 1u << 30; }).find("power of two") != std::string::npos);
    CHECK(changed([](auto& j) { j["width"] = 16; }).find("8 x 8 where 16 x 16") != std::string::npos);
    CHECK(changed([](auto& j) { j["specular"]["mipmaps"].erase(0); }).find("23 pictures") != std::string::npos);
    CHECK(changed([](auto& j) { j["specular"] = 7; }).find("specular") != std::string::npos);
    CHECK(changed([](auto& j) { j["irradiance"]["x"] = {1, 2}; }).find("irradiance.x") != std::string::npos);
    for (const std::uint64_t number : {std::uint64_t(1) << 20, std::uint64_t(1) << 63, ~std::uint64_t(0)}) {
        CHECK(changed([&](auto& j) { j["specular"]["mipmaps"][3]["position"] = number; }).find("past the file's end") !=
              std::string::npos);
        CHECK(changed([&](auto& j) { j["specular"]["mipmaps"][3]["length"] = number; }).find("past the file's end") !=
              std::string::npos);
    }
    CHECK(error_of({bytes.begin() + 1, bytes.end()}).find("not a Babylon .env") != std::string::npos);
}

TEST_CASE("env: a picture that promises more than its bytes can hold is refused before memory is taken") {
    // A PNG header of 16384 x 16384 and nothing behind it.
    std::vector<std::uint8_t> png{0x89, 'P',  'N', 'G', '\r', '\n', 0x1a, '\n', 0, 0, 0, 13, 'I', 'H', 'D', 'R', 0,
                                  0,    0x40, 0,   0,   0,    0x40, 0,    8,    6, 0, 0, 0,  0,   0,   0,   0};
    nlohmann::json json{{"version", 2}, {"width", 16384}};
    for (int i = 0; i < 6; ++i) json["specular"]["mipmaps"].push_back({{"position", 0}, {"length", png.size()}});
    std::vector<std::uint8_t> bytes{0x86, 0x16, 0x87, 0x96, 0xf6, 0xd6, 0x96, 0x36};
    const std::string text = json.dump();
    bytes.insert(bytes.end(), text.begin(), text.end());
    bytes.push_back(0);
    bytes.insert(bytes.end(), png.begin(), png.end());
    CHECK(error_of(bytes).find("cannot hold") != std::string::npos);
}

TEST_CASE("babylon_polynomial: what Babylon makes of it is E / pi of the light, in its mirrored world") {
    // An environment of the first three bands only, whose irradiance is found by quadrature.
    std::vector<Vec3d> radiance(9);
    for (int i = 0; i < 9; ++i) radiance[std::size_t(i)] = {1 / (1.0 + i), std::sin(i + 1.0), 2.0 - 0.3 * i};
    const QuadraticPolynomial p = babylon_polynomial(radiance);
    // Babylon's SphericalHarmonics.FromPolynomial, its six printed digits; then sum of coefficient times basis, whose
    // Condon-Shortley signs cancel those of the coefficients.
    const double pi = k_pi;
    const Vec3d h[9] = {(p.xx * 0.376127 + p.yy * 0.376127 + p.zz * 0.376126) * pi,
                        p.y * (0.977204 * pi),
                        p.z * (0.977204 * pi),
                        p.x * (0.977204 * pi),
                        p.xy * (1.16538 * pi),
                        p.yz * (1.16538 * pi),
                        (p.zz * 1.34567 - p.xx * 0.672834 - p.yy * 0.672834) * pi,
                        p.zx * (1.16538 * pi),
                        (p.xx * 1.16538 - p.yy * 1.16538) * pi};
    for (const Vec3d& n : {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, normalize(Vec3d{1, -2, 0.5}), normalize(Vec3d{-1, 1, 3})}) {
        // E / π by the midpoint rule over the sphere; its error is some (π / 200)^2.
        const int rows = 200;
        Vec3d truth;
        for (int y = 0; y < rows; ++y)
            for (int x = 0; x < 2 * rows; ++x) {
                const Vec3d d = latlong_direction({(x + 0.5) / (2 * rows), (y + 0.5) / rows});
                truth += sh_evaluate(radiance, d) *
                                    (std::max(0.0, dot(n, d)) * latlong_solid_angle(y, 2 * rows, rows) / pi);
            }
        double y[9];
        sh_basis({-n.x, n.y, n.z}, 3, y);
        Vec3d shown;
        for (int i = 0; i < 9; ++i) shown += h[i] * y[i];
        CHECK(length(shown - truth) < 1e-3 * length(truth));
    }
}

TEST_CASE("env: a constant furnace stays constant in every level and in the diffuse light") {
    const TemporaryFolder folder;
    ImageF furnace(64, 32, 3);
    std::fill(furnace.pixels().begin(), furnace.pixels().end(), 0.75f);
    Environment environment = environment_of(furnace);
    REQUIRE(bake(environment, babylon_options(16), folder.path()));
    const auto env = read_env(folder / "sky.env");
    REQUIRE(env);
    CHECK(env->cube.levels.size() == 5);
    for (int l = 0; l < 5; ++l)
        for (int f = 0; f < 6; ++f) {
            const ImageF face = decode_texture(env->cube, l, f);
            // One step of the encoding is 2.2 / 255 of the value.
            for (const float v : face.pixels()) CHECK(std::abs(v - 0.75f) < 0.004f);
        }
    for (const Vec3d& d : {Vec3d{1, 0, 0}, Vec3d{0, -1, 0}, normalize(Vec3d{1, 1, 1})})
        CHECK(length((*env->irradiance)(d)-Vec3d{0.75, 0.75, 0.75}) < 1e-4);
}

TEST_CASE("env: Babylon's shader finds every direction's light, and so do we on reading") {
    const TemporaryFolder folder;
    const ImageF image = direction_image(64);
    Environment environment = environment_of(image);
    REQUIRE(bake(environment, babylon_options(16), folder.path()));
    const auto env = read_env(folder / "sky.env");
    REQUIRE(env);
    const auto cubes = decode_cubes(env->cube);
    REQUIRE(cubes);
    // Steps of the encoding, and the mean over a texel instead of its middle.
    CHECK(worst_direction(cubes->front(), [](const Vec3d& d) { return Vec3d{-d.x, d.y, d.z}; }) < 0.03);
    const auto opened = open_environment({folder / "sky.env"});
    REQUIRE(opened);
    CHECK(opened->format == "Babylon .env");
    CHECK(worst_direction(*opened->cube(), [](const Vec3d& d) { return d; }) < 0.03);
    CHECK(opened->report().warnings.empty());
    // Diffuse light: the linear part of the polynomial points in the direction of the light.
    const Vec3d x = env->irradiance->x;
    CHECK(x.x == doctest::Approx(-4.0 / 9).epsilon(0.01));
    CHECK(std::abs(x.y) < 1e-3);
    CHECK(env->irradiance->y.y == doctest::Approx(4.0 / 9).epsilon(0.01));
}

TEST_CASE("env: Babylon's own file shows its source, in the convention that Babylon gives lat-long images") {
    DOMELIGHT_DATA_FILE(file, "reference/symmetrical_garden/symmetrical_garden.env");
    DOMELIGHT_DATA_FILE(source, "reference/symmetrical_garden/symmetrical_garden_1k.hdr");
    const auto theirs = open_environment({file});
    REQUIRE(theirs);
    EnvironmentOptions options;
    options.latlong = "usd";
    auto opened = open_environment({source}, options);
    REQUIRE(opened);
    const auto image = read_latlong(**opened->rows());
    REQUIRE(image);
    // The correlation of the logarithms of 16 x 16 means in each face, which the sun and clipping hardly affect.
    double sa = 0, sb = 0, saa = 0, sbb = 0, sab = 0, n = 0;
    const int block = theirs->cube()->size() / 16;
    for (int f = 0; f < 6; ++f)
        for (int y = 0; y < 16; ++y)
            for (int x = 0; x < 16; ++x) {
                double a = 0, b = 0;
                for (int j = 0; j < block; ++j)
                    for (int i = 0; i < block; ++i) {
                        const double s = (x * block + i + 0.5) / (16 * block), t = (y * block + j + 0.5) / (16 * block);
                        const UV uv = latlong_uv(opened->world_to_source * cube_direction(f, {s, t}));
                        a += double(theirs->cube()->face(f).at(x * block + i, y * block + j)[1]);
                        b += double(texel_at(*image, uv.u, uv.v)[1]);
                    }
                a = std::log(a / (block * block) + 0.01), b = std::log(b / (block * block) + 0.01);
                sa += a, sb += b, saa += a * a, sbb += b * b, sab += a * b, n += 1;
            }
    const double correlation = (sab - sa * sb / n) / std::sqrt((saa - sa * sa / n) * (sbb - sb * sb / n));
    CHECK(correlation > 0.99);  // 0.998 measured; any other of the 48 orientations stays below 0.8
}
