// Runs the text of docs/shaders/generic.glsl, .hlsl and .wgsl, and holds it against the C++ that `domelight render
// --shading split-sum` draws with.

#include "domelight/bake/bake.h"
#include "domelight/io/environment/open_environment.h"
#include "domelight/io/write_image.h"
#include "domelight/projection/projection.h"

#include "shaders/shader_test.h"
#include "test.h"

#include <fstream>
#include <nlohmann/json.hpp>

#define uniform static
namespace shading_language::generic_glsl {
#include "shaders/generic.glsl"
}  // namespace shading_language::generic_glsl
namespace shading_language::generic_hlsl {
#include "shaders/generic_hlsl.inl"
}  // namespace shading_language::generic_hlsl
namespace shading_language::generic_wgsl {
#include "shaders/generic_wgsl.inl"
}  // namespace shading_language::generic_wgsl
#undef uniform

using namespace domelight;
using namespace domelight::test;
namespace sl = shading_language;

namespace {

/// The functions of a shader, whatever its language.
struct Shader {
    std::string language;
    sl::vec3 (*shade)(sl::vec3 n, sl::vec3 v, sl::vec3 base_color, float metallic, float roughness);
    sl::vec3 (*shade_multiple_scattering)(sl::vec3 n, sl::vec3 v, sl::vec3 base_color, float metallic, float roughness);
    sl::vec3 (*diffuse)(sl::vec3 n);
    sl::vec3 (*diffuse_sh)(sl::vec3 n);
    sl::vec3 (*weight_energy)(sl::vec3 f0, sl::vec2 scale_bias);
    sl::vec3 (*weight_fresnel)(sl::vec3 f0, float NdotV);
    sl::vec3 (*multiple_scattering)(sl::vec3 f0, sl::vec2 scale_bias);
    float (*f0_of_reflectance)(float reflectance);
    /// Binds the textures and values that the shader reads.
    void (*bind)(const sl::Cube& specular, const sl::Cube& irradiance, const sl::Plane& brdf,
                 const std::vector<Vec3f>& sh, const Mat3& environment, float last_level);
};

#define DOMELIGHT_FUNCTIONS(space)                                                                            \
    sl::space::domelight_shade, sl::space::domelight_shade_multiple_scattering, sl::space::domelight_diffuse, \
        sl::space::domelight_diffuse_sh, sl::space::domelight_diffuse_weight_energy,                          \
        sl::space::domelight_diffuse_weight_fresnel, sl::space::domelight_multiple_scattering,                \
        sl::space::domelight_f0_of_reflectance

void bind_glsl(const sl::Cube& specular, const sl::Cube& irradiance, const sl::Plane& brdf,
               const std::vector<Vec3f>& sh, const Mat3& environment, float last_level) {
    namespace s = sl::generic_glsl;
    s::u_specular = specular, s::u_irradiance = irradiance, s::u_brdf = brdf, s::u_last_level = last_level;
    for (std::size_t i = 0; i < sh.size(); ++i) s::u_sh[i] = to_shader(sh[i]);
    s::u_environment = to_shader(environment);
}

void bind_hlsl(const sl::Cube& specular, const sl::Cube& irradiance, const sl::Plane& brdf,
               const std::vector<Vec3f>& sh, const Mat3& environment, float last_level) {
    namespace s = sl::generic_hlsl;
    s::g_specular = {specular}, s::g_irradiance = {irradiance}, s::g_brdf = {brdf}, s::g_last_level = last_level;
    for (std::size_t i = 0; i < sh.size(); ++i) s::g_sh[i] = to_shader4(sh[i]);
    for (std::size_t i = 0; i < 3; ++i) s::g_environment[i] = to_shader4(Vec3f(environment.row[i]));
}

void bind_wgsl(const sl::Cube& specular, const sl::Cube& irradiance, const sl::Plane& brdf,
               const std::vector<Vec3f>& sh, const Mat3& environment, float last_level) {
    namespace s = sl::generic_wgsl;
    s::specular = {specular}, s::irradiance = {irradiance}, s::brdf = {brdf}, s::light.last_level = last_level;
    for (std::size_t i = 0; i < sh.size(); ++i) s::light.sh[int(i)] = to_shader4(sh[i]);
    s::light.environment = to_shader(environment);
}

const Shader k_shaders[] = {{"GLSL", DOMELIGHT_FUNCTIONS(generic_glsl), bind_glsl},
                            {"HLSL", DOMELIGHT_FUNCTIONS(generic_hlsl), bind_hlsl},
                            {"WGSL", DOMELIGHT_FUNCTIONS(generic_wgsl), bind_wgsl}};

/// Lets a shader read the maps of a bake.
void bind_maps(const Shader& shader, const LightMaps& maps, const std::vector<Vec3f>& sh,
               const Mat3& environment = {}) {
    const int last_level = 5;
    const sl::Cube specular{[&maps](const sl::vec3& d, float level) {
        const double roughness = engines().front().roughness(level, last_level + 1, 512);
        return to_shader4(maps.specular(from_shader(d), float(roughness)));
    }};
    const sl::Cube irradiance{[&maps](const sl::vec3& d, float) {
        return to_shader4(maps.irradiance_over_pi(from_shader(d)) * float(k_pi));
    }};
    const sl::Plane brdf{[&maps](const sl::vec2& p, float) {
        const auto table = maps.brdf(p.x, p.y);
        return sl::vec4(table.scale, table.bias, 0, 1);
    }};
    shader.bind(specular, irradiance, brdf, sh, environment, last_level);
}

/// A bake of a light that differs in all directions, through the files.
struct Bake {
    Bake() {
        ImageF image(128, 64, 3);
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 128; ++x) {
                const Vec3d d = latlong_direction({(x + 0.5) / 128, (y + 0.5) / 64});
                for (int c = 0; c < 3; ++c) image.at(x, y)[c] = float(1.1 + (c == 0 ? d.x : c == 1 ? d.y : d.z));
            }
        REQUIRE(write_hdr(folder / "light.hdr", image.view()));
        auto environment = open_environment({folder / "light.hdr"});
        REQUIRE(environment);
        BakeOptions options;
        options.preview = false;
        REQUIRE(bake(*environment, options, folder / "out"));
        auto loaded = LightMaps::load(folder / "out");
        REQUIRE(loaded);
        maps = std::make_unique<LightMaps>(std::move(*loaded));
        const auto json = nlohmann::json::parse(std::ifstream(folder / "out/sh.json"));
        for (const auto& c : json["irradiance"])
            if (sh.size() < 9) sh.push_back({c[0].get<float>(), c[1].get<float>(), c[2].get<float>()});
    }
    const TemporaryFolder folder;
    std::unique_ptr<LightMaps> maps;
    std::vector<Vec3f> sh;  ///< of the irradiance
};

}  // namespace

TEST_CASE("shaders: in GLSL, HLSL and WGSL the surface is split-sum's, also where the world is turned") {
    const Bake bake;
    const Mat3 turn{{Vec3d{0, 0, 1}, Vec3d{1, 0, 0}, Vec3d{0, 1, 0}}};
    ShadingOptions multiple;
    multiple.multiple_scattering = true;
    for (const Shader& shader : k_shaders)
        for (const Mat3& environment : {Mat3{}, turn * rotation_y(0.4)}) {
            bind_maps(shader, *bake.maps, bake.sh, environment);
            const auto turned = [&](const Vec3f& d) { return Vec3f(environment * Vec3d(d)); };
            for (const Paint& m :
                 {Paint{{0.9f, 0.5f, 0.2f}, 0, 0.3f}, {{0.9f, 0.5f, 0.2f}, 1, 0.6f}, {{0.1f, 1, 0.7f}, 0.4f, 0.9f}})
                for (const float slant : {0.f, 0.8f, 1.45f}) {
                    const Vec3f n = normalize(Vec3f{0.3f, 0.8f, -0.5f}), side = normalize(cross(n, Vec3f{0, 0, 1})),
                                v = n * std::cos(slant) + side * std::sin(slant);
                    INFO(shader.language << ", metallic " << m.metallic << ", slant " << slant);
                    CHECK(near(from_shader(shader.shade(to_shader(n), to_shader(v), to_shader(m.base_color), m.metallic,
                                                        m.roughness)),
                               shade_split_sum(m, turned(n), turned(v), *bake.maps, {}), k_rounding));
                    CHECK(near(from_shader(shader.shade_multiple_scattering(
                                   to_shader(n), to_shader(v), to_shader(m.base_color), m.metallic, m.roughness)),
                               shade_split_sum(m, turned(n), turned(v), *bake.maps, multiple), k_rounding));
                    CHECK(near(from_shader(shader.diffuse(to_shader(n))), bake.maps->irradiance_over_pi(turned(n)),
                               k_rounding));
                    // The coefficients of sh.json are written with nine digits, those in the shader with six.
                    CHECK(near(from_shader(shader.diffuse_sh(to_shader(n))),
                               bake.maps->irradiance_over_pi_sh(turned(n)), k_rounding));
                }
        }
}

TEST_CASE("shaders: the diffuse weights and F0 are those of the C++ functions of the same names") {
    const Vec3f f0{0.04f, 0.3f, 0.8f}, f90{1, 1, 1};
    const LightMaps::ScaleBias table{0.55f, 0.2f};
    for (const Shader& s : k_shaders) {
        INFO(s.language);
        CHECK(near(from_shader(s.weight_energy(to_shader(f0), {table.scale, table.bias})),
                   diffuse_weight_energy(f0, f90, table), k_rounding));
        CHECK(near(from_shader(s.multiple_scattering(to_shader(f0), {table.scale, table.bias})),
                   multiple_scattering(f0, f90, table), k_rounding));
        for (const float NdotV : {0.f, 0.1f, 0.5f, 1.f})
            CHECK(near(from_shader(s.weight_fresnel(to_shader(f0), NdotV)), diffuse_weight_fresnel(f0, f90, NdotV),
                       k_rounding));
        for (const float reflectance : {0.f, 0.35f, 0.5f, 1.f})
            CHECK(s.f0_of_reflectance(reflectance) == doctest::Approx(f0_of_reflectance(reflectance)));
    }
}

TEST_CASE(
    "shaders: a white surface in an even light shows the light, and with the courses' weight at worst 0.28 of it") {
    auto maps = LightMaps::bake(ImageF(64, 32, 3, 1.f), {});
    REQUIRE(maps);
    const sl::vec3 n(0, 0, 1), white(1.f);
    for (const Shader& s : k_shaders) {
        bind_maps(s, *maps, {});
        double darkest = 1;
        for (const float roughness : {0.1f, 0.3f, 0.6f, 1.f})
            for (const float NdotV : {0.05f, 0.1f, 0.3f, 0.7f, 1.f}) {
                const sl::vec3 v(std::sqrt(1 - NdotV * NdotV), 0, NdotV);
                INFO(s.language << ", roughness " << roughness << ", NdotV " << NdotV);
                CHECK(s.shade(n, v, white, 0, roughness).y == doctest::Approx(1).epsilon(1e-3));
                for (const float metallic : {0.f, 1.f})
                    CHECK(s.shade_multiple_scattering(n, v, white, metallic, roughness).y ==
                          doctest::Approx(1).epsilon(1e-3));
                const sl::vec3 f0(0.04f);
                const auto table = maps->brdf(NdotV, roughness);
                darkest = std::min(darkest, double(s.weight_fresnel(f0, NdotV).y + f0.y * table.scale + table.bias));
            }
        CHECK(darkest == doctest::Approx(0.282).epsilon(0.01));
    }
}
