#include "domelight/probe/probe_blend.h"

#include "probe/distance_lookup.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace domelight {
namespace {

/// The nearest probes begin to fill a blend whose weights sum to less than this.
constexpr float k_enough = 0.02f;
/// How many nearest probes fill it.
constexpr std::size_t k_nearest = 8;

Vec3f clamped(const ProbeBox& box, const Vec3f& p) {
    const auto within = [](float v, float low, float high) { return std::min(std::max(v, low), high); };
    return {within(p.x, box.low.x, box.high.x), within(p.y, box.low.y, box.high.y), within(p.z, box.low.z, box.high.z)};
}

/// 1 well inside of the influence, falling to 0 at its boundary.
float influence_at(const Probe& probe, const Vec3f& point) {
    const ProbeInfluence& i = probe.influence;
    float inside = 0;  // metres from the boundary
    switch (i.shape) {
        case ProbeInfluence::Shape::everywhere:
            return 1;
        case ProbeInfluence::Shape::box: {
            const Vec3f low = point - i.box.low, high = i.box.high - point;
            inside = std::min({low.x, low.y, low.z, high.x, high.y, high.z});
            break;
        }
        case ProbeInfluence::Shape::sphere:
            inside = i.radius - length(point - probe.position);
            break;
    }
    if (inside <= 0) return 0;
    return inside >= i.fade ? 1 : inside / i.fade;
}

}  // namespace

Vec3f parallax_direction(const ProbeBox& proxy, const Vec3f& probe, const Vec3f& point, const Vec3f& direction) {
    const Vec3f start = clamped(proxy, point);
    float t = std::numeric_limits<float>::infinity();
    const auto leave = [&](float from, float along, float low, float high) {
        if (along != 0) t = std::min(t, ((along > 0 ? high : low) - from) / along);
    };
    leave(start.x, direction.x, proxy.low.x, proxy.high.x);
    leave(start.y, direction.y, proxy.low.y, proxy.high.y);
    leave(start.z, direction.z, proxy.low.z, proxy.high.z);
    const Vec3f seen = start + direction * t - probe;
    return dot(seen, seen) > 0 ? seen : direction;
}

float chebyshev_visibility(const DistanceMoments& moments, float distance) {
    const float behind = distance - moments.mean;
    if (!(behind > 0)) return 1;
    // Rounding leaves a variance of the order of 1e-6 of the square; a quarter of a percent of the distance is wider.
    const float narrowest = 0.0025f * moments.mean;
    const float variance = std::max(moments.mean_square - moments.mean * moments.mean, narrowest * narrowest);
    const float bound = variance / (variance + behind * behind);
    constexpr float least = 0.1f;
    const float v = std::max(0.f, (bound - least) / (1 - least));
    return v * v * v;
}

/// Weights of probes, in the order in which they were first added.
struct ProbeBlender::Weighted {
    std::array<ProbeBlend::Part, 2 * k_nearest> parts;
    int count = 0;
    float sum = 0;

    void add(int probe, float weight) {
        if (!(weight > 0)) return;
        sum += weight;
        for (int i = 0; i < count; ++i)
            if (parts[std::size_t(i)].probe == probe) {
                parts[std::size_t(i)].weight += weight;
                return;
            }
        parts[std::size_t(count++)] = {probe, weight};
    }

    /// Leaves only the `most` largest weights, each less the largest of the others.
    void keep(int most) {
        if (count <= most) return;
        std::ranges::stable_sort(parts.begin(), parts.begin() + count, std::greater<>(), &ProbeBlend::Part::weight);
        const float next = parts[std::size_t(most)].weight;
        int kept = 0;
        for (int i = 0; i < most; ++i)
            if (parts[std::size_t(i)].weight > next) parts[std::size_t(kept++)].weight -= next;
        // Several weights are the same: the first of them.
        count = std::max(kept, 1);
    }

    ProbeBlend normalised() const {
        ProbeBlend blend;
        blend.count = count;
        float total = 0;
        for (int i = 0; i < count; ++i) total += parts[std::size_t(i)].weight;
        for (int i = 0; i < count; ++i)
            blend.parts[std::size_t(i)] = {parts[std::size_t(i)].probe, parts[std::size_t(i)].weight / total};
        return blend;
    }
};

ProbeBlender::ProbeBlender(const ProbeSet& set, const BlendOptions& options) : set_(&set), options_(options) {
    options_.most = std::clamp(options_.most, 1, 8);
    for (int i = 0; i < int(set.probes().size()); ++i)
        if (set.probes()[std::size_t(i)].valid || !options_.visibility) usable_.push_back(i);
    if (usable_.empty())  // better the light that invalid probes were given than none
        for (int i = 0; i < int(set.probes().size()); ++i) usable_.push_back(i);
    if (set.grid()) {
        offset_ = set.grid()->spacing * options_.normal_offset;
        return;
    }
    // An invalid probe would leave a hole between the other corners of its tetrahedra, so it is no corner at all.
    std::vector<Vec3f> positions;
    for (const int i : usable_) positions.push_back(set.probes()[std::size_t(i)].position);
    tetrahedra_.emplace(positions);
}

float ProbeBlender::importance(int number, const Vec3f& point, const Vec3f& normal) const {
    const Probe& probe = set_->probes()[std::size_t(number)];
    float weight = influence_at(probe, point);
    if (!options_.visibility || !(weight > 0)) return weight;
    if (!probe.valid) return 0;
    const Vec3f to_probe = probe.position - point;
    const float distance = length(to_probe);
    if (distance > 0) {
        const float half = (1 + dot(to_probe, normal) / distance) / 2;
        weight *= half * half + 0.02f;
    }
    if (set_->distance_size() == 0 || !(distance > 0)) return weight;
    const float tolerance = distance_tolerance(set_->distance_size());
    return weight * chebyshev_visibility(set_->distance(number, -to_probe), distance * (1 - tolerance));
}

struct ProbeBlender::Nearest {
    struct Near {
        int probe;
        float distance;
    };
    std::array<Near, k_nearest + 1> probes;  ///< the nearest first
    std::size_t count = 0;
};

ProbeBlender::Nearest ProbeBlender::nearest(const Vec3f& point) const {
    Nearest found;
    const auto nearer = [](const Nearest::Near& a, const Nearest::Near& b) { return a.distance < b.distance; };
    for (const int probe : usable_) {
        const Vec3f d = set_->probes()[std::size_t(probe)].position - point;
        const Nearest::Near near{probe, dot(d, d)};
        const auto end = found.probes.begin() + std::ptrdiff_t(found.count);
        if (found.count == found.probes.size() && !nearer(near, found.probes.back())) continue;
        const auto place = std::upper_bound(found.probes.begin(), end, near, nearer);
        if (found.count < found.probes.size()) ++found.count;
        std::move_backward(place, found.probes.begin() + std::ptrdiff_t(found.count) - 1,
                           found.probes.begin() + std::ptrdiff_t(found.count));
        *place = near;
    }
    for (std::size_t i = 0; i < found.count; ++i) found.probes[i].distance = std::sqrt(found.probes[i].distance);
    return found;
}

void ProbeBlender::add_grid_cell(Weighted& sum, const Vec3f& point, const Vec3f& normal) const {
    const GridCell cell = cell_at(*set_->grid(), point);
    for (std::size_t i = 0; i < 8; ++i)
        if (cell.weight[i] > 0) sum.add(cell.place[i], cell.weight[i] * importance(cell.place[i], point, normal));
}

void ProbeBlender::add_tetrahedron(Weighted& sum, const Nearest& near, const Vec3f& point, const Vec3f& normal) const {
    // Tetrahedra at the hull can be long. Probes at more than twice the distance of the second nearest are too far.
    const float radius = near.count > 2 ? 2 * near.probes[1].distance + 1e-6f : 0;
    const Tetrahedra::Weights cell = tetrahedra_->at(point);
    for (std::size_t i = 0; i < 4; ++i) {
        if (!(cell.weight[i] > 0)) continue;
        const int probe = usable_[std::size_t(cell.point[i])];
        float closeness = 1;
        if (radius > 0) {
            const float part = length(set_->probes()[std::size_t(probe)].position - point) / radius;
            closeness = part < 1 ? (1 - part * part) * (1 - part * part) : 0;
        }
        if (closeness > 0) sum.add(probe, cell.weight[i] * closeness * importance(probe, point, normal));
    }
}

void ProbeBlender::add_nearest(Weighted& sum, const Nearest& near, const Vec3f& point, const Vec3f& normal) const {
    // A probe's weight falls to 0 where it stops to be one of the nearest: at the distance of the first one left out.
    const float last = near.probes[near.count - 1].distance,
                radius = near.count > k_nearest ? last * 1.0001f + 1e-6f : 2 * last + 1e-6f;
    std::array<float, k_nearest> weight{};
    float total = 0;
    const std::size_t count = std::min(near.count, k_nearest);
    for (std::size_t i = 0; i < count; ++i) {
        const float part = 1 - near.probes[i].distance / radius;
        // If no probe sees the point, the nearest ones count.
        weight[i] = part * part * (importance(near.probes[i].probe, point, normal) + 1e-5f);
        total += weight[i];
    }
    const float missing = k_enough - sum.sum;
    for (std::size_t i = 0; i < count; ++i) sum.add(near.probes[i].probe, missing * weight[i] / total);
}

ProbeBlend ProbeBlender::at(const Vec3f& surface, const Vec3f& normal) const {
    const Vec3f point = surface + product(normal, offset_);
    Weighted sum;
    std::optional<Nearest> near;
    if (tetrahedra_) {
        near = nearest(point);
        add_tetrahedron(sum, *near, point, normal);
    } else {
        add_grid_cell(sum, point, normal);
    }
    if (sum.sum < k_enough) add_nearest(sum, near ? *near : nearest(point), point, normal);
    sum.keep(options_.most);
    return sum.normalised();
}

Vec3f ProbeBlender::radiance(const ProbeBlend& blend, const Vec3f& point, const Vec3f& direction,
                             float roughness) const {
    Vec3f sum;
    for (const auto& [number, weight] : blend.all()) {
        const Probe& probe = set_->probes()[std::size_t(number)];
        const Vec3f d = options_.parallax && probe.proxy
                            ? parallax_direction(*probe.proxy, probe.position, point, direction)
                            : direction;
        sum += set_->radiance(number, d, roughness) * weight;
    }
    return sum;
}

Vec3f ProbeBlender::irradiance_over_pi(const ProbeBlend& blend, const Vec3f& normal) const {
    Vec3f sum;
    for (const auto& [probe, weight] : blend.all()) sum += set_->irradiance_over_pi(probe, normal) * weight;
    return sum;
}

Vec3f ProbeBlender::irradiance_over_pi_sh(const ProbeBlend& blend, const Vec3f& normal) const {
    Vec3f sum;
    for (const auto& [probe, weight] : blend.all()) sum += set_->irradiance_over_pi_sh(probe, normal) * weight;
    return sum;
}

}  // namespace domelight
