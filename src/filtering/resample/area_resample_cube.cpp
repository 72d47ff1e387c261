#include "filtering/resample/area_resample_cube.h"

#include "domelight/base/parallel.h"
#include "domelight/projection/projection.h"

#include "base/sort.h"
#include "filtering/resample/cube_resize.h"
#include "filtering/resample/cube_to_latlong.h"

#include <algorithm>
#include <array>

namespace domelight::area {

namespace {

/// A face's plane: its normal and its axes of growing u and v.
struct Plane {
    Vec3d normal, right, down;
};

Plane plane_of(int face) {
    const Vec3d n = cube_direction(face, {0.5, 0.5});
    return {n, cube_direction(face, {1, 0.5}) - n, cube_direction(face, {0.5, 1}) - n};
}

/// The part of a closed border of arcs on the side dot(p, normal) >= 0 of a plane through the centre, closed along the
/// plane.
std::vector<Arc> clip(std::span<const Arc> border, const Vec3d& normal) {
    std::vector<Arc> kept;
    std::vector<double> s;
    const auto append = [&](const Arc& arc) {
        if (!kept.empty()) {
            const Vec3d from = kept.back().at(kept.back().s1), to = arc.at(arc.s0);
            // The points where the border leaves the half space and returns lie on the plane, so the great arc between
            // them does too.
            if (length(to - from) > 1e-15) kept.push_back(great_arc(normalize(from), normalize(to)));
        }
        kept.push_back(arc);
    };
    for (const Arc& arc : border) {
        s.assign({arc.s0, arc.s1});
        cross_plane(arc, normal, 0, s);
        sort_items(s);
        for (std::size_t k = 0; k + 1 < s.size(); ++k) {
            Arc part = arc;
            part.s0 = s[k];
            part.s1 = s[k + 1];
            if (part.s1 > part.s0 && dot(normal, part.at(0.5 * (part.s0 + part.s1))) > 0) append(part);
        }
    }
    if (!kept.empty()) append(Arc(kept.front()));
    if (!kept.empty()) kept.pop_back();  // the first again, appended to close the ring
    return kept;
}

/// The face that a border lies in, or -1 if it may cross the edge of one. Where both ends of a great arc are inside the
/// planes through the centre and the edges, so is the arc; another arc bulges from it by s^2 / 8 at most.
int face_around(std::span<const Arc> border) {
    const int face = cube_point(border[0].at(border[0].s0)).face;
    const Plane plane = plane_of(face);
    for (const Arc& arc : border) {
        const double bulge = arc.is_great() ? 1e-12 : 0.25 * (arc.s1 - arc.s0) * (arc.s1 - arc.s0) + 1e-12;
        for (const double s : {arc.s0, arc.s1}) {
            const Vec3d p = arc.at(s);
            const double depth = dot(p, plane.normal),
                         beside = std::max(std::abs(dot(p, plane.right)), std::abs(dot(p, plane.down)));
            if (!(depth - beside > bulge)) return -1;
        }
    }
    return face;
}

}  // namespace

struct CubeIntegrator::Flux {
    Vec3d light;
    double solid_angle = 0;
    void add(double weight, const Vec3d& g) { light += g * weight; }
};

struct CubeIntegrator::Cell {
    int column, row;
};

CubeIntegrator::CubeIntegrator(const Cubemap& source) : size_(source.size()), source_(source) {}

Vec3d CubeIntegrator::texel(int face, int column, int row) const {
    const float* p = source_.texel(face, column, row);
    return {p[0], p[1], p[2]};
}

Vec3d CubeIntegrator::at(const Vec3d& d) const {
    const CubePoint p = cube_point(d);
    const double x = p.uv.u * size_ - 0.5, y = p.uv.v * size_ - 0.5;
    const int i = std::min(int(std::floor(x)), size_ - 1), j = std::min(int(std::floor(y)), size_ - 1);
    const double s = x - i, t = y - j;
    return (texel(p.face, i, j) * (1 - s) + texel(p.face, i + 1, j) * s) * (1 - t) +
           (texel(p.face, i, j + 1) * (1 - s) + texel(p.face, i + 1, j + 1) * s) * t;
}

/// ∫ g (1 + S^2 + T^2)^(-3/2) dS at T = t from the left end of column cell `reference` to `s`, which lies in `cell`;
/// v is t's place in the cell.
CubeIntegrator::Flux CubeIntegrator::along_row(int face, double s, Cell cell, double v, double t, int reference) const {
    Flux sum;
    const double q = 1 + t * t;
    const auto part = [&](int column, double a, double b) {
        const double ra = std::sqrt(q + a * a), rb = std::sqrt(q + b * b);
        const double zeroth = (b / rb - a / ra) / q, first = 1 / ra - 1 / rb;
        const double right = (first - centre(column) * zeroth) * 0.5 * size_;
        const auto g = [&](int i) { return texel(face, i, cell.row) * (1 - v) + texel(face, i, cell.row + 1) * v; };
        sum.add(zeroth - right, g(column));
        sum.add(right, g(column + 1));
        sum.solid_angle += zeroth;
    };
    if (cell.column >= reference) {
        for (int i = reference; i < cell.column; ++i) part(i, centre(i), centre(i + 1));
        part(cell.column, centre(cell.column), s);
        return sum;
    }
    for (int i = cell.column + 1; i < reference; ++i) part(i, centre(i), centre(i + 1));
    part(cell.column, s, centre(cell.column + 1));
    return {-sum.light, -sum.solid_angle};
}

void CubeIntegrator::add_piece(int face, const Arc& arc, double a, double b, Cell cell, int reference,
                               Flux& sum) const {
    const double half = 0.5 * (b - a), middle = 0.5 * (a + b), size = 2 * half * arc.radius();
    if (size > 0.1) {
        add_piece(face, arc, a, middle, cell, reference, sum);
        add_piece(face, arc, middle, b, cell, reference, sum);
        return;
    }
    const Plane plane = plane_of(face);
    const GaussRule& rule = size < 0.02 ? k_gauss3 : k_gauss5;
    for (int k = 0; k < rule.count; ++k) {
        const double at = middle + half * rule.node[k];
        const auto [p, d] = arc.place(at);
        const double depth = dot(p, plane.normal), s = dot(p, plane.right) / depth, t = dot(p, plane.down) / depth;
        const double dt = half * rule.weight[k] * (dot(d, plane.down) - t * dot(d, plane.normal)) / depth;
        const Flux f = along_row(face, s, cell, (t - centre(cell.row)) * 0.5 * size_, t, reference);
        sum.add(dt, f.light);
        sum.solid_angle += dt * f.solid_angle;
    }
}

void CubeIntegrator::add_arc(int face, const Arc& arc, int reference, Flux& sum) const {
    const Plane plane = plane_of(face);
    std::vector<double> cuts{arc.s0, arc.s1}, places;
    const auto cell_of = [&](double s, const Vec3d& axis) {
        const Vec3d p = arc.at(s);
        const double u = 0.5 * (dot(p, axis) / dot(p, plane.normal) + 1);
        return std::clamp(int(std::floor(u * size_ - 0.5)), -1, size_ - 1);
    };
    for (const Vec3d& axis : {plane.right, plane.down}) {
        places.assign({arc.s0, arc.s1});
        turning_points(arc, axis, plane.normal, places);
        int first = size_, last = -1;
        for (double s : places) {
            first = std::min(first, cell_of(s, axis));
            last = std::max(last, cell_of(s, axis));
        }
        for (int i = std::max(first, 0); i <= std::min(last + 1, size_ - 1); ++i)
            cross_plane(arc, axis - plane.normal * centre(i), 0, cuts);
    }
    sort_items(cuts);
    for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
        const double middle = 0.5 * (cuts[k] + cuts[k + 1]);
        const Cell cell{cell_of(middle, plane.right), cell_of(middle, plane.down)};
        if (cuts[k + 1] > cuts[k]) add_piece(face, arc, cuts[k], cuts[k + 1], cell, reference, sum);
    }
}

void CubeIntegrator::add_face(int face, std::span<const Arc> part, Flux& sum) const {
    const Plane plane = plane_of(face);
    const Vec3d start = part[0].at(part[0].s0);
    const double u = 0.5 * (dot(start, plane.right) / dot(start, plane.normal) + 1);
    const int reference = std::clamp(int(std::floor(u * size_ - 0.5)), -1, size_ - 1);
    for (const Arc& arc : part) add_arc(face, arc, reference, sum);
}

Vec3d CubeIntegrator::integrate(std::span<const Arc> border) const {
    Flux sum;
    if (const int face = face_around(border); face >= 0) {
        add_face(face, border, sum);
        return sum.solid_angle < 0 ? -sum.light : sum.light;
    }
    for (int f = 0; f < 6; ++f) {
        const Plane plane = plane_of(f);
        std::vector<Arc> part(border.begin(), border.end());
        for (const Vec3d& side : {plane.right, -plane.right, plane.down, -plane.down})
            part = clip(part, plane.normal + side);
        if (!part.empty()) add_face(f, part, sum);
    }
    return sum.solid_angle < 0 ? -sum.light : sum.light;
}

namespace {

/// Whether the matrix only permutes and mirrors the axes (up to rounding).
bool permutes_axes(const Mat3& m) {
    for (const Vec3d& r : m.row)
        for (double e : {r.x, r.y, r.z})
            if (std::abs(e - std::round(e)) > 1e-12) return false;
    return true;
}

/// The same texels in other places: the cube in axes that `world_to_source`, which permutes and mirrors, exchanges.
Cubemap turned_cube(const Cubemap& source, const Mat3& world_to_source, int threads) {
    assert(source.channels() == 3);
    const int size = source.size();
    Cubemap out(size);
    parallel_for(6 * size, threads, [&](int row) {
        for (int x = 0; x < size; ++x) {
            const CubePoint p =
                cube_point(world_to_source * cube_direction(row / size, {(x + 0.5) / size, (row % size + 0.5) / size}));
            const float* from = source.face(p.face).at(int(p.uv.u * size), int(p.uv.v * size));
            std::copy(from, from + 3, out.strip().at(x, row));
        }
    });
    return out;
}

void store(float* to, const Vec3d& g, std::pair<double, double> range) {
    to[0] = float(std::clamp(g.x, range.first, range.second));
    to[1] = float(std::clamp(g.y, range.first, range.second));
    to[2] = float(std::clamp(g.z, range.first, range.second));
}

/// Averages lie between the least and the greatest texel; rounding must not move them outside (below zero, for
/// example).
std::pair<double, double> range_of(const Cubemap& source) {
    const auto [least, greatest] = std::minmax_element(source.pixels().begin(), source.pixels().end());
    return {*least, *greatest};
}

}  // namespace

Cubemap plain_cube_to_cube(const Cubemap& source, int size, const Mat3& world_to_source, int threads) {
    assert(source.channels() == 3);
    Cubemap out(size);
    const CubeIntegrator integrator(source);
    const auto range = range_of(source);
    parallel_for(6 * size, threads, [&](int row) {
        for (int x = 0; x < size; ++x) {
            const Vec3d flux =
                integrator.integrate(cube_texel_border(row / size, x, row % size, size, world_to_source));
            store(out.strip().at(x, row), flux / cube_solid_angle(x, row % size, size), range);
        }
    });
    return out;
}

ImageF plain_cube_to_latlong(const Cubemap& source, int out_height, const Mat3& world_to_source, int threads) {
    assert(source.channels() == 3);
    const int width = 2 * out_height;
    ImageF out(width, out_height, 3);
    const CubeIntegrator integrator(source);
    const auto range = range_of(source);
    // Texels wider than an eighth of a turn are divided, because a border must be small compared with a half sphere.
    const int across = (8 + width - 1) / width, down = (4 + out_height - 1) / out_height;
    parallel_for(out_height, threads, [&](int y) {
        for (int x = 0; x < width; ++x) {
            Vec3d flux;
            for (int j = 0; j < down; ++j)
                for (int i = 0; i < across; ++i) {
                    const double u0 = (x + double(i) / across) / width, u1 = (x + double(i + 1) / across) / width;
                    const double v0 = (y + double(j) / down) / out_height, v1 = (y + double(j + 1) / down) / out_height;
                    flux += integrator.integrate(latlong_border(u0, u1, v0, v1, world_to_source));
                }
            store(out.at(x, y), flux / latlong_solid_angle(y, width, out_height), range);
        }
    });
    return out;
}

}  // namespace domelight::area

namespace domelight {

Cubemap area_resample_cube(const Cubemap& source, int size, const Mat3& world_to_source, int threads) {
    if (!area::permutes_axes(world_to_source)) return area::plain_cube_to_cube(source, size, world_to_source, threads);
    // At the same size averaging the reconstruction would blur the texels for no gain.
    Cubemap turned = area::turned_cube(source, world_to_source, threads);
    return size == source.size() ? std::move(turned) : area::resize_cube(turned, size, threads);
}

ImageF area_resample_cube_to_latlong(const Cubemap& source, int out_height, const Mat3& world_to_source, int threads) {
    if (const auto aligned = area::align(world_to_source.transposed()))
        return area::aligned_cube_to_latlong(source, out_height, *aligned, threads);
    return area::plain_cube_to_latlong(source, out_height, world_to_source, threads);
}

}  // namespace domelight
