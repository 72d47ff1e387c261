#include "projection/shapes.h"

namespace domelight {

namespace {

/// Six faces in OpenGL's orientation. Frame: z at the middle of face +Z, x to the right on it, y up.
class CubeShape : public ProjectionShape {
    /// Between the face's centre and the corner (s, t): atan(s t / sqrt(s^2 + t^2 + 1)).
    static double corner(double u, double v) {
        const double s = 2 * u - 1, t = 2 * v - 1;
        return std::atan2(s * t, std::sqrt(s * s + t * t + 1));
    }

  public:
    int charts() const override { return 6; }
    Vec3d direction(int chart, UV uv) const override { return normalize(cube_direction(chart, uv)); }
    ProjectionPoint locate(const Vec3d& d) const override {
        const CubePoint p = cube_point(d);
        return {p.face, p.uv, true};
    }
    /// A direction on the face's plane, even beyond its edges.
    UV locate_in(int chart, int, const Vec3d& d) const override {
        const Vec3d n = cube_direction(chart, {0.5, 0.5}), right = cube_direction(chart, {1, 0.5}) - n,
                    down = cube_direction(chart, {0.5, 1}) - n;
        const double depth = dot(d, n);
        return {0.5 * (dot(d, right) / depth + 1), 0.5 * (dot(d, down) / depth + 1)};
    }
    /// dω = ds dt / (1 + s^2 + t^2)^(3/2), s = 2 u - 1, t = 2 v - 1.
    double jacobian(UV uv) const override {
        const double s = 2 * uv.u - 1, t = 2 * uv.v - 1, q = 1 + s * s + t * t;
        return 4 / (q * std::sqrt(q));
    }
    double solid_angle(const UVBox& b) const override {
        return corner(b.u1, b.v1) - corner(b.u0, b.v1) - corner(b.u1, b.v0) + corner(b.u0, b.v0);
    }
    void solid_angles(double v0, double v1, std::span<const double> u_edges, std::span<double> out) const override {
        double left = corner(u_edges[0], v1) - corner(u_edges[0], v0);
        for (std::size_t i = 0; i < out.size(); ++i) {
            const double right = corner(u_edges[i + 1], v1) - corner(u_edges[i + 1], v0);
            out[i] = right - left;
            left = right;
        }
    }
    /// The equator's texels around the middle of a face are the widest, 2 / n; its edge's half that.
    int latlong_height(int size) const override { return 2 * size; }
};

}  // namespace

std::shared_ptr<const ProjectionShape> make_cube_shape() {
    return std::make_shared<CubeShape>();
}

}  // namespace domelight
