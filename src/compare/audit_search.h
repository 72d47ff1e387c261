#pragma once
// The search for the roughness of one level.

#include "compare/audit_fit.h"

#include <optional>
#include <vector>

namespace domelight {

/// The least roughness that differs visibly from 0 on faces of `size`^2: its lobe, 2 α wide, is as wide as a texel.
double least_roughness(int size);

/// The roughnesses that a search may try.
struct RoughnessRange {
    bool mirror = true;  ///< 0, the environment itself, is among them
    double least = 0.1;  ///< the least one above 0; filtering with narrower lobes takes seconds
};
/// For a level with faces of `size`^2 whose file states the roughness `stated`.
RoughnessRange roughness_range(bool mirror, int size, std::optional<double> stated);

/// Fits a level at a few roughnesses. Use: call add() for every roughness in wanted(), until wanted() is empty.
class LevelSearch {
  public:
    /// `turned`: for each texel of the sample, the texel of the exact cubes to compare with, from turned_texels().
    LevelSearch(TexelSample sample, std::vector<int> turned, RoughnessRange range);

    const TexelSample& sample() const { return sample_; }
    /// Sets where the search begins; with `mirror`, roughness 0 is tried as well.
    void guess(double roughness, bool mirror = false) {
        guess_ = roughness;
        try_mirror_ = mirror;
    }
    /// Sets the slope of the squared error over the squared roughness at 0, for a level that fits best there.
    void growth_at_mirror(double growth) { growth_at_mirror_ = growth; }
    void add(double roughness, const Cubemap& exact);

    bool has(double roughness) const;  ///< whether it was added
    /// The fit with the scale held at 1; interpolated at a roughness that was not added.
    Fit trusting(double roughness) const;
    double best_error() const { return tried_[best()].fit.error; }
    double best_roughness() const { return tried_[best()].roughness; }
    double error_at(double roughness) const;  ///< 1 where it was not added

    /// Roughnesses to add next: the guess with a neighbour on either side; then roughnesses further out, as long as the
    /// best fit is the outermost one; then close neighbours of the best fit.
    std::vector<double> wanted() const;

    struct Found {
        double roughness = 0, within = 0;  ///< as LevelAudit::roughness and roughness_within
        bool known = true;                 ///< as LevelAudit::roughness_known
        Fit fit;
        double energy = 1;  ///< as LevelAudit::energy
    };
    /// The best fit; interpolated between neighbours where they are close enough.
    Found found() const;

    struct Coarse {
        double roughness = 0, error = 1;
    };
    /// The best fit among roughnesses that may lie far apart, and between them, where the exact light is interpolated:
    /// where to begin a search with close neighbours.
    Coarse coarse() const;
    /// The roughness nearest to this one at which a search may begin.
    double allowed(double roughness) const;

  private:
    struct Tried {
        double roughness = 0;
        Fit fit;
        double mean = 0;           ///< mean luminance over the sphere, by the same texels as the level's own mean
        std::vector<Vec3f> exact;  ///< at the sampled texels
    };
    std::size_t best() const;
    bool neighbour_below() const;
    bool neighbour_above() const;
    double minimum() const;
    double growth(double at, double error) const;
    Tried interpolated(double roughness, std::size_t middle) const;
    Tried between(double roughness) const;
    std::vector<double> near(double roughness) const;

    TexelSample sample_;
    std::vector<int> turned_;
    RoughnessRange range_;
    std::optional<double> guess_;
    bool try_mirror_ = false;
    double growth_at_mirror_ = 0;
    std::vector<Tried> tried_;  ///< in rising order of roughness
};

}  // namespace domelight
