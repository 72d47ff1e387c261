#include "sampling/harmonic_fill.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>
#include <vector>

namespace domelight {
namespace {

/// A texel's link to one of its four neighbours: flux per difference, the length of their common edge over the distance
/// of their centres.
struct Link {
    std::int64_t texel;
    double weight;
};

/// Both horizontal neighbours, then those above and below if they exist: no edge is shared across a pole.
int links(const TexelSphere& sphere, std::int64_t texel, std::array<Link, 4>& out) {
    const int w = sphere.width(), h = sphere.height(), x = sphere.column(texel), y = sphere.row(texel);
    const double column = 2 * k_pi / w, row = k_pi / h, beside = row / (sphere.sine(y) * column);
    const std::int64_t start = std::int64_t(y) * w;
    int n = 0;
    out[n++] = {start + (x + 1) % w, beside};
    out[n++] = {start + (x + w - 1) % w, beside};
    if (y > 0) out[n++] = {texel - w, std::sin(y * row) * column / row};
    if (y + 1 < h) out[n++] = {texel + w, std::sin((y + 1) * row) * column / row};
    return n;
}

/// One connected part of the region as a sparse symmetric system: (sum of weights) u_i - sum over inner neighbours w
/// u_j = sum over the rim w f.
struct Laplace {
    std::vector<std::int64_t> texels;
    std::vector<std::array<int, 4>> inner;  ///< unknowns' numbers, -1 for none
    std::vector<std::array<double, 4>> weight;
    std::vector<double> diagonal;
    std::vector<std::array<double, 3>> rim_sum;
    std::array<double, 3> least, largest;  ///< on the rim
    bool has_rim = false;

    void apply(const std::vector<double>& u, std::vector<double>& out) const {
        for (std::size_t i = 0; i < texels.size(); ++i) {
            double sum = diagonal[i] * u[i];
            for (int k = 0; k < 4; ++k)
                if (inner[i][k] >= 0) sum -= weight[i][k] * u[inner[i][k]];
            out[i] = sum;
        }
    }
};

using Numbers = std::unordered_map<std::int64_t, int>;

Laplace assemble(const TexelSphere& sphere, std::vector<std::int64_t> texels, const Numbers& numbers,
                 ImageView<const float> image) {
    Laplace system;
    const std::size_t n = texels.size();
    system.inner.assign(n, {-1, -1, -1, -1});
    system.weight.assign(n, {});
    system.diagonal.assign(n, 0);
    system.rim_sum.assign(n, {});
    system.least.fill(INFINITY);
    system.largest.fill(0);
    for (std::size_t i = 0; i < n; ++i) {
        std::array<Link, 4> around;
        const int count = links(sphere, texels[i], around);
        for (int k = 0; k < count; ++k) {
            system.diagonal[i] += around[k].weight;
            if (const auto found = numbers.find(around[k].texel); found != numbers.end()) {
                system.inner[i][k] = found->second;
                system.weight[i][k] = around[k].weight;
                continue;
            }
            const float* p = image.at(sphere.column(around[k].texel), sphere.row(around[k].texel));
            system.has_rim = true;
            for (int c = 0; c < 3; ++c) {
                system.rim_sum[i][c] += around[k].weight * p[c];
                system.least[c] = std::min(system.least[c], double(p[c]));
                system.largest[c] = std::max(system.largest[c], double(p[c]));
            }
        }
    }
    system.texels = std::move(texels);
    return system;
}

double dot(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
}

/// Conjugate gradients preconditioned by the diagonal (Shewchuk 1994, section B3), from the middle of the rim's range
/// to a millionth of the residual there: the remaining error is invisible, and the balance of power uses the result as
/// it is.
std::vector<double> solve(const Laplace& system, int channel) {
    const std::size_t n = system.texels.size();
    std::vector<double> u(n, 0.5 * (system.least[channel] + system.largest[channel])), r(n), z(n), p(n), q(n);
    system.apply(u, q);
    double goal = 0;
    for (std::size_t i = 0; i < n; ++i) {
        r[i] = system.rim_sum[i][channel] - q[i];
        z[i] = p[i] = r[i] / system.diagonal[i];
        goal += system.rim_sum[i][channel] * system.rim_sum[i][channel] / system.diagonal[i];
    }
    double rz = dot(r, z);
    goal = 1e-12 * rz + 1e-26 * goal;  // of the difference to the start, or of rounding if the start is the solution
    for (int step = 0; step < 4000 && rz > goal; ++step) {
        system.apply(p, q);
        const double pq = dot(p, q);
        if (!(pq > 0)) break;
        const double alpha = rz / pq;
        for (std::size_t i = 0; i < n; ++i) {
            u[i] += alpha * p[i];
            r[i] -= alpha * q[i];
            z[i] = r[i] / system.diagonal[i];
        }
        const double next = dot(r, z), beta = next / rz;
        for (std::size_t i = 0; i < n; ++i) p[i] = z[i] + beta * p[i];
        rz = next;
    }
    return u;
}

void fill_part(const TexelSphere& sphere, const Laplace& system, ImageView<float> image) {
    if (!system.has_rim) return;
    for (int c = 0; c < 3; ++c) {
        const std::vector<double> u = solve(system, c);
        for (std::size_t i = 0; i < u.size(); ++i)  // the solution lies within the rim's range, the iteration only
                                                    // nearly
            image.at(sphere.column(system.texels[i]), sphere.row(system.texels[i]))[c] =
                float(std::clamp(u[i], system.least[c], system.largest[c]));
    }
}

}  // namespace

void harmonic_fill(const TexelSphere& sphere, std::span<const std::int64_t> region, ImageView<float> image) {
    // Each part is solved by itself, so that a bright part does not determine the accuracy of a dim one.
    Numbers waiting;
    for (const std::int64_t texel : region) waiting.emplace(texel, 0);
    for (const std::int64_t start : region) {
        if (!waiting.contains(start)) continue;
        std::vector<std::int64_t> part{start};
        Numbers numbers{{start, 0}};
        waiting.erase(start);
        for (std::size_t i = 0; i < part.size(); ++i) {
            std::array<Link, 4> around;
            const int count = links(sphere, part[i], around);
            for (int k = 0; k < count; ++k)
                if (waiting.erase(around[k].texel)) {
                    numbers.emplace(around[k].texel, int(part.size()));
                    part.push_back(around[k].texel);
                }
        }
        fill_part(sphere, assemble(sphere, std::move(part), numbers, image), image);
    }
}

}  // namespace domelight
