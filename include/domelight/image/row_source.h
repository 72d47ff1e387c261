#pragma once

#include "domelight/base/result.h"
#include "domelight/image/image.h"

#include <cstdint>

namespace domelight {

/// A lat-long image in the default convention that is read from the top row down: RGB float radiance, linear Rec. 709,
/// finite and >= 0. A 16384 x 8192 image can be read without ever being in memory as a whole.
class RowSource {
  public:
    virtual ~RowSource() = default;
    virtual int width() const = 0;
    virtual int height() const = 0;
    /// Reads the next `rows.height` rows (no more than are left) into `rows` (width() wide, 3 channels).
    virtual Result<void> read(ImageView<float> rows) = 0;
};

/// An image in memory as a RowSource. It refers to the pixels without copying them.
class ImageRowSource : public RowSource {
  public:
    explicit ImageRowSource(ImageView<const float> image) : image_(image) {}
    int width() const override { return image_.width; }
    int height() const override { return image_.height; }
    Result<void> read(ImageView<float> rows) override;

  private:
    ImageView<const float> image_;
    int next_row_ = 0;
};

/// The largest lat-long image that is held in memory, in bytes: 16384 x 8192 texels need 1.6e9. A compressed file of some
/// hundred kilobytes can truthfully be any size.
inline constexpr std::int64_t k_most_latlong_bytes = std::int64_t(1) << 31;

/// Reads all remaining rows of a source into memory. Errors: width() x height() texels need more than `max_bytes`; those
/// of reading.
Result<ImageF> read_latlong(RowSource& source, std::int64_t max_bytes = k_most_latlong_bytes);

}  // namespace domelight
