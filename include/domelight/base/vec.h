#pragma once

#include <array>
#include <cmath>
#include <numbers>

namespace domelight {

inline constexpr double k_pi = std::numbers::pi;

/// A vector of three components. World space is right-handed with +Y up. Directions to the light and to the viewer
/// point away from the surface; the only exception is PunctualLight::direction.
template <typename T>
struct Vec3 {
    T x{}, y{}, z{};

    constexpr Vec3() = default;
    constexpr Vec3(T x_, T y_, T z_) : x(x_), y(y_), z(z_) {}
    template <typename U>
    constexpr explicit Vec3(const Vec3<U>& v) : x(T(v.x)), y(T(v.y)), z(T(v.z)) {}

    constexpr Vec3 operator+(const Vec3& b) const { return {x + b.x, y + b.y, z + b.z}; }
    constexpr Vec3 operator-(const Vec3& b) const { return {x - b.x, y - b.y, z - b.z}; }
    constexpr Vec3 operator-() const { return {-x, -y, -z}; }
    constexpr Vec3 operator*(T s) const { return {x * s, y * s, z * s}; }
    constexpr Vec3 operator/(T s) const { return {x / s, y / s, z / s}; }
    constexpr Vec3& operator+=(const Vec3& b) { return *this = *this + b; }
    constexpr Vec3& operator-=(const Vec3& b) { return *this = *this - b; }
    constexpr Vec3& operator*=(T s) { return *this = *this * s; }
    constexpr bool operator==(const Vec3&) const = default;
};

using Vec3f = Vec3<float>;
using Vec3d = Vec3<double>;

template <typename T>
constexpr Vec3<T> operator*(T s, const Vec3<T>& v) {
    return v * s;
}
template <typename T>
constexpr T dot(const Vec3<T>& a, const Vec3<T>& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <typename T>
constexpr Vec3<T> cross(const Vec3<T>& a, const Vec3<T>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
/// The component-wise product: a colour seen through a filter, for example.
template <typename T>
constexpr Vec3<T> product(const Vec3<T>& a, const Vec3<T>& b) {
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}
template <typename T>
T length(const Vec3<T>& v) {
    return std::sqrt(dot(v, v));
}
template <typename T>
Vec3<T> normalize(const Vec3<T>& v) {
    return v / length(v);
}

/// A 3 x 3 matrix by rows: an orthogonal one turns (and perhaps mirrors) directions.
struct Mat3 {
    std::array<Vec3d, 3> row{Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}};

    constexpr Vec3d operator*(const Vec3d& v) const { return {dot(row[0], v), dot(row[1], v), dot(row[2], v)}; }
    constexpr Mat3 transposed() const {
        return {{Vec3d{row[0].x, row[1].x, row[2].x}, Vec3d{row[0].y, row[1].y, row[2].y},
                 Vec3d{row[0].z, row[1].z, row[2].z}}};
    }
    constexpr Mat3 operator*(const Mat3& b) const {
        const Mat3 t = b.transposed();
        Mat3 out;
        for (int i = 0; i < 3; ++i) out.row[i] = {dot(row[i], t.row[0]), dot(row[i], t.row[1]), dot(row[i], t.row[2])};
        return out;
    }
    constexpr bool operator==(const Mat3&) const = default;
};

/// Turns directions about +Y by `angle` radians; a positive angle moves +X towards +Z (so that the content of a
/// lat-long image moves right).
inline Mat3 rotation_y(double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    return {{Vec3d{c, 0, -s}, Vec3d{0, 1, 0}, Vec3d{s, 0, c}}};
}

}  // namespace domelight
