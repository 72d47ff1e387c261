// Files by way of the C interface: the bytes are those of C++, and broken files are refused.
#include "domelight/bake/bake.h"
#include "domelight/domelight_c.h"
#include "domelight/io/environment/convert.h"
#include "domelight/io/environment/open_environment.h"
#include "domelight/io/write_image.h"
#include "domelight/texture/container/texture_bytes.h"

#include "c/owned.h"
#include "io/file/file_reader.h"
#include "test.h"

#include <cstring>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

using namespace domelight;
using namespace domelight::test;

namespace {

std::vector<std::uint8_t> bytes_of(const std::filesystem::path& file) {
    const auto bytes = FileBytes::open(file, 1 << 28);
    REQUIRE(bytes);
    const auto all = (*bytes)->bytes();
    return {all.begin(), all.end()};
}

/// The light of an environment as its lat-long map.
std::vector<float> light_of(const domelight_environment* environment) {
    OwnedImage image;
    CHECK_DONE(domelight_environment_latlong(environment, image.place()));
    domelight_pixels pixels;
    domelight_pixels_init(&pixels);
    CHECK_DONE(domelight_image_pixels(image, &pixels));
    const auto floats = floats_of(pixels);
    return {floats.begin(), floats.end()};
}

/// A texture of the same texels, and of nothing else that the first one has.
void copy_texels(const domelight_texture* texture, const char* encoding, domelight_texture** copy) {
    domelight_texture_info info{};
    info.struct_size = sizeof info;
    CHECK_DONE(domelight_texture_get_info(texture, &info));
    std::vector<const void*> levels(std::size_t(info.levels));
    std::vector<std::size_t> sizes(levels.size());
    for (std::size_t l = 0; l < levels.size(); ++l)
        CHECK_DONE(domelight_texture_level(texture, l, &levels[l], &sizes[l]));
    CHECK_DONE(domelight_texture_from_levels(&info, encoding, levels.data(), sizes.data(), copy));
}

}  // namespace

TEST_SUITE("c") {
    TEST_CASE("c: a file, its bytes in memory and C++ give the same light, for every format") {
        const TemporaryFolder folder;
        const ImageF image = test_latlong(16);
        REQUIRE(write_exr(folder / "a.exr", image, {.half = false}));
        REQUIRE(write_hdr(folder / "a.hdr", image));
        FilterOptions one;
        one.specular = {{16, true, {}}};
        const auto maps = prefilter(Environment::from_latlong(image), one);
        REQUIRE(write_ktx2(folder / "a.ktx2", encode_texture(maps->specular, Encoding::rgba32f, 1)));
        REQUIRE(write_dds(folder / "a.dds", encode_texture(maps->specular, Encoding::rgba16f, 1)));
        REQUIRE(write_ktx1(folder / "a.ktx", encode_texture(maps->specular, Encoding::rgb9e5, 1)));
        for (const char* name : {"a.exr", "a.hdr", "a.ktx2", "a.dds", "a.ktx"}) {
            CAPTURE(name);
            const std::string file = (folder / name).string();
            const char* files[] = {file.c_str()};
            OwnedEnvironment opened, in_memory;
            CHECK_DONE(domelight_environment_open(files, 1, nullptr, opened.place()));
            const auto bytes = bytes_of(file);
            CHECK_DONE(domelight_environment_open_memory(bytes.data(), bytes.size(), name, nullptr, in_memory.place()));
            const auto expected = *open_environment({file})->latlong();
            const auto light = light_of(opened);
            CHECK(same_bits(light, expected->pixels()));
            CHECK(same_bits(light_of(in_memory), light));
            domelight_environment_info info{}, other{};
            info.struct_size = other.struct_size = sizeof info;
            CHECK_DONE(domelight_environment_get_info(opened, &info));
            CHECK_DONE(domelight_environment_get_info(in_memory, &other));
            CHECK(std::string(info.format) == other.format);
            CHECK(domelight_environment_warning_count(opened) == domelight_environment_warning_count(in_memory));
        }
    }

    TEST_CASE("c: options of opening have the words of the command line") {
        const TemporaryFolder folder;
        REQUIRE(write_exr(folder / "a.exr", test_latlong(16), {.half = false}));
        const std::string file = (folder / "a.exr").string();
        const char* files[] = {file.c_str()};
        domelight_environment_options options;
        domelight_environment_options_init(&options);
        CHECK(options.max_bytes == EnvironmentOptions().max_bytes);
        options.latlong = "usd";
        options.exposure = 1;
        options.rotate_y_deg = 90;
        OwnedEnvironment environment;
        CHECK_DONE(domelight_environment_open(files, 1, &options, environment.place()));
        domelight_environment_info info{};
        info.struct_size = sizeof info;
        CHECK_DONE(domelight_environment_get_info(environment, &info));
        CHECK(std::string(info.convention) == "usd");
        EnvironmentOptions same;
        same.latlong = "usd", same.exposure = 1, same.rotate_y_deg = 90;
        const auto expected = open_environment({file}, same);
        CHECK(info.world_to_source[2] == expected->world_to_source.row[0].z);
        CHECK(same_bits(light_of(environment), (*expected->latlong())->pixels()));

        OwnedEnvironment none;
        const auto refused = [&] { return said(domelight_environment_open(files, 1, &options, none.place())); };
        options.latlong = "mercator";
        CHECK(refused().starts_with("`latlong`: "));
        options.latlong = nullptr, options.negatives = "ignore";
        CHECK(refused().starts_with("`negatives`: "));
        options.negatives = nullptr, options.exposure = 65;
        CHECK(refused() == "`exposure`: exposure must lie between -64 and 64 stops");
        options.exposure = 0, options.max_bytes = 0;
        CHECK(refused() == "`max_bytes`: 0 is not above 0");
        CHECK(none.handle == nullptr);
    }

    TEST_CASE("c: files that are missing, broken or empty are refused by name") {
        const TemporaryFolder folder;
        const std::string missing = (folder / "none.hdr").string();
        const char* files[] = {missing.c_str()};
        OwnedEnvironment none;
        CHECK(said(domelight_environment_open(files, 1, nullptr, none.place())) == missing + ": no such file");
        CHECK(said(domelight_environment_open(files, 0, nullptr, none.place())).starts_with("0 files"));
        REQUIRE(write_hdr(folder / "a.hdr", test_latlong(16)));
        REQUIRE(write_exr(folder / "a.exr", test_latlong(16)));
        for (const char* name : {"a.hdr", "a.exr"}) {
            auto bytes = bytes_of(folder / name);
            for (const std::size_t size : {std::size_t(1), std::size_t(40), bytes.size() / 2, bytes.size() - 1}) {
                CAPTURE(name);
                CAPTURE(size);
                OwnedEnvironment environment;
                const std::string text =
                    said(domelight_environment_open_memory(bytes.data(), size, "broken", nullptr, environment.place()));
                // Broken rows are found when they are read.
                OwnedImage image;
                const std::string read =
                    environment ? said(domelight_environment_latlong(environment, image.place())) : text;
                CHECK(read.find("broken") != std::string::npos);
            }
        }
        CHECK(said(domelight_environment_open_memory("", 0, nullptr, nullptr, none.place())) ==
              "memory: there are no bytes");
        const std::string gltf =
            R"({"asset": {"version": "2.0"}, "extensionsUsed": ["EXT_lights_image_based"], "images": [{"uri": "a.png"}],
            "extensions": {"EXT_lights_image_based": {"lights": [{"specularImageSize": 1, "irradianceCoefficients": [[1,1,1],[1,1,1],[1,1,1],[1,1,1],
            [1,1,1],[1,1,1],[1,1,1],[1,1,1],[1,1,1]], "specularImages": [[0,0,0,0,0,0]]}]}}})";
        CHECK(said(domelight_environment_open_memory(gltf.data(), gltf.size(), "sky.gltf", nullptr, none.place())) ==
              "sky.gltf: level 0, face 0: names the file a.png, but is itself in memory\n"
              "       Give the path of the glTF file, or one that contains its pictures.");
        CHECK(none.handle == nullptr);
    }

    TEST_CASE("c: textures as files, written and in memory, are those of C++") {
        const TemporaryFolder folder;
        TestEnvironment environment;
        const auto levels = chain(8, 4);
        domelight_prefilter_options options;
        domelight_prefilter_options_init(&options);
        options.levels = levels.data();
        options.level_count = levels.size();
        options.sh_bands = 3;
        OwnedFiltered filtered;
        CHECK_DONE(domelight_prefilter(environment, &options, filtered.place()));
        FilterOptions same;
        for (const domelight_level& level : levels)
            same.specular.push_back(glossy_level_spec(Lobe::ggx, level.size, level.roughness));
        const auto maps = prefilter(Environment::from_latlong(test_latlong(32)), same);

        const auto check = [&](const char* encoding, const char* format, const char* packing,
                               const TexelBytes& expected) {
            CAPTURE(format);
            domelight_encode_options encode;
            domelight_encode_options_init(&encode);
            encode.encoding = encoding;
            OwnedTexture texture;
            CHECK_DONE(domelight_encode_filtered(filtered, &encode, texture.place()));
            CHECK_DONE(domelight_texture_set_metadata(texture, "note", "of a test"));
            CHECK_DONE(domelight_texture_set_metadata(texture, "other", "x"));
            CHECK_DONE(domelight_texture_set_metadata(texture, "other", nullptr));
            Owned<domelight_bytes, domelight_bytes_free> bytes;
            CHECK_DONE(domelight_texture_file(texture, format, packing, bytes.place()));
            std::size_t size = 0;
            const void* data = domelight_bytes_data(bytes, &size);
            CHECK(size == expected.size());
            CHECK(std::memcmp(data, expected.data(), std::min(size, expected.size())) == 0);
            const std::string file = (folder / "out").string();
            CHECK_DONE(domelight_texture_write(texture, file.c_str(), format, packing));
            const auto written = bytes_of(file);
            CHECK(std::equal(written.begin(), written.end(), expected.begin(), expected.end()));
            // The same of its texels alone.
            OwnedTexture copy;
            copy_texels(texture, encoding, copy.place());
            CHECK_DONE(domelight_texture_set_metadata(copy, "note", "of a test"));
            Owned<domelight_bytes, domelight_bytes_free> again;
            CHECK_DONE(domelight_texture_file(copy, format, packing, again.place()));
            data = domelight_bytes_data(again, &size);
            CHECK(size == expected.size());
            CHECK(std::memcmp(data, expected.data(), std::min(size, expected.size())) == 0);
        };
        Texture texture = encode_texture(maps->specular, Encoding::rgba16f, 1);
        texture.metadata["note"] = "of a test";
        check("rgba16f", "ktx2", nullptr, *ktx2_bytes(texture));
        check("rgba16f", "ktx2", "zstd", *ktx2_bytes(texture, Supercompression::zstd));
        check("rgba16f", "ktx1", "none", *ktx1_bytes(texture));
        check("rgba16f", "dds", nullptr, *dds_bytes(texture));
        check("rgba16f", "dds9", nullptr, *dds9_bytes(texture));
        // The forms with files write what the forms in memory return.
        REQUIRE(write_ktx2(folder / "a.ktx2", texture, Supercompression::zstd));
        const auto written = bytes_of(folder / "a.ktx2");
        const auto in_memory = *ktx2_bytes(texture, Supercompression::zstd);
        CHECK(std::equal(written.begin(), written.end(), in_memory.begin(), in_memory.end()));

        OwnedTexture half;
        CHECK_DONE(domelight_encode_filtered(filtered, nullptr, half.place()));
        Owned<domelight_bytes, domelight_bytes_free> none;
        CHECK(said(domelight_texture_file(half, "png", nullptr, none.place())).starts_with("`format`: "));
        CHECK(said(domelight_texture_file(half, "dds", "zstd", none.place())).starts_with("`supercompression`: "));
        CHECK(said(domelight_texture_file(half, "env", nullptr, none.place())) ==
              "a .env file holds rgbd, not rgba16f");
        CHECK(
            said(domelight_texture_write(half, "a.png", nullptr, nullptr)).starts_with("a.png: does not end in .ktx2"));
        CHECK(
            said(domelight_texture_write(half, "/nowhere/a.ktx2", nullptr, nullptr)).starts_with("/nowhere/a.ktx2: "));
    }

    TEST_CASE("c: texels that are no texture's are refused") {
        domelight_texture_info info{};
        info.struct_size = sizeof info;
        info.width = info.height = 4;
        info.faces = info.levels = 1;
        const std::vector<std::uint8_t> bytes(4 * 4 * 8);
        const void* levels[] = {bytes.data(), bytes.data()};
        std::size_t sizes[] = {bytes.size(), bytes.size()};
        OwnedTexture texture;
        const auto made = [&](const char* encoding) {
            return domelight_texture_from_levels(&info, encoding, levels, sizes, texture.place());
        };
        CHECK_DONE(made(nullptr));
        CHECK(said(made("rgba32f")) == "`levels`: level 0 has 128 bytes, not 256");
        CHECK(said(made("rgba64f")).starts_with("`encoding`: "));
        info.levels = 2;
        CHECK(said(made(nullptr)) == "`levels`: level 1 has 128 bytes, not 32");
        info.levels = 4;
        CHECK(said(made(nullptr)) == "`levels`: 4 is not from 1 to 3");
        info.levels = 1, info.faces = 2;
        CHECK(said(made(nullptr)) == "`faces`: 2 is neither 1 nor 6");
        info.faces = 1, info.width = 0;
        CHECK(said(made(nullptr)).starts_with("`width`: 0 is not from 1 to "));
        info.width = 4, levels[0] = nullptr;
        CHECK(said(made(nullptr)).starts_with("`levels`"));
        const double sh[3] = {1, 1, 1};
        CHECK_DONE(domelight_texture_set_sh(texture, sh, 1));
        CHECK(said(domelight_texture_set_sh(texture, sh, 65)) == "`bands`: 65 is not from 0 to 64");
        CHECK(said(domelight_texture_set_sh(texture, nullptr, 1)).starts_with("`rgb`"));
    }

    TEST_CASE("c: a .env file holds the light where Babylon reads it") {
        const TemporaryFolder folder;
        TestEnvironment environment;
        const auto levels = chain(8, 4);
        domelight_prefilter_options options;
        domelight_prefilter_options_init(&options);
        options.levels = levels.data();
        options.level_count = levels.size();
        options.sh_bands = 3;
        OwnedFiltered filtered;
        CHECK_DONE(domelight_prefilter(environment, &options, filtered.place()));
        domelight_encode_options encode;
        domelight_encode_options_init(&encode);
        encode.encoding = "rgbd";
        OwnedTexture texture;
        CHECK_DONE(domelight_encode_filtered(filtered, &encode, texture.place()));
        const std::string file = (folder / "a.env").string();
        CHECK_DONE(domelight_texture_write(texture, file.c_str(), nullptr, nullptr));
        // open_environment turns Babylon's world into ours.
        const auto back = open_environment({file});
        REQUIRE(back);
        domelight_pixels map;
        domelight_pixels_init(&map);
        CHECK_DONE(domelight_filtered_level(filtered, 0, &map));
        const auto stored = back->cube()->pixels();
        REQUIRE(stored.size() == floats_of(map).size());
        for (std::size_t i = 0; i < stored.size(); ++i) {
            const float value = floats_of(map)[i];
            if (value < 100) CHECK(stored[i] == doctest::Approx(value).epsilon(0.05).scale(1));
        }
        const auto env = read_env(file);
        REQUIRE(env);
        CHECK(env->irradiance.has_value());

        // Of the texels alone and their harmonics the same file.
        OwnedTexture copy;
        copy_texels(texture, "rgbd", copy.place());
        CHECK_DONE(domelight_texture_set_sh(copy, domelight_filtered_sh(filtered, nullptr), 3));
        const std::string same = (folder / "b.env").string();
        CHECK_DONE(domelight_texture_write(copy, same.c_str(), nullptr, nullptr));
        CHECK(bytes_of(same) == bytes_of(file));
    }

    TEST_CASE("c: a conversion and its file are those of C++") {
        const TemporaryFolder folder;
        TestEnvironment environment;
        domelight_convert_options options;
        domelight_convert_options_init(&options);
        options.to = "cube";
        options.height = 12;
        OwnedImage image;
        CHECK_DONE(domelight_convert(environment, &options, image.place()));
        domelight_pixels pixels;
        domelight_pixels_init(&pixels);
        CHECK_DONE(domelight_image_pixels(image, &pixels));
        CHECK(pixels.faces == 6);
        ConvertOptions same;
        same.width = same.height = 12;
        const auto expected = convert(Environment::from_latlong(test_latlong(32)), *projection_from_name("cube"), same);
        CHECK(same_bits(floats_of(pixels), expected->image.pixels.pixels()));
        const std::string file = (folder / "a.exr").string();
        CHECK_DONE(domelight_pixels_write(&pixels, file.c_str()));
        const char* files[] = {file.c_str()};
        OwnedEnvironment back;
        CHECK_DONE(domelight_environment_open(files, 1, nullptr, back.place()));
        OwnedImage none;
        options.to = "mercator";
        CHECK(said(domelight_convert(environment, &options, none.place())).starts_with("`to`: "));
        options.to = nullptr, options.height = 1 << 20;
        CHECK(said(domelight_convert(environment, &options, none.place())).starts_with("`height`: "));
        options.height = INT32_MAX;
        CHECK(said(domelight_convert(environment, &options, none.place()))
                  .starts_with("`height`: 2147483647 is not from 0 to "));
        CHECK(said(domelight_pixels_write(&pixels, "a.png")) == "a.png: does not end in .exr or .hdr");
    }

    TEST_CASE("c: a bake writes the files of C++") {
        const TemporaryFolder folder;
        REQUIRE(write_hdr(folder / "sky.hdr", test_latlong(32)));
        const std::string file = (folder / "sky.hdr").string();
        const char* files[] = {file.c_str()};
        OwnedEnvironment environment;
        CHECK_DONE(domelight_environment_open(files, 1, nullptr, environment.place()));
        domelight_bake_options options;
        domelight_bake_options_init(&options);
        options.engines = "three, filament";
        options.size = 16;
        options.levels = 2;
        options.preview = 0;
        CHECK_DONE(domelight_bake(environment, &options, (folder / "c").string().c_str()));
        BakeOptions same;
        same.engines = {"three", "filament"};
        same.size = 16, same.levels = 2, same.preview = false;
        REQUIRE(bake(*open_environment({file}), same, folder / "cpp"));
        int count = 0;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(folder / "cpp")) {
            if (!entry.is_regular_file()) continue;
            const auto other = folder / "c" / std::filesystem::relative(entry.path(), folder / "cpp");
            CAPTURE(other.string());
            CHECK(bytes_of(other) == bytes_of(entry.path()));
            ++count;
        }
        CHECK(count > 6);
        const std::string place = (folder / "d").string();
        const auto refused = [&] { return said(domelight_bake(environment, &options, place.c_str())); };
        options.engines = "doom";
        CHECK(refused().starts_with("`engines`: "));
        options.engines = nullptr, options.size = -1;
        CHECK(refused() == "`size`: -1 is not from 1 to 16384");
        options.size = 0, options.lobe = "blinn";
        CHECK(refused().starts_with("`lobe`: "));
        options.lobe = nullptr, options.roughness_count = 2;
        CHECK(refused() == "`roughness`: is NULL");
        CHECK(!std::filesystem::exists(place));
    }

    TEST_CASE("c: pixels in memory can be baked") {
        const TemporaryFolder folder;
        TestEnvironment environment;
        domelight_bake_options options;
        domelight_bake_options_init(&options);
        options.size = 16;
        options.levels = 2;
        CHECK_DONE(domelight_bake(environment, &options, (folder / "out").string().c_str()));
        CHECK(std::filesystem::exists(folder / "out" / "manifest.json"));
    }
}
