#include "projection/shapes.h"

#include <array>
#include <cmath>

namespace domelight {

namespace {

/// A point of the square |x|, |y| <= 1 (y up) that may lie beyond an edge: there the picture continues mirrored at the
/// edge's middle.
DiscPoint into_square(DiscPoint p) {
    if (std::abs(p.x) > 1) p = {std::copysign(2, p.x) - p.x, -p.y};
    if (std::abs(p.y) > 1) p = {-p.x, std::copysign(2, p.y) - p.y};
    return p;
}

/// Which eighth of the sphere, by the signs.
int octant(const Vec3d& d) {
    return std::signbit(d.x) + 2 * std::signbit(d.y) + 4 * std::signbit(d.z);
}
/// 1 or -1: an axis's sign in an octant, 0: x.
double octant_sign(int octant, int axis) {
    return octant >> axis & 1 ? -1 : 1;
}

/// The part of a convex polygon on the side a x + b y <= c.
struct Polygon {
    std::array<DiscPoint, 12> p;
    int count = 0;
    void add(DiscPoint q) { p[std::size_t(count++)] = q; }
    Polygon clipped(double a, double b, double c) const {
        Polygon out;
        for (int k = 0; k < count; ++k) {
            const DiscPoint u = p[std::size_t(k)], v = p[std::size_t((k + 1) % count)];
            const double du = c - a * u.x - b * u.y, dv = c - a * v.x - b * v.y;
            if (du >= 0) out.add(u);
            if ((du > 0 && dv < 0) || (du < 0 && dv > 0)) {
                const double s = du / (du - dv);
                out.add({u.x + s * (v.x - u.x), u.y + s * (v.y - u.y)});
            }
        }
        return out;
    }
};

/// Solid angle of a plane triangle of directions. (Van Oosterom and Strackee 1983.)
double triangle_solid_angle(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    // a . (b x c), computed from differences so that small triangles keep their digits.
    const double volume = std::abs(dot(a, cross(b - a, c - a)));
    const double la = length(a), lb = length(b), lc = length(c);
    return 2 * std::atan2(volume, la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
}

/// Frame of both: z at the middle and -z at the four corners, x to the right, y up.
class OctahedralShape : public ProjectionShape {
  public:
    Vec3d direction(int, UV uv) const override { return normalize(on_octahedron(into_square(disc_point(uv)))); }
    ProjectionPoint locate(const Vec3d& d) const override { return {0, locate_in(0, octant(d), d), true}; }
    UV locate_in(int, int region, const Vec3d& d) const override {
        const double sx = octant_sign(region, 0), sy = octant_sign(region, 1), ax = sx * d.x, ay = sy * d.y;
        const double sum = ax + ay + octant_sign(region, 2) * d.z, x = ax / sum, y = ay / sum;
        return region & 4 ? disc_uv({sx * (1 - y), sy * (1 - x)}) : disc_uv({sx * x, sy * y});
    }
    /// On the face |x| + |y| + |z| = 1: dω = dx dy / |d|^3.
    double jacobian(UV uv) const override {
        const double q = length(on_octahedron(disc_point(uv)));
        return 4 / (q * q * q);
    }
    /// Each of the eight faces is a central projection: a box's part of it is a plane polygon.
    double solid_angle(const UVBox& box) const override {
        const DiscPoint low = disc_point({box.u0, box.v1}), high = disc_point({box.u1, box.v0});
        double sum = 0;
        for (const double sx : {-1.0, 1.0})
            for (const double sy : {-1.0, 1.0}) {
                Polygon quarter;
                for (const DiscPoint q : {low, DiscPoint{high.x, low.y}, high, DiscPoint{low.x, high.y}})
                    quarter.add(q);
                quarter = quarter.clipped(-sx, 0, 0).clipped(0, -sy, 0);
                sum += polygon_solid_angle(quarter.clipped(sx, sy, 1), false, sx, sy);
                sum += polygon_solid_angle(quarter.clipped(-sx, -sy, -1), true, sx, sy);
            }
        return sum;
    }
    int region(const Vec3d& d) const override { return octant(d); }
    /// The middle of a face has the finest texels, 2 / (3 sqrt(3))^(1/2) of the axes'.
    int latlong_height(int size) const override { return int(std::ceil(0.5 * k_pi * size)); }

  private:
    static Vec3d on_octahedron(DiscPoint p) {
        const double z = 1 - std::abs(p.x) - std::abs(p.y);
        if (z >= 0) return {p.x, p.y, z};
        return {std::copysign(1 - std::abs(p.y), p.x), std::copysign(1 - std::abs(p.x), p.y), z};
    }
    static double polygon_solid_angle(const Polygon& polygon, bool folded, double sx, double sy) {
        const auto place = [&](int k) {
            const DiscPoint p = polygon.p[std::size_t(k)];
            const double ax = std::abs(p.x), ay = std::abs(p.y);
            return folded ? Vec3d{sx * (1 - ay), sy * (1 - ax), 1 - ax - ay} : Vec3d{p.x, p.y, 1 - ax - ay};
        };
        double sum = 0;
        for (int k = 1; k + 1 < polygon.count; ++k) sum += triangle_solid_angle(place(0), place(k), place(k + 1));
        return sum;
    }
};

/// Clarberg 2008, "Fast equal-area mapping of the (hemi)sphere using SIMD", as pbrt-v4 has it (its y runs down the
/// picture).
class EqualAreaOctahedralShape : public ProjectionShape {
  public:
    Vec3d direction(int, UV uv) const override {
        const DiscPoint p = into_square(disc_point(uv));
        const double u = std::abs(p.x), v = std::abs(p.y), signed_distance = 1 - (u + v),
                     r = 1 - std::abs(signed_distance);
        const double phi = (r == 0 ? 1 : (v - u) / r + 1) * k_pi / 4;
        const double z = std::copysign(1 - r * r, signed_distance), s = r * std::sqrt(2 - r * r);
        return {std::copysign(std::cos(phi), p.x) * s, std::copysign(std::sin(phi), p.y) * s, z};
    }
    ProjectionPoint locate(const Vec3d& d) const override { return {0, locate_in(0, octant(d), d), true}; }
    UV locate_in(int, int region, const Vec3d& d) const override {
        const double side = std::hypot(d.x, d.y), l = std::hypot(side, d.z);
        // r = sqrt(1 - |z|), without cancellation at the poles.
        const double r = side / std::sqrt(l * (l + std::abs(d.z)));
        const double phi = side > 0 ? std::atan2(std::abs(d.y), std::abs(d.x)) * 2 / k_pi : 0;
        double v = phi * r, u = r - v;
        if (region & 4) {
            const double swapped = 1 - u;
            u = 1 - v, v = swapped;
        }
        return disc_uv({octant_sign(region, 0) * u, octant_sign(region, 1) * v});
    }
    double jacobian(UV) const override { return 4 * k_pi; }
    double solid_angle(const UVBox& b) const override { return 4 * k_pi * (b.u1 - b.u0) * (b.v1 - b.v0); }
    int region(const Vec3d& d) const override { return octant(d); }
};

}  // namespace

std::shared_ptr<const ProjectionShape> make_octahedral_shape() {
    return std::make_shared<OctahedralShape>();
}
std::shared_ptr<const ProjectionShape> make_equal_area_octahedral_shape() {
    return std::make_shared<EqualAreaOctahedralShape>();
}

}  // namespace domelight
