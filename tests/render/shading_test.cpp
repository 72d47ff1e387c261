#include "domelight/shading.h"

#include "domelight/bake.h"
#include "domelight/image_io.h"
#include "domelight/projection.h"
#include "domelight/reference.h"
#include "domelight/sky.h"
#include "render/shapes.h"
#include "test.h"

using namespace domelight;
using namespace domelight::test;

namespace {

RenderOptions view() {
    RenderOptions o;
    o.width = o.height = 16;
    o.samples = 64;
    o.camera = look_at({0, 0, 4}, {0, 0, 0}, 0.6f);
    o.background = Background::transparent;
    o.occlusion = false;
    return o;
}

RayScene sphere(Material material) {
    Scene scene;
    add(scene, sphere_mesh(64), std::move(material));
    auto traced = RayScene::build(std::move(scene));
    REQUIRE(traced);
    return std::move(*traced);
}

double mean_inside(const RenderResult& r, int channel = 1) {
    double sum = 0;
    int n = 0;
    for (int y = 0; y < r.radiance.height(); ++y)
        for (int x = 0; x < r.radiance.width(); ++x)
            if (*r.opacity.at(x, y) == 1) sum += r.radiance.at(x, y)[channel], ++n;
    return sum / n;
}

/// Bright towards +X, dim elsewhere, without an edge.
ImageF gradient() {
    ImageF image(128, 64, 3);
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 128; ++x) {
            const Vec3d d = latlong_direction({(x + 0.5) / 128, (y + 0.5) / 64});
            image.at(x, y)[0] = float(1 + 0.5 * d.x);
            image.at(x, y)[1] = float(1 + 0.5 * d.y);
            image.at(x, y)[2] = float(1 + 0.5 * d.z);
        }
    return image;
}

struct Light {
    explicit Light(ImageF picture) : image(std::move(picture)) {
        auto built = EnvironmentSampler::build(image, reference_sampler_options());
        REQUIRE(built);
        sampler = std::make_unique<EnvironmentSampler>(std::move(*built));
        auto baked = LightMaps::bake(image, {});
        REQUIRE(baked);
        maps = std::make_unique<LightMaps>(std::move(*baked));
    }
    RenderResult shade(const RayScene& scene, const ShadingOptions& shading) const {
        auto r = render_shaded(scene, *maps, *sampler, shading, view());
        REQUIRE(r);
        return std::move(*r);
    }
    ImageF image;
    std::unique_ptr<EnvironmentSampler> sampler;
    std::unique_ptr<LightMaps> maps;
};

}  // namespace

TEST_CASE("split-sum: under an even sky it is the truth without shadows") {
    const Light light(ImageF(64, 32, 3, 1.f));
    for (const float roughness : {0.2f, 0.6f, 1.f}) {
        const RayScene scene = sphere(metal_material(roughness));
        auto truth = render_reference(scene, *light.sampler, view());
        REQUIRE(truth);
        INFO("roughness " << roughness);
        CHECK(mean_inside(light.shade(scene, {})) == doctest::Approx(mean_inside(*truth)).epsilon(0.005));
        ShadingOptions multiple;
        multiple.multiple_scattering = true;
        CHECK(mean_inside(light.shade(scene, multiple)) == doctest::Approx(1).epsilon(0.01));
    }
    Material plastic;
    plastic.metalness = 0;
    plastic.roughness = 0.4f;
    plastic.base_color = {0.5f, 0.5f, 0.5f};
    const RayScene scene = sphere(plastic);
    auto truth = render_reference(scene, *light.sampler, view());
    // Its diffuse part knows Fresnel at the viewer's angle only.
    CHECK(mean_inside(light.shade(scene, {})) == doctest::Approx(mean_inside(*truth)).epsilon(0.03));
}

TEST_CASE("split-sum: a matte sphere is lit by the exact irradiance, from the cube and nearly so from nine harmonics") {
    const Light light(gradient());
    const RayScene scene = sphere(lambert_material(0.7f));
    for (const bool sh : {false, true}) {
        ShadingOptions options;
        options.sh_irradiance = sh;
        const RenderResult r = light.shade(scene, options);
        for (int y = 2; y < 16; y += 3)
            for (int x = 2; x < 16; x += 3) {
                if (*r.opacity.at(x, y) < 1) continue;
                const float* n = r.normal.at(x, y);
                const Vec3d normal = normalize(Vec3d{n[0], n[1], n[2]});
                const Vec3d exact = convolve_exactly(light.image, ZonalKernel::cosine(), std::span(&normal, 1))[0];
                for (const auto& [got, want] : {std::pair{r.radiance.at(x, y)[0], exact.x}, {r.radiance.at(x, y)[2], exact.z}})
                    CHECK(got == doctest::Approx(0.7 * want).epsilon(0.01));
            }
    }
}

TEST_CASE("mirror and refract: the middle of a ball shows what lies behind the viewer, and through it what lies ahead") {
    const Light light(gradient());
    const RayScene ball = sphere(Material{});
    ShadingOptions mirror;
    mirror.model = ShadingModel::mirror;
    const RenderResult reflected = light.shade(ball, mirror);
    CHECK(reflected.radiance.at(8, 8)[2] == doctest::Approx(1.5).epsilon(0.02));  // from +Z, where the viewer is
    CHECK(reflected.radiance.at(13, 8)[0] > 1.3f);                                // the right rim looks towards +X
    CHECK(reflected.radiance.at(8, 2)[1] > 1.3f);                                 // the upper one towards +Y
    ShadingOptions refract;
    refract.model = ShadingModel::refract;
    CHECK(light.shade(ball, refract).radiance.at(8, 8)[2] == doctest::Approx(0.96 * 0.5 + 0.04 * 1.5).epsilon(0.03));
}

TEST_CASE("light maps: what bake wrote to a folder lights like what was baked in memory") {
    const TemporaryFolder folder;
    const ImageF image = gradient();
    REQUIRE(write_hdr(folder / "sky.hdr", image.view()));
    auto environment = open_environment({folder / "sky.hdr"});
    REQUIRE(environment);
    BakeOptions options;
    options.preview = false;
    REQUIRE(bake(*environment, options, folder / "out"));
    auto loaded = LightMaps::load(folder / "out");
    REQUIRE_MESSAGE(loaded, (loaded ? "" : loaded.error().format()));
    auto baked = LightMaps::bake(image, {});
    REQUIRE(baked);
    for (const Vec3f& d : {Vec3f{1, 0.2f, 0.1f}, {-0.3f, 1, 0.2f}, {0.1f, -0.4f, -1}}) {
        for (const float roughness : {0.f, 0.25f, 0.5f, 1.f})
            CHECK(length(loaded->specular(d, roughness) - baked->specular(d, roughness)) < 0.02f);  // RGBE and halves
        CHECK(length(loaded->irradiance_over_pi(d) - baked->irradiance_over_pi(d)) < 0.02f);
        CHECK(length(loaded->irradiance_over_pi_sh(d) - baked->irradiance_over_pi(d)) < 0.02f);
    }
    CHECK(loaded->brdf(0.5f, 0.3f).scale == doctest::Approx(baked->brdf(0.5f, 0.3f).scale).epsilon(2e-3));
    CHECK(!LightMaps::load(folder / "none"));
}
