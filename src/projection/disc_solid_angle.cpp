#include "projection/disc_solid_angle.h"

#include "base/gauss_legendre.h"

#include <vector>

namespace domelight {

namespace {

/// ∫ cap dφ along the segment from a to b inside the disc; dφ = (x dy - y dx) / r^2.
double along(DiscPoint a, DiscPoint b, const std::function<double(double)>& cap) {
    static const GaussLegendre &few = gauss_legendre(5), &many = gauss_legendre(24);
    const double dx = b.x - a.x, dy = b.y - a.y, turn = a.x * dy - a.y * dx;  // x dy - y dx is the same all along
    if (turn == 0) return 0;
    const auto integrand = [&](double s) {
        const double x = a.x + s * dx, y = a.y + s * dy, r2 = x * x + y * y;
        return r2 > 0 ? cap(std::min(1.0, std::sqrt(r2))) / r2 : 0.0;
    };
    double sum = 0;
    if (dx * dx + dy * dy < 0.01 && std::max(a.squared(), b.squared()) < 0.8) {
        for (std::size_t k = 0; k < few.x.size(); ++k) sum += few.w[k] * integrand(0.5 * (1 + few.x[k]));
        return 0.5 * sum * turn;
    }
    // At the rim cap may behave like a square root, so the nodes are denser at both ends: s = (1 + sin(pi x / 2)) / 2.
    for (std::size_t k = 0; k < many.x.size(); ++k) {
        const double t = 0.5 * k_pi * many.x[k];
        sum += many.w[k] * std::cos(t) * integrand(0.5 * (1 + std::sin(t)));
    }
    return 0.25 * k_pi * sum * turn;
}

}  // namespace

double disc_solid_angle(const UVBox& box, const std::function<double(double)>& cap) {
    const DiscPoint low = disc_point({box.u0, box.v1}), high = disc_point({box.u1, box.v0});
    const DiscPoint corner[4] = {low, {high.x, low.y}, high, {low.x, high.y}};  // counterclockwise
    // The parts of the border inside the disc, in order.
    std::vector<std::pair<DiscPoint, DiscPoint>> parts;
    for (int k = 0; k < 4; ++k) {
        const DiscPoint a = corner[k], b = corner[(k + 1) % 4];
        const double dx = b.x - a.x, dy = b.y - a.y, q = dx * dx + dy * dy;
        if (q == 0) return 0;
        // |a + s (b - a)| <= 1
        const double p = (a.x * dx + a.y * dy) / q, root = p * p - (a.squared() - 1) / q;
        if (root <= 0) continue;
        const double s0 = std::max(0.0, -p - std::sqrt(root)), s1 = std::min(1.0, -p + std::sqrt(root));
        if (s1 > s0) parts.push_back({{a.x + s0 * dx, a.y + s0 * dy}, {a.x + s1 * dx, a.y + s1 * dy}});
    }
    if (parts.empty()) {
        // Either outside the disc, or containing the whole disc.
        const bool around = low.x <= 0 && low.y <= 0 && high.x >= 0 && high.y >= 0 &&
                            std::min({-low.x, -low.y, high.x, high.y}) >= 1 - 1e-12;
        return around ? 2 * k_pi * cap(1) : 0;
    }
    double sum = 0;
    for (std::size_t k = 0; k < parts.size(); ++k) {
        const auto& [a, b] = parts[k];
        const DiscPoint next = parts[(k + 1) % parts.size()].first;
        sum += along(a, b, cap);
        // Between two parts the border follows the rim, where phi grows.
        double gap = std::atan2(b.x * next.y - b.y * next.x, b.x * next.x + b.y * next.y);
        if (gap < -1e-9) gap += 2 * k_pi;
        if (std::hypot(next.x - b.x, next.y - b.y) > 1e-14) sum += cap(1) * gap;
    }
    return sum;
}

}  // namespace domelight
