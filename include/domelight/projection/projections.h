#pragma once

#include "domelight/base/result.h"
#include "domelight/base/vec.h"
#include "domelight/projection/projection.h"

#include <memory>
#include <span>
#include <string>

namespace domelight {

/// A part of a picture, u0 <= u <= u1 and v0 <= v <= v1.
struct UVBox {
    double u0 = 0, v0 = 0, u1 = 1, v1 = 1;
};

/// Where a projection shows a direction.
struct ProjectionPoint {
    int chart = 0;
    UV uv;
    /// false: the projection leaves this direction out (behind a hemisphere); uv is then the nearest.
    bool shown = true;
};

/// The mathematics of one projection, in the picture's own frame: x to the right, y up, z out of the centre.
///
/// A picture consists of charts: the six faces of a cube, the two halves of a dual paraboloid, otherwise one. Each
/// fills a rectangle with u and v from 0 to 1, whose width : height is aspect().
class ProjectionShape {
  public:
    virtual ~ProjectionShape() = default;
    virtual int charts() const { return 1; }
    virtual double aspect() const { return 1; }
    /// Solid angle of all directions shown: 4 pi for a full projection.
    virtual double coverage() const { return 4 * k_pi; }
    /// Unit direction shown at a point. Defined outside the valid part too, as the continuation of the picture.
    virtual Vec3d direction(int chart, UV uv) const = 0;
    /// Inverse, for any d != 0.
    virtual ProjectionPoint locate(const Vec3d& d) const = 0;
    /// Whether the point belongs to the map (for round maps: whether it lies within the disc).
    virtual bool valid(UV) const { return true; }
    /// dω / (du dv) of a chart, for valid points.
    virtual double jacobian(UV uv) const = 0;
    /// Solid angle of the valid part of a box of a chart.
    virtual double solid_angle(const UVBox& box) const = 0;
    /// The same for a row of boxes from v0 to v1 between consecutive `u_edges` (one more than `out` has elements).
    virtual void solid_angles(double v0, double v1, std::span<const double> u_edges, std::span<double> out) const {
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = solid_angle({u_edges[i], v0, u_edges[i + 1], v1});
    }
    /// Points on different sides of a seam have different charts or different regions. (At a seam, neighbouring
    /// directions lie apart in the picture.)
    virtual int region(const Vec3d&) const { return 0; }
    /// locate() with the given chart and region continued a little past their seams: for a direction on a seam that
    /// falls into the neighbour because of a rounding error.
    virtual UV locate_in(int /*chart*/, int /*region*/, const Vec3d& d) const { return locate(d).uv; }
    /// Whether the picture's left and right edges meet.
    virtual bool wraps() const { return false; }
    /// Height of the lat-long map whose texels are as fine as the finest texels of a chart `size` texels high.
    virtual int latlong_height(int size) const { return size; }
};

/// Where the samples of an image lie.
enum class SampleGrid {
    centres,        ///< u = (i + 1/2) / W, v = (j + 1/2) / H
    rows_on_poles,  ///< v = j / (H - 1)
    both_on_edges,  ///< u = i / (W - 1), v = j / (H - 1)
};

/// A projection with its convention: the world directions of the picture's centre, right and top.
///
///     auto p = projection_from_name("angular/centre=+X,right=+Z");
///     Vec3d d = p->direction(0, {0.5, 0.5});  // (1, 0, 0)
class Projection {
  public:
    Projection(std::string name, std::shared_ptr<const ProjectionShape> shape, const Mat3& world_to_picture,
               SampleGrid grid = SampleGrid::centres)
        : name_(std::move(name)), shape_(std::move(shape)), world_to_picture_(world_to_picture), grid_(grid) {}

    const std::string& name() const { return name_; }  ///< without the convention: "sphere-map"
    const ProjectionShape& shape() const { return *shape_; }
    const Mat3& world_to_picture() const { return world_to_picture_; }
    SampleGrid grid() const { return grid_; }
    int charts() const { return shape_->charts(); }
    /// The same picture looked up with `before` applied to each direction first.
    Projection turned(const Mat3& before) const { return {name_, shape_, world_to_picture_ * before, grid_}; }
    bool full() const { return shape_->coverage() > 4 * k_pi - 1e-9; }

    Vec3d direction(int chart, UV uv) const { return world_to_picture_.transposed() * shape_->direction(chart, uv); }
    ProjectionPoint locate(const Vec3d& d) const { return shape_->locate(world_to_picture_ * d); }
    bool valid(UV uv) const { return shape_->valid(uv); }
    double jacobian(UV uv) const { return shape_->jacobian(uv); }

    /// The part of a chart of width x height texels that texel (x, y) represents. Where samples lie on the edges, the
    /// outer ones represent half as much.
    UVBox texel_box(int x, int y, int width, int height) const;
    double texel_solid_angle(int x, int y, int width, int height) const {
        return shape_->solid_angle(texel_box(x, y, width, height));
    }
    /// The solid angles of all texels of row y, computed faster together. (Every projection is symmetric: row height -
    /// 1 - y has the same solid angles, and so have the columns counted from the right.)
    void texel_solid_angles(int y, int width, int height, std::span<double> out) const;

  private:
    std::string name_;
    std::shared_ptr<const ProjectionShape> shape_;
    Mat3 world_to_picture_;
    SampleGrid grid_;
};

/// A row of the table of projections.
struct ProjectionInfo {
    const char* name;
    const char* about;
    const char *centre, *right, *up;  ///< world axes of the default convention
    /// fov_deg: of a mirror ball, as in projection_from_name(); the others ignore it.
    std::shared_ptr<const ProjectionShape> (*make_shape)(double fov_deg);
};
std::span<const ProjectionInfo> projections();

/// The projection of the text NAME, NAME/CONVENTION or NAME/key=value,... NAME is a name in projections(), or
/// "equirectangular" (= latlong) or "pbrt" (= equal-area-octahedral). CONVENTION is a lat-long convention
/// (docs/conventions.md), for a cube "openexr". Keys are centre, right and up (signed axes) and, for mirror-ball, fov
/// (degrees that the ball spans in the photograph; 0: a photograph from far away). Errors: any other text.
Result<Projection> projection_from_name(const std::string& text);

}  // namespace domelight
