#pragma once

#include "domelight/filtering/resample/area_resample.h"
#include "domelight/projection/projection.h"

#include "filtering/resample/area_resample_arc.h"

#include <algorithm>
#include <span>

namespace domelight::area {

struct SineMoments {
    double zeroth, first;
};

/// ∫_a^b sin t dt and ∫_a^b (t - a) sin t dt, without cancellation in thin intervals.
SineMoments sine_moments(double a, double b);

/// ∫ g dω over regions of the sphere, g the bilinear reconstruction of a lat-long image (u wraps, v clamps in
/// the half rows at the poles). In double; the view must outlive the integrator.
///
/// By Stokes: with F(theta, phi) = ∫_{theta_ref}^theta g sin t dt, ∫_R g dω = ∮ F dphi around
/// R, for any theta_ref if R contains no pole, and for theta_ref = the pole if it contains one. The border is cut where
/// it crosses the rows and columns of texel centres: between the cuts F is smooth and a few Gauss-Legendre nodes are
/// exact to rounding. theta_ref is close to R, so that a bright light elsewhere on the meridian does not cost
/// precision.
class LatlongIntegrator {
  public:
    explicit LatlongIntegrator(ImageView<const float> image);

    /// Which poles of the source a region contains (including poles on its border).
    enum class Pole { none, north, south };

    /// ∫_R g dω of the three channels. `border` runs around R once, either way; R is no larger than a half
    /// sphere.
    Vec3d integrate(std::span<const Arc> border, Pole pole) const;

  private:
    struct Flux {
        Vec3d light;
        double solid_angle = 0;
        void add(double weight, const Vec3d& g) { light += g * weight; }
    };
    struct Cell {
        int column, row;
    };
    void cuts(const Arc& arc, std::vector<double>& out) const;
    void add_piece(const Arc& arc, double a, double b, Cell cell, int reference, Flux& sum) const;
    Flux meridian(double theta, double u, Cell cell, int reference) const;
    Vec3d texel(int row, int column, double u) const;
    Cell cell_at(const Vec3d& p) const;
    double cell_top(int row) const { return std::clamp((row + 0.5) * row_angle_, 0.0, k_pi); }

    ImageView<const float> image_;
    double row_angle_, column_angle_;
    // Cell row j (-1 .. H - 1) lies between the centres of rows j and j + 1: its integrals of (1 - s) sin and of s sin.
    std::vector<double> upper_, lower_;
};

/// The plain version of area_resample_to_cube and area_resample_to_latlong: any orthogonal matrix, any size. Keeps the
/// whole source.
std::unique_ptr<AreaResampler> plain_to_cube(int width, int height, int size, const Mat3& world_to_source, int threads);
std::unique_ptr<AreaResampler> plain_to_latlong(int width, int height, int out_height, const Mat3& world_to_source,
                                                int threads);

}  // namespace domelight::area
