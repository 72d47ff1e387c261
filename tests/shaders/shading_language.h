#pragma once
// The types and functions of GLSL, HLSL and WGSL that the shaders of docs/shaders use, so that a C++ compiler accepts
// the very text of these files and the tests can run it. A shader is included within namespace shading_language.

#include <cmath>
#include <functional>

namespace shading_language {

/// Some components of a vector, in any order, as `v.xyz` or `v.rg`. Read only.
template <typename V, int N, int... I>
struct Swizzle {
    float c[N];
    operator V() const { return V(c[I]...); }
};

/// What the vectors of N components have in common, component by component. The functions are friends, so that an
/// argument may be a swizzle.
template <typename V, int N>
struct Components {
    template <typename F>
    static V each(const F& f) {
        V out;
        for (int i = 0; i < N; ++i) out.c[i] = float(f(i));
        return out;
    }

    friend V operator+(const V& a, const V& b) { return each([&](int i) { return a.c[i] + b.c[i]; }); }
    friend V operator-(const V& a, const V& b) { return each([&](int i) { return a.c[i] - b.c[i]; }); }
    friend V operator*(const V& a, const V& b) { return each([&](int i) { return a.c[i] * b.c[i]; }); }
    friend V operator/(const V& a, const V& b) { return each([&](int i) { return a.c[i] / b.c[i]; }); }
    friend V operator+(const V& a, float b) { return a + V(b); }
    friend V operator-(const V& a, float b) { return a - V(b); }
    friend V operator*(const V& a, float b) { return a * V(b); }
    friend V operator/(const V& a, float b) { return a / V(b); }
    friend V operator+(float a, const V& b) { return V(a) + b; }
    friend V operator-(float a, const V& b) { return V(a) - b; }
    friend V operator*(float a, const V& b) { return V(a) * b; }
    friend V operator-(const V& a) { return V(0.f) - a; }
    friend V& operator+=(V& a, const V& b) { return a = a + b; }
    friend V max(const V& a, const V& b) { return each([&](int i) { return std::fmax(a.c[i], b.c[i]); }); }
    friend V max(const V& a, float b) { return max(a, V(b)); }
    friend V mix(const V& a, const V& b, float t) { return a + (b - a) * t; }
    friend V lerp(const V& a, const V& b, float t) { return mix(a, b, t); }
    friend float dot(const V& a, const V& b) {
        float sum = 0;
        for (int i = 0; i < N; ++i) sum += a.c[i] * b.c[i];
        return sum;
    }
    friend float length(const V& a) { return std::sqrt(dot(a, a)); }
    friend V normalize(const V& a) { return a / length(a); }
    /// The incident direction `i`, mirrored at the normal `n`.
    friend V reflect(const V& i, const V& n) { return i - n * (2 * dot(n, i)); }
    friend V value(const V& a) { return a; }
};

struct vec2 : Components<vec2, 2> {
    union {
        float c[2];
        struct {
            float x, y;
        };
        struct {
            float s, t;
        };
    };
    vec2() : c{} {}
    explicit vec2(float a) : c{a, a} {}
    vec2(float a, float b) : c{a, b} {}
};

struct vec3 : Components<vec3, 3> {
    union {
        float c[3];
        struct {
            float x, y, z;
        };
        struct {
            float r, g, b;
        };
        Swizzle<vec2, 3, 0, 1> xy, rg;
    };
    vec3() : c{} {}
    explicit vec3(float a) : c{a, a, a} {}
    vec3(float a, float b, float d) : c{a, b, d} {}
};

struct vec4 : Components<vec4, 4> {
    union {
        float c[4];
        struct {
            float x, y, z, w;
        };
        struct {
            float r, g, b, a;
        };
        Swizzle<vec2, 4, 0, 1> xy, rg;
        Swizzle<vec3, 4, 0, 1, 2> xyz, rgb;
    };
    vec4() : c{} {}
    explicit vec4(float a) : c{a, a, a, a} {}
    vec4(float a, float b, float d, float e) : c{a, b, d, e} {}
    vec4(const vec3& v, float e) : c{v.x, v.y, v.z, e} {}
};

struct ivec2 {
    int x = 0, y = 0;
    ivec2() = default;
    ivec2(int a, int b) : x(a), y(b) {}
};

/// By columns.
struct mat3 {
    vec3 column[3] = {vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1)};
    friend mat3 transpose(const mat3& m) {
        mat3 out;
        for (int i = 0; i < 3; ++i) out.column[i] = vec3(m.column[0].c[i], m.column[1].c[i], m.column[2].c[i]);
        return out;
    }
    friend vec3 operator*(const mat3& m, const vec3& v) {
        return m.column[0] * v.x + m.column[1] * v.y + m.column[2] * v.z;
    }
};

// clang-format off
inline float value(float a) { return a; }
inline float sin(float a) { return std::sin(a); }
inline float cos(float a) { return std::cos(a); }
inline float acos(float a) { return std::acos(a); }
inline float atan(float y, float x) { return std::atan2(y, x); }
inline float atan2(float y, float x) { return std::atan2(y, x); }
inline float sqrt(float a) { return std::sqrt(a); }
inline float pow(float a, float b) { return std::pow(a, b); }
inline float exp2(float a) { return std::exp2(a); }
inline float log2(float a) { return std::log2(a); }
inline float floor(float a) { return std::floor(a); }
inline float mod(float a, float b) { return a - b * std::floor(a / b); }
inline float min(float a, float b) { return std::fmin(a, b); }
inline float max(float a, float b) { return std::fmax(a, b); }
inline float clamp(float a, float low, float high) { return std::fmin(std::fmax(a, low), high); }
inline float saturate(float a) { return clamp(a, 0, 1); }
inline float mix(float a, float b, float t) { return a + (b - a) * t; }
// clang-format on

/// A texture, by what a lookup in a direction or at a point gives. Levels between two whole ones are mixed.
struct Cube {
    std::function<vec4(const vec3& direction, float level)> look_up;
};
struct Plane {
    std::function<vec4(const vec2& point, float level)> look_up;
    std::function<vec4(const ivec2& texel)> fetch{};  ///< of level 0
    ivec2 size{};
};

// GLSL
using samplerCube = Cube;
using sampler2D = Plane;
inline vec4 textureLod(const samplerCube& t, const vec3& d, float level) {
    return t.look_up(d, level);
}
inline vec4 texture(const samplerCube& t, const vec3& d) {
    return t.look_up(d, 0);
}
inline vec4 textureLod(const sampler2D& t, const vec2& point, float level) {
    return t.look_up(point, level);
}
inline vec4 texelFetch(const sampler2D& t, const ivec2& texel, int) {
    return t.fetch(texel);
}
inline ivec2 textureSize(const sampler2D& t, int) {
    return t.size;
}

// HLSL
using float2 = vec2;
using float3 = vec3;
using float4 = vec4;
struct SamplerState {};
template <typename T>
struct TextureCube : Cube {
    T SampleLevel(SamplerState, const float3& d, float level) const { return T(look_up(d, level)); }
};
template <typename T>
struct Texture2D : Plane {
    T SampleLevel(SamplerState, const float2& point, float level) const { return T(look_up(point, level).xy); }
};

// WGSL
using f32 = float;
using vec2f = vec2;
using vec3f = vec3;
using vec4f = vec4;
using mat3x3f = mat3;
using sampler = SamplerState;
template <typename T, int N>
struct array {
    T item[N];
    const T& operator[](int i) const { return item[i]; }
    T& operator[](int i) { return item[i]; }
};
template <typename>
struct texture_cube : Cube {};
template <typename>
struct texture_2d : Plane {};
inline vec4 textureSampleLevel(const Cube& t, sampler, const vec3& d, float level) {
    return t.look_up(d, level);
}
inline vec4 textureSampleLevel(const Plane& t, sampler, const vec2& point, float level) {
    return t.look_up(point, level);
}

}  // namespace shading_language
