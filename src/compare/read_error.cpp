#include "domelight/compare/read_error.h"

#include "domelight/base/parallel.h"
#include "domelight/base/random.h"
#include "domelight/base/unit_point.h"

#include "compare/audit_lobe.h"
#include "compare/read_directions.h"
#include "projection/bilinear.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace domelight {
namespace {

/// A level for bilinear lookups.
class LevelReader {
  public:
    explicit LevelReader(const FilteredMap& map) : image_(map.image.view()) {
        if (map.layout == Layout::cube) cube_.emplace(map.cube());
    }
    Vec3f operator()(const Vec3d& direction) const {
        return cube_ ? look_up(*cube_, Vec3f(direction)) : bilinear(image_, latlong_uv(direction), true);
    }

  private:
    ImageView<const float> image_;
    std::optional<BorderedCube> cube_;
};

/// The level that is linear in the roughness between neighbouring levels.
double level_between(const std::vector<double>& levels, double roughness) {
    const auto above = std::upper_bound(levels.begin(), levels.end(), roughness);
    if (above == levels.begin()) return 0;
    const double below = double(above - levels.begin()) - 1;
    return above == levels.end() ? below : below + (roughness - *(above - 1)) / (*above - *(above - 1));
}

/// One roughness in each of `count` equal parts of [least, 1].
std::vector<double> random_roughnesses(const ReadErrorOptions& o) {
    std::vector<double> values;
    for (int i = 0; i < o.roughnesses; ++i) {
        const double jitter = unit_double(std::uint32_t(derive_key(o.seed, std::uint64_t(i)) >> 32));
        values.push_back(o.least_roughness + (1 - o.least_roughness) * (i + jitter) / o.roughnesses);
    }
    return values;
}

Result<void> check(const ReadChain& chain, const ReadErrorOptions& o) {
    if (chain.levels.empty()) return Error{"no levels to read", "levels", ""};
    if (chain.roughness.size() != chain.levels.size())
        return Error{fmt::format("has {} values, expected one for each of {} levels", chain.roughness.size(),
                                 chain.levels.size()),
                     "roughness", ""};
    if (!std::ranges::is_sorted(chain.roughness)) return Error{"does not rise from level to level", "roughness", ""};
    if (is_phong(chain.lobe))
        return Error{name_of(chain.lobe) + " is not measured as read, expected ggx or charlie", "lobe", ""};
    if (o.directions < 2) return Error{fmt::format("is {}, expected 2 or more", o.directions), "directions", ""};
    if (o.roughnesses < 1) return Error{fmt::format("is {}, expected 1 or more", o.roughnesses), "roughnesses", ""};
    if (!(o.least_roughness > 0 && o.least_roughness < 1))
        return Error{fmt::format("is {}, expected a value between 0 and 1", o.least_roughness), "least_roughness", ""};
    return {};
}

class Measurement {
  public:
    Measurement(const ReadChain& chain, const Environment& environment, const ReadErrorOptions& options)
        : chain_(chain), environment_(environment), options_(options) {
        for (const FilteredMap& level : chain.levels) readers_.emplace_back(level);
        plan_reads();
    }

    Result<ReadErrors> run() {
        if (auto ok = evaluate_truth(); !ok) return ok.error();
        parallel_for(int(reads_.size()), options_.threads, [&](int i) { measure(i); });
        const auto own = reads_.begin() + own_levels_;
        ReadErrors errors;
        errors.levels.assign(reads_.begin(), own);
        errors.between.assign(own, reads_.end());
        for (const ReadErrorAt& at : errors.between) {
            errors.relative_rmse += at.relative_rmse * at.relative_rmse / double(errors.between.size());
            errors.largest = std::max(errors.largest, at.largest);
        }
        errors.relative_rmse = std::sqrt(errors.relative_rmse);
        return errors;
    }

  private:
    double level_of(double roughness) const {
        const double level = chain_.level_of ? chain_.level_of(roughness) : level_between(chain_.roughness, roughness);
        return std::clamp(level, 0.0, double(chain_.levels.size() - 1));
    }

    void plan_reads() {
        const double last = std::ceil(level_of(1));
        for (std::size_t l = 0; l < chain_.levels.size() && double(l) <= last; ++l)
            if (chain_.roughness[l] >= options_.least_roughness)
                reads_.push_back({chain_.roughness[l], double(l), 0, 0});
        own_levels_ = std::ptrdiff_t(reads_.size());
        for (const double roughness : random_roughnesses(options_))
            reads_.push_back({roughness, level_of(roughness), 0, 0});
    }

    Result<void> evaluate_truth() {
        const auto drawn = ReadDirections::draw(environment_, options_.directions, options_.seed, options_.threads);
        if (!drawn) return drawn.error();
        directions_ = drawn->directions();
        FilterOptions filter;
        filter.directions = directions_;
        filter.sh_bands = 0;
        filter.threads = options_.threads;
        filter.progress = options_.progress;
        for (const ReadErrorAt& read : reads_)
            filter.specular.push_back({1, false, lobe_at_roughness(chain_.lobe, read.roughness)});
        filter.specular.push_back({1, false, ReadDirections::lobe()});
        auto filtered = prefilter(environment_, filter);
        if (!filtered) return filtered.error();
        mean_ = filtered->mean;
        weights_ = drawn->weights(filtered->specular.back().pixels(), mean_);
        truth_ = std::move(filtered->specular);
        return {};
    }

    /// The chain's value in a world direction.
    Vec3f read(const Vec3d& direction, double level) const {
        const Vec3d d = chain_.map_from_world * direction;
        const std::size_t below = std::size_t(level);
        const Vec3f value = readers_[below](d);
        const float t = float(level - double(below));
        return t > 0 ? value + (readers_[below + 1](d) - value) * t : value;
    }

    void measure(int index) {
        ReadErrorAt& at = reads_[std::size_t(index)];
        const ImageF& truth = truth_[std::size_t(index)].image;
        double errors = 0, squares = 0;
        const double least[3] = {0.01 * mean_.x, 0.01 * mean_.y, 0.01 * mean_.z};
        for (std::size_t i = 0; i < directions_.size(); ++i) {
            const Vec3f value = read(directions_[i], at.level);
            const float *t = truth.at(int(i), 0), v[3] = {value.x, value.y, value.z};
            for (int c = 0; c < 3; ++c) {
                const double error = double(v[c]) - t[c];
                errors += weights_[i] * error * error;
                squares += weights_[i] * double(t[c]) * t[c];
                at.largest = std::max(at.largest, std::abs(error) / std::max({double(t[c]), least[c], 1e-30}));
            }
        }
        at.relative_rmse = std::sqrt(errors / std::max(squares, 1e-300));
    }

    const ReadChain& chain_;
    const Environment& environment_;
    const ReadErrorOptions& options_;
    std::vector<LevelReader> readers_;
    std::vector<ReadErrorAt> reads_;  ///< the levels at their own roughness first, then the random roughnesses
    std::ptrdiff_t own_levels_ = 0;   ///< how many of reads_ are levels at their own roughness
    std::vector<Vec3d> directions_;
    std::vector<double> weights_;
    std::vector<FilteredMap> truth_;  ///< for each of reads_
    Vec3d mean_;
};

}  // namespace

Result<ReadErrors> measure_as_read(const ReadChain& chain, const Environment& environment,
                                   const ReadErrorOptions& options) {
    if (auto ok = check(chain, options); !ok) return ok.error();
    return Measurement(chain, environment, options).run();
}

}  // namespace domelight
