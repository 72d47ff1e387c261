#pragma once

#include "domelight/base/vec.h"

#include <cstdint>

namespace domelight {

/// Four floats that the processor handles together: a colour and an unused one. (GCC's and Clang's vector extension;
/// other processors than x86 have their own such registers.)
struct alignas(16) Texel4 {
    typedef float Vector __attribute__((vector_size(16)));
    typedef std::int32_t Integers __attribute__((vector_size(16)));
    Vector v;

    static Texel4 of(float x, float y, float z) { return {Vector{x, y, z, 0}}; }
    static Texel4 all(float x) { return {Vector{x, x, x, x}}; }
    Vec3f rgb() const { return {v[0], v[1], v[2]}; }
};

}  // namespace domelight
