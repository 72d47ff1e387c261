#pragma once

#include "domelight/base/vec.h"

#include <array>
#include <span>
#include <vector>

namespace domelight {

/// Delaunay tetrahedra between points, and the interpolation in them: continuous, linear within each tetrahedron, and
/// exact for linear functions inside the points' convex hull.
///
/// Built by insertion (Bowyer 1981; Watson 1981) with "ghost" tetrahedra outside of the hull.
///   - Points that are outermost along an axis are copied outwards by the typical spacing. A place just outside lies
///     between the points next to it, and not above a long triangle of the hull. (Cupisz 2012, "Light probe interpolation
///     using tetrahedral tessellations", extrudes the hull's faces along normals for the same purpose.)
///   - Points that lie nearly on a plane (thinner than half of their spacing) or nearly on a line are interpolated within
///     that plane or line; a single point has all the weight.
///   - Four points of a square, as grids have them, can have a tetrahedron without volume between them, across which an
///     interpolation would jump. So the squares of the points (the fourth coordinate, of which Delaunay tetrahedra are
///     the convex hull) are raised by up to a hundredth of the squared distance to the nearest, which leaves out the flattest ones; the
///     points are moved by a millionth of their extent, so that no four of the hull lie on a plane. Both are the same
///     each time.
class Tetrahedra {
  public:
    /// What lies outside of the points' convex hull.
    enum class Outside {
        copies,  ///< copies of the outermost points, as above
        nothing  ///< cells() then fill the hull
    };
    /// points: at least 1, finite. A point that coincides with an earlier one (within 1e-5 of the extent) is left out:
    /// its weight is 0 everywhere.
    explicit Tetrahedra(std::span<const Vec3f> points, Outside outside = Outside::copies);

    /// The points of each tetrahedron that has no copy among its corners. None where the points lie on a plane or a line.
    std::span<const std::array<int, 4>> cells() const { return cells_; }

    /// The points between which a place lies, and their weights: >= 0, sum 1. A point may occur more than once.
    struct Weights {
        std::array<int, 4> point{};
        std::array<float, 4> weight{};
    };
    /// Outside of the hull and its copies, those of the nearest place on it.
    Weights at(const Vec3f& place) const;

  private:
    struct Cell {
        std::array<int, 4> vertex;     ///< positive orientation; -1: the ghost vertex at infinity
        std::array<int, 4> neighbour;  ///< across the face opposite to that vertex
    };
    static const Cell k_removed;
    static bool is_removed(const Cell& cell);
    static int ghost_of(const Cell& cell);  ///< which of its vertices is the ghost, -1: none
    static std::array<int, 3> face_of(const Cell& cell, std::size_t opposite);
    std::array<Vec3d, 3> face_positions(const Cell& cell, std::size_t opposite) const;
    struct Frame {
        Vec3d centre;
        std::array<Vec3d, 3> axis;
        int rank = 0;  ///< how many axes the points extend along
    };

    void make_frame(std::span<const Vec3f> points);
    void make_vertices(std::span<const Vec3f> points, Outside outside);
    /// Adds a point; where the points lie on a plane or a line, its layers on both sides of that.
    void add_vertex(const Vec3d& place, int point, double raise);
    /// No other place is near in this direction.
    bool is_outermost(const std::vector<Vec3d>& places, std::size_t i, int axis, double sign) const;
    void triangulate();
    void insert(int vertex);
    void drop_removed();
    void make_shortcuts();
    bool conflicts(const Cell& cell, int vertex) const;
    int find_conflict(int vertex) const;
    /// The tetrahedron that holds a place in the frame, by walking from `start`; that of a ghost if it is outside.
    int walk(const Vec3d& place, int start) const;
    int shortcut(const Vec3d& place) const;
    Vec3d to_frame(const Vec3f& place) const;
    Weights inside(const Cell& cell, const Vec3d& place) const;
    Vec3d nearest_on_hull(const Vec3d& place) const;

    Frame frame_;
    double extent_ = 0;
    double spacing_ = 0;            ///< the typical distance of points
    std::vector<Vec3d> position_;   ///< of the vertices, in the frame, moved a little
    std::vector<double> raised_;    ///< by how much their squares are raised
    std::vector<char> is_copy_;     ///< 1: an outward copy of a point
    std::vector<int> point_;        ///< whose vertex it is
    std::vector<Cell> tetrahedra_;  ///< with the ghosts
    std::vector<int> hull_;         ///< the ghosts
    std::vector<std::array<int, 4>> cells_;
    std::array<int, 3> bins_{1, 1, 1};
    Vec3d bin_origin_, bin_size_;
    std::vector<int> start_;  ///< where to begin the walk, for each bin
};

}  // namespace domelight
