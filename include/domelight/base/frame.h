#pragma once

#include "domelight/base/vec.h"

namespace domelight {

/// A right-handed orthonormal basis whose third axis is a given direction: world = x tangent + y bitangent + z normal.
template <typename T>
struct Frame {
    Vec3<T> tangent, bitangent, normal;

    /// `n` must have unit length. Duff et al. 2017, "Building an orthonormal basis, revisited": there is no branch, and
    /// no direction near which precision is lost. The tangent is discontinuous where n.z changes sign.
    explicit Frame(const Vec3<T>& n) : normal(n) {
        const T sign = std::copysign(T(1), n.z), a = -1 / (sign + n.z), b = n.x * n.y * a;
        tangent = {1 + sign * n.x * n.x * a, sign * b, -sign * n.x};
        bitangent = {b, sign + n.y * n.y * a, -n.y};
    }
    Vec3<T> to_world(const Vec3<T>& local) const { return tangent * local.x + bitangent * local.y + normal * local.z; }
    Vec3<T> to_local(const Vec3<T>& world) const {
        return {dot(tangent, world), dot(bitangent, world), dot(normal, world)};
    }
};

}  // namespace domelight
