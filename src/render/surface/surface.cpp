#include "render/surface/surface.h"

#include "domelight/image/colour.h"

#include "render/surface/lobe_albedo.h"
#include "render/surface/surface_lobes.h"

#include <algorithm>
#include <cmath>

namespace domelight {
namespace {

Vec3f mix(const Vec3f& a, const Vec3f& b, float t) {
    return a + (b - a) * t;
}
Rgba base_color(const Scene& scene, const Material& m, const Corners& c) {
    Rgba base = look_up(scene, m.base_color_texture, c, true);
    base.rgb = product(base.rgb, m.base_color);
    base.a *= m.opacity;
    if (const auto& colors = c.mesh.colors; !colors.empty()) {
        Vec3f rgb;
        float a = 0;
        for (int k = 0; k < 3; ++k) rgb += colors[c.i[k]].rgb * c.w[k], a += colors[c.i[k]].a * c.w[k];
        base.rgb = product(base.rgb, rgb);
        base.a *= a;
    }
    return base;
}

Vec3f emission_of(const Scene& scene, const Material& m, const Corners& c) {
    return product(m.emission, look_up(scene, m.emission_texture, c, true).rgb);
}

float opacity_of(const Material& m, float alpha) {
    switch (m.alpha_mode) {
        case Material::AlphaMode::opaque:
            return 1;
        case Material::AlphaMode::mask:
            return alpha >= m.alpha_cutoff ? 1 : 0;
        case Material::AlphaMode::blend:
            break;
    }
    return std::clamp(alpha, 0.f, 1.f);
}

/// Beckmann's relation between a Phong exponent and a GGX width: n = 2 / alpha^2 - 2.
float phong_exponent(float alpha) {
    return std::max(0.f, 2 / std::max(alpha * alpha, 1e-7f) - 2);
}

/// The base of a surface, with the values that its layers need.
struct Base {
    Bsdf bsdf;
    float metalness = 0, roughness = 1;
    Vec3f dielectric_f0, dielectric_f90;
};

Base make_base(const Scene& scene, const Material& m, const Corners& c, const Vec3f& color, float NdotV,
               bool multiple_scattering) {
    Base out;
    Bsdf& bsdf = out.bsdf;
    if (m.lambert) {
        bsdf.diffuse = color;
        return out;
    }
    const Rgba metallic_roughness = look_up(scene, m.metallic_roughness_texture, c, false);
    const float metalness = std::clamp(m.metalness * metallic_roughness.rgb.z, 0.f, 1.f),
                roughness = std::clamp(m.roughness * metallic_roughness.rgb.y, 0.f, 1.f);
    const float specular = m.specular * look_up(scene, m.specular_texture, c, false).a;
    const Vec3f tint = product(m.specular_color, look_up(scene, m.specular_color_texture, c, true).rgb);
    const float ratio = (m.ior - 1) / (m.ior + 1), f0 = ratio * ratio;
    const auto least_one = [](float x) { return std::min(x, 1.f); };
    bsdf.dielectric_f0 = Vec3f{least_one(f0 * tint.x), least_one(f0 * tint.y), least_one(f0 * tint.z)} * specular;
    bsdf.dielectric_f90 = {specular, specular, specular};
    bsdf.f0 = mix(bsdf.dielectric_f0, color, metalness);
    bsdf.f90 = mix(bsdf.dielectric_f90, {1, 1, 1}, metalness);
    bsdf.diffuse = color * (1 - metalness);
    bsdf.kind = m.phong ? Bsdf::Kind::phong : Bsdf::Kind::metallic_roughness;
    bsdf.alpha = std::max(roughness * roughness, k_least_brdf_alpha);
    bsdf.exponent = phong_exponent(bsdf.alpha);
    bsdf.separable_masking = m.separable_masking;
    out.metalness = metalness;
    out.roughness = roughness;
    out.dielectric_f0 = bsdf.dielectric_f0;
    out.dielectric_f90 = bsdf.dielectric_f90;
    if (multiple_scattering && !m.phong) {
        const TableAlbedo albedo = table_albedo(NdotV, roughness);
        bsdf.compensation = albedo.all() > 0 ? 1 / albedo.all() - 1 : 0;
        // The layer below receives the light that the layer above leaves, averaged over all directions (as in
        // Fdez-Aguera 2019): with glTF's 1 - F(VdotH) more light would be reflected than received at grazing angles.
        const auto reflected = [&](float low, float high) {
            return std::min(1.f, (low * albedo.scale + high * albedo.bias) * (1 + low * bsdf.compensation));
        };
        const Vec3f &low = out.dielectric_f0, &high = out.dielectric_f90;
        const float most = std::max({reflected(low.x, high.x), reflected(low.y, high.y), reflected(low.z, high.z)});
        bsdf.dielectric_f0 = bsdf.dielectric_f90 = {most, most, most};
    }
    // The lobes are sampled roughly in proportion to their reflection: the specular lobe by its reflectance at this
    // angle.
    const float schlick = schlick_weight(NdotV), gloss = luminance(bsdf.f0 + (bsdf.f90 - bsdf.f0) * schlick),
                matt = luminance(bsdf.diffuse);
    bsdf.specular_share = matt <= 0 ? 1 : gloss <= 0 ? 0 : std::clamp(gloss / (gloss + matt), 0.2f, 0.9f);
    return out;
}

}  // namespace

SurfacePoint surface_at(const Scene& scene, const Hit& hit, const Vec3f& origin, const Vec3f& direction,
                        bool multiple_scattering, LayeredBsdf* layers, UnitPoint shift) {
    const Instance& instance = scene.instances[hit.instance];
    const Mesh& mesh = scene.meshes[instance.mesh];
    const Material& m = scene.materials[mesh.material];
    const Corners c(mesh, hit);
    SurfacePoint out;
    // Computed from the corners and not along the ray, because a long ray has lost digits.
    out.position = instance.to_world.point(c.mean(mesh.positions));
    const Vec3f reach{std::abs(out.position.x) + std::abs(origin.x), std::abs(out.position.y) + std::abs(origin.y),
                      std::abs(out.position.z) + std::abs(origin.z)};
    out.error = 4e-6f * std::max({reach.x, reach.y, reach.z, hit.distance});
    out.front = dot(hit.geometric_normal, direction) < 0;
    const float side = out.front ? 1.f : -1.f;
    out.geometric_normal = unit_or(hit.geometric_normal, -direction) * side;
    Vec3f smooth = out.geometric_normal;
    if (!mesh.normals.empty())
        smooth = unit_or(
            instance.to_world.normal(c.mean(mesh.normals)) * (instance.to_world.determinant() < 0 ? -side : side),
            out.geometric_normal);
    Vec3f normal = smooth;
    // Seen from behind, the normal-mapped surface is flipped as a whole.
    if (m.normal_texture)
        normal = mapped_normal(scene, m.normal_texture, m.normal_scale, c, instance.to_world, smooth * side) * side;
    normal = facing_normal(normal, direction, out.geometric_normal);
    out.normal = normal;

    const Rgba base = base_color(scene, m, c);
    out.opacity = opacity_of(m, base.a);
    out.emission = m.unlit ? base.rgb : emission_of(scene, m, c);
    out.albedo = base.rgb;
    out.unlit = m.unlit;
    if (m.unlit) return out;
    const Base below = make_base(scene, m, c, base.rgb, -dot(normal, direction), multiple_scattering);
    out.bsdf = below.bsdf;
    if (!layers || !has_layers(m)) return out;
    *layers = {};
    layers->base = below.bsdf;
    if (make_layers(
            {scene, instance, m, c, -direction, normal, smooth, out.geometric_normal, out.front, base.rgb,
             below.metalness, below.roughness, below.dielectric_f0, below.dielectric_f90, multiple_scattering, shift},
            *layers)) {
        out.layers = layers;
        out.emission *= layers->under();
    }
    return out;
}

Vec3f emission_before_layers(const Scene& scene, const Hit& hit) {
    const Mesh& mesh = scene.meshes[scene.instances[hit.instance].mesh];
    const Material& m = scene.materials[mesh.material];
    const Corners c(mesh, hit);
    return m.unlit ? base_color(scene, m, c).rgb : emission_of(scene, m, c);
}

Vec3f emission_at(const Scene& scene, const Hit& hit, const Vec3f& origin, const Vec3f& direction,
                  bool multiple_scattering) {
    const Material& m = scene.materials[scene.meshes[scene.instances[hit.instance].mesh].material];
    if (m.unlit || !has_layers(m)) return emission_before_layers(scene, hit);
    LayeredBsdf layers;
    return surface_at(scene, hit, origin, direction, multiple_scattering, &layers).emission;
}

float opacity_at(const Scene& scene, const Hit& hit) {
    const Mesh& mesh = scene.meshes[scene.instances[hit.instance].mesh];
    const Material& m = scene.materials[mesh.material];
    if (m.alpha_mode == Material::AlphaMode::opaque) return 1;
    return opacity_of(m, base_color(scene, m, Corners(mesh, hit)).a);
}

float occlusion_at(const Scene& scene, const Hit& hit) {
    const Mesh& mesh = scene.meshes[scene.instances[hit.instance].mesh];
    const Material& m = scene.materials[mesh.material];
    // glTF 2.0, 3.9.3: 1 + strength (texel - 1).
    return 1 + m.occlusion_strength * (look_up(scene, m.occlusion_texture, Corners(mesh, hit), false).rgb.x - 1);
}

bool has_passages(const Scene& scene) {
    return std::ranges::any_of(scene.materials,
                               [](const Material& m) { return m.alpha_mode != Material::AlphaMode::opaque; });
}

}  // namespace domelight
