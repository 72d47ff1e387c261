#include "domelight/engines/engine.h"

#include "domelight/io/environment/open_environment.h"

#include "bake/plan.h"
#include "test.h"

#include <cmath>

using namespace domelight;

namespace {

EnginePlan plan_of(const char* name, BakeOptions options = {}) {
    options.engines = {name};
    const auto plans = plan_bake(options, nullptr);
    REQUIRE(plans);
    return plans->front();
}

/// Whether the centre of a stored lat-long map lies this many quarter turns to the right of the map's own.
bool moves_columns_by(const TexelOrder& order, int quarters) {
    FilteredMap map(Layout::latlong, ImageF(4, 2, 3));
    for (int x = 0; x < 4; ++x) map.image.at(x, 0)[0] = float(x);
    return order.apply(map).image.at(0, 0)[0] == float(quarters);
}

std::vector<int> sizes(const EnginePlan& plan) {
    std::vector<int> out;
    for (const LevelPlan& level : plan.specular) out.push_back(level.spec.size);
    return out;
}

}  // namespace

TEST_CASE(
    "engine: generic is a cube of 512^2 down to 16^2, each of 0.6 times the next one's roughness, half floats, "
    "irradiance E") {
    const EnginePlan plan = plan_of("generic");
    CHECK(sizes(plan) == std::vector{512, 256, 128, 64, 32, 16});
    const double roughness[] = {0, 0.1296, 0.216, 0.36, 0.6, 1};
    for (int l = 0; l < 6; ++l) {
        CHECK(plan.specular[l].roughness == doctest::Approx(roughness[l]));
        CHECK(plan.specular[l].alpha == doctest::Approx(roughness[l] * roughness[l]));
        CHECK(plan.specular[l].spec.mirror == (l == 0));
    }
    CHECK(plan.encoding == Encoding::rgba16f);
    CHECK(plan.container == Container::ktx2);
    CHECK(plan.engine->irradiance_quantity == Quantity::irradiance);
    CHECK(plan.engine->mirror == CubeMirror::none);
}

TEST_CASE("engine: a long chain of generic begins at roughness 0.08 and is geometric from there on") {
    const Engine& generic = engines().front();
    CHECK(generic.roughness(1, 2, 32) == 1);
    CHECK(generic.roughness(1, 7, 1024) == doctest::Approx(0.08));
    for (const int levels : {8, 11}) {
        CHECK(generic.roughness(0, levels, 1024) == 0);
        CHECK(generic.roughness(1, levels, 1024) == doctest::Approx(0.08));
        CHECK(generic.roughness(levels - 1, levels, 1024) == 1);
        const double ratio = generic.roughness(1, levels, 1024) / generic.roughness(2, levels, 1024);
        for (int l = 2; l + 1 < levels; ++l)
            CHECK(generic.roughness(l, levels, 1024) / generic.roughness(l + 1, levels, 1024) ==
                  doctest::Approx(ratio));
    }
}

TEST_CASE("engine: khronos is linear from 256^2 to 16^2 with Charlie beside GGX and E / pi") {
    const EnginePlan plan = plan_of("khronos");
    CHECK(sizes(plan) == std::vector{256, 128, 64, 32, 16});
    CHECK(plan.specular[2].roughness == 0.5);
    REQUIRE(plan.sheen.size() == 5);
    CHECK(plan.sheen[4].spec.kernel.lobe == Lobe::charlie);
    CHECK(plan.sheen[0].roughness == k_charlie_least_roughness);
    CHECK(plan.engine->irradiance_quantity == Quantity::irradiance_over_pi);
    CHECK(plan.brdf_form == BrdfForm::scale_bias_charlie);
}

TEST_CASE("engine: filament inverts its lookup level = (levels - 1) r (2 - r)") {
    const EnginePlan plan = plan_of("filament");
    CHECK(sizes(plan) == std::vector{256, 128, 64, 32, 16});
    for (int l = 0; l < 5; ++l) {
        const double r = plan.specular[l].roughness;
        CHECK(4 * r * (2 - r) == doctest::Approx(l));
    }
    CHECK(plan.specular[4].roughness == 1);
    CHECK(plan.encoding == Encoding::r11g11b10f);
    CHECK(plan.container == Container::ktx1);
}

TEST_CASE("engine: babylon inverts its lookup level = 0.8 log2(N alpha), every level down to 1^2") {
    const EnginePlan plan = plan_of("babylon");
    CHECK(sizes(plan) == std::vector{256, 128, 64, 32, 16, 8, 4, 2, 1});
    CHECK(plan.specular[0].spec.mirror);
    for (int l = 1; l < 7; ++l) CHECK(0.8 * std::log2(256 * plan.specular[l].alpha) == doctest::Approx(l));
    CHECK(plan.specular[7].alpha == 1);
    CHECK(plan.engine->mirror == CubeMirror::x);
}

TEST_CASE("engine: bevy is linear from 512^2 in RGB9E5 with zstd, diffuse 32^2 of E / pi, z negated") {
    const EnginePlan plan = plan_of("bevy");
    CHECK(plan.specular[0].spec.size == 512);
    CHECK(plan.specular[3].roughness == doctest::Approx(0.5));
    CHECK(plan.encoding == Encoding::rgb9e5);
    CHECK(plan.zstd);
    CHECK(plan.irradiance_size == 32);
    CHECK(plan.engine->irradiance_quantity == Quantity::irradiance_over_pi);
    CHECK(plan.engine->mirror == CubeMirror::z);
}

TEST_CASE("engine: three gets 512^2 to 8^2 in UASTC HDR with zstd, at its lookup level = 6 r (2 - r), x flipped") {
    const EnginePlan plan = plan_of("three");
    CHECK(sizes(plan) == std::vector{512, 256, 128, 64, 32, 16, 8});
    for (int l = 0; l < 7; ++l) {
        const double r = plan.specular[l].roughness;
        CHECK(6 * r * (2 - r) == doctest::Approx(l));
    }
    CHECK(plan.specular[0].spec.mirror);
    CHECK(plan.encoding == Encoding::uastc_hdr);
    CHECK(plan.container == Container::ktx2);
    CHECK(plan.zstd);
    CHECK(plan.engine->mirror == CubeMirror::x);
    CHECK(plan.engine->specular_file == "{stem}.pmrem");
    BakeOptions options;
    options.encoding = Encoding::rgba16f;
    CHECK(plan_of("three", options).encoding == Encoding::rgba16f);
}

TEST_CASE("engine: three-latlong gets one lat-long image four times as wide as the cube it makes") {
    const EnginePlan plan = plan_of("three-latlong");
    CHECK(plan.layout == Layout::latlong);
    CHECK(sizes(plan) == std::vector{1024});
    CHECK(plan.specular[0].spec.mirror);
    CHECK(plan.container == Container::exr);
}

TEST_CASE("engine: an unknown name lists the known ones") {
    const auto engine = find_engine("quake");
    REQUIRE_FALSE(engine);
    CHECK(engine.error().what.find(
              "generic, khronos, filament, babylon, bevy, three, three-latlong, playcanvas, gltf, godot, "
              "unity, unreal, blender, mitsuba, pbrt, usd, materialx") != std::string::npos);
    for (const Engine& e : engines()) CHECK(find_engine(e.name));
}

TEST_CASE("engine: babylon is a .env of RGBD") {
    const EnginePlan plan = plan_of("babylon");
    CHECK(plan.container == Container::env);
    CHECK(plan.encoding == Encoding::rgbd);
    BakeOptions options;
    options.format = Container::dds;
    CHECK(plan_of("babylon", options).encoding == Encoding::rgba16f);
}

TEST_CASE("engine: playcanvas is an atlas of lat-long maps whose level l shows roughness l / 5") {
    const EnginePlan plan = plan_of("playcanvas");
    CHECK(plan.layout == Layout::latlong);
    CHECK(moves_columns_by(plan.order, 1));
    CHECK(sizes(plan) == std::vector{512, 256, 128, 64, 32, 16, 8});
    for (int l = 0; l < 6; ++l) CHECK(plan.specular[l].roughness == doctest::Approx(l / 5.0));
    CHECK(plan.encoding == Encoding::rgbp);
}

TEST_CASE("engine: gltf maps its levels evenly to roughness, down to 16^2") {
    const EnginePlan plan = plan_of("gltf");
    CHECK(sizes(plan) == std::vector{256, 128, 64, 32, 16});
    CHECK(plan.specular[1].roughness == 0.25);
    CHECK(plan.engine->mirror == CubeMirror::none);
}

TEST_CASE("engine: unity inverts its lookup level = 6 r (1.7 - 0.7 r) of seven levels") {
    const EnginePlan plan = plan_of("unity");
    CHECK(sizes(plan) == std::vector{256, 128, 64, 32, 16, 8, 4});
    for (int l = 0; l < 7; ++l) {
        const double r = plan.specular[l].roughness;
        CHECK(6 * r * (1.7 - 0.7 * r) == doctest::Approx(l));
    }
    CHECK(plan.specular[6].roughness == doctest::Approx(1));
    CHECK(plan.panorama->height == 1024);
}

TEST_CASE("engine: unreal inverts its lookup level = last - 1 + 1.2 log2 r") {
    const EnginePlan plan = plan_of("unreal");
    REQUIRE(plan.specular.size() == 9);
    CHECK(plan.specular[0].spec.mirror);
    for (int l = 1; l < 8; ++l) CHECK(7 + 1.2 * std::log2(plan.specular[l].roughness) == doctest::Approx(l));
    CHECK(plan.specular[8].roughness == 1);
}

TEST_CASE("engine: materialx inverts its lookup, alpha < 1/4 ? sqrt(alpha) : alpha / 2 + 3/8") {
    const EnginePlan plan = plan_of("materialx");
    CHECK(plan.layout == Layout::latlong);
    CHECK(moves_columns_by(plan.order, 3));
    const int last = int(plan.specular.size()) - 1;
    REQUIRE(last == 6);  // 512 to 8
    for (int l = 0; l < last; ++l) {
        const double alpha = plan.specular[l].alpha;
        CHECK(last * (alpha < 0.25 ? std::sqrt(alpha) : alpha / 2 + 0.375) == doctest::Approx(l));
    }
    CHECK(plan.specular[last].alpha == 1);
    CHECK(plan.container == Container::exr_mip);
    CHECK(plan.engine->irradiance_quantity == Quantity::irradiance_over_pi);
}

TEST_CASE("plan: options override the engine, level by level") {
    BakeOptions options;
    options.size = 100;
    options.roughness = {0, 0.3, 1};
    const EnginePlan plan = plan_of("generic", options);
    CHECK(sizes(plan) == std::vector{100, 50, 25});
    CHECK(plan.specular[1].spec.kernel.width == doctest::Approx(0.09));

    options = {};
    options.layout = Layout::latlong;
    CHECK(sizes(plan_of("generic", options)).front() == 1024);  // as fine as a cube of 512^2
    CHECK(sizes(plan_of("generic", options)).size() == 7);      // to 16 rows

    options = {};
    options.size = 16;
    CHECK(sizes(plan_of("generic", options)) == std::vector{16, 8, 4});  // a small map is not a mirror alone
    options.layout = Layout::latlong;

    // One texture holds 132 x 66 and 66 x 33, but then 33 x 16: an engine that takes a file for each level may go on.
    options.size = 66;
    CHECK(sizes(plan_of("generic", options)) == std::vector{66, 33});
    options.format = Container::exr;
    CHECK(sizes(plan_of("generic", options)) == std::vector{66, 33, 16});

    options = {};
    options.lobe = Lobe::phong_brdf;
    CHECK(sizes(plan_of("generic", options)) == std::vector{512, 256, 128, 64, 32, 16, 8});  // exponents inf to 2
    options.exponents = {std::numeric_limits<double>::infinity(), 64, 0};
    const EnginePlan phong = plan_of("generic", options);
    CHECK(phong.specular[0].spec.mirror);
    CHECK(phong.specular[1].spec.kernel.width == 64);
    CHECK(phong.specular[2].exponent == 0);

    options = {};
    options.format = Container::ktx2;
    CHECK(plan_of("filament", options).encoding == Encoding::rgba16f);  // this container's own default
}

TEST_CASE("plan: contradictions are errors that name the field") {
    const auto where = [](auto change) {
        BakeOptions options;
        change(options);
        const auto ok = check_bake_options(options);
        if (ok) return std::string();
        CHECK((ok.error().what + ok.error().hint).find("--") == std::string::npos);
        return ok.error().where;
    };
    CHECK(where([](BakeOptions&) {}).empty());
    CHECK(where([](BakeOptions& o) { o.size = 0; }) == "`size`");
    CHECK(where([](BakeOptions& o) { o.size = 1 << 30; }) == "`size`");
    CHECK(where([](BakeOptions& o) { o.levels = 11; }) == "`levels`");
    CHECK(where([](BakeOptions& o) { o.roughness = {-0.1}; }) == "`roughness`");
    CHECK(where([](BakeOptions& o) { o.exponents = {1}; }) == "`exponents`");
    CHECK(where([](BakeOptions& o) { o.encoding = Encoding::rg16f; }) == "`encoding`");
    CHECK(where([](BakeOptions& o) { o.zstd = true, o.format = Container::dds; }) == "`zstd`");
    CHECK(where([](BakeOptions& o) { o.engines = {"three-latlong"}, o.lobe = Lobe::charlie; }) == "`lobe`");
    CHECK(where([](BakeOptions& o) { o.engines = {}; }) == "`engines`");
    CHECK(where([](BakeOptions& o) { o.engines = {"babylon"}, o.size = 100; }) == "`size`");
    CHECK(where([](BakeOptions& o) { o.engines = {"babylon"}, o.levels = 3; }) == "`levels`");
    CHECK(where([](BakeOptions& o) { o.engines = {"babylon"}, o.encoding = Encoding::rgb9e5; }) == "`encoding`");
    CHECK(where([](BakeOptions& o) { o.engines = {"babylon"}, o.layout = Layout::latlong; }) == "`layout`");
    CHECK(where([](BakeOptions& o) { o.engines = {"playcanvas"}, o.size = 256; }) == "`size`");
    CHECK(where([](BakeOptions& o) { o.engines = {"playcanvas"}, o.levels = 6; }) == "`levels`");
    CHECK(where([](BakeOptions& o) { o.engines = {"playcanvas"}, o.irradiance_size = 16; }) == "`irradiance_size`");
    CHECK(where([](BakeOptions& o) { o.engines = {"materialx"}, o.size = 9, o.levels = 1; }) == "`size`");
    CHECK(where([](BakeOptions& o) { o.format = Container::exr_mip, o.encoding = Encoding::rgb9e5; }) == "`encoding`");
    CHECK(where([](BakeOptions& o) { o.format = Container::dds9, o.encoding = Encoding::rgb9e5; }) == "`encoding`");
    CHECK(where([](BakeOptions& o) { o.sh_bands = 65; }) == "`sh_bands`");
    CHECK(where([](BakeOptions& o) { o.engines = {"three"}, o.irradiance_quantity = Quantity::irradiance; }) ==
          "`irradiance_quantity`");
    CHECK(where([](BakeOptions& o) { o.irradiance_quantity = Quantity::radiance; }) == "`irradiance_quantity`");
    CHECK(where([](BakeOptions& o) { o.irradiance_quantity = Quantity::irradiance_over_pi; }).empty());
    CHECK(where([](BakeOptions& o) { o.layout = Layout::latlong, o.size = 100, o.levels = 4; }) == "`size`");
    CHECK(where([](BakeOptions& o) { o.latlong_out = "usd"; }) == "`latlong_out`");
    CHECK(where([](BakeOptions& o) { o.layout = Layout::latlong, o.latlong_out = "up"; }) == "`latlong_out`");
    CHECK(where([](BakeOptions& o) { o.engines = {"unity"}, o.latlong_out = "up"; }) == "`latlong_out`");
    CHECK(where([](BakeOptions& o) { o.layout = Layout::latlong, o.latlong_out = "mitsuba"; }).empty());
    CHECK(where([](BakeOptions& o) { o.engines = {"unity"}, o.latlong_out = "latlong/mod"; }).empty());
    CHECK(where([](BakeOptions& o) { o.engines = {"blender"}, o.latlong_out = "centre=+Z,right=-X"; }).empty());
    CHECK(where([](BakeOptions& o) { o.engines = {"pbrt"}, o.latlong_out = "usd"; }) == "`latlong_out`");
    CHECK(where([](BakeOptions& o) { o.engines = {"playcanvas"}, o.latlong_out = "mod"; }) == "`latlong_out`");
    CHECK(where([](BakeOptions& o) { o.engines = {"filament"}, o.latlong_out = "usd"; }) == "`latlong_out`");
}

TEST_CASE("engine: filament's cube lies as cmgen's does, from the same image with its convention") {
    DOMELIGHT_DATA_FILE(source, "reference/symmetrical_garden/symmetrical_garden_1k.hdr");
    DOMELIGHT_DATA_FILE(cmgen, "reference/symmetrical_garden/symmetrical_garden_ibl.ktx");
    const test::TemporaryFolder folder;
    BakeOptions options;
    options.engines = {"filament"};
    options.environment.latlong = "usd";
    options.preview = false;
    auto environment = open_environment({source}, options.environment);
    REQUIRE(environment);
    REQUIRE(bake(*environment, options, folder.path()));
    const auto ours = read_texture(folder / "symmetrical_garden_1k_ibl.ktx"), theirs = read_texture(cmgen);
    REQUIRE(ours);
    REQUIRE(theirs);
    REQUIRE(ours->levels.size() == theirs->levels.size());
    const int level = 3;
    double error = 0, mirrored = 0, square = 0;
    for (int f = 0; f < 6; ++f) {
        const ImageF a = decode_texture(*ours, level, f), b = decode_texture(*theirs, level, f);
        for (int y = 0; y < a.height(); ++y)
            for (int x = 0; x < a.width(); ++x)
                for (int c = 0; c < 3; ++c) {
                    const double value = a.at(x, y)[c], other = b.at(x, y)[c], flipped = b.at(a.width() - 1 - x, y)[c];
                    error += (value - other) * (value - other);
                    mirrored += (value - flipped) * (value - flipped);
                    square += other * other;
                }
    }
    // Measured 9 %: cmgen's own error with a sun in the picture. Seen in a mirror it is 116 %.
    CHECK(std::sqrt(error / square) < 0.15);
    CHECK(std::sqrt(mirrored / square) > 0.5);
}
