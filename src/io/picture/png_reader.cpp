#include "image/repair.h"
#include "io/picture/exif.h"
#include "io/picture/oriented_reader.h"
#include "io/picture/png_colour.h"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <cstring>

namespace domelight {

namespace {

/// A PNG, read row by row; an interlaced one is kept in memory as stored.
///
/// On an error libpng calls longjmp. Each method that calls libpng sets its own return point and has no local with a
/// destructor after that.
class PngReader : public ImageReader {
  public:
    PngReader(std::shared_ptr<const FileBytes> bytes, const ReaderOptions& options)
        : bytes_(std::move(bytes)), decode_(options.decode), max_bytes_(options.max_bytes) {}
    ~PngReader() override { png_destroy_read_struct(&png_, &info_, nullptr); }

    Result<void> open();
    Result<bool> read(ImageView<float> rows) override;

  private:
    bool read_header();
    std::span<const std::uint8_t> icc_profile();
    void set_colour();
    bool start_rows();
    bool read_bytes(unsigned char* row);
    bool read_interlaced();
    Error failure() const {
        return {fmt::format("not a readable PNG: {}", message_), "", "The file is truncated or damaged."};
    }

    static void on_error(png_structp png, png_const_charp message);
    static void on_warning(png_structp, png_const_charp) {}
    static void on_read(png_structp png, png_bytep out, std::size_t n);

    std::shared_ptr<const FileBytes> bytes_;
    Decode decode_;
    std::int64_t max_bytes_;
    png_structp png_ = nullptr;
    png_infop info_ = nullptr;
    std::size_t at_ = 0;
    char message_[128] = "";
    int passes_ = 1, bytes_a_sample_ = 1, next_row_ = 0;
    ScreenColour colour_;
    std::vector<unsigned char> buffer_;  // one row, or the whole image where it is interlaced
    std::vector<unsigned char*> row_starts_;
};

void PngReader::on_error(png_structp png, png_const_charp message) {
    auto* self = static_cast<PngReader*>(png_get_error_ptr(png));
    std::snprintf(self->message_, sizeof self->message_, "%s", message);
    png_longjmp(png, 1);
}

void PngReader::on_read(png_structp png, png_bytep out, std::size_t n) {
    auto* self = static_cast<PngReader*>(png_get_io_ptr(png));
    const auto all = self->bytes_->bytes();
    if (n > all.size() - self->at_) png_error(png, "file ends too early");
    std::memcpy(out, all.data() + self->at_, n);
    self->at_ += n;
}

bool PngReader::read_header() {
    if (setjmp(png_jmpbuf(png_))) return false;
    png_set_read_fn(png_, this, on_read);
    png_set_user_limits(png_, k_max_image_side, k_max_image_side);
    png_set_chunk_malloc_max(png_, 8 << 20);
    png_set_chunk_cache_max(png_, 256);
    png_read_info(png_, info_);
    return true;
}

/// The profile in iCCP, decompressed; empty: none, or it is damaged.
std::span<const std::uint8_t> PngReader::icc_profile() {
    if (setjmp(png_jmpbuf(png_))) return {};
    png_charp name = nullptr;
    png_bytep profile = nullptr;
    int compression = 0;
    png_uint_32 length = 0;
    if (!png_get_iCCP(png_, info_, &name, &compression, &profile, &length)) return {};
    return {profile, length};
}

/// The colours that the file states, unless a decoding was asked for.
void PngReader::set_colour() {
    const int levels = bytes_a_sample_ == 2 ? 65536 : 256;
    PngColour said = decode_ == Decode::automatic ? colour_of_png(bytes_->bytes(), icc_profile(), levels)
                                                  : PngColour{colour_of_decode(decode_, levels)};
    colour_ = std::move(said.colour);
    facts_.high_dynamic_range = colour_.hdr;
    facts_.always_light = !colour_.profile;
    facts_.largest = k_largest_radiance;
    facts_.to_rec709 = colour_.to_rec709;
    facts_.warnings = screen_warnings("PNG", colour_, said.assumed);
}

/// Every kind of PNG as RGB of 8 or 16 bits.
bool PngReader::start_rows() {
    if (setjmp(png_jmpbuf(png_))) return false;
    png_set_expand(png_);
    png_set_gray_to_rgb(png_);
    png_set_strip_alpha(png_);
    passes_ = png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
    return png_get_channels(png_, info_) == 3;
}

bool PngReader::read_bytes(unsigned char* row) {
    if (setjmp(png_jmpbuf(png_))) return false;
    png_read_row(png_, row, nullptr);
    if (next_row_ + 1 == facts_.height) png_read_end(png_, nullptr);  // checks what follows the texels
    return true;
}

bool PngReader::read_interlaced() {
    if (setjmp(png_jmpbuf(png_))) return false;
    png_read_image(png_, row_starts_.data());
    png_read_end(png_, nullptr);
    return true;
}

Result<void> PngReader::open() {
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, on_error, on_warning);
    info_ = png_ ? png_create_info_struct(png_) : nullptr;
    if (!info_) return Error{"libpng cannot start", "", ""};
    if (!read_header()) return failure();
    const std::int64_t width = png_get_image_width(png_, info_), height = png_get_image_height(png_, info_);
    if (const auto sized = check_image_size(width, height); !sized) return sized.error();
    // Deflate turns a byte into at most 1032.
    const auto stored = std::int64_t(png_get_rowbytes(png_, info_)) * height;
    if (stored / 1040 > std::int64_t(bytes_->bytes().size()))
        return Error{fmt::format("file ends too early: {} bytes cannot hold {} x {} texels", bytes_->bytes().size(),
                                 width, height),
                     "", "The file is truncated, or its header is wrong."};
    const bool had_alpha =
        (png_get_color_type(png_, info_) & PNG_COLOR_MASK_ALPHA) || png_get_valid(png_, info_, PNG_INFO_tRNS);
    if (!start_rows()) return failure();

    bytes_a_sample_ = png_get_bit_depth(png_, info_) == 16 ? 2 : 1;
    const std::size_t row_bytes = std::size_t(width) * 3 * std::size_t(bytes_a_sample_);
    const std::size_t held_rows = passes_ > 1 ? std::size_t(height) : 1;
    if (std::int64_t(row_bytes * held_rows) > max_bytes_)
        return Error{fmt::format("decoding {} x {} interlaced texels needs {} bytes, more than the limit of {}", width,
                                 height, row_bytes * held_rows, max_bytes_),
                     "", ""};
    buffer_.resize(row_bytes * held_rows);
    for (std::size_t y = 0; y < held_rows; ++y) row_starts_.push_back(buffer_.data() + y * row_bytes);
    facts_.format = "PNG";
    facts_.width = int(width);
    facts_.height = int(height);
    set_colour();
    if (had_alpha) facts_.warnings.push_back("the alpha channel is ignored");
    return {};
}

Result<bool> PngReader::read(ImageView<float> rows) {
    for (int y = 0; y < rows.height; ++y, ++next_row_) {
        if (passes_ > 1 && next_row_ == 0 && !read_interlaced()) return failure();
        unsigned char* row = row_starts_[passes_ > 1 ? std::size_t(next_row_) : 0];
        if (passes_ == 1 && !read_bytes(row)) return failure();
        float* out = rows.row(y);
        for (int i = 0; i < 3 * rows.width; ++i)
            out[i] = colour_.curves[std::size_t(i % 3)]
                                   [bytes_a_sample_ == 2 ? std::size_t(row[2 * i] << 8 | row[2 * i + 1]) : row[i]];
        if (colour_.profile) colour_.profile(out, rows.width);
    }
    return !colour_.profile;
}

}  // namespace

Result<std::unique_ptr<ImageReader>> open_png_reader(std::shared_ptr<const FileBytes> bytes,
                                                     const ReaderOptions& options) {
    const std::shared_ptr<const FileBytes> file = bytes;
    auto reader = std::make_unique<PngReader>(std::move(bytes), options);
    if (const auto opened = reader->open(); !opened) return opened.error();
    const auto exif = find_png_chunk(file->bytes(), "eXIf");
    return oriented_reader(std::move(reader), exif && !options.as_stored ? exif_orientation(*exif) : 1,
                           options.max_bytes);
}

}  // namespace domelight
