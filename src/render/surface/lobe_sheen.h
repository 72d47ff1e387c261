#pragma once

#include "domelight/sampling/brdf.h"

namespace domelight {

/// The Charlie lobe of KHR_materials_sheen, scaled down where it would reflect more light than it receives. Half of the
/// samples are drawn by half vectors, half by the cosine: at grazing V half vectors alone have unbounded weights.
struct SheenLobe {
    CharlieBrdf charlie;
    float scale = 1;  ///< 1 / max(1, albedo of the lobe at V)

    float evaluate(const Vec3f& V, const Vec3f& L) const { return charlie.evaluate(V, L).x * scale; }
    float pdf_solid_angle(const Vec3f& V, const Vec3f& L) const {
        return 0.5f * (charlie.pdf_solid_angle(V, L) + LambertBrdf{}.pdf_solid_angle(V, L));
    }
    Vec3f sample(const Vec3f& V, UnitPoint u) const {
        const bool by_cosine = u.x >> 31;
        u.x <<= 1;
        return by_cosine ? cosine_hemisphere(u) : charlie.sample(V, u).L;
    }
};

}  // namespace domelight
