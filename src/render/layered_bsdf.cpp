#include "render/layered_bsdf.h"

#include "domelight/image/colour.h"

#include <algorithm>
#include <cmath>

namespace domelight {
namespace {

Vec3f fresnel(const Vec3f& f0, const Vec3f& f90, float weight) {
    return f0 + (f90 - f0) * weight;
}
Vec3f rest_of(const Vec3f& F) {
    return {1 - F.x, 1 - F.y, 1 - F.z};
}

/// The part into which a number falls, and the number rescaled to [0, 1) within that part.
int choose(const float (&shares)[4], std::uint32_t& u) {
    std::uint64_t begin = 0;
    double sum = 0;
    for (int i = 0; i < 4; ++i) {
        sum += shares[i];
        const auto end =
            i == 3 ? std::uint64_t(1) << 32 : std::min(std::uint64_t(sum * 0x1p32), std::uint64_t(1) << 32);
        if (u < end) {
            u = std::uint32_t(((u - begin) << 32) / (end - begin));
            return i;
        }
        begin = end;
    }
    return 3;
}

}  // namespace

Vec3f LayeredBsdf::through(float distance) const {
    return {std::exp(-absorption.x * distance), std::exp(-absorption.y * distance), std::exp(-absorption.z * distance)};
}

void LayeredBsdf::share_out(const Vec3f& V) {
    const float schlick = schlick_weight(V.z);
    const float shine = luminance(fresnel(base.f0, base.f90, schlick)), matt = luminance(base.diffuse),
                clear = transmits ? luminance(transmitted) * (1 - gloss.fresnel(V.z)) : 0;
    const float lower = shine + clear + matt;
    // A part that exists has at least a tenth, so that no sample has a very large weight.
    const auto present = [](float part, float all) { return part <= 0 ? 0 : std::clamp(part / all, 0.1f, 1.f); };
    diffuse_share = present(matt, lower);
    gloss_share = shine + luminance(transmitted) > 0 ? std::max(0.1f, (shine + clear) / lower) : 0;
    sheen_share = present(1 - under_sheen, 1);
    coat_share = present(1 - under_coat, 1);
    diffuse_share *= under_sheen * under_coat;
    gloss_share *= under_sheen * under_coat;
    sheen_share *= under_coat;
    const float sum = coat_share + sheen_share + diffuse_share + gloss_share;
    if (!(sum > 0)) {
        coat_share = sheen_share = gloss_share = 0, diffuse_share = 1;
        return;
    }
    coat_share /= sum, sheen_share /= sum, diffuse_share /= sum, gloss_share /= sum;
}

/// The value without the cosine.
Bsdf::Value LayeredBsdf::evaluate_base(const Vec3f& V, const Vec3f& L) const {
    if (!own_gloss()) return base.evaluate(V, L);
    Bsdf::Value value;
    const Vec3f Vt = to_tangent(V), Lt = to_tangent(L);
    if (L.z < 0) {
        const InterfaceLobe::Part t = gloss.transmission(Vt, Lt);
        if (t.value > 0) {
            const Vec3f F = fresnel(clear_f0, clear_f90, gloss.weight(t.VdotH));
            value.specular = product(transmitted, rest_of(F)) * t.value;
        }
        return value;
    }
    const InterfaceLobe::Part r = gloss.reflection(Vt, Lt);
    const Vec3f under = fresnel(base.dielectric_f0, base.dielectric_f90, schlick_weight(r.VdotH));
    value.diffuse = base.diffuse * ((1 - std::max({under.x, under.y, under.z})) * float(1 / k_pi));
    const Vec3f F = gloss.total(r.VdotH) ? Vec3f{1, 1, 1} : fresnel(base.f0, base.f90, gloss.weight(r.VdotH));
    value.specular = product(F, gloss_gain) * r.value;
    return value;
}

Bsdf::Value LayeredBsdf::evaluate_cosine(const Vec3f& V, const Vec3f& L) const {
    Bsdf::Value value;
    if (dot(L, geometric_normal) < 0) {
        // From behind there is only transmission.
        if (transmits && L.z < 0) value.specular = evaluate_base(V, L).specular * (-L.z * under());
        return value;
    }
    if (L.z > 0) {
        value = evaluate_base(V, L);
        const float scale = L.z * under();
        value.diffuse *= scale;
        value.specular *= scale;
        if (sheen_share > 0) value.specular += sheen_colour * (sheen.evaluate(V, L) * L.z * under_coat);
    }
    if (coat > 0) {
        const Vec3f Vc = coat_frame.to_local(V), Lc = coat_frame.to_local(L);
        const float f = GgxBrdf{coat_alpha, {k_coat_f0, k_coat_f0, k_coat_f0}}.evaluate(Vc, Lc).x * Lc.z * coat;
        value.specular += Vec3f{f, f, f};
    }
    return value;
}

float LayeredBsdf::pdf_gloss(const Vec3f& V, const Vec3f& L) const {
    if (transmits) return gloss.pdf_solid_angle(to_tangent(V), to_tangent(L));
    if (elliptic) return gloss.ggx.pdf_solid_angle(to_tangent(V), to_tangent(L));
    return GgxBrdf{base.alpha}.pdf_solid_angle(V, L);
}

float LayeredBsdf::pdf_solid_angle(const Vec3f& V, const Vec3f& L) const {
    float pdf = gloss_share > 0 ? gloss_share * pdf_gloss(V, L) : 0;
    if (diffuse_share > 0) pdf += diffuse_share * LambertBrdf{}.pdf_solid_angle(V, L);
    if (sheen_share > 0) pdf += sheen_share * sheen.pdf_solid_angle(V, L);
    if (coat_share > 0)
        pdf += coat_share * GgxBrdf{coat_alpha}.pdf_solid_angle(coat_frame.to_local(V), coat_frame.to_local(L));
    return pdf;
}

Bsdf::Sample LayeredBsdf::sample(const Vec3f& V, UnitPoint u, float choice) const {
    Vec3f L;
    // A direction that is invalid for the lobe that drew it is rejected, even if another lobe could have drawn it.
    bool valid = true;
    switch (choose({coat_share, sheen_share, diffuse_share, gloss_share}, u.x)) {
        case 0: {
            const BrdfSample s = GgxBrdf{coat_alpha}.sample(coat_frame.to_local(V), u);
            valid = s.pdf_solid_angle > 0;
            L = coat_frame.to_world(s.L);
            break;
        }
        case 1:
            L = sheen.sample(V, u);
            valid = L.z > k_least_cosine;
            break;
        case 2:
            L = cosine_hemisphere(u);
            break;
        default:
            if (transmits) {
                L = from_tangent(gloss.sample(to_tangent(V), u, choice));
                valid = L.z != 0;
            } else {
                L = elliptic ? from_tangent(gloss.ggx.sample(to_tangent(V), u)) : GgxBrdf{base.alpha}.sample(V, u).L;
                valid = L.z > k_least_cosine;
            }
    }
    if (!valid) return {};
    return {L, pdf_solid_angle(V, L)};
}

}  // namespace domelight
