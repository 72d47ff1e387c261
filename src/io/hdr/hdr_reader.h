#pragma once

#include "io/hdr/hdr_header_reader.h"
#include "io/image_reader.h"

#include <cstdint>
#include <vector>

namespace domelight {

/// A Radiance picture (.hdr, .pic), decoded row by row. Only pictures whose scanlines are columns are held in memory,
/// as RGBE bytes.
class HdrReader : public ImageReader {
  public:
    static Result<std::unique_ptr<ImageReader>> open(std::shared_ptr<const FileBytes> bytes,
                                                     const ReaderOptions& options);
    Result<bool> read(ImageView<float> rows) override;

  private:
    HdrReader() = default;
    Result<void> index_scanlines(int count);
    Result<void> decode_columns();
    Result<bool> read_scanlines(ImageView<float> rows);
    Result<bool> read_in_order(ImageView<float> rows);
    Result<bool> read_by_index(ImageView<float> rows);
    Result<bool> read_columns(ImageView<float> rows);
    void set_scale();
    void set_primaries();
    bool convert_row(const std::uint8_t* planes, std::size_t plane_stride, float* out) const;
    Error scanline_error(int scanline, const char* what) const;

    std::shared_ptr<const FileBytes> bytes_;
    HdrHeader header_;
    int threads_ = 0;
    int next_row_ = 0;
    std::array<float, 3> scale_{1, 1, 1};
    std::vector<float> curve_;          ///< where the header has a GAMMA: the light of each mantissa, for each exponent
    int brightest_exponent_ = 0;        // exponents up to this one give values within k_largest_radiance
    std::vector<std::size_t> offsets_;  // where the scanlines found so far start, and where the last of them ends
    std::vector<std::uint8_t> columns_;  // four planes of the whole image, where scanlines are columns
};

}  // namespace domelight
