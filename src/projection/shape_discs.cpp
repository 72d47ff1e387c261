// Projections onto a disc that turn with the direction about its middle: a direction at the angle rho from the centre's
// lies at the distance r(rho) from it.
#include "projection/disc_solid_angle.h"
#include "projection/shapes.h"

namespace domelight {

namespace {

/// Frame: z at the middle, x to the right, y up.
class DiscShape : public ProjectionShape {
  public:
    bool valid(UV uv) const override { return disc_point(uv).squared() <= 1; }
    double solid_angle(const UVBox& box) const override {
        return disc_solid_angle(box, [this](double r) { return cap(r); });
    }

  protected:
    /// 1 - cos rho(r).
    virtual double cap(double r) const = 0;
};

class SphereMapShape : public DiscShape {
  public:
    /// Beyond the rim the picture continues through -Z to the other side.
    Vec3d direction(int, UV uv) const override {
        const DiscPoint p = disc_point(uv);
        const double r = std::sqrt(p.squared());
        if (r <= 1) return sphere_map_direction(uv);
        const double back = -std::max(0.0, 2 - r) / r;
        return sphere_map_direction(disc_uv({p.x * back, p.y * back}));
    }
    ProjectionPoint locate(const Vec3d& d) const override { return {0, sphere_map_uv(d), true}; }
    double jacobian(UV) const override { return k_sphere_map_jacobian; }

  protected:
    /// r = sin(rho / 2).
    double cap(double r) const override { return 2 * r * r; }
};

class HemisphereShape : public DiscShape {
  public:
    double coverage() const override { return 2 * k_pi; }
    Vec3d direction(int, UV uv) const override {
        const DiscPoint p = disc_point(uv);
        const double q = p.squared();
        if (q > 1) return Vec3d{p.x, p.y, 0} / std::sqrt(q);
        return {p.x, p.y, std::sqrt(1 - q)};
    }
    ProjectionPoint locate(const Vec3d& d) const override {
        const double side = std::hypot(d.x, d.y);
        if (d.z >= 0) return {0, disc_uv({d.x / length(d), d.y / length(d)}), true};
        return {0, side > 0 ? disc_uv({d.x / side, d.y / side}) : disc_uv({1, 0}), false};
    }
    /// dω = dx dy / z.
    double jacobian(UV uv) const override { return 4 / std::sqrt(std::max(1e-300, 1 - disc_point(uv).squared())); }
    int region(const Vec3d& d) const override { return d.z < 0; }
    int latlong_height(int size) const override { return int(std::ceil(0.5 * k_pi * size)); }

  protected:
    double cap(double r) const override { return r * r / (1 + std::sqrt(std::max(0.0, 1 - r * r))); }
};

class AngularShape : public DiscShape {
  public:
    /// r = rho / pi (Debevec's light probes). Beyond the rim rho continues beyond pi.
    Vec3d direction(int, UV uv) const override {
        const DiscPoint p = disc_point(uv);
        const double r = std::sqrt(p.squared()), s = r > 0 ? std::sin(k_pi * r) / r : k_pi;
        return {s * p.x, s * p.y, std::cos(k_pi * r)};
    }
    ProjectionPoint locate(const Vec3d& d) const override {
        const double side = std::hypot(d.x, d.y), r = std::atan2(side, d.z) / k_pi;
        if (side == 0) return {0, d.z > 0 ? UV{0.5, 0.5} : disc_uv({1, 0}), true};
        return {0, disc_uv({r * d.x / side, r * d.y / side}), true};
    }
    /// sin(rho) drho dphi over r dr dphi / 4.
    double jacobian(UV uv) const override {
        const double r = std::sqrt(disc_point(uv).squared());
        return 4 * k_pi * (r > 0 ? std::sin(k_pi * r) / r : k_pi);
    }

  protected:
    double cap(double r) const override { return 2 * std::pow(std::sin(0.5 * k_pi * r), 2); }
};

class ParaboloidShape : public DiscShape {
  public:
    explicit ParaboloidShape(int halves) : halves_(halves) {}
    int charts() const override { return halves_; }
    double coverage() const override { return 2 * k_pi * halves_; }
    Vec3d direction(int chart, UV uv) const override { return paraboloid_direction(half(chart), uv); }
    ProjectionPoint locate(const Vec3d& d) const override {
        if (halves_ == 2) {
            const ParaboloidPoint p = dual_paraboloid_point(d);
            return {p.half == ParaboloidHalf::back, p.uv, true};
        }
        if (d.z >= 0) return {0, paraboloid_uv(ParaboloidHalf::front, d), true};
        const double side = std::hypot(d.x, d.y);
        return {0, side > 0 ? disc_uv({d.x / side, d.y / side}) : disc_uv({1, 0}), false};
    }
    UV locate_in(int chart, int, const Vec3d& d) const override { return paraboloid_uv(half(chart), d); }
    double jacobian(UV uv) const override { return paraboloid_jacobian(uv); }
    int region(const Vec3d& d) const override { return d.z < 0; }
    int latlong_height(int size) const override { return int(std::ceil(0.5 * k_pi * size)); }

  protected:
    /// r = tan(rho / 2).
    double cap(double r) const override { return 2 * r * r / (1 + r * r); }

  private:
    static ParaboloidHalf half(int chart) { return chart == 0 ? ParaboloidHalf::front : ParaboloidHalf::back; }
    int halves_;
};

/// A direction (x, y, z) with z < 0 is found at (x, y) / (z - 1): where the front half shows (-x, -y, -z).
class ParaboloidOppositeShape : public ParaboloidShape {
  public:
    ParaboloidOppositeShape() : ParaboloidShape(1) {}
    Vec3d direction(int chart, UV uv) const override { return -ParaboloidShape::direction(chart, uv); }
    ProjectionPoint locate(const Vec3d& d) const override { return ParaboloidShape::locate(-d); }
    UV locate_in(int chart, int region, const Vec3d& d) const override {
        return ParaboloidShape::locate_in(chart, region, -d);
    }
    int region(const Vec3d& d) const override { return d.z > 0; }
};

/// A ball of radius 1 seen by a camera on +Z at the distance D from its middle, 1 / D = sin(fov / 2). The light comes
/// from so far away that only the reflected direction counts.
class MirrorBallShape : public DiscShape {
  public:
    explicit MirrorBallShape(double fov)
        : half_(0.5 * fov), tangent_(std::tan(half_)), distance_(1 / std::sin(half_)) {}
    /// Everything except the cone behind the ball, which the camera would see beside the ball.
    double coverage() const override { return 2 * k_pi * (1 + std::cos(half_)); }
    Vec3d direction(int, UV uv) const override {
        const DiscPoint p = disc_point(uv);
        const double r = std::sqrt(p.squared());
        if (r == 0) return {0, 0, 1};
        const double rho = angle(std::min(r, 1.0)), s = std::sin(rho) / r;
        return {s * p.x, s * p.y, std::cos(rho)};
    }
    ProjectionPoint locate(const Vec3d& d) const override {
        const double side = std::hypot(d.x, d.y), rho = std::atan2(side, d.z);
        if (side == 0) return {0, d.z > 0 ? UV{0.5, 0.5} : disc_uv({1, 0}), d.z > 0};
        const double r = radius(rho);
        return {0, disc_uv({r * d.x / side, r * d.y / side}), rho <= k_pi - half_ + 1e-12};
    }
    double jacobian(UV uv) const override {
        const double r = std::sqrt(disc_point(uv).squared()), view = std::atan(r * tangent_);
        const double sine = distance_ * std::sin(view), root = std::sqrt(std::max(1e-300, 1 - sine * sine));
        const double slope =
            (2 * distance_ * std::cos(view) / root - 1) * tangent_ / (1 + r * tangent_ * r * tangent_);  // drho / dr
        return 4 * slope * (r > 0 ? std::sin(angle(r)) / r : slope);
    }
    int region(const Vec3d& d) const override { return std::atan2(std::hypot(d.x, d.y), d.z) > k_pi - half_; }

  protected:
    double cap(double r) const override { return 2 * std::pow(std::sin(0.5 * angle(r)), 2); }

  private:
    /// The angle from +Z of the direction seen at the distance r: the ray leaves the camera at the angle a, tan a = r
    /// tan(fov / 2), and meets the ball at the angle b from +Z, sin(a + b) = D sin a; the normal's angle counts twice.
    double angle(double r) const {
        const double a = std::atan(r * tangent_);
        return 2 * std::asin(std::min(1.0, distance_ * std::sin(a))) - a;
    }
    /// Its inverse: 2 b + atan(sin b / (D - cos b)) = rho by Newton's method, whose function's slope is 2 to 2 + 1 / (D
    /// - 1).
    double radius(double rho) const {
        const double D = distance_, last = 0.5 * k_pi - half_;
        double b = std::min(0.5 * rho, last);
        for (int k = 0; k < 12; ++k) {
            const double c = std::cos(b), f = 2 * b + std::atan2(std::sin(b), D - c) - rho;
            const double step = f / (2 + (D * c - 1) / (D * D - 2 * D * c + 1));
            b = std::clamp(b - step, 0.0, last);
            if (std::abs(step) < 1e-15) break;
        }
        return std::min(1.0, std::sin(b) / (D - std::cos(b)) / tangent_);
    }

    double half_, tangent_, distance_;
};

}  // namespace

std::shared_ptr<const ProjectionShape> make_sphere_map_shape() {
    return std::make_shared<SphereMapShape>();
}
std::shared_ptr<const ProjectionShape> make_hemisphere_shape() {
    return std::make_shared<HemisphereShape>();
}
std::shared_ptr<const ProjectionShape> make_mirror_ball_shape(double fov) {
    if (fov < 1e-4) return make_sphere_map_shape();  // as good as infinitely far
    return std::make_shared<MirrorBallShape>(fov);
}
std::shared_ptr<const ProjectionShape> make_angular_shape() {
    return std::make_shared<AngularShape>();
}
std::shared_ptr<const ProjectionShape> make_paraboloid_shape() {
    return std::make_shared<ParaboloidShape>(1);
}
std::shared_ptr<const ProjectionShape> make_paraboloid_opposite_shape() {
    return std::make_shared<ParaboloidOppositeShape>();
}
std::shared_ptr<const ProjectionShape> make_dual_paraboloid_shape() {
    return std::make_shared<ParaboloidShape>(2);
}

}  // namespace domelight
