#include "projection/shapes.h"

namespace domelight {

namespace {

/// Frame: z at the centre, x a quarter turn to the right, y at the top row.
class LatlongShape : public ProjectionShape {
  public:
    double aspect() const override { return 2; }
    Vec3d direction(int, UV uv) const override {
        const Vec3d d = latlong_direction(uv);  // x at the centre, z to the right
        return {d.z, d.y, d.x};
    }
    ProjectionPoint locate(const Vec3d& d) const override { return {0, latlong_uv({d.z, d.y, d.x}), true}; }
    /// omega = ∫∫ sin(pi v) pi dv 2 pi du.
    double jacobian(UV uv) const override { return 2 * k_pi * k_pi * std::sin(k_pi * uv.v); }
    double solid_angle(const UVBox& b) const override {
        // cos a - cos b = 2 sin((a + b) / 2) sin((b - a) / 2): no cancellation in thin rows.
        return 2 * k_pi * (b.u1 - b.u0) * 2 * std::sin(0.5 * k_pi * (b.v0 + b.v1)) *
               std::sin(0.5 * k_pi * (b.v1 - b.v0));
    }
    void solid_angles(double v0, double v1, std::span<const double> u_edges, std::span<double> out) const override {
        const double whole = solid_angle({0, v0, 1, v1});
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = whole * (u_edges[i + 1] - u_edges[i]);
    }
    bool wraps() const override { return true; }
};

}  // namespace

std::shared_ptr<const ProjectionShape> make_latlong_shape() {
    return std::make_shared<LatlongShape>();
}

}  // namespace domelight
