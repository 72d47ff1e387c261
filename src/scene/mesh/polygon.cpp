#include "scene/mesh/polygon.h"

#include <cmath>

namespace domelight {

namespace {

constexpr std::size_t k_most_corners = 64;  // ear clipping takes time in proportion to its cube

struct Point {
    double x, y;
};

/// Twice the area of a triangle, positive if it turns to the left.
double turn(const Point& a, const Point& b, const Point& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// The polygon's corners in its plane, turning to the left: seen along the largest component of its normal (Newell's
/// sum of cross products).
std::vector<Point> flattened(std::span<const std::uint32_t> corners, std::span<const Vec3f> positions) {
    const Vec3d origin(positions[corners[0]]);
    Vec3d normal;
    for (std::size_t i = 1; i + 1 < corners.size(); ++i)
        normal += cross(Vec3d(positions[corners[i]]) - origin, Vec3d(positions[corners[i + 1]]) - origin);
    const double x = std::abs(normal.x), y = std::abs(normal.y), z = std::abs(normal.z);
    std::vector<Point> points;
    for (const std::uint32_t corner : corners) {
        const Vec3d p(positions[corner]);
        const double sign_of = x >= y && x >= z ? normal.x : y >= z ? normal.y : normal.z;
        Point q = x >= y && x >= z ? Point{p.y, p.z} : y >= z ? Point{p.z, p.x} : Point{p.x, p.y};
        if (sign_of < 0) q.x = -q.x;
        points.push_back(q);
    }
    return points;
}

bool is_ear(const std::vector<Point>& points, const std::vector<std::size_t>& left, std::size_t at) {
    const std::size_t n = left.size();
    const Point &a = points[left[(at + n - 1) % n]], &b = points[left[at]], &c = points[left[(at + 1) % n]];
    if (!(turn(a, b, c) > 0)) return false;
    for (std::size_t k = 0; k < n; ++k) {
        if (k == at || k == (at + 1) % n || k == (at + n - 1) % n) continue;
        const Point& p = points[left[k]];
        if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return false;
    }
    return true;
}

}  // namespace

void triangulate(std::span<const std::uint32_t> corners, std::span<const Vec3f> positions,
                 std::vector<std::uint32_t>& out) {
    const auto fan = [&] {
        for (std::size_t i = 1; i + 1 < corners.size(); ++i)
            out.insert(out.end(), {corners[0], corners[i], corners[i + 1]});
    };
    if (corners.size() <= 3 || corners.size() > k_most_corners) return fan();
    const std::vector<Point> points = flattened(corners, positions);
    bool convex = true;
    for (std::size_t i = 0, n = points.size(); i < n; ++i)
        convex &= turn(points[i], points[(i + 1) % n], points[(i + 2) % n]) >= 0;
    if (convex) return fan();
    std::vector<std::size_t> left(corners.size());
    for (std::size_t i = 0; i < left.size(); ++i) left[i] = i;
    while (left.size() >= 3) {
        std::size_t ear = 0;
        while (ear < left.size() && !is_ear(points, left, ear)) ++ear;
        if (ear == left.size()) ear = 1;  // the polygon crosses itself, so any cut is as good
        const std::size_t n = left.size();
        out.insert(out.end(), {corners[left[(ear + n - 1) % n]], corners[left[ear % n]], corners[left[(ear + 1) % n]]});
        left.erase(left.begin() + std::ptrdiff_t(ear % n));
    }
}

}  // namespace domelight
