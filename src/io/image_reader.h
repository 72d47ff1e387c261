#pragma once

#include "domelight/base/result.h"
#include "domelight/base/vec.h"
#include "domelight/image/image.h"
#include "domelight/io/decode.h"

#include "io/file/file_reader.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace domelight {

/// The largest image side any reader accepts: 65536 x 32768 is two gigapixels, more than any environment and small
/// enough for int arithmetic.
inline constexpr int k_max_image_side = 65536;

/// The properties of the image in a file.
struct ImageFacts {
    enum class Envmap { none, latlong, cube };  ///< OpenEXR's attribute of that name

    std::string format;  ///< "Radiance HDR", ...
    int width = 0, height = 0;
    std::string layer;               ///< OpenEXR: the layer that is read; empty: the unnamed one
    bool high_dynamic_range = true;  ///< false: cut off at the white of a screen
    bool always_light = false;       ///< the format has no negative values, infinities and NaNs (before `to_rec709`)
    float largest = 0;               ///< the largest finite value of the format, which replaces infinity
    Envmap envmap = Envmap::none;
    std::optional<Mat3> to_rec709 = std::nullopt;  ///< the file's primaries to linear Rec. 709, where they differ
    std::vector<std::string> warnings;
};

struct ReaderOptions {
    Decode decode = Decode::automatic;
    std::int64_t max_bytes = std::int64_t(1) << 30;
    int threads = 0;
    std::string layer = {};  ///< OpenEXR: which layer, channel or part (exr_channels.h); empty: the picture itself
    /// Codes of a PNG or JPEG as they are stored, whatever the file says of its orientation: for textures.
    bool as_stored = false;
    /// OpenEXR: the most black texels that a display window may add to the data window, unless it adds no more than four
    /// times what it shows of that. k_most_black_in_memory for those who hold the whole picture.
    std::int64_t max_black = std::int64_t(1) << 25;
};

/// A small region of a picture of 4096 x 2048. A header of some hundred bytes may promise any size, and who compares or
/// draws from a picture needs up to 150 bytes of memory for each of its texels.
inline constexpr std::int64_t k_most_black_in_memory = std::int64_t(1) << 23;

/// An image file that is decoded from the top row down. Pixels are RGB as stored (linear, but in the file's own
/// primaries, and with its NaNs, infinities and negative values).
class ImageReader {
  public:
    virtual ~ImageReader() = default;
    const ImageFacts& facts() const { return facts_; }
    /// Reads the next `rows.height` rows (no more than are left). True: every value is known to lie in [0,
    /// k_largest_radiance].
    virtual Result<bool> read(ImageView<float> rows) = 0;

  protected:
    ImageFacts facts_;
};

/// Opens the image in `bytes`; the format is recognised by its first bytes. Errors name no file: the caller adds it.
Result<std::unique_ptr<ImageReader>> open_image_reader(std::shared_ptr<const FileBytes> bytes,
                                                       const ReaderOptions& options);

/// One by format. Each expects the format's magic number at the start.
Result<std::unique_ptr<ImageReader>> open_hdr_reader(std::shared_ptr<const FileBytes> bytes,
                                                     const ReaderOptions& options);
Result<std::unique_ptr<ImageReader>> open_exr_reader(std::shared_ptr<const FileBytes> bytes,
                                                     const ReaderOptions& options);
Result<std::unique_ptr<ImageReader>> open_png_reader(std::shared_ptr<const FileBytes> bytes,
                                                     const ReaderOptions& options);
Result<std::unique_ptr<ImageReader>> open_jpeg_reader(std::shared_ptr<const FileBytes> bytes,
                                                      const ReaderOptions& options);

/// The error where a layer is asked of a file of another format.
Error no_layers();

/// An error unless 1 <= width, height <= k_max_image_side.
Result<void> check_image_size(std::int64_t width, std::int64_t height);

}  // namespace domelight
