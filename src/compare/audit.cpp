#include "domelight/compare/bake_audit.h"

#include "compare/audit_exact.h"
#include "compare/audit_lobe.h"
#include "compare/audit_orientation.h"
#include "compare/audit_search.h"
#include "compare/audit_verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace domelight {
namespace {

/// The ladder: roughnesses at which the source is filtered when a level states none that fits. 0 comes before these.
constexpr double k_ladder[] = {0.18, 0.24, 0.31, 0.39, 0.48, 0.58, 0.69, 0.8, 0.9, 1};
/// The same for Charlie's lobe, for which 0 is not a mirror.
constexpr double k_charlie_ladder[] = {0.1, 0.14, 0.18, 0.24, 0.31, 0.39, 0.48, 0.58, 0.69, 0.8, 0.9, 1};
/// Between 0 and the ladder's first, for levels that fit best there, because filtering with a narrow lobe takes long.
constexpr double k_narrow_rung = 0.13;

constexpr int k_broad_texels = 1536;     ///< sampled from each averaged level
constexpr double k_good_fit = 0.02;      ///< a stated roughness whose error is at most this needs no ladder
constexpr double k_good_turn = 0.05;     ///< an orientation whose error is at most this needs no ladder
constexpr double k_good_mirror = 0.005;  ///< an error at roughness 0 that the rounding of common encodings explains
constexpr int k_rounds = 4;              ///< filter runs of the final search, at most

/// One roughness of the ladder: the exact filter there, averaged to faces of k_broad_size^2.
struct Rung {
    double roughness = 0;
    Cubemap broad;
};

/// The searches for the roughness of one level: on averaged faces first, then at the level's own size.
struct Level {
    std::optional<double> stated;
    LevelSearch broad, fine;
    double broad_error = 1;  ///< of averaged faces, at the best roughness
};

class Audit {
  public:
    Audit(std::span<const CubeLevel> levels, const Environment& source, const AuditOptions& options)
        : given_(levels),
          options_(options),
          exact_(source, options.lobe, options.texels_hold, options.threads),
          source_(source) {}

    Result<BakeAudit> run() {
        if (given_.empty()) return Error{"no levels to audit", "", ""};
        // A lat-long source is filtered several times, but read only once.
        if (!source_.cube())
            if (const auto image = source_.latlong(); !image) return image.error();
        for (auto step :
             {&Audit::sample, &Audit::find_orientation, &Audit::filter_as_stated, &Audit::guess, &Audit::search}) {
            auto done = (this->*step)();
            if (!done) return done.error();
        }
        if (options_.progress && !options_.progress("audit", 1)) return Error{"cancelled", "", ""};
        return report();
    }

  private:
    // --- the steps ---

    Result<void> sample() {
        for (std::size_t l = 0; l < given_.size(); ++l) {
            const Cubemap& cube = given_[l].cube;
            samples_.push_back(sample_texels(cube, std::max(options_.texels, 96), options_.threads));
            if (!(samples_.back().mean > 0))
                return Error{fmt::format("level {} is black, so it cannot be audited", l), "", ""};
            broad_samples_.push_back(sample_broadly(cube, k_broad_texels, options_.threads));
        }
        return {};
    }

    /// By averaged faces, so that a bake of another environment is recognised before any level is filtered at its size.
    Result<void> find_orientation() {
        OrientationSearch search(broad_samples_[0]);
        if (const auto r = stated_roughness(given_[0])) {
            const double roughness = broad_roughness(*r);
            const ExactLevel wanted{size_for_rung(roughness), roughness};
            const auto add = [&](std::size_t, const Cubemap& cube) {
                search.add(rung_for({roughness, broad(cube)}, 0), options_.threads);
            };
            if (auto ok = filter(std::span(&wanted, 1), 0.05, add); !ok) return ok;
        }
        orientation_ = search.found();
        if (orientation_.error > k_good_turn) {
            if (auto ok = make_ladder(); !ok) return ok;
            for (const Rung& rung : ladder_) search.add(rung_for(rung, 0), options_.threads);
            orientation_ = search.found();
        }
        begin_levels();
        return {};
    }

    void begin_levels() {
        const Mat3& m = orientation_.ours_from_theirs;
        for (std::size_t l = 0; l < given_.size(); ++l) {
            const auto stated = stated_roughness(given_[l]);
            const RoughnessRange range =
                roughness_range(starts_at_mirror(options_.lobe), given_[l].cube.size(), stated);
            std::vector<int> turned = turned_texels(samples_[l], m), broad_turned = turned_texels(broad_samples_[l], m);
            levels_.push_back({stated, LevelSearch(std::move(broad_samples_[l]), std::move(broad_turned), range),
                               LevelSearch(std::move(samples_[l]), std::move(turned), range)});
        }
    }

    /// Every level that states its roughness, filtered by that one.
    Result<void> filter_as_stated() {
        if (of_another()) return {};
        std::vector<ExactLevel> wanted;
        std::vector<std::size_t> levels;
        for (std::size_t l = 0; l < levels_.size(); ++l)
            if (const auto r = levels_[l].stated) {
                wanted.push_back({given_[l].cube.size(), *r});
                levels.push_back(l);
            }
        const auto ok = filter(wanted, 0.3, [&](std::size_t i, const Cubemap& cube) {
            Level& level = levels_[levels[i]];
            level.broad.add(wanted[i].roughness, broad(cube));
            level.fine.add(wanted[i].roughness, cube);
            level.broad_error = level.broad.best_error();
        });
        if (ok && levels_[0].stated) orientation_.error = std::min(orientation_.error, levels_[0].broad_error);
        return ok;
    }

    /// A first guess at the roughness of every level: the stated one where it fits, otherwise the best of the ladder or
    /// between two of its rungs.
    Result<void> guess() {
        for (std::size_t l = 0; l < levels_.size(); ++l) {
            Level& level = levels_[l];
            if (!of_another() && level.stated && level.fine.best_error() <= k_good_fit) {
                if (*level.stated > 0) level.fine.guess(*level.stated);
                continue;
            }
            if (auto ok = make_ladder(); !ok) return ok;
            for (const Rung& rung : ladder_) level.broad.add(rung.roughness, rung_for(rung, l));
            level.broad_error = level.broad.best_error();
            guessed_.push_back(l);
        }
        if (of_another()) return {};
        if (auto ok = add_narrow_rung(); !ok) return ok;
        for (const std::size_t l : guessed_) {
            Level& level = levels_[l];
            const LevelSearch::Coarse found = level.broad.coarse();
            level.broad_error = found.error;
            level.fine.guess(level.fine.allowed(found.roughness), level.broad.best_roughness() == 0);
        }
        return measure_mirrors();
    }

    /// For levels that fit best below the ladder's second roughness above 0, but not exactly at 0.
    Result<void> add_narrow_rung() {
        std::vector<std::size_t> narrow;
        for (const std::size_t l : guessed_)
            if (const LevelSearch& broad = levels_[l].broad;
                broad.best_roughness() <= k_ladder[0] && broad.best_error() > k_good_mirror)
                narrow.push_back(l);
        if (narrow.empty() || !starts_at_mirror(options_.lobe)) return {};
        if (auto ok = add_rungs(std::span(&k_narrow_rung, 1)); !ok) return ok;
        for (const std::size_t l : narrow) levels_[l].broad.add(k_narrow_rung, rung_for(ladder_.back(), l));
        return {};
    }

    /// For levels that fit best at roughness 0: measures how fast the error grows away from 0, at the ladder's first
    /// roughness. The range in LevelAudit::roughness_within follows from it.
    Result<void> measure_mirrors() {
        std::vector<std::size_t> mirrors;
        for (std::size_t l = 0; l < levels_.size(); ++l)
            if (levels_[l].broad.best_roughness() == 0) mirrors.push_back(l);
        if (mirrors.empty()) return {};
        const double r = k_ladder[0];
        if (ladder_.empty())
            if (auto ok = add_rungs(std::span(&r, 1)); !ok) return ok;
        for (const std::size_t l : mirrors) {
            Level& level = levels_[l];
            for (const Rung& rung : ladder_)
                if (rung.roughness == r) level.broad.add(r, rung_for(rung, l));
            const double there = level.broad.error_at(r), here = level.broad.error_at(0);
            level.fine.growth_at_mirror((there * there - here * here) / (r * r));
        }
        return {};
    }

    /// Filters at the levels' own sizes, all levels in one run, until every level has its best roughness between two
    /// others.
    Result<void> search() {
        if (of_another()) return {};
        for (int round = 0; round < k_rounds; ++round) {
            std::vector<ExactLevel> wanted;
            std::vector<std::size_t> levels;
            for (std::size_t l = 0; l < levels_.size(); ++l)
                for (const double r : levels_[l].fine.wanted()) {
                    wanted.push_back({levels_[l].fine.sample().size, r});
                    levels.push_back(l);
                }
            if (wanted.empty()) return {};
            const auto ok = filter(wanted, 0.5, [&](std::size_t i, const Cubemap& cube) {
                levels_[levels[i]].fine.add(wanted[i].roughness, cube);
            });
            if (!ok) return ok;
        }
        return {};
    }

    // --- the ladder ---

    Result<void> make_ladder() {
        if (ladder_.size() > 1) return {};
        ladder_.clear();
        if (!starts_at_mirror(options_.lobe)) return add_rungs(k_charlie_ladder);
        std::vector<double> values{0};
        values.insert(values.end(), std::begin(k_ladder), std::end(k_ladder));
        return add_rungs(values);
    }

    Result<void> add_rungs(std::span<const double> roughness) {
        std::vector<ExactLevel> wanted;
        for (const double r : roughness) wanted.push_back({size_for_rung(r), r});
        return filter(wanted, 0.4, [&](std::size_t i, const Cubemap& cube) {
            ladder_.push_back({wanted[i].roughness, broad(cube)});
        });
    }

    /// A stated roughness as averaged faces show it: a narrower lobe than a texel's cannot be told from 0.
    double broad_roughness(double stated) const {
        return starts_at_mirror(options_.lobe) && stated < least_roughness(k_broad_size) ? 0 : stated;
    }

    /// The size at which a rung is filtered: texels half as wide as the lobe, and not above 4 k_broad_size.
    static int size_for_rung(double roughness) {
        int size = k_broad_size;
        while (roughness > 0 && size < 4 * k_broad_size && 2 * least_roughness(size) > roughness) size *= 2;
        return size;
    }

    /// A rung at the size of a level's averaged faces, which are smaller than k_broad_size for small levels.
    Cubemap rung_for(const Rung& rung, std::size_t level) const {
        return averaged_to(rung.broad, given_[level].cube.size(), options_.threads);
    }
    Cubemap broad(const Cubemap& cube) const { return averaged_to(cube, k_broad_size, options_.threads); }

    // --- the report ---

    bool of_another() const { return orientation_.error > options_.same; }

    std::optional<double> stated_roughness(const CubeLevel& level) const {
        if (is_phong(options_.lobe) && level.exponent) return roughness_of_exponent(*level.exponent);
        return level.roughness;
    }

    LevelAudit report_of(const Level& level) const {
        // Nothing is filtered at the levels' own sizes for a bake of another environment.
        const LevelSearch& search = of_another() ? level.broad : level.fine;
        const LevelSearch::Found found = search.found();
        LevelAudit audit;
        audit.size = level.fine.sample().size;
        audit.roughness = found.roughness;
        if (is_phong(options_.lobe)) audit.exponent = exponent_of_roughness(found.roughness);
        audit.roughness_within = found.within;
        audit.roughness_known = found.known;
        audit.scale = found.fit.scale;
        audit.energy = found.energy;
        audit.error = found.fit.error;
        audit.broad_error = std::min(audit.error, level.broad_error);
        audit.relative_rmse = found.fit.relative_rmse;
        audit.largest = found.fit.largest;
        audit.stated_roughness = level.stated;
        if (level.stated) {
            const Fit trusting = search.trusting(*level.stated);
            audit.stated_error = trusting.error;
            audit.stated_relative_rmse = trusting.relative_rmse;
        }
        return audit;
    }

    BakeAudit report() const {
        BakeAudit audit;
        audit.lobe = options_.lobe;
        audit.orientation = orientation_;
        for (const Level& level : levels_) audit.levels.push_back(report_of(level));
        return judged(std::move(audit), source_, options_);
    }

    /// Filters the source at these levels and calls `use(index, cube)` for each. For the progress, the run counts as
    /// `share` of the work that is left.
    Result<void> filter(std::span<const ExactLevel> wanted, double share,
                        const std::function<void(std::size_t, Cubemap)>& use) {
        if (wanted.empty()) return {};
        const double begin = done_;
        done_ += share * (1 - done_);
        return exact_.make(wanted, piece_of(options_.progress, begin, done_), use);
    }

    std::span<const CubeLevel> given_;
    const AuditOptions& options_;
    ExactFilter exact_;
    const Environment& source_;
    std::vector<TexelSample> samples_, broad_samples_;
    CubeOrientation orientation_;
    std::vector<Level> levels_;
    std::vector<std::size_t> guessed_;
    std::vector<Rung> ladder_;
    double done_ = 0;
};

}  // namespace

Result<BakeAudit> audit_bake(std::span<const CubeLevel> levels, const Environment& source,
                             const AuditOptions& options) {
    return Audit(levels, source, options).run();
}

}  // namespace domelight
