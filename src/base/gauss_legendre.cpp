#include "base/gauss_legendre.h"

#include "domelight/base/vec.h"

#include "base/mutex.h"

#include <array>
#include <cassert>
#include <cmath>
#include <map>
#include <memory>

namespace domelight {
namespace {

constexpr int k_block = 16;  ///< the number of nodes for which the recurrence is evaluated together

/// P_n and P_{n-1} at several cosines: (k + 1) P_{k+1} = (2k + 1) x P_k - k P_{k-1}.
void legendre_pair(int n, const std::array<double, k_block>& x, std::array<double, k_block>& p,
                   std::array<double, k_block>& previous) {
    previous.fill(0);
    p.fill(1);
    for (int k = 0; k < n; ++k) {
        const double a = (2 * k + 1.0) / (k + 1), b = double(k) / (k + 1);
        for (int i = 0; i < k_block; ++i) {
            const double next = a * x[i] * p[i] - b * previous[i];
            previous[i] = p[i];
            p[i] = next;
        }
    }
}

GaussLegendre compute(int n) {
    GaussLegendre rule;
    rule.x.assign(n, 0);
    rule.w.assign(n, 0);
    const int half = (n + 1) / 2;
    for (int begin = 0; begin < half; begin += k_block) {
        // In the angle: x = cos t, P' by t is n (P_{n-1} - x P_n) / sin t times -sin t. Tricomi's start is good to
        // O(n^-4).
        std::array<double, k_block> t{}, x{}, p{}, previous{};
        for (int i = 0; i < k_block; ++i) {
            const double angle = k_pi * (std::min(begin + i, half - 1) + 0.75) / (n + 0.5);
            t[i] = std::acos(std::min(1.0, (1 - (n - 1.0) / (8.0 * n * n * n)) * std::cos(angle)));
        }
        for (int iteration = 0; iteration < (n < 32 ? 6 : 3); ++iteration) {
            for (int i = 0; i < k_block; ++i) x[i] = std::cos(t[i]);
            legendre_pair(n, x, p, previous);
            for (int i = 0; i < k_block; ++i) {
                const double s = std::sin(t[i]);
                t[i] += p[i] * s / (n * (previous[i] - x[i] * p[i]));
            }
        }
        for (int i = 0; i < k_block; ++i) x[i] = std::cos(t[i]);
        legendre_pair(n, x, p, previous);
        for (int i = 0; i < k_block && begin + i < half; ++i) {
            const int j = begin + i;
            const double s = std::sin(t[i]), slope = n * (previous[i] - x[i] * p[i]) / s;  // -dP/dt
            const double weight = 2 / (slope * slope);
            const bool middle = 2 * j + 1 == n;
            rule.x[n - 1 - j] = middle ? 0 : x[i];
            rule.x[j] = middle ? 0 : -x[i];
            rule.w[j] = rule.w[n - 1 - j] = weight;
        }
    }
    return rule;
}

}  // namespace

const GaussLegendre& gauss_legendre(int n) {
    assert(n >= 1);
    static Mutex mutex;
    static std::map<int, std::unique_ptr<GaussLegendre>> cache;
    const Lock lock(mutex);
    auto& rule = cache[n];
    if (!rule) rule = std::make_unique<GaussLegendre>(compute(n));
    return *rule;
}

}  // namespace domelight
