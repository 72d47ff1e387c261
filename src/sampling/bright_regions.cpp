#include "sampling/bright_regions.h"

#include "base/sort.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <unordered_set>

namespace domelight {
namespace {

using Texels = std::vector<std::int64_t>;

/// A cap: the texels whose centres lie within `radius` (radians) of an axis.
struct Cap {
    Vec3d axis;
    double cosine;
    Cap(const Vec3d& a, double radius) : axis(a), cosine(std::cos(std::min(radius, k_pi)) - 1e-12) {}
    bool holds(const Vec3d& d) const { return dot(axis, d) >= cosine; }
};

/// Finds sources in two steps.
///
// clang-format off
/// 1. Cores. From the brightest texel down, each one not yet visited is a peak. The texels connected to it that are
///    brighter than peak / contrast are a core if they stay within the largest diameter and contain no brighter peak.
///    Otherwise none of them can belong to a core: any peak among them is lower, so its own set contains this one and
///    fails too. Each texel is thus visited once.
/// 2. Growth. Cores that are close become one source. Its level is then lowered in steps, and the texels connected to
///    it above the level are its region, until that becomes too wide, touches another source or comes near the
///    luminance of the surroundings.
// clang-format on
class Finder {
  public:
    Finder(const TexelSphere& sphere, std::span<const float> luminance, const LightExtractionOptions& options)
        : sphere_(sphere), luminance_(luminance), options_(options), owner_(luminance.size(), k_free) {
        const double texel = std::max(k_pi / sphere.height(), 2 * k_pi / sphere.width());
        diameter_ = std::max(options.largest_diameter_deg * k_pi / 180, 3 * texel);
        margin_ = 0.5 * texel;
    }

    BrightRegions find(double least_peak) {
        find_cores(least_peak);
        BrightRegions found;
        found.sources = int(cores_.size());
        group_cores();
        for (std::size_t g = 0; g < groups_.size(); ++g) found.regions.push_back(grow(int(g)));
        std::stable_sort(found.regions.begin(), found.regions.end(),
                         [](const auto& a, const auto& b) { return a.power > b.power; });
        return found;
    }

  private:
    static constexpr int k_free = -1, k_done = -2;  // other owners: the number of a core, later of a group
    /// More sources than this are not followed: the strongest are.
    static constexpr std::size_t k_most_groups = 2048;

    struct Core {
        Texels texels;
        Vec3d sum;  ///< of directions times power
        double power = 0, peak = 0;
    };
    struct Group {
        std::vector<int> cores;
        Vec3d axis;
        double power = 0, peak = 0;
        Texels texels;
    };

    void find_cores(double least_peak) {
        Texels peaks;
        for (std::int64_t i = 0; i < sphere_.size(); ++i)
            if (luminance_[i] > least_peak) peaks.push_back(i);
        sort_items(peaks, [&](std::int64_t a, std::int64_t b) {
            return luminance_[a] != luminance_[b] ? luminance_[a] > luminance_[b] : a < b;
        });
        for (const std::int64_t peak : peaks)
            if (owner_[peak] == k_free) try_peak(peak);
    }

    void try_peak(std::int64_t peak) {
        const float level = float(luminance_[peak] / options_.least_contrast);
        const Cap cap(sphere_.direction(peak), diameter_);
        Core core;
        core.peak = luminance_[peak];
        core.texels.push_back(peak);
        const int number = int(cores_.size());
        owner_[peak] = number;
        bool fine = true;
        for (std::size_t i = 0; i < core.texels.size() && fine; ++i) {
            const std::int64_t t = core.texels[i];
            const double power = luminance_[t] * sphere_.solid_angle(t);
            core.power += power;
            core.sum += sphere_.direction(t) * power;
            sphere_.for_each_neighbour(t, [&](std::int64_t next) {
                if (owner_[next] == number || !(luminance_[next] > level)) return;
                if (owner_[next] != k_free || !cap.holds(sphere_.direction(next))) {
                    fine = false;
                    return;
                }
                owner_[next] = number;
                core.texels.push_back(next);
            });
        }
        fine = fine && length(core.sum) > 0 && fits(core.texels, normalize(core.sum));
        if (fine)
            cores_.push_back(std::move(core));
        else
            for (const std::int64_t t : core.texels) owner_[t] = k_done;
    }

    bool fits(const Texels& texels, const Vec3d& axis) const {
        const Cap cap(axis, 0.5 * diameter_ + margin_);
        return std::all_of(texels.begin(), texels.end(),
                           [&](std::int64_t t) { return cap.holds(sphere_.direction(t)); });
    }

    /// The strongest core first: each joins the first group close by, or starts a new one.
    void group_cores() {
        std::vector<int> order(cores_.size());
        for (std::size_t i = 0; i < order.size(); ++i) order[i] = int(i);
        sort_stably(order, [&](int a, int b) { return cores_[a].power > cores_[b].power; });
        const double close = std::cos(options_.merge_deg * k_pi / 180) - 1e-12;
        for (const int c : order) {
            const Core& core = cores_[c];
            const Vec3d d = normalize(core.sum);
            auto group = std::find_if(groups_.begin(), groups_.end(), [&](const Group& g) {
                return dot(g.axis, d) >= close && fits(core.texels, g.axis);
            });
            if (group == groups_.end()) {
                if (groups_.size() == k_most_groups) continue;
                group = groups_.insert(groups_.end(), Group{});
                group->axis = d;
            }
            group->cores.push_back(c);
            group->peak = std::max(group->peak, core.peak);
            group->texels.insert(group->texels.end(), core.texels.begin(), core.texels.end());
        }
        std::fill(owner_.begin(), owner_.end(), k_free);
        for (std::size_t g = 0; g < groups_.size(); ++g)
            for (const std::int64_t t : groups_[g].texels) owner_[t] = int(g);
    }

    /// The luminance of the surroundings: on rings at one and a half to two and a half times `reach` (radians).
    struct Surroundings {
        double median = 0, mean = 0;
    };
    Surroundings surroundings(const Vec3d& axis, double reach) const {
        constexpr int rings = 9, points = 128;
        const Vec3d side = normalize(cross(axis, std::abs(axis.y) < 0.9 ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0}));
        const Vec3d other = cross(axis, side);
        std::vector<float> values;
        double sum = 0, weight = 0;
        for (int ring = 0; ring < rings; ++ring)
            for (int i = 0; i < points; ++i) {
                const double away = reach * (1.5 + ring / (rings - 1.0)),
                             phi = 2 * k_pi * (i + 0.5 * (ring & 1)) / points;
                const Vec3d across = side * std::cos(phi) + other * std::sin(phi);
                values.push_back(luminance_[sphere_.at(axis * std::cos(away) + across * std::sin(away))]);
                sum += values.back() * std::sin(away);
                weight += std::sin(away);
            }
        std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
        return {values[values.size() / 2], sum / weight};
    }

    /// The texels brighter than `level` that are connected to those of a group; none if they extend too far or touch
    /// another source.
    std::optional<Texels> flood(int number, float level, double reach) const {
        const Group& group = groups_[number];
        const Cap cap(group.axis, reach + margin_);
        Texels texels = group.texels;
        std::unordered_set<std::int64_t> seen(texels.begin(), texels.end());
        bool fine = true;
        for (std::size_t i = 0; i < texels.size() && fine; ++i)
            sphere_.for_each_neighbour(texels[i], [&](std::int64_t next) {
                if (!(luminance_[next] > level) || !seen.insert(next).second) return;
                const bool foreign = owner_[next] != k_free && owner_[next] != number;
                if (foreign || !cap.holds(sphere_.direction(next))) fine = false;
                texels.push_back(next);
            });
        if (!fine) return std::nullopt;
        return texels;
    }

    double mean_luminance(const Texels& texels) const {
        double sum = 0, weight = 0;
        for (const std::int64_t t : texels) {
            sum += luminance_[t] * sphere_.solid_angle(t);
            weight += sphere_.solid_angle(t);
        }
        return sum / weight;
    }

    BrightRegion grow(int number) {
        Group& group = groups_[number];
        // A source's skirt (halo, blur) may extend as far beyond its core as the core is wide, and to the largest
        // diameter in any case.
        double core = 1;
        for (const std::int64_t t : group.texels) core = std::min(core, dot(group.axis, sphere_.direction(t)));
        const double reach = std::max(0.5 * diameter_, 2 * std::acos(std::max(core, -1.0)));
        const Surroundings around = surroundings(group.axis, reach);
        const double floor = std::max(1.5 * around.median, 1e-6 * group.peak);
        const double core_mean = mean_luminance(group.texels);
        double level = group.peak / options_.least_contrast, reached = level;
        for (; level >= floor; level *= std::sqrt(0.5)) {
            auto wider = flood(number, float(level), reach);
            if (!wider) break;
            group.texels = std::move(*wider);
            reached = level;
        }
        dilate(group.texels, number, 0.1 * around.median);
        for (const std::int64_t t : group.texels) owner_[t] = number;
        BrightRegion region;
        region.peak = group.peak;
        region.rim = reached;
        // The luminance of one pane of a skylight drops at its dark frame, but the pane is no brighter than the panes
        // around it.
        region.stands_out = core_mean >= options_.least_contrast * around.mean;
        for (const std::int64_t t : group.texels)
            region.power += std::max(0.0, luminance_[t] - reached) * sphere_.solid_angle(t);
        region.texels = group.texels;
        sort_items(region.texels);
        return region;
    }

    /// One texel more on each side: the skirt of a source that ends between texels. Beyond it up to two more that are
    /// far darker than the surroundings: lossy encodings leave a ring of negative values around a bright source, which
    /// reading sets to 0.
    void dilate(Texels& texels, int number, double dark) const {
        std::unordered_set<std::int64_t> seen(texels.begin(), texels.end());
        std::size_t first = 0;
        for (int step = 0; step < 3; ++step) {
            const std::size_t last = texels.size();
            for (std::size_t i = first; i < last; ++i)
                sphere_.for_each_neighbour(texels[i], [&](std::int64_t next) {
                    if (owner_[next] != k_free && owner_[next] != number) return;
                    if (step > 0 && luminance_[next] >= dark) return;
                    if (seen.insert(next).second) texels.push_back(next);
                });
            if (step > 0) first = last;
        }
    }

    const TexelSphere& sphere_;
    std::span<const float> luminance_;
    const LightExtractionOptions& options_;
    double diameter_, margin_;
    std::vector<int> owner_;
    std::vector<Core> cores_;
    std::vector<Group> groups_;
};

}  // namespace

BrightRegions find_bright_regions(const TexelSphere& sphere, std::span<const float> luminance, double mean,
                                  const LightExtractionOptions& options) {
    // A light with the share s of all luminance, 4 pi mean, within a cap of the largest diameter is brighter there on
    // average, and so at its peak, than s 4 pi mean over the cap's solid angle 2 pi (1 - cos(D / 2)) = 4 pi sin^2(D /
    // 4).
    const double quarter = std::sin(options.largest_diameter_deg * k_pi / 720);
    const double least_peak = std::max(options.least_share * mean / (quarter * quarter), mean);
    return Finder(sphere, luminance, options).find(least_peak);
}

}  // namespace domelight
