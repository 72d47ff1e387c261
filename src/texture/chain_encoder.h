#pragma once

#include "domelight/texture/texture.h"

#include "texture/texel/encode_row.h"
#include "texture/texel_order.h"

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace domelight {

/// Encodes the levels of a chain piece by piece, in any order and on any number of threads, so that texels can be
/// stored while they are still in the processor's cache. The levels must not change meanwhile. A row is a row of
/// texels, or of blocks if the encoding has them.
class ChainEncoder {
  public:
    /// `levels`: at least one. For a texture each must have half the size of the one before, rounded down. `order`:
    /// where their texels go.
    ChainEncoder(std::span<const FilteredMap> levels, Encoding encoding,
                 std::map<std::string, std::string> metadata = {}, EncodingQuality quality = EncodingQuality::standard,
                 const TexelOrder& order = {});

    /// The texture that the levels make, its own levels left empty.
    const Texture& head() const { return head_; }
    int level_count() const { return int(levels_.size()); }
    /// Rows of one face, and bytes of a row.
    int rows(int level) const { return in_blocks(levels_[level].height); }
    std::size_t row_bytes(int level) const;
    /// Bytes of each level, all faces together.
    std::vector<std::uint64_t> level_bytes() const;

    /// Encodes `count` rows of a level from `first` on, rows of all faces counted one after the other. `out` takes
    /// count * row_bytes(level) bytes. Different rows may be encoded at the same time.
    void encode(int level, int first, int count, std::uint8_t* out);

    /// The report of each level, once all its rows have been encoded. Its bits do not depend on the pieces.
    std::vector<EncodingReport> reports() const;

  private:
    struct Level {
        const FilteredMap* map = nullptr;
        int width = 0, height = 0;
        std::vector<float> weights;    ///< cube: of the upper half of a face's rows; the lower half is its reflection
        std::vector<EncodeSums> sums;  ///< of each row of each face
        LogScale log_scale;
    };
    int in_blocks(int texels) const {
        return (texels + encoding_block(head_.encoding) - 1) / encoding_block(head_.encoding);
    }
    /// Solid angles, up to a factor, of the texels in row `y` of a face.
    const float* row_weights(const Level& level, int y, std::vector<float>& scratch) const;

    /// `count` rows of texels of a face from `y` on, one after the other; copied to `scratch` where the order asks for
    /// it.
    const float* rows_in_order(const Level& level, int face, int y, int count, std::vector<float>& scratch) const;

    Texture head_;
    EncodingQuality quality_;
    TexelOrder order_;
    std::vector<Level> levels_;
};

/// Encodes the whole chain in memory.
Texture encode_in_memory(ChainEncoder& encoder, int threads);

/// The errors of levels stored as RGBE (.hdr pictures) in an order, one report for each level.
std::vector<EncodingReport> rgbe_reports(std::span<const FilteredMap> levels, const TexelOrder& order = {});

}  // namespace domelight
