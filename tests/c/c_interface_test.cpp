// The C interface returns the bits of the C++ library, and answers every wrong call with a sentence.
#include "domelight/base/version.h"
#include "domelight/domelight_c.h"
#include "domelight/filtering/brdf/brdf_table.h"
#include "domelight/filtering/harmonic/spherical_harmonics.h"
#include "domelight/filtering/prefilter.h"
#include "domelight/filtering/probe_filter.h"
#include "domelight/sampling/environment_sampler.h"
#include "domelight/sampling/light_extraction.h"
#include "domelight/sampling/sequences.h"
#include "domelight/texture/texture.h"

#include "c/owned.h"
#include "test.h"
#include "texture/texel/half.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>
#include <string>
#include <thread>
#include <vector>

using namespace domelight;
using namespace domelight::test;

TEST_SUITE("c") {
    TEST_CASE("c: versions are those of the headers") {
        CHECK(domelight_c_abi_version() == DOMELIGHT_C_ABI_VERSION);
        CHECK(std::string(domelight_version()) == version());
    }

    // A struct may get fields at its end, and k_first_size then keeps the size that it has here. On 64-bit systems.
    TEST_CASE("c: structs have the sizes of the first version of the interface") {
        if (sizeof(void*) != 8) return;
        CHECK(sizeof(domelight_pixels) == 40);
        CHECK(sizeof(domelight_environment_options) == 104);
        CHECK(sizeof(domelight_environment_info) == 120);
        CHECK(sizeof(domelight_level) == 40);
        CHECK(sizeof(domelight_prefilter_options) == 96);
        CHECK(sizeof(domelight_sampler_options) == 40);
        CHECK(sizeof(domelight_light_sample) == 36);
        CHECK(sizeof(domelight_light_samples) == 72);
        CHECK(sizeof(domelight_lights_options) == 48);
        CHECK(sizeof(domelight_light) == 160);
        CHECK(sizeof(domelight_encode_options) == 32);
        CHECK(sizeof(domelight_texture_info) == 32);
        CHECK(sizeof(domelight_encoding_report) == 40);
        CHECK(sizeof(domelight_convert_options) == 48);
        CHECK(sizeof(domelight_bake_options) == 176);
    }

    TEST_CASE("c: several threads may use one environment and one sampler") {
        TestEnvironment environment(64);
        OwnedSampler sampler;
        CHECK_DONE(domelight_sampler_build(environment, nullptr, sampler.place()));
        const auto levels = chain(16, 2);
        std::vector<std::vector<float>> results(4);
        std::vector<std::thread> threads;
        for (std::vector<float>& result : results)
            threads.emplace_back([&] {
                domelight_prefilter_options options;
                domelight_prefilter_options_init(&options);
                options.levels = levels.data();
                options.level_count = levels.size();
                domelight_filtered* filtered = nullptr;
                domelight_light_sample sample;
                domelight_pixels map;
                domelight_pixels_init(&map);
                const bool done = !domelight_sampler_sample(sampler, 1u << 30, 3u << 30, &sample) &&
                                  !domelight_prefilter(environment, &options, &filtered) &&
                                  !domelight_filtered_level(filtered, 1, &map);
                if (done) result.assign(floats_of(map).begin(), floats_of(map).end());
                if (done) result.push_back(sample.pdf);
                domelight_filtered_free(filtered);
            });
        for (std::thread& thread : threads) thread.join();
        CHECK(results[0].size() > 100);
        for (const auto& result : results) CHECK(result == results[0]);
    }

    TEST_CASE("c: prefilter, irradiance and harmonics have the bits of C++, for maps and for cubes") {
        const ImageF image = test_latlong(32);
        for (const bool cube : {false, true})
            for (const char* texels : {"centre", "read"}) {
                CAPTURE(cube);
                CAPTURE(texels);
                ImageF strip(24, 6 * 24, 3);
                std::copy_n(image.pixels().begin(), std::min(image.pixels().size(), strip.pixels().size()),
                            strip.pixels().begin());
                domelight_pixels pixels = pixels_of(cube ? strip : image);
                if (cube) pixels.faces = 6, pixels.height = 24;
                OwnedEnvironment environment;
                CHECK_DONE(domelight_environment_from_pixels(&pixels, nullptr, environment.place()));
                const auto levels = chain(32, 3);
                domelight_prefilter_options options;
                domelight_prefilter_options_init(&options);
                options.texels = texels;
                options.levels = levels.data();
                options.level_count = levels.size();
                options.irradiance_size = 8;
                options.sh_bands = 3;
                OwnedFiltered filtered;
                CHECK_DONE(domelight_prefilter(environment, &options, filtered.place()));

                FilterOptions same;
                same.specular = {{32, true, {}}, {16, false, ZonalKernel::ggx(0.5)}, {8, false, ZonalKernel::ggx(1)}};
                same.texels = *from_name<Texels>(texels);
                same.irradiance_size = 8;
                const Environment of_image =
                    cube ? Environment::from_cube(Cubemap(strip)) : Environment::from_latlong(image);
                const auto expected = prefilter(of_image, same);
                REQUIRE(expected);

                REQUIRE(domelight_filtered_level_count(filtered) == 3);
                domelight_pixels map;
                domelight_pixels_init(&map);
                for (std::size_t l = 0; l < 3; ++l) {
                    CHECK_DONE(domelight_filtered_level(filtered, l, &map));
                    CHECK(map.faces == 6);
                    CHECK(map.width == 32 >> l);
                    CHECK(same_bits(floats_of(map), expected->specular[l].pixels()));
                }
                CHECK_DONE(domelight_filtered_irradiance_over_pi(filtered, &map));
                CHECK(same_bits(floats_of(map), expected->irradiance_over_pi.pixels()));
                std::size_t count = 0;
                const double* sh = domelight_filtered_sh(filtered, &count);
                REQUIRE(count == 9);
                CHECK(std::memcmp(sh, expected->sh.data(), 9 * sizeof(Vec3d)) == 0);
                double mean[3];
                domelight_filtered_mean(filtered, mean);
                CHECK(std::memcmp(mean, &expected->mean, sizeof mean) == 0);
            }
    }

    TEST_CASE("c: irradiance alone is E, harmonics alone are of the quantity and with the window") {
        TestEnvironment environment;
        FilterOptions options;
        options.irradiance_size = 8;
        const auto expected = prefilter(Environment::from_latlong(test_latlong(32)), options);
        OwnedImage image;
        CHECK_DONE(domelight_irradiance(environment, "cube", 8, 1, image.place()));
        domelight_pixels pixels;
        domelight_pixels_init(&pixels);
        CHECK_DONE(domelight_image_pixels(image, &pixels));
        CHECK(pixels.faces == 6);
        for (std::size_t i = 0; i < floats_of(pixels).size(); ++i)
            REQUIRE(floats_of(pixels)[i] == float(expected->irradiance_over_pi.pixels()[i] * k_pi));

        double sh[27];
        CHECK_DONE(domelight_spherical_harmonics(environment, 3, "irradiance", "hann", 1, sh));
        options.irradiance_size = 0;
        std::vector<Vec3d> windowed = prefilter(Environment::from_latlong(test_latlong(32)), options)->sh;
        sh_window(windowed, ShWindow::hann);
        const auto over_pi = sh_irradiance_over_pi(windowed);
        for (int i = 0; i < 9; ++i) CHECK(sh[3 * i] == over_pi[i].x * k_pi);
    }

    TEST_CASE("c: light in single directions is that of C++") {
        TestEnvironment environment;
        auto levels = chain(1, 2);
        levels.erase(levels.begin());
        domelight_prefilter_options options;
        domelight_prefilter_options_init(&options);
        options.levels = levels.data();
        options.level_count = 1;
        const double directions[] = {0, 1, 0, 3, -1, 2};
        options.directions = directions;
        options.direction_count = 2;
        levels[0].size = 0;
        CHECK(said(domelight_prefilter(environment, &options, nullptr)) == "`filtered`: is NULL");
        levels[0].size = 1;
        OwnedFiltered filtered;
        CHECK_DONE(domelight_prefilter(environment, &options, filtered.place()));
        domelight_pixels map;
        domelight_pixels_init(&map);
        CHECK_DONE(domelight_filtered_level(filtered, 0, &map));
        FilterOptions same;
        same.specular = {{1, false, ZonalKernel::ggx(1)}};
        same.directions = {{0, 1, 0}, {3, -1, 2}};
        const auto expected = prefilter(Environment::from_latlong(test_latlong(32)), same);
        CHECK(map.width == 2);
        CHECK(same_bits(floats_of(map), expected->specular[0].pixels()));
    }

    TEST_CASE("c: samples, lookups, tables and points have the bits of C++") {
        TestEnvironment environment;
        const Environment same = Environment::from_latlong(test_latlong(32));
        constexpr std::size_t count = 3000;
        std::vector<std::uint32_t> points(2 * count);
        CHECK_DONE(domelight_sequence_points("halton", 5, 10, count, 4096, points.data()));
        CHECK(points[2] == unit_point(Sequence::halton, 5, 11, 4096).x);
        std::vector<UnitPoint> own;
        for (std::size_t i = 0; i < count; ++i) own.push_back({points[2 * i], points[2 * i + 1]});
        for (const char* method : {"bilinear", "alias"}) {
            CAPTURE(method);
            domelight_sampler_options options;
            domelight_sampler_options_init(&options);
            options.method = method;
            options.uniform_share = 0.25;
            OwnedSampler sampler;
            CHECK_DONE(domelight_sampler_build(environment, &options, sampler.place()));
            EnvironmentSamplerOptions same_options;
            same_options.method = *from_name<DistributionMethod>(method);
            same_options.uniform_share = 0.25;
            const auto expected = EnvironmentSampler::build(same, same_options);

            std::vector<std::vector<float>> got(9, std::vector<float>(count)), wanted = got;
            const auto arrays = [](auto& a) {
                return domelight_light_samples{a[0].data(), a[1].data(), a[2].data(), a[3].data(), a[4].data(),
                                               a[5].data(), a[6].data(), a[7].data(), a[8].data()};
            };
            domelight_light_samples samples = arrays(got);
            const LightSampleSpans spans{wanted[0], wanted[1], wanted[2], wanted[3], wanted[4],
                                         wanted[5], wanted[6], wanted[7], wanted[8]};
            CHECK_DONE(domelight_sampler_sample_many(sampler, points.data(), count, &samples));
            expected->sample(own, spans);
            CHECK(got == wanted);

            // Only some of the arrays.
            std::vector<float> pdf(count);
            domelight_light_samples only{};
            only.pdf = pdf.data();
            CHECK_DONE(domelight_sampler_sample_many(sampler, points.data(), count, &only));
            CHECK(pdf == wanted[8]);

            CHECK_DONE(domelight_sampler_look_up_many(sampler, count, &samples));
            expected->look_up(spans);
            CHECK(got == wanted);

            domelight_light_sample one;
            CHECK_DONE(domelight_sampler_sample(sampler, points[8], points[9], &one));
            const LightSample single = expected->sample(own[4]);
            CHECK(one.pdf == single.pdf_solid_angle);
            CHECK(one.direction[1] == single.direction.y);
            CHECK(one.radiance[2] == single.radiance.z);
            CHECK_DONE(domelight_sampler_look_up(sampler, one.direction, &one));
            CHECK(one.pdf == expected->look_up(single.direction).pdf_solid_angle);
        }
        OwnedImage table;
        CHECK_DONE(domelight_brdf_table(16, "smith", 1, table.place()));
        domelight_pixels pixels;
        domelight_pixels_init(&pixels);
        CHECK_DONE(domelight_image_pixels(table, &pixels));
        CHECK(same_bits(floats_of(pixels), brdf_table({16, BrdfG::smith, 1}).pixels()));
    }

    TEST_CASE("c: pixels may be half floats, have a fourth channel and gaps between rows") {
        const ImageF image = test_latlong(16);
        const int stride = 4 * image.width() + 5;
        std::vector<std::uint16_t> halves(std::size_t(stride) * image.height(), 0x7e00);  // NaN in the gaps
        ImageF rounded(image.width(), image.height(), 3);
        for (int y = 0; y < image.height(); ++y)
            for (int x = 0; x < image.width(); ++x)
                for (int c = 0; c < 3; ++c) {
                    halves[std::size_t(y * stride + 4 * x + c)] = half_from_float(image.at(x, y)[c]);
                    rounded.at(x, y)[c] = float_from_half(half_from_float(image.at(x, y)[c]));
                }
        domelight_pixels pixels = pixels_of(image);
        pixels.data = halves.data();
        pixels.bits = 16;
        pixels.channels = 4;
        pixels.row_stride = stride;
        OwnedEnvironment environment;
        CHECK_DONE(domelight_environment_from_pixels(&pixels, nullptr, environment.place()));
        OwnedImage latlong;
        CHECK_DONE(domelight_environment_latlong(environment, latlong.place()));
        domelight_pixels back;
        domelight_pixels_init(&back);
        CHECK_DONE(domelight_image_pixels(latlong, &back));
        CHECK(same_bits(floats_of(back), rounded.pixels()));
    }

    TEST_CASE("c: a turn of the light, the facts and the radiance of an environment") {
        const ImageF image = test_latlong(16);
        const domelight_pixels pixels = pixels_of(image);
        const double quarter[9] = {0, 0, 1, 0, 1, 0, -1, 0, 0};
        OwnedEnvironment environment;
        CHECK_DONE(domelight_environment_from_pixels(&pixels, quarter, environment.place()));
        domelight_environment_info info{};
        info.struct_size = sizeof info;
        CHECK_DONE(domelight_environment_get_info(environment, &info));
        CHECK(info.struct_size == sizeof info);
        CHECK(info.width == 32);
        CHECK(info.latlong_height == 16);
        CHECK(std::string(info.projection) == "latlong");
        CHECK(std::equal(quarter, quarter + 9, info.world_to_source));
        float rgb[3];
        const double direction[3] = {0.1, 0.2, 0.9};
        CHECK_DONE(domelight_environment_radiance(environment, direction, rgb));
        const Mat3 turn{{Vec3d{0, 0, 1}, Vec3d{0, 1, 0}, Vec3d{-1, 0, 0}}};
        CHECK(rgb[0] == Environment::from_latlong(image, turn).radiance({0.1, 0.2, 0.9})->x);
        CHECK(domelight_environment_warning_count(environment) == 0);
        CHECK(std::string(domelight_environment_warning(environment, 7)) == "");
    }

    TEST_CASE("c: lights are those of C++, and the remainder is an environment without them") {
        TestEnvironment environment(64);
        domelight_lights_options options;
        domelight_lights_options_init(&options);
        CHECK(options.least_share == LightExtractionOptions().least_share);
        options.least_share = 0.001;
        OwnedLights lights;
        CHECK_DONE(domelight_extract_lights(environment, &options, lights.place()));
        LightExtractionOptions same;
        same.least_share = 0.001;
        const auto expected = extract_lights(test_latlong(64), same);
        REQUIRE(domelight_lights_count(lights) == expected->lights.size());
        REQUIRE(domelight_lights_count(lights) > 0);
        domelight_light light{};
        light.struct_size = sizeof light;
        CHECK_DONE(domelight_lights_get(lights, 0, &light));
        CHECK(light.direction[1] == expected->lights[0].direction.y);
        CHECK(light.irradiance[2] == expected->lights[0].irradiance.z);
        CHECK(light.texels == expected->lights[0].texels);
        CHECK(said(domelight_lights_get(lights, 99, &light)).starts_with("`index`: 99 is not below"));
        OwnedEnvironment rest;
        CHECK_DONE(domelight_lights_remainder(lights, rest.place()));
        OwnedImage image;
        CHECK_DONE(domelight_environment_latlong(rest, image.place()));
        domelight_pixels pixels;
        domelight_pixels_init(&pixels);
        CHECK_DONE(domelight_image_pixels(image, &pixels));
        CHECK(same_bits(floats_of(pixels), expected->remainder.pixels()));
        options.merge_deg = 31;
        OwnedLights none;
        CHECK(said(domelight_extract_lights(environment, &options, none.place())) ==
              "`merge_deg`: 31 is not from 0 to 30");
    }

    TEST_CASE("c: a probe filter gives the levels of C++, and refuses other cubes") {
        std::vector<float> values(6 * 32 * 32 * 3);
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = float(i * 7919 % 1000) / 500;
        domelight_pixels cube;
        domelight_pixels_init(&cube);
        cube.data = values.data(), cube.width = cube.height = 32, cube.faces = 6, cube.channels = 3;
        const auto levels = chain(32, 3);
        domelight_prefilter_options options;
        domelight_prefilter_options_init(&options);
        options.levels = levels.data(), options.level_count = levels.size();
        OwnedProbeFilter filter;
        CHECK_DONE(domelight_probe_filter_make(32, &options, filter.place()));
        FilterOptions same;
        same.specular = {{32, true, {}}, {16, false, ZonalKernel::ggx(0.5)}, {8, false, ZonalKernel::ggx(1)}};
        same.sh_bands = 0;
        Cubemap copy(32);
        std::copy(values.begin(), values.end(), copy.pixels().begin());
        const auto expected = ProbeFilter::make(32, same)->filter(copy);
        OwnedFiltered filtered;
        CHECK_DONE(domelight_probe_filter_filter(filter, &cube, filtered.place()));
        for (std::size_t l = 0; l < 3; ++l) {
            domelight_pixels level;
            domelight_pixels_init(&level);
            CHECK_DONE(domelight_filtered_level(filtered, l, &level));
            CHECK(same_bits(floats_of(level), expected->specular[l].pixels()));
        }
        OwnedFiltered none;
        cube.faces = 1;
        CHECK(said(domelight_probe_filter_filter(filter, &cube, none.place())) == "`cube`: 1 faces, expected 6");
        values[5] = std::numeric_limits<float>::quiet_NaN(), cube.faces = 6;
        CHECK(!said(domelight_probe_filter_filter(filter, &cube, none.place())).empty());
        OwnedProbeFilter small;
        CHECK(said(domelight_probe_filter_make(8, &options, small.place())) == "`size`: 8 is not in 16 to 256");
    }

    TEST_CASE("c: encoded texels are those of C++") {
        TestEnvironment environment;
        const auto levels = chain(32, 3);
        domelight_prefilter_options options;
        domelight_prefilter_options_init(&options);
        options.levels = levels.data();
        options.level_count = levels.size();
        OwnedFiltered filtered;
        CHECK_DONE(domelight_prefilter(environment, &options, filtered.place()));
        FilterOptions same;
        same.specular = {{32, true, {}}, {16, false, ZonalKernel::ggx(0.5)}, {8, false, ZonalKernel::ggx(1)}};
        const auto maps = prefilter(Environment::from_latlong(test_latlong(32)), same);
        std::vector<domelight_pixels> pixels(3);
        for (std::size_t l = 0; l < 3; ++l) {
            domelight_pixels_init(&pixels[l]);
            CHECK_DONE(domelight_filtered_level(filtered, l, &pixels[l]));
        }
        for (const char* encoding : {"rgba16f", "rgb9e5", "rgbd", "bc6h"}) {
            CAPTURE(encoding);
            domelight_encode_options encode;
            domelight_encode_options_init(&encode);
            encode.encoding = encoding;
            OwnedTexture texture, from_pixels;
            CHECK_DONE(domelight_encode_filtered(filtered, &encode, texture.place()));
            CHECK_DONE(domelight_encode(pixels.data(), 3, &encode, from_pixels.place()));
            const Texture expected = encode_texture(maps->specular, *from_name<Encoding>(encoding), 1);
            for (const domelight_texture* t : {texture.handle, from_pixels.handle})
                for (std::size_t l = 0; l < 3; ++l) {
                    const void* bytes = nullptr;
                    std::size_t size = 0;
                    CHECK_DONE(domelight_texture_level(t, l, &bytes, &size));
                    REQUIRE(size == expected.levels[l].size());
                    CHECK(std::memcmp(bytes, expected.levels[l].data(), size) == 0);
                }
            domelight_encoding_report report{};
            report.struct_size = sizeof report;
            CHECK_DONE(domelight_texture_report(texture, 0, &report));
            CHECK(report.rms_error > 0);
        }
        OwnedTexture none;
        CHECK(said(domelight_encode(pixels.data() + 1, 0, nullptr, none.place())) == "`levels`: there are none");
        std::swap(pixels[0], pixels[2]);
        CHECK(said(domelight_encode(pixels.data(), 2, nullptr, none.place())) ==
              "`levels`: level 1 is 16 x 16, not 4 x 4, half of the level before");
    }

    TEST_CASE("c: wrong calls are answered with a sentence, and nothing is made") {
        TestEnvironment environment;
        OwnedEnvironment made;
        OwnedFiltered filtered;
        OwnedSampler sampler;
        OwnedImage image;
        ImageF radiance = test_latlong(8);
        domelight_pixels pixels = pixels_of(radiance);

        SUBCASE("pointers that are null") {
            CHECK(said(domelight_environment_from_pixels(nullptr, nullptr, made.place())) == "`pixels`: is NULL");
            CHECK(said(domelight_environment_from_pixels(&pixels, nullptr, nullptr)) == "`environment`: is NULL");
            CHECK(said(domelight_prefilter(environment, nullptr, filtered.place())) == "`options`: is NULL");
            CHECK(said(domelight_sampler_build(nullptr, nullptr, sampler.place())) == "`environment`: is NULL");
            CHECK(said(domelight_brdf_table(8, nullptr, 0, nullptr)) == "`image`: is NULL");
            CHECK(said(domelight_sampler_sample(nullptr, 0, 0, nullptr)) == "`sampler`: is NULL");
            pixels.data = nullptr;
            CHECK(said(domelight_environment_from_pixels(&pixels, nullptr, made.place())) == "`data`: is NULL");
            domelight_environment_free(nullptr);
            domelight_filtered_free(nullptr);
            domelight_error_free(nullptr);
            CHECK(domelight_filtered_level_count(nullptr) == 0);
            CHECK(domelight_filtered_sh(nullptr, nullptr) == nullptr);
            CHECK(std::string(domelight_error_text(nullptr)) == "");
            domelight_pixels_init_sized(nullptr, 100);
        }
        SUBCASE("a struct_size that cannot be") {
            pixels.struct_size = 0;
            const std::string text = said(domelight_environment_from_pixels(&pixels, nullptr, made.place()));
            CHECK(text.starts_with("`struct_size`: 0 is not from 40 to 65536\n"));
            pixels.struct_size = std::size_t(-1);
            CHECK(said(domelight_environment_from_pixels(&pixels, nullptr, made.place()))
                      .starts_with("`struct_size`: 18446744073709551615"));
        }
        SUBCASE("a struct of a newer interface") {
            struct Newer {
                domelight_pixels known;
                std::int64_t unknown;
            } newer;
            domelight_pixels_init_sized(&newer.known, sizeof newer);
            CHECK(newer.unknown == 0);
            newer.known.data = pixels.data;
            newer.known.width = pixels.width;
            newer.known.height = pixels.height;
            CHECK_DONE(domelight_environment_from_pixels(&newer.known, nullptr, made.place()));
            newer.unknown = 1;
            OwnedEnvironment other;
            CHECK(said(domelight_environment_from_pixels(&newer.known, nullptr, other.place())) ==
                  "`struct_size`: byte 40 of the struct is set, but this version of the library knows 40 bytes\n"
                  "       The program needs a newer library.");
        }
        SUBCASE("pixels of a shape that does not exist") {
            const auto refused = [&] {
                return said(domelight_environment_from_pixels(&pixels, nullptr, made.place()));
            };
            pixels.width = 0;
            CHECK(refused() == "`width`: 0 is not from 1 to 65536");
            pixels = pixels_of(radiance), pixels.channels = 2;
            CHECK(refused() == "`channels`: 2 is not 3 or 4");
            pixels = pixels_of(radiance), pixels.bits = 8;
            CHECK(refused() == "`bits`: 8 is not 16 or 32");
            pixels = pixels_of(radiance), pixels.faces = 6;
            CHECK(refused() == "`height`: a face is 16 x 8, but the faces of a cube are square");
            pixels = pixels_of(radiance), pixels.faces = 2;
            CHECK(refused() == "`faces`: 2 is not 1 or 6");
            pixels = pixels_of(radiance), pixels.row_stride = 47;
            CHECK(refused().starts_with("`row_stride`: 47 is less than the 48 channels of a row"));
        }
        SUBCASE("values that are no radiance") {
            radiance.at(5, 3)[1] = std::numeric_limits<float>::quiet_NaN();
            CHECK(said(domelight_environment_from_pixels(&pixels, nullptr, made.place()))
                      .starts_with("texel (5, 3) is ("));
            radiance.at(5, 3)[1] = -1;
            CHECK(said(domelight_environment_from_pixels(&pixels, nullptr, made.place()))
                      .starts_with("texel (5, 3) is ("));
            ImageF strip(4, 24, 3, 1.f);
            strip.at(2, 4 * 4 + 1)[0] = std::numeric_limits<float>::infinity();
            domelight_pixels cube = pixels_of(strip);
            cube.faces = 6, cube.height = 4;
            CHECK(said(domelight_environment_from_pixels(&cube, nullptr, made.place()))
                      .starts_with("face 4: texel (2, 1) is (inf, 1, 1)"));
        }
        SUBCASE("a matrix that is not orthogonal") {
            const double stretched[9] = {2, 0, 0, 0, 1, 0, 0, 0, 1};
            CHECK(said(domelight_environment_from_pixels(&pixels, stretched, made.place()))
                      .starts_with("`world_to_source`: is not an orthogonal matrix"));
        }
        SUBCASE("levels and options out of range") {
            auto levels = chain(8, 2);
            domelight_prefilter_options options;
            domelight_prefilter_options_init(&options);
            options.level_count = 2;
            const auto refused = [&] { return said(domelight_prefilter(environment, &options, filtered.place())); };
            CHECK(refused() == "`levels`: is NULL");
            options.levels = levels.data();
            levels[1].size = 0;
            CHECK(refused() == "`size`: level 1: 0 is not from 1 to 16384");
            levels[1].size = 4, levels[1].roughness = 1.5;
            CHECK(refused() == "`roughness`: level 1: 1.5 is not from 0 to 1");
            levels[1].lobe = "phong", levels[1].exponent = -2;
            CHECK(refused() == "`exponent`: level 1: -2 is not 0 or more");
            levels[1].lobe = "beckmann";
            CHECK(refused().find("ggx") != std::string::npos);
            levels[1] = levels[0];
            options.layout = "torus";
            CHECK(refused().starts_with("`layout`: "));
            options.layout = "latlong";
            options.irradiance_size = 5000;
            CHECK(refused() == "`irradiance_size`: 5000 is not from 0 to 4096");
            options.irradiance_size = 0, options.sh_bands = 65;
            CHECK(refused() == "`sh_bands`: 65 is not from 0 to 64");
            options.sh_bands = 0, options.threads = -1;
            CHECK(refused() == "`threads`: -1 is not from 0 to 1024");
            options.threads = 1;
            const double nowhere[3] = {0, 0, 0};
            options.directions = nowhere, options.direction_count = 1;
            CHECK(refused().starts_with("`directions`: "));
        }
        SUBCASE("samplers and tables") {
            domelight_sampler_options options;
            domelight_sampler_options_init(&options);
            options.uniform_share = 1.5;
            CHECK(said(domelight_sampler_build(environment, &options, sampler.place())) ==
                  "`uniform_share`: 1.5 is not from 0 to 1");
            options.uniform_share = 0, options.method = "dice";
            CHECK(said(domelight_sampler_build(environment, &options, sampler.place())).find("bilinear") !=
                  std::string::npos);
            CHECK(said(domelight_brdf_table(0, nullptr, 0, image.place())) == "`size`: 0 is not from 1 to 4096");
            CHECK(said(domelight_irradiance(environment, nullptr, 5000, 0, image.place())) ==
                  "`size`: 5000 is not from 1 to 4096");
            double sh[3];
            CHECK(said(domelight_spherical_harmonics(environment, 0, nullptr, nullptr, 0, sh)) ==
                  "`bands`: 0 is not from 1 to 64");
            CHECK(said(domelight_sequence_points(nullptr, 0, 0, 1, 0, nullptr)) == "`total`: 0 is not from 1 to 2^31");
        }
        CHECK(filtered.handle == nullptr);
        CHECK(sampler.handle == nullptr);
        CHECK(image.handle == nullptr);
    }

    TEST_CASE("c: progress is told, and may cancel") {
        TestEnvironment environment(128);
        const auto levels = chain(32, 3);
        domelight_prefilter_options options;
        domelight_prefilter_options_init(&options);
        options.levels = levels.data();
        options.level_count = levels.size();
        struct Told {
            int calls = 0, most = 1 << 30;
            double last = 0;
            std::string stage;
        } told;
        options.progress = [](void* data, const char* stage, double done) -> std::int32_t {
            Told& t = *static_cast<Told*>(data);
            t.stage = stage, t.last = done;
            return ++t.calls >= t.most;
        };
        options.progress_data = &told;
        OwnedFiltered filtered;
        CHECK_DONE(domelight_prefilter(environment, &options, filtered.place()));
        CHECK(told.calls > 2);
        CHECK(told.stage == "filter");
        told = {0, 2, 0, ""};
        OwnedFiltered cancelled;
        domelight_error* error = domelight_prefilter(environment, &options, cancelled.place());
        REQUIRE(error);
        CHECK(domelight_error_is_cancelled(error) == 1);
        CHECK(std::string(domelight_error_message(error)) == "cancelled");
        CHECK(std::string(domelight_error_where(error)) == "");
        CHECK(std::string(domelight_error_hint(error)) == "");
        domelight_error_free(error);
        CHECK(told.calls == 2);
        CHECK(cancelled.handle == nullptr);
    }
}
