#include "render/surface/surface_lobes.h"

#include "render/surface/lobe_albedo.h"

#include <algorithm>
#include <cmath>

namespace domelight {
namespace {

float largest(const Vec3f& c) {
    return std::max({c.x, c.y, c.z});
}
template <typename F>
Vec3f by_channel(const F& f) {
    return {f(&Vec3f::x), f(&Vec3f::y), f(&Vec3f::z)};
}

/// The direction of the anisotropy in the local frame (x, y of unit length), and its strength.
struct Brushing {
    float x = 1, y = 0, strength = 0;
};

/// KHR_materials_anisotropy: direction from the texture, turned by the rotation, in the tangent frame. If a mesh has
/// neither tangents nor texture coordinates, the direction runs around the vertical axis.
Brushing brushing_at(const LayerInputs& in, const Frame<float>& frame) {
    const Material& m = in.material;
    const SceneTexture& texture = m.anisotropy_texture;
    const Rgba texel = look_up(in.scene, texture, in.corners, false);
    Brushing out{1, 0, std::clamp(m.anisotropy * texel.rgb.z, 0.f, 1.f)};
    if (out.strength <= 0) return out;
    float x = texture ? 2 * texel.rgb.x - 1 : 1, y = texture ? 2 * texel.rgb.y - 1 : 0;
    const float c = std::cos(m.anisotropy_rotation), s = std::sin(m.anisotropy_rotation), turned = c * x - s * y;
    y = s * x + c * y;
    x = turned;
    Tangents t = tangents_at(in.corners, texture ? texture.texcoord : m.normal_texture.texcoord, in.instance.to_world,
                             in.normal);
    if (!t.known) {
        t.tangent = unit_or(cross(Vec3f{0, 1, 0}, in.normal), frame.tangent);
        t.bitangent = cross(in.normal, t.tangent);
    }
    const Vec3f along = frame.to_local(t.tangent * x + t.bitangent * y);
    const float n = std::hypot(along.x, along.y);
    if (n > 1e-6f) out.x = along.x / n, out.y = along.y / n;
    return out;
}

/// KHR_materials_transmission and _volume.
void make_transmission(const LayerInputs& in, float amount, LayeredBsdf& out) {
    const Material& m = in.material;
    out.transmits = true;
    out.volume = m.thickness > 0;
    out.gloss.schlick = false;
    const float ior = std::min(m.ior, 1e3f);  // beyond it hardly any light is transmitted, and squares would overflow
    out.gloss.eta = in.front || m.thickness <= 0 ? ior : 1 / ior;  // a sheet looks the same from both sides
    // A body with the index of air does not refract; its microfacets would divide by rounding errors.
    constexpr float k_no_refraction = 1e-3f;
    const bool straight = std::abs(m.ior - 1) < k_no_refraction;
    out.gloss.thin = !out.volume || straight;
    if (out.volume && straight) out.gloss.ggx = {k_least_brdf_alpha, k_least_brdf_alpha};
    out.clear_f0 = in.dielectric_f0;
    out.clear_f90 = in.dielectric_f90;
    out.transmitted = in.base * ((1 - in.metalness) * amount);
    out.base.diffuse *= (1 - amount);
    if (!out.volume) return;
    // In the mesh's own metres.
    const float scale = std::cbrt(std::abs(in.instance.to_world.determinant()));
    const float texel = look_up(in.scene, m.thickness_texture, in.corners, false).rgb.y;
    constexpr float k_most = 1e18f;  // so that no product is infinite
    out.thickness = std::min(m.thickness * texel * scale, k_most);
    // KHR_materials_volume: white light is the attenuation colour after the attenuation distance.
    if (std::isfinite(m.attenuation_distance))
        out.absorption = by_channel([&](auto c) {
            return std::min(-std::log(std::max(m.attenuation_color.*c, 1e-6f)) / m.attenuation_distance, k_most);
        });
}

/// Adds the light that is scattered between microfacets, so that a white surface loses no energy (as Bsdf::compensation
/// does for isotropic reflection): the reflected part by Turquin's rule with the mean Fresnel term; the rest is
/// transmitted.
void compensate(const LayerInputs& in, const Vec3f& V, LayeredBsdf& out) {
    const InterfaceAlbedo albedo = interface_albedo(out.gloss, out.to_tangent(V), in.shift);
    const Vec3f reflected_in_all = by_channel([&](auto c) {
        const float f0 = in.dielectric_f0.*c, f90 = in.dielectric_f90.*c;
        const float R = albedo.reflected(f0, f90), T = albedo.transmitted(f0, f90), all = R + T;
        if (!(all > 0)) return 0.f;
        const float lost = 1 / all - 1, fresnel = R / all, R_all = std::min(1.f, R * (1 + fresnel * lost));
        out.gloss_gain.*c = 1 + (fresnel + (in.base.*c - fresnel) * in.metalness) * lost;
        if (out.transmits) out.transmitted.*c *= T > 0 ? (1 - R_all) / T : 0;
        return R_all;
    });
    const float below = largest(reflected_in_all);
    out.base.dielectric_f0 = out.base.dielectric_f90 = {below, below, below};
}

void make_sheen(const LayerInputs& in, float NdotV, LayeredBsdf& out) {
    const Material& m = in.material;
    out.sheen_colour = product(m.sheen_color, look_up(in.scene, m.sheen_color_texture, in.corners, true).rgb);
    if (largest(out.sheen_colour) <= 0) return;
    const float roughness =
        std::clamp(m.sheen_roughness * look_up(in.scene, m.sheen_roughness_texture, in.corners, false).a, 0.f, 1.f);
    out.sheen.charlie.alpha = std::max(roughness * roughness, CharlieBrdf::k_least_charlie_alpha);
    const float albedo = table_albedo(NdotV, std::sqrt(out.sheen.charlie.alpha)).sheen;
    out.sheen.scale = 1 / std::max(1.f, albedo);
    out.under_sheen = std::max(0.f, 1 - std::min(1.f, largest(out.sheen_colour)) * std::min(albedo, 1.f));
}

void make_coat(const LayerInputs& in, const Frame<float>& frame, LayeredBsdf& out) {
    const Material& m = in.material;
    out.coat = std::clamp(m.clearcoat * look_up(in.scene, m.clearcoat_texture, in.corners, false).rgb.x, 0.f, 1.f);
    if (out.coat <= 0) return;
    const float roughness = std::clamp(
        m.clearcoat_roughness * look_up(in.scene, m.clearcoat_roughness_texture, in.corners, false).rgb.y, 0.f, 1.f);
    out.coat_alpha = std::max(roughness * roughness, k_least_brdf_alpha);
    Vec3f normal = in.smooth_normal;
    if (m.clearcoat_normal_texture)
        normal = mapped_normal(in.scene, m.clearcoat_normal_texture, m.clearcoat_normal_scale, in.corners,
                               in.instance.to_world, in.front ? normal : -normal) *
                 (in.front ? 1.f : -1.f);
    normal = facing_normal(normal, -in.view, in.geometric_normal);
    out.coat_frame = Frame<float>(unit_or(frame.to_local(normal), {0, 0, 1}));
    const TableAlbedo albedo = table_albedo(dot(normal, in.view), roughness);
    out.under_coat = 1 - out.coat * std::clamp(LayeredBsdf::k_coat_f0 * albedo.scale + albedo.bias, 0.f, 1.f);
}

}  // namespace

bool has_layers(const Material& m) {
    if (m.lambert || m.phong || m.unlit) return false;
    return m.anisotropy > 0 || m.transmission > 0 || m.clearcoat > 0 || largest(m.sheen_color) > 0;
}

bool has_layers(const Scene& scene) {
    return std::ranges::any_of(scene.materials, [](const Material& m) { return has_layers(m); });
}

bool make_layers(const LayerInputs& in, LayeredBsdf& out) {
    const Material& m = in.material;
    const Frame<float> frame(in.normal);
    const Vec3f V = frame.to_local(in.view);
    out.geometric_normal = frame.to_local(in.geometric_normal);

    const Brushing brushing = brushing_at(in, frame);
    const float alpha = out.base.alpha, along = alpha + (1 - alpha) * brushing.strength * brushing.strength;
    out.elliptic = along != alpha;
    out.tangent_x = brushing.x, out.tangent_y = brushing.y;
    out.gloss.ggx = {along, alpha};
    out.gloss.schlick = true;
    out.gloss.thin = true;
    // An index of 0 stands for a mirror.
    const float amount =
        m.ior > 0
            ? std::clamp(m.transmission * look_up(in.scene, m.transmission_texture, in.corners, false).rgb.x, 0.f, 1.f)
            : 0;
    if (amount > 0) make_transmission(in, amount, out);
    if (in.multiple_scattering && (out.elliptic || out.transmits)) compensate(in, V, out);
    out.gloss.f0 = largest(in.dielectric_f0), out.gloss.f90 = largest(in.dielectric_f90);
    out.gloss.transmit = largest(out.transmitted);

    // Seen from inside a body there is only its boundary.
    if (!(out.volume && !in.front)) {
        make_sheen(in, V.z, out);
        make_coat(in, frame, out);
    }
    const bool any = out.elliptic || out.transmits || out.coat > 0 || largest(out.sheen_colour) > 0;
    if (any) out.share_out(V);
    return any;
}

}  // namespace domelight
