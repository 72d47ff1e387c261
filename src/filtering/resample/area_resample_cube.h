#pragma once

#include "domelight/filtering/resample/area_resample.h"

#include "filtering/resample/area_resample_arc.h"
#include "projection/bordered_cube.h"

#include <span>

namespace domelight::area {

/// ∫ g dω over regions of the sphere, g the reconstruction of a cubemap that continues across edges
/// (BorderedCube): between the centres of a face's texels bilinear on the face's plane; past the outermost centres
/// towards the texels of the neighbouring face that lie across the edge; and towards each of the cube's corners to the
/// mean of the three texels that meet there. g is continuous everywhere.
///
/// By Stokes on each face's plane (S to the right, T down, -1..1): dω = dS dT / (1 + S^2 + T^2)^(3/2), so with
/// F(S, T) = ∫_{S_ref}^S g (1 + S^2 + T^2)^(-3/2) dS, ∫_R g dω = ∮ F dT around R, which is
/// cut at the face's edges and at the lines of texel centres. In double.
class CubeIntegrator {
  public:
    explicit CubeIntegrator(const Cubemap& source);

    /// ∫_R g dω of the three channels. `border` runs around R once, either way; R is small against a half
    /// sphere.
    Vec3d integrate(std::span<const Arc> border) const;

    /// g at the direction `d` (any length).
    Vec3d at(const Vec3d& d) const;

  private:
    struct Flux;
    struct Cell;
    void add_face(int face, std::span<const Arc> part, Flux& sum) const;
    void add_arc(int face, const Arc& arc, int reference, Flux& sum) const;
    void add_piece(int face, const Arc& arc, double a, double b, Cell cell, int reference, Flux& sum) const;
    Flux along_row(int face, double s, Cell cell, double v, double t, int reference) const;
    Vec3d texel(int face, int column, int row) const;  ///< -1 .. size: with the border from the neighbours
    double centre(int index) const { return (2 * index + 1.0) / size_ - 1; }

    int size_;
    BorderedCube source_;
};

/// area_resample_cube and area_resample_cube_to_latlong in any orientation and at any size, texel by texel: what the fast
/// versions are tested against.
Cubemap plain_cube_to_cube(const Cubemap& source, int size, const Mat3& world_to_source, int threads);
ImageF plain_cube_to_latlong(const Cubemap& source, int out_height, const Mat3& world_to_source, int threads);

}  // namespace domelight::area
