#include "render/surface/surface_corners.h"

namespace domelight {

Tangents tangents_at(const Corners& c, int texcoord, const Affine& to_world, const Vec3f& normal) {
    Vec3f tangent, bitangent;
    if (!c.mesh.tangents.empty()) {
        const auto& t = c.mesh.tangents;
        tangent = to_world.vector(t[c.i[0]].t * c.w[0] + t[c.i[1]].t * c.w[1] + t[c.i[2]].t * c.w[2]);
        bitangent = cross(normal, tangent) * (t[c.i[0]].sign * (to_world.determinant() < 0 ? -1.f : 1.f));
    } else {
        const auto& uv = c.mesh.texcoords[texcoord == 1 ? 1 : 0];
        if (uv.empty()) return {};
        const Vec3f e1 = to_world.vector(c.mesh.positions[c.i[1]] - c.mesh.positions[c.i[0]]),
                    e2 = to_world.vector(c.mesh.positions[c.i[2]] - c.mesh.positions[c.i[0]]);
        const float u1 = uv[c.i[1]].u - uv[c.i[0]].u, v1 = uv[c.i[1]].v - uv[c.i[0]].v,
                    u2 = uv[c.i[2]].u - uv[c.i[0]].u, v2 = uv[c.i[2]].v - uv[c.i[0]].v, determinant = u1 * v2 - u2 * v1;
        if (determinant == 0) return {};
        const float sign = determinant < 0 ? -1.f : 1.f;
        tangent = (e1 * v2 - e2 * v1) * sign;
        // glTF's textures have v down: green points up, against v.
        bitangent = (e1 * u2 - e2 * u1) * sign;
    }
    return {unit_or(tangent - normal * dot(normal, tangent), {}),
            unit_or(bitangent - normal * dot(normal, bitangent), {}), true};
}

Vec3f mapped_normal(const Scene& scene, const SceneTexture& map, float scale, const Corners& c, const Affine& to_world,
                    const Vec3f& normal) {
    const Tangents t = tangents_at(c, map.texcoord, to_world, normal);
    if (!t.known) return normal;
    const Rgba texel = look_up(scene, map, c, false);
    const Vec3f bend{(2 * texel.rgb.x - 1) * scale, (2 * texel.rgb.y - 1) * scale, 2 * texel.rgb.z - 1};
    return unit_or(t.tangent * bend.x + t.bitangent * bend.y + normal * bend.z, normal);
}

Vec3f facing_normal(const Vec3f& normal, const Vec3f& direction, const Vec3f& otherwise) {
    const float facing = -dot(normal, direction);
    return facing < 1e-3f ? unit_or(normal - direction * (1e-3f - facing), otherwise) : normal;
}

}  // namespace domelight
