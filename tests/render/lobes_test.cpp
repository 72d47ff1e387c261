// glTF's layers: their samples against the densities that they state, their energy, their symmetries, and pictures
// whose values are known.
#include "domelight/environment/sky/sky.h"
#include "domelight/render/render.h"
#include "domelight/render/shading/shading.h"
#include "domelight/sampling/sequences.h"

#include "render/shapes.h"
#include "render/surface/lobe_albedo.h"
#include "render/surface/surface.h"
#include "sampling/distribution/chi_square.h"
#include "sampling/hemisphere_quadrature.h"
#include "test.h"

#include <algorithm>
#include <functional>

using namespace domelight;
using namespace domelight::test;

namespace {

/// The surface of a material on a floor, seen at an angle from above (or, from inside a body, from below).
struct Seen {
    Scene scene;
    LayeredBsdf layers;
    SurfacePoint point;
    Vec3f V;

    Seen(const Material& m, double degrees, bool from_below = false, bool multiple_scattering = false,
         UnitPoint shift = {}) {
        add(scene, floor_mesh(1, 0), m);
        const double theta = degrees * k_pi / 180, up = from_below ? -1 : 1;
        const Vec3f view(Vec3d{std::sin(theta) * std::cos(0.7), up * std::cos(theta), std::sin(theta) * std::sin(0.7)});
        Hit hit;
        hit.instance = 0, hit.u = hit.v = 0.3f, hit.geometric_normal = {0, 1, 0}, hit.distance = 1;
        point = surface_at(scene, hit, view, -view, multiple_scattering, &layers, shift);
        V = Frame<float>(point.normal).to_local(view);
    }
    Seen(const Seen&) = delete;

    Vec3f evaluate(const Vec3d& L) const { return point.evaluate_cosine(V, Vec3f(L)).sum(); }
    double pdf(const Vec3d& L) const { return point.pdf_solid_angle(V, Vec3f(L)); }
};

constexpr int k_polar = 12, k_azimuth = 12, k_patches = 2 * k_polar * k_azimuth;

/// The sphere in patches: first those of the upper hemisphere, then those of the lower one.
Vec3d turned(const Vec3d& d, bool below) {
    return below ? Vec3d{d.x, d.y, -d.z} : d;
}
int patch_of(const Vec3d& d) {
    return hemisphere_patch_of({d.x, d.y, std::abs(d.z)}, k_polar, k_azimuth) + (d.z < 0 ? k_patches / 2 : 0);
}
template <typename G>
double integrate_patch(int i, const G& g, double tolerance) {
    const bool below = i >= k_patches / 2;
    return integrate(
        hemisphere_patch(i % (k_patches / 2), k_polar, k_azimuth), [&](const Vec3d& d) { return g(turned(d, below)); },
        tolerance);
}
double albedo(const Seen& seen, double tolerance = 1e-5) {
    double sum = 0;
    for (int i = 0; i < k_patches; ++i)
        sum += integrate_patch(
            i, [&](const Vec3d& L) { return double(seen.evaluate(L).y); }, tolerance);
    return sum;
}

Material white(float metalness, float roughness) {
    Material m;
    m.metalness = metalness;
    m.roughness = roughness;
    return m;
}
Material with(Material m, const std::function<void(Material&)>& change) {
    change(m);
    return m;
}
void brush(Material& m) {
    m.anisotropy = 0.7f, m.anisotropy_rotation = 0.4f;
}
void coat(Material& m) {
    m.clearcoat = 1, m.clearcoat_roughness = 0.3f;
}
void fluff(Material& m) {
    m.sheen_color = {1, 1, 1}, m.sheen_roughness = 0.5f;
}
void sheet(Material& m) {
    m.transmission = 1;
}
void body(Material& m) {
    m.transmission = 1, m.thickness = 1;
}

struct Named {
    std::string name;
    Material material;
    bool from_below = false;
};
std::vector<Named> all_lobes() {
    const Material metal = white(1, 0.4f), plastic = white(0, 0.5f);
    return {{"brushed metal", with(metal, brush)},
            {"brushed plastic", with(plastic, brush)},
            {"coated plastic", with(plastic, coat)},
            {"velvet", with(plastic, fluff)},
            {"sheet", with(plastic, sheet)},
            {"body", with(plastic, body)},
            {"body from inside", with(plastic, body), true},
            {"brushed body", with(with(plastic, body), brush), true},
            {"all", with(with(with(with(white(0.3f, 0.5f), brush), coat), fluff), [](Material& m) {
                 body(m);
                 m.transmission = 0.6f;
                 m.base_color = {0.9f, 0.7f, 0.5f};
                 m.specular_color = {0.3f, 0.9f, 2};
             })}};
}

RayScene trace(Scene scene) {
    auto traced = RayScene::build(std::move(scene));
    REQUIRE(traced);
    return std::move(*traced);
}
Scene one(Mesh mesh, Material material) {
    Scene scene;
    add(scene, std::move(mesh), std::move(material));
    return scene;
}
RenderOptions view(int size, int samples) {
    RenderOptions o;
    o.width = o.height = size;
    o.samples = samples;
    o.camera = look_at({0, 0, 4}, {0, 0, 0}, 0.6f);
    return o;
}
RenderResult render(const RayScene& scene, const ImageF& environment, const RenderOptions& o) {
    auto sampler = EnvironmentSampler::build(environment, reference_sampler_options(o.strategy));
    REQUIRE(sampler);
    auto result = render_reference(scene, *sampler, o);
    REQUIRE(result);
    return std::move(*result);
}
double mean_inside(const RenderResult& r) {
    double sum = 0;
    int n = 0;
    for (int y = 0; y < r.radiance.height(); ++y)
        for (int x = 0; x < r.radiance.width(); ++x)
            if (*r.opacity.at(x, y) == 1) sum += r.radiance.at(x, y)[1], ++n;
    REQUIRE(n > 0);
    return sum / n;
}
/// A light that changes slowly everywhere, and differently in each channel.
ImageF smooth_environment() {
    ImageF image(64, 32, 3);
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 64; ++x) {
            const double theta = (y + 0.5) * k_pi / 32, phi = (x + 0.5) * 2 * k_pi / 64;
            float* p = image.at(x, y);
            p[0] = float(2 + std::sin(theta) * std::cos(phi));
            p[1] = float(2 + std::cos(theta));
            p[2] = float(2 + std::sin(theta) * std::sin(phi));
        }
    return image;
}
/// Top and bottom of a slab of glass, the lower one facing down.
Scene slab(float thickness, const Material& glass) {
    Mesh mesh = floor_mesh(100, 0), bottom = floor_mesh(100, -thickness);
    for (const Vec3f& p : bottom.positions) mesh.positions.push_back(p);
    mesh.normals.insert(mesh.normals.end(), 4, {0, -1, 0});
    mesh.indices.insert(mesh.indices.end(), {4, 6, 5, 4, 7, 6});
    return one(std::move(mesh), glass);
}

}  // namespace

TEST_CASE("lobes: draws follow the stated density, and weigh what the lobes reflect and let through") {
    std::uint64_t seed = 40;
    constexpr int k_samples = 40000;
    for (const Named& n : all_lobes())
        for (const double degrees : {10.0, 45.0, 80.0})
            for (const bool multiple_scattering : {false, true}) {
                if (multiple_scattering && degrees != 45) continue;
                const Seen seen(n.material, degrees, n.from_below, multiple_scattering);
                INFO(n.name << " at " << degrees);
                REQUIRE(seen.point.layers);
                std::vector<double> counts(k_patches + 1), expected(k_patches + 1);
                double sum = 0, squares = 0;
                ++seed;
                for (int i = 0; i < k_samples; ++i) {
                    const Bsdf::Sample s =
                        seen.layers.sample(seen.V, random_point(seed, std::uint32_t(i)),
                                           unit_float(random_point(seed + 1000, std::uint32_t(i)).x));
                    const bool drawn = s.pdf_solid_angle > 0;
                    ++counts[drawn ? patch_of(Vec3d(s.L)) : k_patches];
                    const double weight = drawn ? seen.evaluate(Vec3d(s.L)).y / s.pdf_solid_angle : 0;
                    sum += weight, squares += weight * weight;
                    REQUIRE(std::isfinite(weight));
                    if (drawn) CHECK(std::abs(dot(s.L, s.L) - 1) < 1e-5);
                }
                double drawn = 0, reflected = 0;
                for (int i = 0; i < k_patches; ++i) {
                    drawn += expected[i] = integrate_patch(
                        i, [&](const Vec3d& L) { return seen.pdf(L); }, 3e-6);
                    reflected += integrate_patch(
                        i, [&](const Vec3d& L) { return double(seen.evaluate(L).y); }, 3e-6);
                }
                expected[k_patches] = std::max(0.0, 1 - drawn);
                CHECK(drawn < 1 + 2e-3);
                CHECK(chi_square_p_value(counts, expected) > 1e-3 / 36);
                const double mean = sum / k_samples,
                             error = std::sqrt(std::max(0.0, squares / k_samples - mean * mean) / k_samples);
                CHECK(std::abs(mean - reflected) < 4.5 * error + 1e-3);
            }
}

TEST_CASE("lobes: white under a white light stays white with multiple scattering, and never gains without") {
    for (const float roughness : {0.3f, 0.6f, 1.f})
        for (const double degrees : {5.0, 50.0, 75.0, 86.0}) {
            const Material metal = white(1, roughness), plastic = white(0, roughness);
            const std::vector<Named> conserving = {
                {"brushed metal", with(metal, brush)},
                {"coated metal", with(metal, coat)},
                {"coated plastic", with(plastic, coat)},
                {"rough coat", with(plastic, [](Material& m) { m.clearcoat = m.clearcoat_roughness = 1; })},
                {"velvet", with(plastic, fluff)},
                {"sheet", with(plastic, sheet)},
                {"half a sheet", with(plastic, [](Material& m) { m.transmission = 0.5f; })},
                {"body", with(plastic, body)},
                {"body from inside", with(plastic, body), true},
                {"plastic", plastic},
            };
            for (const Named& n : conserving) {
                INFO(n.name << ", roughness " << roughness << " at " << degrees);
                // If the albedo is estimated from few normals, each estimate is close and their mean is right (next
                // test).
                const bool by_few = n.material.transmission > 0 || n.material.anisotropy > 0;
                CHECK(std::abs(albedo(Seen(n.material, degrees, n.from_below, true)) - 1) < (by_few ? 0.05 : 1e-3));
                // glTF's diffuse layer below a dielectric gains energy at grazing angles; nothing else does.
                if (n.material.metalness == 1 || n.material.transmission == 1)
                    CHECK(albedo(Seen(n.material, degrees, n.from_below, false)) < 1 + 1e-4);
            }
        }
}

TEST_CASE("lobes: the albedo of a boundary, from few normals at a time, is right in the mean") {
    for (const float roughness : {0.3f, 0.6f, 1.f})
        for (const double degrees : {5.0, 50.0, 75.0, 86.0})
            for (const Named& n : {Named{"sheet", with(white(0, roughness), sheet)},
                                   Named{"brushed sheet", with(with(white(0, roughness), brush), sheet)},
                                   Named{"body", with(white(0, roughness), body)},
                                   Named{"body from inside", with(white(0, roughness), body), true}}) {
                const Seen seen(n.material, degrees, n.from_below);
                double mean = 0, squares = 0;
                constexpr int k_shifts = 400;
                for (std::uint32_t i = 0; i < k_shifts; ++i) {
                    const InterfaceAlbedo a =
                        interface_albedo(seen.layers.gloss, seen.layers.to_tangent(seen.V), sobol_owen(1, i));
                    const double all = a.reflected(0.04f, 1) + a.transmitted(0.04f, 1);
                    mean += all / k_shifts;
                    squares += all * all / k_shifts;
                }
                INFO(n.name << ", roughness " << roughness << " at " << degrees);
                CHECK(mean == doctest::Approx(albedo(seen)).epsilon(5e-4));
                CHECK(squares - mean * mean < 0.02 * 0.02 * mean * mean);
            }
}

TEST_CASE("lobes: sheen sends out no more than comes in at any roughness") {
    for (const float roughness : {0.f, 0.1f, 0.3f, 0.7f, 1.f})
        for (const double degrees : {0.0, 60.0, 85.0, 89.0}) {
            Material m = white(1, 1);
            m.base_color = {0, 0, 0};
            m.sheen_color = {1, 1, 1};
            m.sheen_roughness = roughness;
            m.metalness = 0;
            m.specular = 0;
            INFO("roughness " << roughness << " at " << degrees);
            CHECK(albedo(Seen(m, degrees)) < 1 + 2e-3);
            m.base_color = {1, 1, 1};
            // The table has few points for the lobe's narrow rim at low roughness.
            CHECK(albedo(Seen(m, degrees)) == doctest::Approx(1).epsilon(roughness < 0.2f ? 0.015 : 2e-3));
        }
}

TEST_CASE("lobes: microfacets are reciprocal, by reflection and through a boundary") {
    const EllipticGgx ggx{0.6f, 0.2f};
    const InterfaceLobe out{ggx, 1.5f, false}, in{ggx, 1 / 1.5f, false}, sheet{ggx, 1.5f, true};
    int through = 0;
    for (std::uint32_t i = 0; i < 2000; ++i) {
        const Vec3f V = uniform_hemisphere(random_point(3, i)), L = uniform_hemisphere(random_point(4, i)), down = -L;
        CHECK(ggx.evaluate(V, L) == doctest::Approx(ggx.evaluate(L, V)).epsilon(1e-4));
        CHECK(sheet.transmission(V, down).value == doctest::Approx(sheet.transmission(L, -V).value).epsilon(1e-4));
        // Walter et al. 2007, eq. 15: f / n² with the n of the side to which the light leaves; the lobe contains the
        // factor n².
        const auto one_way = out.transmission(V, down), other_way = in.transmission(L, -V);
        through += one_way.value > 0;
        CHECK(one_way.value == doctest::Approx(1.5 * 1.5 * other_way.value).epsilon(2e-3));
        if (one_way.value > 0) CHECK(std::abs(out.fresnel(one_way.VdotH) - in.fresnel(other_way.VdotH)) < 1e-3);
    }
    CHECK(through > 300);
}

TEST_CASE("lobes: Fresnel's equations at known angles") {
    CHECK(fresnel_dielectric(1, 1.5f) == doctest::Approx(0.04).epsilon(1e-5));
    CHECK(fresnel_dielectric(0, 1.5f) == doctest::Approx(1));
    // At Brewster's angle only s is reflected: (sin(i - t))^2 / 2 with i + t = 90 degrees.
    const double brewster = std::atan(1.5), apart = 2 * brewster - k_pi / 2;
    CHECK(fresnel_dielectric(float(std::cos(brewster)), 1.5f) ==
          doctest::Approx(0.5 * std::pow(std::sin(apart), 2)).epsilon(1e-4));
    CHECK(fresnel_dielectric(0.7f, 1 / 1.5f) == 1);  // beyond 41.8 degrees
    CHECK(fresnel_weight(0.3f, 1) == 0);
}

TEST_CASE("lobes: a brushed surface of strength 0 is the round one, and so is its lobe") {
    const EllipticGgx ggx{0.3f, 0.3f};
    const GgxBrdf round{0.3f};
    for (std::uint32_t i = 0; i < 500; ++i) {
        const Vec3f V = uniform_hemisphere(random_point(5, i)), L = uniform_hemisphere(random_point(6, i));
        CHECK(ggx.evaluate(V, L) == doctest::Approx(round.evaluate(V, L).x).epsilon(1e-4));
        CHECK(ggx.pdf_solid_angle(V, L) == doctest::Approx(round.pdf_solid_angle(V, L)).epsilon(1e-4));
        CHECK(length(ggx.sample(V, random_point(7, i)) - round.sample(V, random_point(7, i)).L) < 1e-4);
    }
    CHECK(!Seen(with(white(1, 0.5f), [](Material& m) { m.anisotropy_rotation = 1; }), 30).point.layers);
    // A surface that is smooth in one direction and rough in the other has a highlight that is stretched in the rough
    // direction.
    Material m = with(white(1, 0.3f), [](Material& b) { b.anisotropy = 1; });
    const Seen seen(m, 0);
    const Vec3f x = Frame<float>(seen.point.normal).to_local({0, 0, 1});  // brushed around the vertical axis
    CHECK(seen.layers.gloss.ggx.alpha_x == 1);
    CHECK(seen.layers.gloss.ggx.alpha_y == doctest::Approx(0.09));
    CHECK(std::isfinite(x.x));
}

TEST_CASE("lobes: brushing follows the texture coordinates and turns with its rotation") {
    // u runs along +x, v (down the picture) along -z of the floor seen from above: glTF's tangent and bitangent.
    Mesh mesh = floor_mesh(1, 0);
    mesh.texcoords[0] = {{0, 0}, {1, 0}, {1, -1}, {0, -1}};
    for (const float rotation : {0.f, float(k_pi / 4), float(k_pi / 2)}) {
        Material m = white(1, 0.3f);
        m.anisotropy = 1;
        m.anisotropy_rotation = rotation;
        Scene scene = one(mesh, m);
        Hit hit;
        hit.instance = 0, hit.u = hit.v = 0.3f, hit.geometric_normal = {0, 1, 0};
        LayeredBsdf layers;
        const SurfacePoint p = surface_at(scene, hit, {0, 1, 0}, {0, -1, 0}, false, &layers);
        const Vec3f along = Frame<float>(p.normal).to_world({layers.tangent_x, layers.tangent_y, 0});
        CHECK(along.y == doctest::Approx(0));
        CHECK(along.x * along.z == doctest::Approx(-0.5 * std::sin(2 * rotation)).epsilon(1e-5));
        CHECK(along.x * along.x == doctest::Approx(std::pow(std::cos(rotation), 2)).epsilon(1e-5));
    }
}

TEST_CASE("lobes: layers that a texture takes away leave the base, bit for bit") {
    Rgba8Image black;
    black.width = black.height = 1;
    black.rgba = {0, 0, 0, 255};
    const Material base = white(0.2f, 0.4f);
    Material layered = base;
    layered.clearcoat = layered.transmission = layered.anisotropy = 1;
    layered.sheen_color = {1, 1, 1};
    for (SceneTexture* t : {&layered.clearcoat_texture, &layered.transmission_texture, &layered.anisotropy_texture,
                            &layered.sheen_color_texture})
        t->image = 0;
    RenderOptions o = view(16, 16);
    o.bounces = 2;
    Scene a = one(sphere_mesh(24), base), b = one(sphere_mesh(24), layered);
    add(a, floor_mesh(3, -1), base);
    add(b, floor_mesh(3, -1), layered);
    b.images.push_back(black);
    const RenderResult plain = render(trace(std::move(a)), smooth_environment(), o),
                       other = render(trace(std::move(b)), smooth_environment(), o);
    CHECK(std::ranges::equal(plain.radiance.pixels(), other.radiance.pixels()));
    CHECK(std::ranges::equal(plain.diffuse.pixels(), other.diffuse.pixels()));
}

TEST_CASE("lobes: a body of the index of air shows the background unchanged") {
    Material air = with(white(0, 0), body);
    air.ior = 1;
    RenderOptions o = view(24, 16);
    // Even the smoothest lobe has a tail: with MIS, one sample in thousands counts as drawn from the environment.
    o.strategy = LightStrategy::brdf;
    const RenderResult seen = render(trace(one(sphere_mesh(300), air)), smooth_environment(), o);
    Scene far = one(sphere_mesh(8), air);
    far.instances[0].to_world.translation = {0, 0, 1000};
    const RenderResult empty = render(trace(std::move(far)), smooth_environment(), o);
    CHECK(*seen.opacity.at(12, 12) == 1);
    for (int y = 0; y < 24; ++y)
        for (int x = 0; x < 24; ++x)
            for (int c = 0; c < 3; ++c)
                CHECK(seen.radiance.at(x, y)[c] == doctest::Approx(empty.radiance.at(x, y)[c]).epsilon(2e-3));
}

TEST_CASE("lobes: light through a slab follows Beer's law, with all its inner reflections") {
    Material glass = with(white(0, 0), body);
    glass.attenuation_color = {0.5f, 0.25f, 1};
    glass.attenuation_distance = 2;
    RenderOptions o = view(2, 256);
    o.camera = look_at({0, 3, 0.001f}, {0, 0, 0}, 0.02f);
    for (const float ior : {1.f, 1.5f, 2.4f}) {
        glass.ior = ior;
        const RenderResult r = render(trace(slab(3, glass)), ImageF(16, 8, 3, 1.f), o);
        const double R = std::pow((ior - 1) / (ior + 1), 2);
        for (int c = 0; c < 3; ++c) {
            const double color[] = {0.5, 0.25, 1}, a = std::pow(color[c], 3 / 2.0);
            // Light from below through both faces, light from above reflected by the first one, and light reflected to
            // and fro inside.
            const double truth = R + (1 - R) * (1 - R) * a / (1 - R * a);
            INFO("ior " << ior << " channel " << c);
            CHECK(r.radiance.at(0, 0)[c] == doctest::Approx(truth).epsilon(0.01));
        }
    }
}

TEST_CASE("lobes: without occlusion glass shows the environment refracted at its first surface") {
    Material glass = with(white(0, 0), body);
    glass.attenuation_color = {0.5f, 0.5f, 0.5f};
    glass.attenuation_distance = 1;
    RenderOptions o = view(1, 1024);
    o.occlusion = false;
    o.camera = look_at({2, 2, 0}, {0, 0, 0}, 0.001f);
    const ImageF environment = smooth_environment();
    auto sampler = EnvironmentSampler::build(environment, reference_sampler_options());
    const RenderResult r = render(trace(slab(3, glass)), environment, o);
    const double c = std::sqrt(0.5), t = std::sqrt(1 - 0.5 / 2.25), F = fresnel_dielectric(float(c), 1.5f);
    const Vec3f down{-float(c / 1.5), -float(t), 0}, up{-float(c), float(c), 0};
    for (int k = 0; k < 3; ++k) {
        const auto part = [&](const Vec3f& d) {
            const Vec3f light = sampler->radiance(d);
            return (k == 0 ? light.x : k == 1 ? light.y : light.z);
        };
        CHECK(r.radiance.at(0, 0)[k] == doctest::Approx(F * part(up) + (1 - F) * 0.5 * part(down)).epsilon(5e-3));
    }
}

TEST_CASE(
    "lobes: a glass sphere in a white furnace is white, rough or smooth, and what is seen through it direct light") {
    for (const float roughness : {0.f, 0.5f}) {
        const RayScene scene = trace(one(sphere_mesh(96), with(white(0, roughness), body)));
        RenderOptions o = view(16, 128);
        o.background = Background::transparent;
        o.multiple_scattering = true;
        o.refractions = 200;
        const RenderResult r = render(scene, ImageF(32, 16, 3, 1.f), o);
        INFO("roughness " << roughness);
        // The error of meshes, whose normals are smooth although their triangles are flat.
        CHECK(mean_inside(r) == doctest::Approx(1).epsilon(0.01));
        CHECK(*std::ranges::max_element(r.indirect.pixels()) == 0);
        // With few passages only the light that is reflected to and fro is lost.
        o.refractions = 2;
        CHECK(mean_inside(render(scene, ImageF(32, 16, 3, 1.f), o)) < mean_inside(r) + 1e-3);
    }
}

TEST_CASE("lobes: brushed metal and sheets keep their light in a white furnace") {
    for (const Material& m : {with(white(1, 0.6f), brush), with(white(0, 0.6f), sheet)}) {
        RenderOptions o = view(16, 1024);
        o.background = Background::transparent;
        o.multiple_scattering = true;
        o.bounces = 8;  // inside the hollow sphere
        o.refractions = 64;
        o.strategy = LightStrategy::brdf;  // this has the least noise under an even light
        const RenderResult r = render(trace(one(sphere_mesh(96), m)), ImageF(32, 16, 3, 1.f), o);
        CHECK(std::abs(mean_inside(r) - 1) < 1e-3);
    }
}

TEST_CASE("lobes: a material of absurd numbers gives finite pictures") {
    Material m = with(with(with(white(0, 0.2f), body), coat), fluff);
    m.thickness = m.ior = std::numeric_limits<float>::max();
    m.attenuation_color = {0, 0.5f, 1};
    m.attenuation_distance = 1e-38f;
    for (const bool occlusion : {true, false})
        for (const float ior : {m.ior, 1.f, 1.0005f, 1.002f, 0.f}) {
            m.ior = ior;
            RenderOptions o = view(8, 16);
            o.occlusion = occlusion;
            o.multiple_scattering = occlusion;
            const RenderResult r = render(trace(one(sphere_mesh(12), m)), ImageF(16, 8, 3, 1.f), o);
            INFO("index " << ior << " occlusion " << occlusion);
            for (const float v : r.radiance.pixels()) CHECK(std::abs(v - 1) <= 1);
            // Samples that are not finite would count as black.
            CHECK(r.radiance.at(4, 4)[2] > 0.01f);
        }
}

TEST_CASE("lobes: what lies behind a sheet is lit as if it were not there, less what the sheet takes") {
    // A luminous matte wall behind a window that reflects nothing and lets half of the light through.
    Material window = with(white(0, 0), sheet);
    window.base_color = {0.5f, 0.5f, 0.5f};
    window.ior = 1;
    window.specular = 0;
    Material wall = lambert_material(0);
    wall.emission = {2, 2, 2};
    Scene scene = one(floor_mesh(100, 0), wall);
    add(scene, floor_mesh(100, 1), window);
    RenderOptions o = view(2, 64);
    o.camera = look_at({0, 3, 0.001f}, {0, 0, 0}, 0.02f);
    const RenderResult r = render(trace(std::move(scene)), ImageF(16, 8, 3), o);
    CHECK(r.radiance.at(0, 0)[1] == doctest::Approx(1).epsilon(1e-3));
    CHECK(r.direct.at(0, 0)[1] == doctest::Approx(1).epsilon(1e-3));
}

TEST_CASE("lobes: a coat dims what shines below it by what it reflects") {
    Material m = with(white(0, 0.5f), coat);
    m.emission = {1, 1, 1};
    m.clearcoat_roughness = 0;
    CHECK(Seen(m, 0).point.emission.x == doctest::Approx(0.96).epsilon(1e-3));
    CHECK(Seen(m, 89).point.emission.x < 0.2);
}

TEST_CASE("lobes: all strategies find the same light, and all threads the same bits") {
    SkyOptions sky;
    sky.height = 32;
    ImageF environment(64, 32, 3);
    REQUIRE(make_sky(sky)->read(environment.view()));
    for (float& p : environment.pixels()) p /= 3000;
    for (const Named& n : all_lobes()) {
        if (n.from_below) continue;
        const RayScene scene = trace(one(sphere_mesh(48), n.material));
        RenderOptions o = view(16, 128);
        o.background = Background::transparent;
        o.bounces = 1;
        const RenderResult r = render(scene, environment, o);
        const double both = mean_inside(r);
        INFO(n.name);
        o.threads = 3;
        CHECK(std::ranges::equal(r.radiance.pixels(), render(scene, environment, o).radiance.pixels()));
        o.threads = 0;
        for (const LightStrategy strategy : {LightStrategy::environment, LightStrategy::brdf}) {
            o.strategy = strategy;
            o.samples = 512;
            CHECK(mean_inside(render(scene, environment, o)) == doctest::Approx(both).epsilon(0.03));
        }
    }
}

TEST_CASE("lobes: the approximations say what they leave out, the reference what its other models do") {
    Scene scene = one(sphere_mesh(8), with(with(white(0, 0.5f), coat), fluff));
    CHECK(not_rendered(scene).empty());
    CHECK(not_rendered(scene, ShadingModel::split_sum).size() == 2);
    CHECK(not_rendered(scene, ShadingModel::mirror).empty());
    scene.materials[0].phong = true;
    CHECK(not_rendered(scene).size() == 2);
}
