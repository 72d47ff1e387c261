#include "image/colour_primaries.h"

namespace domelight {

namespace {

std::optional<Mat3> inverse(const Mat3& m) {
    const Vec3d a = cross(m.row[1], m.row[2]), b = cross(m.row[2], m.row[0]), c = cross(m.row[0], m.row[1]);
    const double determinant = dot(m.row[0], a);
    if (!(std::abs(determinant) > 1e-9)) return std::nullopt;
    return Mat3{{a / determinant, b / determinant, c / determinant}}.transposed();
}

Vec3d xyz_of(const ColourPrimaries::Xy& c) {
    return {c.x / c.y, 1, (1 - c.x - c.y) / c.y};
}

Mat3 diagonal(const Vec3d& d) {
    return {{Vec3d{d.x, 0, 0}, Vec3d{0, d.y, 0}, Vec3d{0, 0, d.z}}};
}

/// Bradford's sharpened cone responses (Lam 1985; matrix as in ICC.1:2010, annex E.3).
constexpr Mat3 k_bradford{
    {Vec3d{0.8951, 0.2664, -0.1614}, Vec3d{-0.7502, 1.7135, 0.0367}, Vec3d{0.0389, -0.0685, 1.0296}}};

}  // namespace

std::optional<Mat3> rgb_to_xyz(const ColourPrimaries& p) {
    // Columns are the primaries' XYZ, each scaled so that together they make white.
    for (const auto& c : {p.red, p.green, p.blue, p.white})
        if (!std::isfinite(c.x) || !std::isfinite(c.y)) return std::nullopt;
    if (!(p.white.y > 1e-6)) return std::nullopt;
    const auto column = [](const ColourPrimaries::Xy& c) { return Vec3d{c.x, c.y, 1 - c.x - c.y}; };
    const Mat3 columns = Mat3{{column(p.red), column(p.green), column(p.blue)}}.transposed();
    const std::optional<Mat3> solve = inverse(columns);
    if (!solve) return std::nullopt;
    return columns * diagonal(*solve * xyz_of(p.white));
}

bool are_xyz(const ColourPrimaries& p) {
    const auto is = [](const ColourPrimaries::Xy& c, double x, double y) {
        return std::abs(c.x - x) < 1e-3 && std::abs(c.y - y) < 1e-3;
    };
    return is(p.red, 1, 0) && is(p.green, 0, 1) && is(p.blue, 0, 0) && is(p.white, 1 / 3.0, 1 / 3.0);
}

std::optional<Mat3> rgb_to_rec709(const ColourPrimaries& primaries) {
    if (are_xyz(primaries)) return xyz_to_rec709();
    const std::optional<Mat3> to_xyz = rgb_to_xyz(primaries);
    const std::optional<Mat3> to_rec709 = xyz_to_rec709(primaries.white);
    if (!to_xyz || !to_rec709) return std::nullopt;
    return *to_rec709 * *to_xyz;
}

std::optional<Mat3> xyz_to_rec709(const ColourPrimaries::Xy& white) {
    if (!(white.y > 1e-6)) return std::nullopt;
    const ColourPrimaries rec709;
    if (std::abs(white.x - rec709.white.x) <= 1e-4 && std::abs(white.y - rec709.white.y) <= 1e-4)
        return xyz_to_rec709();
    const Vec3d from = k_bradford * xyz_of(white), to = k_bradford * xyz_of(rec709.white);
    if (!(from.x > 1e-6 && from.y > 1e-6 && from.z > 1e-6)) return std::nullopt;
    const Mat3 adapt = *inverse(k_bradford) * diagonal({to.x / from.x, to.y / from.y, to.z / from.z}) * k_bradford;
    return xyz_to_rec709() * adapt;
}

Mat3 xyz_to_rec709() {
    static const Mat3 matrix = *inverse(*rgb_to_xyz({}));
    return matrix;
}

bool is_nearly_identity(const Mat3& m) {
    const Mat3 identity;
    for (int i = 0; i < 3; ++i) {
        const Vec3d d = m.row[i] - identity.row[i];
        if (!(std::abs(d.x) + std::abs(d.y) + std::abs(d.z) < 2e-4)) return false;
    }
    return true;
}

}  // namespace domelight
