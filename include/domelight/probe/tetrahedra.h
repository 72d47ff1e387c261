#pragma once

#include "domelight/base/vec.h"

#include <array>
#include <span>
#include <vector>

namespace domelight {

/// Delaunay tetrahedra between points, and the interpolation in them: continuous everywhere, linear within each
/// tetrahedron, and exact for linear functions inside the points' convex hull.
///
/// Built by insertion (Bowyer 1981; Watson 1981) with "ghost" tetrahedra outside of the hull. The points are moved by
/// about a millionth of their extent first, the same way each time, so that no five lie on a sphere and no four in a
/// plane. Points that lie nearly on a plane (thinner than half of their spacing) or nearly on a line are interpolated
/// within that plane or line; a single point has all the weight.
class Tetrahedra {
  public:
    /// points: at least 1, finite. A point that coincides with an earlier one (within 1e-5 of the extent) is left out:
    /// its weight is 0 everywhere.
    explicit Tetrahedra(std::span<const Vec3f> points);

    /// The points of each tetrahedron. Where the points lie on a plane or a line, a tetrahedron has the same point
    /// twice or more often; with a single point there is one tetrahedron that has it four times.
    std::span<const std::array<int, 4>> cells() const { return cells_; }

    /// The points between which a place lies, and their weights: >= 0, sum 1. A point may occur more than once.
    struct Weights {
        std::array<int, 4> point{};
        std::array<float, 4> weight{};
    };
    /// Outside of the hull, those of the nearest place on it. (Cupisz 2012, "Light probe interpolation using tetrahedral
    /// tessellations", extrudes the hull's faces along normals for the same purpose. The nearest place of a convex body
    /// needs no normals, and moves no further than the point does.)
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
    void make_vertices(std::span<const Vec3f> points);
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
    Weights on_hull(const Vec3d& place) const;

    Frame frame_;
    double extent_ = 0;
    double layer_ = 0;              ///< half of the distance between the copies of points on a plane or a line
    std::vector<Vec3d> position_;   ///< of the vertices, in the frame, moved a little
    std::vector<int> point_;        ///< whose vertex it is
    std::vector<Cell> tetrahedra_;  ///< with the ghosts
    std::vector<int> hull_;         ///< the ghosts
    std::vector<std::array<int, 4>> cells_;
    std::array<int, 3> bins_{1, 1, 1};
    Vec3d bin_origin_, bin_size_;
    std::vector<int> start_;  ///< where to begin the walk, for each bin
};

}  // namespace domelight
