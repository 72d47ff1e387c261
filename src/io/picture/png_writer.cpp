#include "domelight/io/file/atomic_file.h"
#include "domelight/io/write_image.h"

#include "io/file/output_file.h"
#include "io/picture/png_memory.h"

#include <png.h>
#include <zlib.h>

#include <csetjmp>
#include <new>
#include <string>
#include <vector>

namespace domelight {

namespace {

/// The data that libpng's callbacks use. One of `file` and `memory` is set.
struct PngSink {
    OutputFile* file = nullptr;
    PngBytes* memory = nullptr;
    std::string message = {};

    /// False: it could not be stored.
    bool take(std::span<const std::uint8_t> bytes) noexcept {
        if (file) {
            file->write(bytes);
            return !file->failed();
        }
        try {
            memory->insert(memory->end(), bytes.begin(), bytes.end());
        } catch (const std::bad_alloc&) {
            return false;
        }
        return true;
    }
};

/// The form in which the pixels are stored.
struct PngStyle {
    bool srgb = true;
    int compression_level = 3;
    /// Runs instead of matches: a picture with smooth gradients is as small as with zlib's defaults, in a third of the
    /// time. Encoded texels (RGBD, RGBP) are not smooth.
    bool runs = true;
};

// libpng reports errors by longjmp out of these callbacks, so no function between the setjmp and here may own a
// resource.
[[noreturn]] void on_error(png_structp png, png_const_charp message) {
    static_cast<PngSink*>(png_get_error_ptr(png))->message = message;
    std::longjmp(png_jmpbuf(png), 1);
}
void on_warning(png_structp, png_const_charp) {}
void on_write(png_structp png, png_bytep data, png_size_t size) {
    if (!static_cast<PngSink*>(png_get_io_ptr(png))->take({data, size})) png_error(png, "write");
}
void on_flush(png_structp) {}

/// Returns true once everything is written. Everything that it uses is owned by the caller.
bool write_with(png_structp png, png_infop info, ImageView<const std::uint8_t> pixels, const PngStyle& style) {
    if (setjmp(png_jmpbuf(png))) return false;
    const int color = pixels.channels == 1   ? PNG_COLOR_TYPE_GRAY
                      : pixels.channels == 3 ? PNG_COLOR_TYPE_RGB
                                             : PNG_COLOR_TYPE_RGB_ALPHA;
    png_set_IHDR(png, info, png_uint_32(pixels.width), png_uint_32(pixels.height), 8, color, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (style.srgb) png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_set_compression_level(png, style.compression_level);
    png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_PAETH);
    if (style.runs) png_set_compression_strategy(png, Z_RLE);
    png_write_info(png, info);
    for (int y = 0; y < pixels.height; ++y) png_write_row(png, pixels.row(y));
    png_write_end(png, info);
    return true;
}

Result<void> write_png_to(PngSink& sink, ImageView<const std::uint8_t> pixels, const PngStyle& style) {
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &sink, on_error, on_warning);
    png_infop info = png ? png_create_info_struct(png) : nullptr;
    if (!info) {
        png_destroy_write_struct(&png, nullptr);
        return Error{"libpng could not start", "", ""};
    }
    png_set_write_fn(png, &sink, on_write, on_flush);
    const bool complete = write_with(png, info, pixels, style);
    png_destroy_write_struct(&png, &info);
    if (!complete) return Error{"libpng: " + sink.message, "", ""};
    return {};
}

}  // namespace

Result<void> write_png(const std::filesystem::path& file, ImageView<const std::uint8_t> pixels, int compression_level) {
    return write_file_atomically(file, [&](const std::filesystem::path& path) -> Result<void> {
        OutputFile out(path);
        PngSink sink{.file = &out};
        Result<void> written = write_png_to(sink, pixels, {.compression_level = compression_level});
        // The system's reason for a failed write is more useful than the fact that it failed.
        Result<void> finished = out.finish();
        return finished ? written : finished;
    });
}

Result<PngBytes> encode_png(ImageView<const std::uint8_t> pixels, int compression_level) {
    PngBytes bytes;
    PngSink sink{.memory = &bytes};
    const auto written =
        write_png_to(sink, pixels, {.srgb = false, .compression_level = compression_level, .runs = false});
    if (!written) return written.error();
    return bytes;
}

}  // namespace domelight
