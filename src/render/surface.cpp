#include "render/surface.h"

#include "domelight/brdf_table.h"
#include "domelight/colour.h"

#include "render/texture_lookup.h"

#include <algorithm>
#include <cmath>

namespace domelight {
namespace {

Vec3f mix(const Vec3f& a, const Vec3f& b, float t) {
    return a + (b - a) * t;
}
Vec3f unit_or(const Vec3f& v, const Vec3f& otherwise) {
    const float n = dot(v, v);
    return n > 1e-30f && std::isfinite(n) ? v / std::sqrt(n) : otherwise;
}

/// A triangle's corners and the weights of a point in it.
struct Corners {
    const Mesh& mesh;
    std::uint32_t i[3];
    float w[3];
    Corners(const Mesh& m, const Hit& hit) : mesh(m), w{1 - hit.u - hit.v, hit.u, hit.v} {
        for (int k = 0; k < 3; ++k) i[k] = m.indices[3 * std::size_t(hit.triangle) + k];
    }
    Vec3f mean(const std::vector<Vec3f>& values) const {
        return values[i[0]] * w[0] + values[i[1]] * w[1] + values[i[2]] * w[2];
    }
    Mesh::TexCoord texcoord(int set) const {
        const auto& t = mesh.texcoords[set == 1 ? 1 : 0];
        if (t.empty()) return {};
        return {t[i[0]].u * w[0] + t[i[1]].u * w[1] + t[i[2]].u * w[2],
                t[i[0]].v * w[0] + t[i[1]].v * w[1] + t[i[2]].v * w[2]};
    }
};

Rgba look_up(const Scene& scene, const SceneTexture& t, const Corners& c, bool srgb) {
    return t ? look_up(scene, t, c.texcoord(t.texcoord), srgb) : Rgba{};
}

Rgba base_color(const Scene& scene, const Material& m, const Corners& c) {
    Rgba base = look_up(scene, m.base_color_texture, c, true);
    base.rgb = product(base.rgb, m.base_color);
    base.a *= m.opacity;
    if (const auto& colors = c.mesh.colors; !colors.empty()) {
        Vec3f rgb;
        float a = 0;
        for (int k = 0; k < 3; ++k) rgb = rgb + colors[c.i[k]].rgb * c.w[k], a += colors[c.i[k]].a * c.w[k];
        base.rgb = product(base.rgb, rgb);
        base.a *= a;
    }
    return base;
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

/// The interpolated normal, bent by the normal map. The tangents are the mesh's, or follow from the texture
/// coordinates.
Vec3f mapped_normal(const Scene& scene, const Material& m, const Corners& c, const Affine& to_world,
                    const Vec3f& normal) {
    const Rgba texel = look_up(scene, m.normal_texture, c, false);
    const Vec3f bend{(2 * texel.rgb.x - 1) * m.normal_scale, (2 * texel.rgb.y - 1) * m.normal_scale,
                     2 * texel.rgb.z - 1};
    Vec3f tangent, bitangent;
    if (!c.mesh.tangents.empty()) {
        const auto& t = c.mesh.tangents;
        tangent = to_world.vector(t[c.i[0]].t * c.w[0] + t[c.i[1]].t * c.w[1] + t[c.i[2]].t * c.w[2]);
        bitangent = cross(normal, tangent) * (t[c.i[0]].sign * (to_world.determinant() < 0 ? -1.f : 1.f));
    } else {
        const auto& uv = c.mesh.texcoords[m.normal_texture.texcoord == 1 ? 1 : 0];
        if (uv.empty()) return normal;
        const Vec3f e1 = to_world.vector(c.mesh.positions[c.i[1]] - c.mesh.positions[c.i[0]]),
                    e2 = to_world.vector(c.mesh.positions[c.i[2]] - c.mesh.positions[c.i[0]]);
        const float u1 = uv[c.i[1]].u - uv[c.i[0]].u, v1 = uv[c.i[1]].v - uv[c.i[0]].v,
                    u2 = uv[c.i[2]].u - uv[c.i[0]].u, v2 = uv[c.i[2]].v - uv[c.i[0]].v, determinant = u1 * v2 - u2 * v1;
        if (determinant == 0) return normal;
        const float sign = determinant < 0 ? -1.f : 1.f;
        tangent = (e1 * v2 - e2 * v1) * sign;
        // glTF's textures have v down: green points up, against v.
        bitangent = (e1 * u2 - e2 * u1) * sign;
    }
    const Vec3f t = unit_or(tangent - normal * dot(normal, tangent), {}),
                b = unit_or(bitangent - normal * dot(normal, bitangent), {});
    return unit_or(t * bend.x + b * bend.y + normal * bend.z, normal);
}

/// Share of light that single scattering keeps at a viewing angle, F0 = 1: scale + bias of the BRDF table.
float single_scattering_albedo(float NdotV, float roughness) {
    const ImageF& table = brdf_table_default();
    const int n = table.width();
    // Between texel centres, and in a straight line on beyond the outermost: at roughness 1 clamping would be 1 % off.
    const float x = NdotV * float(n) - 0.5f, y = roughness * float(n) - 0.5f;
    const int x0 = std::clamp(int(x), 0, n - 2), y0 = std::clamp(int(y), 0, n - 2);
    const auto at = [&](int i, int j) { return table.at(i, j)[0] + table.at(i, j)[1]; };
    const float a = x - float(x0), b = y - float(y0);
    const float upper = at(x0, y0) + a * (at(x0 + 1, y0) - at(x0, y0)),
                lower = at(x0, y0 + 1) + a * (at(x0 + 1, y0 + 1) - at(x0, y0 + 1));
    return upper + b * (lower - upper);
}

/// Beckmann's classic match of a Phong exponent to a GGX width: n = 2 / alpha^2 - 2.
float phong_exponent(float alpha) {
    return std::max(0.f, 2 / std::max(alpha * alpha, 1e-7f) - 2);
}

Bsdf make_bsdf(const Scene& scene, const Material& m, const Corners& c, const Vec3f& base, float NdotV,
               bool multiple_scattering) {
    Bsdf bsdf;
    if (m.lambert) {
        bsdf.diffuse = base;
        return bsdf;
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
    bsdf.f0 = mix(bsdf.dielectric_f0, base, metalness);
    bsdf.f90 = mix(bsdf.dielectric_f90, {1, 1, 1}, metalness);
    bsdf.diffuse = base * (1 - metalness);
    bsdf.kind = m.phong ? Bsdf::Kind::phong : Bsdf::Kind::metallic_roughness;
    bsdf.alpha = std::max(roughness * roughness, k_least_brdf_alpha);
    bsdf.exponent = phong_exponent(bsdf.alpha);
    if (multiple_scattering && !m.phong) {
        const float albedo = single_scattering_albedo(NdotV, roughness);
        bsdf.compensation = albedo > 0 ? 1 / albedo - 1 : 0;
    }
    // Samples go where the light comes back from, roughly: the specular lobe by its reflectance at this angle.
    const float schlick = schlick_weight(NdotV), gloss = luminance(bsdf.f0 + (bsdf.f90 - bsdf.f0) * schlick),
                matt = luminance(bsdf.diffuse);
    bsdf.specular_share = matt <= 0 ? 1 : gloss <= 0 ? 0 : std::clamp(gloss / (gloss + matt), 0.2f, 0.9f);
    return bsdf;
}

}  // namespace

SurfacePoint surface_at(const Scene& scene, const Hit& hit, const Vec3f& origin, const Vec3f& direction,
                        bool multiple_scattering) {
    const Instance& instance = scene.instances[hit.instance];
    const Mesh& mesh = scene.meshes[instance.mesh];
    const Material& m = scene.materials[mesh.material];
    const Corners c(mesh, hit);
    SurfacePoint out;
    // From the corners, not along the ray: a long ray has lost digits.
    out.position = instance.to_world.point(c.mean(mesh.positions));
    const Vec3f reach{std::abs(out.position.x) + std::abs(origin.x), std::abs(out.position.y) + std::abs(origin.y),
                      std::abs(out.position.z) + std::abs(origin.z)};
    out.error = 4e-6f * std::max({reach.x, reach.y, reach.z, hit.distance});
    out.front = dot(hit.geometric_normal, direction) < 0;
    const float side = out.front ? 1.f : -1.f;
    out.geometric_normal = unit_or(hit.geometric_normal, -direction) * side;
    Vec3f normal = mesh.normals.empty() ? out.geometric_normal
                                        : unit_or(instance.to_world.normal(c.mean(mesh.normals)) *
                                                      (instance.to_world.determinant() < 0 ? -side : side),
                                                  out.geometric_normal);
    if (m.normal_texture) normal = mapped_normal(scene, m, c, instance.to_world, normal);
    // A normal that looks away from the viewer would make the surface black: bent back to just face him.
    if (const float facing = -dot(normal, direction); facing < 1e-3f)
        normal = unit_or(normal - direction * (1e-3f - facing), out.geometric_normal);
    out.normal = normal;

    const Rgba base = base_color(scene, m, c);
    out.opacity = opacity_of(m, base.a);
    out.emission = product(m.emission, look_up(scene, m.emission_texture, c, true).rgb);
    out.albedo = base.rgb;
    out.unlit = m.unlit;
    if (m.unlit)
        out.emission = base.rgb;
    else
        out.bsdf = make_bsdf(scene, m, c, base.rgb, -dot(normal, direction), multiple_scattering);
    return out;
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
