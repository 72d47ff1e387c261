#include "io/picture/texture_image.h"

#include <fmt/format.h>
#include <png.h>

#include <cstring>

namespace domelight {

namespace {

/// A PNG as 8-bit RGBA. Environments are read row by row and without alpha (png_reader.cpp); a texture is needed as a
/// whole and with alpha.
///
/// On an error libpng calls longjmp: each method that calls libpng sets its own return point and has no local with a
/// destructor after that.
class PngTexture {
  public:
    explicit PngTexture(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
    ~PngTexture() { png_destroy_read_struct(&png_, &info_, nullptr); }
    PngTexture(const PngTexture&) = delete;
    PngTexture& operator=(const PngTexture&) = delete;
    Result<Rgba8Image> decode();

  private:
    bool read_header();
    bool read_rows();
    static void on_error(png_structp png, png_const_charp message);
    static void on_warning(png_structp, png_const_charp) {}
    static void on_read(png_structp png, png_bytep out, std::size_t n);

    std::span<const std::uint8_t> bytes_;
    std::size_t at_ = 0;
    png_structp png_ = nullptr;
    png_infop info_ = nullptr;
    char message_[128] = "";
    std::vector<png_bytep> rows_;
};

void PngTexture::on_error(png_structp png, png_const_charp message) {
    auto* self = static_cast<PngTexture*>(png_get_error_ptr(png));
    std::snprintf(self->message_, sizeof self->message_, "%s", message);
    png_longjmp(png, 1);
}

void PngTexture::on_read(png_structp png, png_bytep out, std::size_t n) {
    auto* self = static_cast<PngTexture*>(png_get_io_ptr(png));
    if (n > self->bytes_.size() - self->at_) png_error(png, "file ends too early");
    std::memcpy(out, self->bytes_.data() + self->at_, n);
    self->at_ += n;
}

/// Every kind of PNG becomes RGBA of 8 bits. No gamma is applied: glTF defines which textures are sRGB, whatever the
/// file states.
bool PngTexture::read_header() {
    if (setjmp(png_jmpbuf(png_))) return false;
    png_set_read_fn(png_, this, on_read);
    png_set_chunk_malloc_max(png_, 8 << 20);
    png_set_chunk_cache_max(png_, 256);
    png_read_info(png_, info_);
    png_set_expand(png_);
    png_set_scale_16(png_);
    png_set_gray_to_rgb(png_);
    png_set_add_alpha(png_, 0xff, PNG_FILLER_AFTER);
    png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
    return png_get_rowbytes(png_, info_) == std::size_t(png_get_image_width(png_, info_)) * 4;
}

bool PngTexture::read_rows() {
    if (setjmp(png_jmpbuf(png_))) return false;
    png_read_image(png_, rows_.data());
    png_read_end(png_, nullptr);
    return true;
}

Result<Rgba8Image> PngTexture::decode() {
    const auto size = texture_image_size(bytes_);
    if (!size) return size.error();
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, on_error, on_warning);
    info_ = png_ ? png_create_info_struct(png_) : nullptr;
    if (!info_) return Error{"libpng cannot start", "", ""};
    const auto failure = [&] {
        return Error{fmt::format("not a readable PNG: {}", message_), "", "The file is truncated or damaged."};
    };
    if (!read_header() || png_get_image_width(png_, info_) != unsigned(size->width) ||
        png_get_image_height(png_, info_) != unsigned(size->height))
        return failure();
    Rgba8Image image;
    image.width = size->width, image.height = size->height;
    image.rgba.resize(std::size_t(image.width) * std::size_t(image.height) * 4);
    for (int y = 0; y < image.height; ++y)
        rows_.push_back(image.rgba.data() + std::size_t(y) * std::size_t(image.width) * 4);
    if (!read_rows()) return failure();
    return image;
}

}  // namespace

Result<Rgba8Image> decode_png_texture(std::span<const std::uint8_t> bytes) {
    return PngTexture(bytes).decode();
}

}  // namespace domelight
