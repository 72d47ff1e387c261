#include "domelight/bake/bake.h"

#include "domelight/io/environment/open_environment.h"
#include "domelight/io/file/atomic_file.h"
#include "domelight/io/write_image.h"
#include "domelight/projection/projection.h"

#include "bake/sh_report.h"
#include "bake/staging.h"
#include "io/file/sha256.h"
#include "io/picture/texture_image.h"
#include "test.h"

#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>

using namespace domelight;

namespace {

std::span<const std::uint8_t> bytes_of(const std::string& text) {
    return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

/// A lat-long environment in memory that is different in every direction.
ImageF smooth_image(int height) {
    ImageF image(2 * height, height, 3);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < 2 * height; ++x) {
            const Vec3d d = latlong_direction({(x + 0.5) / (2 * height), (y + 0.5) / height});
            image.at(x, y)[0] = float(2 + d.x);
            image.at(x, y)[1] = float(2 + d.y);
            image.at(x, y)[2] = float(2 + d.z);
        }
    return image;
}

Environment environment_of(const ImageF& image) {
    Environment environment = Environment::from_latlong(image);
    environment.format = "test";
    return environment;
}

BakeOptions small_options() {
    BakeOptions options;
    options.size = 16;
    options.levels = 2;
    options.irradiance_size = 4;
    options.brdf_size = 16;
    options.preview = false;
    options.threads = 2;
    return options;
}

nlohmann::json read_json(const std::filesystem::path& file) {
    std::ifstream stream(file);
    return nlohmann::json::parse(stream);
}

std::string text_of(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

int count_files(const std::filesystem::path& folder) {
    int n = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::recursive_directory_iterator(folder)) ++n;
    return n;
}

/// The texel of level 0 of `texture` that a shader's texture(cube, d) reads.
Vec3d lookup(const Texture& texture, const Vec3d& d) {
    const CubePoint p = cube_point(d);
    const ImageF face = decode_texture(texture, 0, p.face);
    const float* texel = face.at(std::min(face.width() - 1, int(p.uv.u * face.width())),
                                 std::min(face.width() - 1, int(p.uv.v * face.width())));
    return {texel[0], texel[1], texel[2]};
}

}  // namespace

TEST_CASE("sha256: the test vectors of FIPS 180-4, at once and in pieces") {
    CHECK(sha256(bytes_of("abc")) == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    CHECK(sha256(bytes_of("")) == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    Sha256 hash;
    hash.add(bytes_of("a"));
    hash.add(bytes_of("bc"));
    CHECK(hash.finish() == sha256(bytes_of("abc")));
    const test::TemporaryFolder folder;
    std::ofstream(folder / "a") << "a";
    std::ofstream(folder / "bc") << "bc";
    const std::vector<std::filesystem::path> files{folder / "a", folder / "bc"};
    CHECK(*sha256_files(files) == sha256(bytes_of("abc")));
    CHECK(sha256_file(folder / "none").error().where == (folder / "none").string());
}

TEST_CASE("staging: files appear together, and nothing stays of what was not committed") {
    const test::TemporaryFolder folder;
    {
        auto staging = Staging::open(folder / "new/deep");
        REQUIRE(staging);
        std::ofstream(staging->stage("a.txt")) << "a";
        std::ofstream(staging->stage("sub/b.txt")) << "b";
    }
    CHECK(count_files(folder.path()) == 0);
    {
        auto staging = Staging::open(folder / "new/deep");
        std::ofstream(staging->stage("a.txt")) << "a";
        std::ofstream(staging->stage("sub/b.txt")) << "b";
        CHECK_FALSE(std::filesystem::exists(folder / "new/deep/a.txt"));
        CHECK(staging->commit("a.txt"));
    }
    CHECK(std::filesystem::exists(folder / "new/deep/a.txt"));
    CHECK(std::filesystem::exists(folder / "new/deep/sub/b.txt"));
    CHECK(count_files(folder.path()) == 5);
    CHECK_FALSE(Staging::open(folder / "new/deep/a.txt"));
    {
        auto staging = Staging::open(folder / "new/deep");
        std::ofstream(staging->stage("a.txt")) << "new";
        std::ofstream(staging->stage("sub")) << "a file where a folder is";
        CHECK_FALSE(staging->commit("sub"));
    }
    std::string text;
    std::ifstream(folder / "new/deep/a.txt") >> text;
    CHECK(text == "a");
    CHECK(count_files(folder.path()) == 5);
}

TEST_CASE("staging: a file that is written at once or not at all has one temporary, the staged one") {
    const test::TemporaryFolder folder;
    auto staging = Staging::open(folder.path());
    REQUIRE(staging);
    const auto staged = staging->stage("a.txt");
    REQUIRE(write_file_atomically(staged, [&](const std::filesystem::path& path) -> Result<void> {
        CHECK(path == staged);
        std::ofstream(path) << "a";
        CHECK(count_files(folder.path()) == 1);
        return {};
    }));
    CHECK(staging->commit("a.txt"));
    CHECK(std::filesystem::exists(folder / "a.txt"));
    CHECK(count_files(folder.path()) == 1);
}

TEST_CASE("sh report: three bands hold the irradiance of linear light exactly, two of light of degree two do not") {
    // E / π of a constant plus a linear function: band 1 is scaled by 2/3 (Ramamoorthi and Hanrahan 2001).
    std::vector<Vec3d> radiance(9);
    radiance[0] = Vec3d(1, 1, 1) * (2 * std::sqrt(4 * k_pi));
    radiance[3] = Vec3d(1, 0, 0) * std::sqrt(4 * k_pi / 3);  // x in red
    FilteredMap exact = Cubemap(8);
    for (int f = 0; f < 6; ++f)
        for (int y = 0; y < 8; ++y)
            for (int x = 0; x < 8; ++x) {
                const Vec3d d = normalize(cube_direction(f, {(x + 0.5) / 8, (y + 0.5) / 8}));
                float* texel = exact.face(f).at(x, y);
                texel[0] = float(2 + 2.0 / 3 * d.x);
                texel[1] = texel[2] = 2;
            }
    const ShReport right = make_sh_report(radiance, 3, ShWindow::none, exact, 2);
    CHECK(right.rms_error < 1e-6);  // the map is float
    CHECK(right.max_error < 1e-6);
    CHECK(right.irradiance[0].x == doctest::Approx(k_pi * radiance[0].x));
    CHECK(right.irradiance[3].x == doctest::Approx(2 * k_pi / 3 * radiance[3].x));
    radiance[3] = {};
    const ShReport wrong = make_sh_report(radiance, 3, ShWindow::none, exact, 1);
    CHECK(wrong.max_error > 0.2);
    // Filament's form of the same: E / π = 2 + 2/3 x.
    CHECK(filament_sh_text(right).starts_with(
        "( 2.000000000000000,  2.000000000000000,  2.000000000000000); // L00, irradiance, pre-scaled base\n"));
    CHECK(filament_sh_text(right).find("( 0.666666666666667,  0.000000000000000,  0.000000000000000); // L11") !=
          std::string::npos);
}

TEST_CASE("bake: each engine's cube shows every direction as the engine looks it up") {
    const ImageF image = smooth_image(32);
    const test::TemporaryFolder folder;
    BakeOptions options = small_options();
    options.encoding = Encoding::rgba32f;
    options.format = Container::ktx2;
    options.engines = {"generic", "babylon", "bevy"};
    Environment environment = environment_of(image);
    const auto report = bake(environment, options, folder.path());
    REQUIRE(report);
    for (const EngineReport& engine : report->engines) {
        const auto texture = read_texture(engine.folder / engine.maps.front().file.file);
        REQUIRE(texture);
        for (const Vec3d& d : {Vec3d{1, 0.1, 0.2}, Vec3d{-1, 0.3, 0.1}, Vec3d{0.2, 1, -0.4}, Vec3d{0.2, -1, -0.4},
                               Vec3d{0.3, 0.2, 1}, Vec3d{-0.3, 0.2, -1}}) {
            Vec3d read = d;
            if (engine.name == "babylon") read.x = -d.x;  // its world is left-handed
            if (engine.name == "bevy") read.z = -d.z;     // its shaders negate z
            const Vec3d expected = normalize(d) + Vec3d(2, 2, 2), value = lookup(*texture, read);
            // Half a texel of 16^2 is 0.06 radians.
            CHECK(length(value - expected) < 0.1);
        }
    }
}

TEST_CASE("bake: irradiance is E for generic and E / pi for khronos") {
    ImageF image(64, 32, 3, 0.5f);
    const test::TemporaryFolder folder;
    BakeOptions options = small_options();
    options.encoding = Encoding::rgba32f;
    options.engines = {"generic", "khronos"};
    Environment environment = environment_of(image);
    const auto report = bake(environment, options, folder.path());
    REQUIRE(report);
    const auto generic = read_texture(folder / "generic/irradiance.ktx2");
    const auto khronos = read_texture(folder / "khronos/lambertian/diffuse.ktx2");
    REQUIRE(generic);
    REQUIRE(khronos);
    CHECK(decode_texture(*generic, 0, 0).at(1, 1)[0] == doctest::Approx(0.5 * k_pi).epsilon(1e-5));
    CHECK(decode_texture(*khronos, 0, 0).at(1, 1)[0] == doctest::Approx(0.5).epsilon(1e-5));
    CHECK(generic->metadata.at("domelight.quantity") == "irradiance");
    CHECK(khronos->metadata.at("domelight.quantity") == "irradiance_over_pi");
    CHECK(report->mean_radiance.x == doctest::Approx(0.5).epsilon(1e-6));
    CHECK(read_json(folder / "generic/manifest.json")["irradiance"]["quantity"] == "irradiance");
}

TEST_CASE("bake: the bytes of an engine's files do not depend on the engines baked with it") {
    ImageF image = smooth_image(32);
    image.at(20, 12)[1] = 1e5f;  // a sun, which is removed from the rows for narrow lobes
    const auto files_of = [](const std::filesystem::path& folder) {
        std::map<std::string, std::string> files;
        for (const auto& entry : std::filesystem::directory_iterator(folder))
            files[entry.path().filename().string()] = text_of(entry.path());
        return files;
    };
    const auto bake_it = [&](std::vector<std::string> engines, int size, const std::filesystem::path& folder) {
        Environment environment = environment_of(image);
        BakeOptions options;
        options.engines = std::move(engines);
        options.size = size;
        options.irradiance_size = 32;
        options.threads = 2;
        options.preview = false;
        REQUIRE(bake(environment, options, folder));
    };
    std::map<int, std::map<std::string, std::string>> alone;  // by size
    for (const Engine& engine : engines()) {
        if (engine.name == "generic") continue;
        CAPTURE(engine.name);
        const test::TemporaryFolder folder;
        const int size = engine.name == "playcanvas" ? 512 : engine.name == "unreal" ? 128 : 16;
        if (alone[size].empty()) {
            bake_it({"generic"}, size, folder / "alone");
            alone[size] = files_of(folder / "alone");
        }
        bake_it({"generic", engine.name}, size, folder / "both");
        CHECK(files_of(folder / "both/generic") == alone[size]);
    }
}

TEST_CASE("bake: the picture shows the BRDF table as it is stored") {
    const ImageF image = smooth_image(16);
    for (const char* engine : {"generic", "filament"}) {
        const test::TemporaryFolder folder;
        Environment environment = environment_of(image);
        BakeOptions options = small_options();
        options.engines = {engine};
        options.preview = true;
        REQUIRE(bake(environment, options, folder.path()));
        const auto png = decode_png_texture(bytes_of(text_of(folder / "preview.png")));
        REQUIRE(png);
        // The third of three cells, each 300 px wide. The scale is the larger part; the second channel holds scale +
        // bias.
        const std::uint8_t* middle = png->rgba.data() + 4 * ((626 + 150) * png->width + 32 + 2 * 316 + 150);
        CHECK((middle[0] > middle[1]) == (std::string(engine) == "generic"));
    }
}

TEST_CASE("bake: a reading that fails changes nothing") {
    struct BrokenRows : RowSource {
        int width() const override { return 64; }
        int height() const override { return 32; }
        Result<void> read(ImageView<float>) override { return Error{"is cut off", "", ""}; }
    };
    const test::TemporaryFolder folder;
    Environment environment = Environment::from_rows(
        64, 32, [](auto) -> Result<std::unique_ptr<RowSource>> { return std::unique_ptr<RowSource>(new BrokenRows); });
    environment.file = "broken.hdr";
    BakeOptions options = small_options();
    options.hashes = false;
    const auto report = bake(environment, options, folder / "out");
    REQUIRE_FALSE(report);
    CHECK(report.error().format().starts_with("broken.hdr: is cut off"));
    CHECK_FALSE(std::filesystem::exists(folder / "out"));
}

TEST_CASE("bake: what was clipped is reported") {
    ImageF image(64, 32, 3, 1.0f);
    for (int c = 0; c < 3; ++c) image.at(10, 16)[c] = 1e6f;  // more than a half float can hold
    const test::TemporaryFolder folder;
    Environment environment = environment_of(image);
    const auto report = bake(environment, small_options(), folder.path());
    REQUIRE(report);
    const auto levels = read_json(folder / "manifest.json")["specular"]["levels"];
    CHECK(levels[0]["clipped_texels"] > 0);
    CHECK(levels[0]["clipped_energy"] > 0.5);
    CHECK(levels[1]["clipped_texels"] == 0);
    REQUIRE(report->warnings.size() == 1);
    CHECK(report->warnings[0].find("specular level 0") != std::string::npos);
}

TEST_CASE("bake: OpenEXR maps hold floats where halves would clip, unless halves are asked for") {
    const test::TemporaryFolder folder;
    for (const Container container : {Container::exr, Container::exr_mip})
        for (const bool bright : {false, true})
            for (const bool asked : {false, true}) {
                ImageF image(64, 32, 3, 1.0f);
                if (bright) image.at(10, 16)[1] = 1e6f;
                Environment environment = environment_of(image);
                BakeOptions options = small_options();
                options.format = container;
                if (asked) options.encoding = Encoding::rgba16f;
                REQUIRE(bake(environment, options, folder.path()));
                const auto specular = read_json(folder / "manifest.json")["specular"];
                CHECK(specular["encoding"] == (bright && !asked ? "rgba32f" : "rgba16f"));
                CHECK((specular["levels"][0]["clipped_texels"] > 0) == (bright && asked));
            }
}

TEST_CASE("bake_is_up_to_date: only for the same source, options and files") {
    const test::TemporaryFolder folder;
    const std::vector<std::filesystem::path> files{folder / "env.hdr"};
    const ImageF image = smooth_image(16);
    REQUIRE(write_hdr(files[0], image.view()));
    BakeOptions options = small_options();
    options.source_files = files;
    const auto bake_it = [&] {
        auto environment = open_environment(files);
        REQUIRE(environment);
        REQUIRE(bake(*environment, options, folder / "out"));
    };
    CHECK_FALSE(bake_is_up_to_date(files, options, folder / "out"));
    bake_it();
    CHECK(bake_is_up_to_date(files, options, folder / "out"));
    BakeOptions other = options;
    other.levels = 1;
    CHECK_FALSE(bake_is_up_to_date(files, other, folder / "out"));
    other = options;
    other.environment.rotate_y_deg = 1;
    CHECK_FALSE(bake_is_up_to_date(files, other, folder / "out"));
    other = options;
    other.threads = 7;  // does not change the bytes
    CHECK(bake_is_up_to_date(files, other, folder / "out"));
    std::filesystem::remove(folder / "out/sh.json");
    CHECK_FALSE(bake_is_up_to_date(files, options, folder / "out"));
    bake_it();
    std::ofstream(files[0], std::ios::app) << "x";
    CHECK_FALSE(bake_is_up_to_date(files, options, folder / "out"));
}
