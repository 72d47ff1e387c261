#include "domelight/probe/tetrahedra.h"

#include "domelight/base/random.h"

#include "probe/closest_on_triangle.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace domelight {
namespace {

using Vec3l = Vec3<long double>;

constexpr int k_ghost = -1;
/// The corners of the face opposite to each vertex, in an order that makes (face, vertex) a positive tetrahedron.
constexpr int k_face[4][3] = {{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}};

/// Six times the signed volume: positive if d lies on the side from which a, b, c run clockwise.
long double orientation(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
    const Vec3l u(b - a), v(c - a), w(d - a);
    return dot(cross(u, v), w);
}

/// A point and by how much its square is raised.
struct Lifted {
    Vec3d position;
    double raised;
};

/// Positive if p lies inside of the sphere through a, b, c, d, which have a positive orientation: below the hyperplane
/// through them in four dimensions, if the fourth coordinate is the square of a point.
long double inside_sphere(const std::array<Lifted, 4>& corner, const Lifted& p) {
    std::array<Vec3l, 4> d;
    std::array<long double, 4> square{};
    for (std::size_t i = 0; i < 4; ++i) {
        d[i] = Vec3l(corner[i].position - p.position);
        square[i] = dot(d[i], d[i]) + static_cast<long double>(corner[i].raised - p.raised);
    }
    return square[0] * dot(cross(d[1], d[2]), d[3]) - square[1] * dot(cross(d[2], d[3]), d[0]) +
           square[2] * dot(cross(d[3], d[0]), d[1]) - square[3] * dot(cross(d[0], d[1]), d[2]);
}

/// The eigenvectors of a symmetric matrix, by Jacobi's rotations.
std::array<Vec3d, 3> principal_axes(std::array<std::array<double, 3>, 3> m) {
    std::array<std::array<double, 3>, 3> v{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    constexpr int sweeps = 30;
    for (int sweep = 0; sweep < sweeps; ++sweep)
        for (const auto& [p, q] : {std::pair{0, 1}, {0, 2}, {1, 2}}) {
            if (m[p][q] == 0) continue;
            const double angle = 0.5 * std::atan2(2 * m[p][q], m[q][q] - m[p][p]), c = std::cos(angle),
                         s = std::sin(angle);
            for (int k = 0; k < 3; ++k) {
                const double a = m[k][p], b = m[k][q];
                m[k][p] = c * a - s * b, m[k][q] = s * a + c * b;
            }
            for (int k = 0; k < 3; ++k) {
                const double a = m[p][k], b = m[q][k];
                m[p][k] = c * a - s * b, m[q][k] = s * a + c * b;
                const double x = v[k][p], y = v[k][q];
                v[k][p] = c * x - s * y, v[k][q] = s * x + c * y;
            }
        }
    return {Vec3d{v[0][0], v[1][0], v[2][0]}, Vec3d{v[0][1], v[1][1], v[2][1]}, Vec3d{v[0][2], v[1][2], v[2][2]}};
}

/// A number from -1 to 1 that depends on nothing but its arguments.
double jitter(int vertex, int axis) {
    return double(derive_key(std::uint64_t(vertex), std::uint64_t(axis)) >> 11) * 0x1p-52 - 1;
}

/// Six times the signed volume of a face and a point; positive inside of the tetrahedron.
double height_over(const std::array<Vec3d, 3>& face, const Vec3d& p) {
    return dot(cross(face[1] - face[0], face[2] - face[0]), p - face[0]);
}

double& component(Vec3d& v, int axis) {
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

}  // namespace

const Tetrahedra::Cell Tetrahedra::k_removed{{-2, -2, -2, -2}, {-1, -1, -1, -1}};

bool Tetrahedra::is_removed(const Cell& cell) {
    return cell.vertex[0] == k_removed.vertex[0];
}

int Tetrahedra::ghost_of(const Cell& cell) {
    for (int i = 0; i < 4; ++i)
        if (cell.vertex[std::size_t(i)] == k_ghost) return i;
    return -1;
}

std::array<int, 3> Tetrahedra::face_of(const Cell& cell, std::size_t opposite) {
    const int* face = k_face[opposite];
    return {cell.vertex[std::size_t(face[0])], cell.vertex[std::size_t(face[1])], cell.vertex[std::size_t(face[2])]};
}

std::array<Vec3d, 3> Tetrahedra::face_positions(const Cell& cell, std::size_t opposite) const {
    const std::array<int, 3> face = face_of(cell, opposite);
    return {position_[std::size_t(face[0])], position_[std::size_t(face[1])], position_[std::size_t(face[2])]};
}

Tetrahedra::Tetrahedra(std::span<const Vec3f> points, Outside outside) {
    assert(!points.empty());
    make_frame(points);
    make_vertices(points, outside);
    if (frame_.rank == 0) return;
    triangulate();
    for (int t = 0; t < int(tetrahedra_.size()); ++t) {
        const Cell& cell = tetrahedra_[std::size_t(t)];
        if (ghost_of(cell) >= 0) {
            hull_.push_back(t);
            continue;
        }
        if (frame_.rank < 3 || std::ranges::any_of(cell.vertex, [&](int v) { return bool(is_copy_[std::size_t(v)]); }))
            continue;
        std::array<int, 4> own{};
        for (std::size_t i = 0; i < 4; ++i) own[i] = point_[std::size_t(cell.vertex[i])];
        cells_.push_back(own);
    }
    make_shortcuts();
}

void Tetrahedra::make_frame(std::span<const Vec3f> points) {
    Vec3d sum;
    for (const Vec3f& p : points) sum += Vec3d(p);
    frame_.centre = sum / double(points.size());
    std::array<std::array<double, 3>, 3> spread{};
    for (const Vec3f& p : points) {
        const Vec3d d = Vec3d(p) - frame_.centre;
        const double c[3] = {d.x, d.y, d.z};
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 0; j < 3; ++j) spread[i][j] += c[i] * c[j];
    }
    const std::array<Vec3d, 3> axes = principal_axes(spread);
    std::array<std::pair<double, int>, 3> extents;
    for (int i = 0; i < 3; ++i) {
        double low = std::numeric_limits<double>::infinity(), high = -low;
        for (const Vec3f& p : points) {
            const double along = dot(Vec3d(p) - frame_.centre, axes[std::size_t(i)]);
            low = std::min(low, along), high = std::max(high, along);
        }
        extents[std::size_t(i)] = {high - low, i};
    }
    std::ranges::stable_sort(extents, [](const auto& a, const auto& b) { return a.first > b.first; });
    for (std::size_t i = 0; i < 3; ++i) frame_.axis[i] = axes[std::size_t(extents[i].second)];
    const double n = double(points.size()), e0 = extents[0].first, e1 = extents[1].first, e2 = extents[2].first;
    extent_ = e0;
    const double along_line = e0 / n, on_plane = std::sqrt(e0 * e1 / n);
    frame_.rank = !(e0 > 1e-6) ? 0 : n < 3 || e1 <= 0.5 * along_line ? 1 : n < 4 || e2 <= 0.5 * on_plane ? 2 : 3;
    spacing_ = frame_.rank == 1 ? along_line : frame_.rank == 2 ? on_plane : std::cbrt(e0 * e1 * e2 / n);
}

Vec3d Tetrahedra::to_frame(const Vec3f& place) const {
    const Vec3d d = Vec3d(place) - frame_.centre;
    return {dot(d, frame_.axis[0]), frame_.rank > 1 ? dot(d, frame_.axis[1]) : 0,
            frame_.rank > 2 ? dot(d, frame_.axis[2]) : 0};
}

void Tetrahedra::make_vertices(std::span<const Vec3f> points, Outside outside) {
    std::vector<Vec3d> kept;
    for (int i = 0; i < int(points.size()); ++i) {
        const Vec3d place = to_frame(points[std::size_t(i)]);
        const double same = 1e-5 * extent_;
        if (std::ranges::any_of(kept, [&](const Vec3d& other) { return length(other - place) <= same; })) continue;
        kept.push_back(place);
        point_.push_back(i);
    }
    if (frame_.rank == 0) return;
    const std::vector<int> own = std::exchange(point_, {});
    for (std::size_t i = 0; i < kept.size(); ++i) {
        double nearest = spacing_;
        for (std::size_t j = 0; j < kept.size(); ++j)
            if (j != i) nearest = std::min(nearest, length(kept[j] - kept[i]));
        const double raise = 0.01 * nearest * nearest;
        add_vertex(kept[i], own[i], raise);
        is_copy_.resize(position_.size(), 0);
        if (outside == Outside::nothing) continue;
        for (int axis = 0; axis < frame_.rank; ++axis)
            for (const double sign : {1.0, -1.0})
                if (is_outermost(kept, i, axis, sign)) {
                    Vec3d copy = kept[i];
                    component(copy, axis) += sign * spacing_;
                    add_vertex(copy, own[i], raise);
                    is_copy_.resize(position_.size(), 1);
                }
    }
}

bool Tetrahedra::is_outermost(const std::vector<Vec3d>& places, std::size_t i, int axis, double sign) const {
    for (std::size_t j = 0; j < places.size(); ++j) {
        Vec3d to = places[j] - places[i];
        const double along = sign * component(to, axis), distance = length(to);
        if (j != i && along > 0.7 * distance && distance < 3 * spacing_) return false;
    }
    return true;
}

void Tetrahedra::add_vertex(const Vec3d& place, int point, double raise) {
    const int layers = 1 << (3 - frame_.rank);
    const double move = 1e-6 * extent_;
    for (int layer = 0; layer < layers; ++layer) {
        Vec3d p = place;
        for (int axis = frame_.rank; axis < 3; ++axis)
            component(p, axis) += (layer >> (axis - frame_.rank) & 1 ? 0.25 : -0.25) * spacing_;
        for (int axis = 0; axis < 3; ++axis) component(p, axis) += move * jitter(int(position_.size()), axis);
        raised_.push_back(raise * jitter(int(position_.size()), 3));
        position_.push_back(p);
        point_.push_back(point);
    }
}

void Tetrahedra::triangulate() {
    // The first tetrahedron: of vertices that lie far apart.
    const int n = int(position_.size());
    const auto farthest = [&](auto&& measure) {
        int best = 0;
        for (int i = 1; i < n; ++i)
            if (measure(position_[std::size_t(i)]) > measure(position_[std::size_t(best)])) best = i;
        return best;
    };
    const Vec3d a = position_[0];
    const int ib = farthest([&](const Vec3d& p) { return length(p - a); });
    const Vec3d b = position_[std::size_t(ib)];
    const int ic = farthest([&](const Vec3d& p) { return length(cross(b - a, p - a)); });
    const Vec3d c = position_[std::size_t(ic)];
    const int id = farthest([&](const Vec3d& p) { return std::abs(double(orientation(a, b, c, p))); });
    std::array<int, 4> first{0, ib, ic, id};
    if (orientation(a, b, c, position_[std::size_t(id)]) < 0) std::swap(first[0], first[1]);

    tetrahedra_ = {{first, {1, 2, 3, 4}}};
    for (int f = 0; f < 4; ++f) {
        // A ghost lies on the other side of its face: the face's corners in the opposite order.
        const int* face = k_face[f];
        tetrahedra_.push_back(
            {{first[std::size_t(face[0])], first[std::size_t(face[2])], first[std::size_t(face[1])], k_ghost}, {}});
        Cell& ghost = tetrahedra_.back();
        for (std::size_t i = 0; i < 3; ++i) {
            const int opposite = int(std::ranges::find(first, ghost.vertex[i]) - first.begin());
            ghost.neighbour[i] = 1 + opposite;
        }
        ghost.neighbour[3] = 0;
    }
    for (int i = 0; i < n; ++i)
        if (std::ranges::find(first, i) == first.end()) insert(i);
    drop_removed();
}

bool Tetrahedra::conflicts(const Cell& cell, int vertex) const {
    const Vec3d& p = position_[std::size_t(vertex)];
    const int ghost = ghost_of(cell);
    if (ghost >= 0) {
        // Outside of the hull, on the ghost's side of this face.
        const std::array<Vec3d, 3> face = face_positions(cell, std::size_t(ghost));
        return orientation(face[0], face[1], face[2], p) > 0;
    }
    const auto lifted = [&](int v) { return Lifted{position_[std::size_t(v)], raised_[std::size_t(v)]}; };
    return inside_sphere(
               {lifted(cell.vertex[0]), lifted(cell.vertex[1]), lifted(cell.vertex[2]), lifted(cell.vertex[3])},
               lifted(vertex)) > 0;
}

int Tetrahedra::find_conflict(int vertex) const {
    // Vertices that follow each other are often neighbours in space, so the newest tetrahedra are tried first.
    for (int t = int(tetrahedra_.size()) - 1; t >= 0; --t)
        if (!is_removed(tetrahedra_[std::size_t(t)]) && conflicts(tetrahedra_[std::size_t(t)], vertex)) return t;
    return -1;
}

void Tetrahedra::insert(int vertex) {
    // Find the cavity: all tetrahedra whose sphere holds the vertex. They are connected.
    const int first = find_conflict(vertex);
    if (first < 0) return;
    std::vector<int> cavity{first};
    std::vector<char> in_cavity(tetrahedra_.size(), 0);
    in_cavity[std::size_t(first)] = 1;
    for (std::size_t i = 0; i < cavity.size(); ++i)
        for (const int next : tetrahedra_[std::size_t(cavity[i])].neighbour)
            if (!in_cavity[std::size_t(next)] && conflicts(tetrahedra_[std::size_t(next)], vertex)) {
                in_cavity[std::size_t(next)] = 1;
                cavity.push_back(next);
            }

    // Fill it with tetrahedra from its faces to the vertex, and join those that share an edge of the cavity.
    std::map<std::pair<int, int>, std::pair<int, std::size_t>> open;
    for (const int t : cavity) {
        const Cell old = tetrahedra_[std::size_t(t)];
        for (std::size_t f = 0; f < 4; ++f) {
            const int outer = old.neighbour[f], made = int(tetrahedra_.size());
            if (in_cavity[std::size_t(outer)]) continue;
            *std::ranges::find(tetrahedra_[std::size_t(outer)].neighbour, t) = made;
            const std::array<int, 3> face = face_of(old, f);
            tetrahedra_.push_back({{face[0], face[1], face[2], vertex}, {-1, -1, -1, outer}});
            for (std::size_t k = 0; k < 3; ++k) {
                const auto [u, v] = std::minmax(face[(k + 1) % 3], face[(k + 2) % 3]);
                const auto [found, fresh] = open.try_emplace({u, v}, made, k);
                if (fresh) continue;
                const auto [other, side] = found->second;
                tetrahedra_[std::size_t(made)].neighbour[k] = other;
                tetrahedra_[std::size_t(other)].neighbour[side] = made;
            }
        }
        tetrahedra_[std::size_t(t)] = k_removed;
    }
}

void Tetrahedra::drop_removed() {
    std::vector<int> new_index(tetrahedra_.size(), -1);
    int count = 0;
    for (std::size_t t = 0; t < tetrahedra_.size(); ++t)
        if (!is_removed(tetrahedra_[t])) new_index[t] = count++;
    std::erase_if(tetrahedra_, is_removed);
    for (Cell& cell : tetrahedra_)
        for (int& next : cell.neighbour) next = new_index[std::size_t(next)];
}

void Tetrahedra::make_shortcuts() {
    Vec3d low = position_[0], high = low;
    for (const Vec3d& p : position_) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    const Vec3d size = high - low;
    const double edge = std::cbrt(size.x * size.y * size.z / double(position_.size()));
    const auto count = [&](double length) { return std::clamp(int(std::lround(length / edge)), 1, 64); };
    bins_ = {count(size.x), count(size.y), count(size.z)};
    bin_origin_ = low;
    bin_size_ = {size.x / bins_[0], size.y / bins_[1], size.z / bins_[2]};
    int last = 0;
    while (ghost_of(tetrahedra_[std::size_t(last)]) >= 0) ++last;
    for (int z = 0; z < bins_[2]; ++z)
        for (int y = 0; y < bins_[1]; ++y)
            for (int x = 0; x < bins_[0]; ++x) {
                const Vec3d middle = low + product(bin_size_, Vec3d{x + 0.5, y + 0.5, z + 0.5});
                last = walk(middle, last);
                // Outside of the hull: the tetrahedron behind the face where the walk left it.
                const Cell& cell = tetrahedra_[std::size_t(last)];
                if (const int ghost = ghost_of(cell); ghost >= 0) last = cell.neighbour[std::size_t(ghost)];
                start_.push_back(last);
            }
}

int Tetrahedra::shortcut(const Vec3d& p) const {
    const auto bin = [](double at, double origin, double size, int count) {
        return at > origin ? int(std::min((at - origin) / size, count - 1.0)) : 0;  // 0 for what is not a number
    };
    const int x = bin(p.x, bin_origin_.x, bin_size_.x, bins_[0]), y = bin(p.y, bin_origin_.y, bin_size_.y, bins_[1]),
              z = bin(p.z, bin_origin_.z, bin_size_.z, bins_[2]);
    return start_[std::size_t(x + bins_[0] * (y + bins_[1] * z))];
}

int Tetrahedra::walk(const Vec3d& place, int start) const {
    // In a Delaunay triangulation, a walk through faces that have the place on their other side ends (Edelsbrunner
    // 1990); the bound is for rounding.
    int t = start;
    for (std::size_t step = 0; step < tetrahedra_.size(); ++step) {
        const Cell& cell = tetrahedra_[std::size_t(t)];
        if (ghost_of(cell) >= 0) return t;
        int next = -1;
        for (std::size_t f = 0; f < 4 && next < 0; ++f)
            if (height_over(face_positions(cell, f), place) < 0) next = cell.neighbour[f];
        if (next < 0) return t;
        t = next;
    }
    return t;
}

Tetrahedra::Weights Tetrahedra::inside(const Cell& cell, const Vec3d& place) const {
    std::array<double, 4> volume{};
    double sum = 0;
    for (std::size_t f = 0; f < 4; ++f) {
        volume[f] = std::max(0.0, height_over(face_positions(cell, f), place));
        sum += volume[f];
    }
    Weights out;
    for (std::size_t f = 0; f < 4; ++f) {
        out.point[f] = point_[std::size_t(cell.vertex[f])];
        out.weight[f] = float(volume[f] / sum);
    }
    return out;
}

Vec3d Tetrahedra::nearest_on_hull(const Vec3d& place) const {
    Vec3d found;
    double nearest = std::numeric_limits<double>::infinity();
    for (const int t : hull_) {
        const Cell& cell = tetrahedra_[std::size_t(t)];
        const std::size_t ghost = std::size_t(ghost_of(cell));
        const std::array<Vec3d, 3> corner = face_positions(cell, ghost);
        const auto close = closest_on_triangle(place, corner[0], corner[1], corner[2]);
        if (close.squared_distance >= nearest) continue;
        nearest = close.squared_distance;
        found = corner[0] * close.weight[0] + corner[1] * close.weight[1] + corner[2] * close.weight[2];
    }
    return found;
}

Tetrahedra::Weights Tetrahedra::at(const Vec3f& place) const {
    if (frame_.rank == 0) return {{0, 0, 0, 0}, {1, 0, 0, 0}};
    Vec3d p = to_frame(place);
    if (ghost_of(tetrahedra_[std::size_t(walk(p, shortcut(p)))]) >= 0) p = nearest_on_hull(p);
    // Flat faces of the hull have tetrahedra behind them that are as thin as the points were moved. A place that is
    // shrunk towards the middle by more than that lies below them, on both sides of the hull alike.
    p *= 1 - 2e-5;
    const Cell* cell = &tetrahedra_[std::size_t(walk(p, shortcut(p)))];
    if (const int ghost = ghost_of(*cell); ghost >= 0)
        cell = &tetrahedra_[std::size_t(cell->neighbour[std::size_t(ghost)])];
    return inside(*cell, p);
}

}  // namespace domelight
