#pragma once

#include "domelight/filtering/prefilter.h"

#include "filtering/harmonic/bright_split.h"

#include <memory>
#include <vector>

namespace domelight {

/// Levels whose lobe is narrower than their texels, each texel summed over the image: near the lobe's axis over the
/// bilinear patches, farther out over texels, and from there on over ever larger means of texels, each at least
/// k_reach times its own size away. docs/math/prefilter.md has the error.
///
/// The image goes by row by row and is not kept. The bits do not depend on the number of threads, nor on how many rows
/// are handed over at a time.
class DirectSums {
  public:
    /// width, height   of the lat-long image
    /// options         for its layout, its orientation, its threads, and its levels
    /// levels          indices of options.specular to sum; takes_directly() holds for each
    DirectSums(int width, int height, const FilterOptions& options, const std::vector<int>& levels);
    ~DirectSums();

    /// Whether a level is better summed than expanded in harmonics.
    static bool takes_directly(const LevelSpec& level, Layout layout);

    /// The next rows, without the light that is in `split` in the end.
    void add_rows(ImageView<const float> rows);
    /// After the last row: one map for each of the levels, with the light of `split`.
    std::vector<FilteredMap> finish(const BrightSplit& split);

  private:
    class Pyramid;
    class Level;

    FilterOptions options_;
    std::unique_ptr<Pyramid> pyramid_;
    std::vector<std::unique_ptr<Level>> levels_;
};

}  // namespace domelight
