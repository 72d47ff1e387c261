// Runs the text of the lat-long shaders of docs/shaders: the mapping, importance sampling, split-sum, modified Phong.

#include "domelight/bake/bake.h"
#include "domelight/engines/engine.h"
#include "domelight/io/environment/open_environment.h"
#include "domelight/io/write_image.h"
#include "domelight/projection/projection.h"
#include "domelight/sampling/environment_sampler.h"
#include "domelight/texture/texture.h"

#include "projection/latlong_convention.h"
#include "shaders/shader_test.h"
#include "test.h"

#include <numbers>

#define uniform static
namespace shading_language::spherical_envmap {
#include "shaders/spherical_envmap.glsl"
}  // namespace shading_language::spherical_envmap
namespace shading_language::latlong_split_sum {
#include "shaders/spherical_envmap.glsl"
#include "shaders/latlong_split_sum.glsl"
}  // namespace shading_language::latlong_split_sum
namespace shading_language::latlong_phong {
#include "shaders/spherical_envmap.glsl"
#include "shaders/latlong_phong.glsl"
}  // namespace shading_language::latlong_phong
namespace shading_language::sample_envmap {
#include "shaders/spherical_envmap.glsl"
#include "shaders/sample_envmap.glsl"
}  // namespace shading_language::sample_envmap
#undef uniform

using namespace domelight;
using namespace domelight::test;
namespace sl = shading_language;

namespace {

/// The matrices of the table in spherical_envmap.glsl, for a world with +Y up.
const Mat3 k_mod{{Vec3d{1, 0, 0}, Vec3d{0, 0, -1}, Vec3d{0, 1, 0}}};
const Mat3 k_default{{Vec3d{-1, 0, 0}, Vec3d{0, 0, 1}, Vec3d{0, 1, 0}}};

const std::vector<Vec3d>& directions() {
    static const std::vector<Vec3d> all = [] {
        std::vector<Vec3d> out;
        for (int i = 0; i < 200; ++i) {  // a spiral from pole to pole
            const double y = 1 - (i + 0.5) / 100, s = std::sqrt(1 - y * y);
            out.push_back({s * std::cos(2.4 * i), y, s * std::sin(2.4 * i)});
        }
        return out;
    }();
    return all;
}

/// A texel of a picture as a shader fetches it.
sl::vec4 texel(const ImageF& image, int x, int y) {
    const float* p = image.at(x, y);
    return {p[0], image.channels() > 1 ? p[1] : 0, image.channels() > 2 ? p[2] : 0, 1};
}

/// A lookup with linear filtering, repeating in x unless it is clamped.
sl::vec4 bilinear(const ImageF& image, const sl::vec2& point, bool repeat) {
    const float x = point.x * float(image.width()) - 0.5f, y = point.y * float(image.height()) - 0.5f;
    const float left = std::floor(x), top = std::floor(y);
    const auto row = [&](int j) {
        const auto at = [&](int i) {
            const int w = image.width();
            return texel(image, repeat ? ((i % w) + w) % w : std::clamp(i, 0, w - 1),
                         std::clamp(j, 0, image.height() - 1));
        };
        return mix(at(int(left)), at(int(left) + 1), x - left);
    };
    return mix(row(int(top)), row(int(top) + 1), y - top);
}

sl::Plane plane(std::vector<ImageF> levels, bool repeat) {
    const auto images = std::make_shared<std::vector<ImageF>>(std::move(levels));
    const sl::ivec2 size(images->front().width(), images->front().height());
    return {[images, repeat](const sl::vec2& point, float level) {
                const float last = float(images->size() - 1), l = std::clamp(level, 0.f, last);
                const auto lower = std::size_t(l), upper = std::min(lower + 1, images->size() - 1);
                return mix(bilinear((*images)[lower], point, repeat), bilinear((*images)[upper], point, repeat),
                           l - float(lower));
            },
            [images](const sl::ivec2& t) { return texel(images->front(), t.x, t.y); }, size};
}

sl::Plane plane(const std::filesystem::path& file, bool repeat = true) {
    auto texture = read_texture(file);
    REQUIRE(texture);
    std::vector<ImageF> levels;
    for (std::size_t l = 0; l < texture->levels.size(); ++l) levels.push_back(decode_texture(*texture, int(l), 0));
    return plane(std::move(levels), repeat);
}

/// A light that differs in all directions, and is so smooth that the error of bilinear lookups is less than 0.3 %.
ImageF gentle_light() {
    ImageF image(128, 64, 3);
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 128; ++x) {
            const Vec3d d = latlong_direction({(x + 0.5) / 128, (y + 0.5) / 64});
            for (int c = 0; c < 3; ++c) image.at(x, y)[c] = float(2 + 0.4 * (c == 0 ? d.x : c == 1 ? d.y : d.z));
        }
    return image;
}

/// A bake of it by cubes, which the C++ reads, and one by lat-long maps, which the shaders read. Five levels each.
struct Bakes {
    explicit Bakes(Lobe lobe, const ImageF& light) {
        REQUIRE(write_hdr(folder / "light.hdr", light.view()));
        for (const Layout layout : {Layout::cube, Layout::latlong}) {
            auto environment = open_environment({folder / "light.hdr"});
            REQUIRE(environment);
            BakeOptions options;
            options.layout = layout;
            options.lobe = lobe;
            options.size = 128;
            options.levels = 5;
            options.encoding = Encoding::rgba32f;
            options.preview = false;
            REQUIRE(bake(*environment, options, folder / (layout == Layout::cube ? "cube" : "latlong")));
        }
        auto loaded = LightMaps::load(folder / "cube");
        REQUIRE(loaded);
        maps = std::make_unique<LightMaps>(std::move(*loaded));
    }
    const TemporaryFolder folder;
    std::unique_ptr<LightMaps> maps;
};

void bind_split_sum(const Bakes& bakes) {
    namespace s = sl::latlong_split_sum;
    s::u_environment = to_shader(k_default);
    s::u_specular = plane(bakes.folder / "latlong/specular.ktx2");
    s::u_irradiance = plane(bakes.folder / "latlong/irradiance.ktx2");
    s::u_brdf = plane(bakes.folder / "latlong/brdf.ktx2", false);
    s::u_last_level = 4;
}

}  // namespace

TEST_CASE("shaders: directionToSphericalEnvmap is the convention mod, its t upside down, and has an inverse") {
    namespace s = sl::spherical_envmap;
    const Mat3 to_default = latlong_convention("mod")->world_to_default();
    for (const Vec3d& d : directions()) {
        const sl::vec3 lecture = to_shader(Vec3f(k_mod * d));
        const sl::vec2 st = s::directionToSphericalEnvmap(lecture);
        const UV uv = latlong_uv(to_default * d);
        CHECK(st.x == doctest::Approx(uv.u).epsilon(1e-5));
        CHECK(st.y == doctest::Approx(1 - uv.v).epsilon(1e-5));
        CHECK(near(from_shader(s::sphericalEnvmapToDirection(st)), from_shader(lecture), k_rounding));
    }
}

TEST_CASE("shaders: each environment matrix of the table finds a direction in files of its convention") {
    namespace s = sl::spherical_envmap;
    const Mat3 z_up_to_y_up{{Vec3d{1, 0, 0}, Vec3d{0, 0, 1}, Vec3d{0, -1, 0}}};
    const Mat3 half_turn{{Vec3d{-1, 0, 0}, Vec3d{0, -1, 0}, Vec3d{0, 0, 1}}};
    const struct {
        const char* convention;
        Mat3 environment, to_y_up;
    } rows[] = {{"mod", {}, z_up_to_y_up},
                {"default", half_turn, z_up_to_y_up},
                {"mod", k_mod, {}},
                {"default", k_default, {}},
                // A light that is turned with the world.
                {"default", k_default * rotation_y(0.7).transposed(), rotation_y(0.7).transposed()}};
    for (const auto& row : rows) {
        s::u_environment = to_shader(row.environment);
        const Mat3 to_default = latlong_convention(row.convention)->world_to_default();
        for (const Vec3d& d : directions()) {
            const sl::vec2 point = s::domelight_latlong_point(to_shader(Vec3f(d)));
            const UV uv = latlong_uv(to_default * (row.to_y_up * d));
            CHECK(point.x == doctest::Approx(uv.u).epsilon(1e-5));
            CHECK(point.y == doctest::Approx(uv.v).epsilon(1e-5));
            CHECK(near(from_shader(s::domelight_latlong_direction(point)), Vec3f(d), k_rounding));
        }
    }
}

TEST_CASE("shaders: sampleEnvmap draws what the sampler's walk draws, and its mean is the irradiance") {
    // A sun, a dark half, and rows without any light at both ends.
    ImageF image(32, 16, 3);
    for (int y = 2; y < 14; ++y)
        for (int x = 0; x < 20; ++x)
            for (int c = 0; c < 3; ++c) image.at(x, y)[c] = float(0.1 + ((x * 7 + y * 3 + c) % 5));
    image.at(17, 4)[0] = image.at(17, 4)[1] = image.at(17, 4)[2] = 800;
    const Mat3 turn = rotation_y(0.7);
    const auto sampler = EnvironmentSampler::build(image.view(), {.method = DistributionMethod::walk}, turn);
    REQUIRE(sampler);

    namespace s = sl::sample_envmap;
    const SamplingTextures tables = sampling_textures(*sampler);
    s::u_environment = to_shader(k_default * turn);
    s::u_envmap = plane({image}, true);
    s::u_row_averages = plane({tables.row_averages}, false);
    s::u_total_average = float(tables.total_average);

    int drawn = 0;
    for (int i = 0; i < 1000; ++i) {
        const double x = (i + 0.5) / 1000, y = std::fmod(0.5 + i * std::numbers::phi, 1.0);
        const LightSample expected = sampler->sample(UnitPoint{unit_fixed(x), unit_fixed(y)});
        const auto light = s::sampleEnvmap({float(x), float(y)});
        CHECK(length(light.direction) == doctest::Approx(1).epsilon(1e-5));
        CHECK(light.pdf_solid_angle ==
              doctest::Approx(sampler->pdf_solid_angle(from_shader(light.direction))).epsilon(1e-3));
        CHECK(length(from_shader(light.direction) - expected.direction) < 2e-3);
        drawn += near(from_shader(light.radiance), expected.radiance, k_rounding);
    }
    CHECK(drawn >= 998);  // at the very edge of a texel, sums in float and in double may find different texels
    // The ends of the unit square still give texels with light, in spite of rounding.
    for (const float x : {0.f, 0x1.fffffep-1f})
        for (const float y : {0.f, 0x1.fffffep-1f}) {
            CHECK(length(s::sampleEnvmap({x, y}).radiance) > 0);
            CHECK(s::sampleEnvmap({x, y}).pdf_solid_angle > 0);
        }

    const Vec3f n = normalize(Vec3f{0.4f, 0.9f, -0.2f});
    Vec3d irradiance_over_pi{0, 0, 0};
    for (int y = 0; y < 16 * 8; ++y)
        for (int x = 0; x < 32 * 8; ++x) {
            const Vec3d d = turn.transposed() * latlong_direction({(x + 0.5) / 256, (y + 0.5) / 128});
            const float* p = image.at(x / 8, y / 8);
            const double share = std::max(0.0, dot(d, Vec3d(n))) * latlong_solid_angle(y, 256, 128) / k_pi;
            irradiance_over_pi += Vec3d{p[0], p[1], p[2]} * share;
        }
    CHECK(near(from_shader(s::diffuseBySamples(to_shader(n), 4096)), Vec3f(irradiance_over_pi), 0.01f));
}

TEST_CASE("shaders: split-sum with lat-long maps is split-sum with cubes, and a white surface keeps an even light") {
    namespace s = sl::latlong_split_sum;
    const Bakes bakes(Lobe::ggx, gentle_light());
    bind_split_sum(bakes);
    const Vec3f n = normalize(Vec3f{0.3f, 0.8f, -0.5f}), side = normalize(cross(n, Vec3f{0, 0, 1}));
    for (const Paint& m : {Paint{{0.9f, 0.5f, 0.2f}, 0, 0.3f}, {{0.9f, 0.5f, 0.2f}, 1, 0.6f}, {{0.1f, 1, 0.7f}, 0.4f, 0.9f}})
        for (const float slant : {0.f, 0.8f, 1.45f}) {
            INFO("metallic " << m.metallic << ", slant " << slant);
            const Vec3f v = n * std::cos(slant) + side * std::sin(slant);
            const sl::vec3 got = s::domelight_shade_latlong(to_shader(n), to_shader(v), to_shader(m.base_color), m.metallic,
                                                     m.roughness, 0.5f);
            CHECK(near(from_shader(got), shade_split_sum(m, n, v, *bakes.maps, {}), 3e-3f));
        }

    const Bakes even(Lobe::ggx, ImageF(64, 32, 3, 1.f));
    bind_split_sum(even);
    for (const float roughness : {0.1f, 0.3f, 0.6f, 1.f})
        for (const float NdotV : {0.05f, 0.1f, 0.3f, 0.7f, 1.f}) {
            INFO("roughness " << roughness << ", NdotV " << NdotV);
            const sl::vec3 v(std::sqrt(1 - NdotV * NdotV), 0, NdotV);
            CHECK(s::domelight_shade_latlong({0, 0, 1}, v, sl::vec3(1.f), 0, roughness, 0.5f).y ==
                  doctest::Approx(1).epsilon(1e-3));
        }
}

TEST_CASE("shaders: modified Phong reads the level that holds an exponent, and is Phong with cubes") {
    namespace s = sl::latlong_phong;
    const auto exponents = default_phong_exponents(9);
    for (int l = 1; l < 9; ++l) {
        CHECK(s::domelight_phong_exponent(float(l)) == exponents[std::size_t(l)]);
        if (exponents[std::size_t(l)] > 1) CHECK(s::domelight_phong_level(float(exponents[std::size_t(l)])) == l);
    }
    CHECK(default_phong_level(INFINITY) == 0);
    for (double level = 0.125; level <= 7; level += 0.125) {
        CHECK(default_phong_level(default_phong_exponent(level)) == doctest::Approx(level));
        CHECK(s::domelight_phong_exponent(float(level)) == doctest::Approx(default_phong_exponent(level)).epsilon(1e-4));
        CHECK(s::domelight_phong_level(float(default_phong_exponent(level))) == doctest::Approx(level).epsilon(1e-5));
    }

    const Bakes bakes(Lobe::phong_brdf, gentle_light());
    s::u_environment = to_shader(k_default);
    s::u_phong = plane(bakes.folder / "latlong/specular.ktx2");
    s::u_irradiance = plane(bakes.folder / "latlong/irradiance.ktx2");
    const Vec3f n = normalize(Vec3f{0.3f, 0.8f, -0.5f}), side = normalize(cross(n, Vec3f{0, 0, 1}));
    const Vec3f v = n * std::cos(0.8f) + side * std::sin(0.8f), r = n * (2 * dot(n, v)) - v;
    const Vec3f rho_d{0.5f, 0.2f, 0.1f}, rho_s{0.1f, 0.3f, 0.5f};
    for (const float n_s : {1e6f, 2048.f, 700.f, 128.f, 32.f}) {
        INFO("n_s " << n_s);
        const Vec3f diffuse = bakes.maps->irradiance_over_pi(n), specular = bakes.maps->phong(r, n_s);
        const Vec3f expected{rho_d.x * diffuse.x + rho_s.x * specular.x, rho_d.y * diffuse.y + rho_s.y * specular.y,
                             rho_d.z * diffuse.z + rho_s.z * specular.z};
        const auto got = s::domelight_shade_phong(to_shader(n), to_shader(v), to_shader(rho_d), to_shader(rho_s), n_s);
        CHECK(near(from_shader(got), expected, 3e-3f));
    }
}
