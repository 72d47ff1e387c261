#pragma once
// Boxes seen from outside and from inside.

#include "render/shapes.h"

namespace domelight::test {

/// A box whose sides face outwards.
inline Mesh box_mesh(const Vec3f& low, const Vec3f& high) {
    Mesh mesh;
    for (int i = 0; i < 8; ++i)
        mesh.positions.push_back({i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z});
    mesh.indices = {0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4,
                    2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};
    return mesh;
}

/// The same box, facing inwards: a room.
inline Mesh room_mesh(const Vec3f& low, const Vec3f& high) {
    Mesh mesh = box_mesh(low, high);
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) std::swap(mesh.indices[i], mesh.indices[i + 1]);
    return mesh;
}

}  // namespace domelight::test
