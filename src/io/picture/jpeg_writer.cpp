#include "domelight/io/file/atomic_file.h"
#include "domelight/io/write_image.h"

#include <fmt/format.h>

#include <csetjmp>
#include <cstdio>
#include <cstdlib>
#include <string>

// jpeglib.h requires <cstdio> before it.
#include <jpeglib.h>

namespace domelight {

namespace {

/// One picture being compressed into memory that libjpeg allocates.
///
/// On an error libjpeg calls longjmp. compress() sets the return point and has no local with a destructor.
class JpegEncoder {
  public:
    JpegEncoder() = default;
    ~JpegEncoder() {
        jpeg_destroy_compress(&state_);
        std::free(bytes_);
    }
    JpegEncoder(const JpegEncoder&) = delete;
    JpegEncoder& operator=(const JpegEncoder&) = delete;

    /// False: message() says why.
    bool compress(ImageView<const std::uint8_t> pixels, int quality);
    std::span<const std::uint8_t> bytes() const { return {bytes_, size_}; }
    const char* message() const { return message_; }

  private:
    static void on_error(j_common_ptr state) {
        auto* self = static_cast<JpegEncoder*>(state->client_data);
        state->err->format_message(state, self->message_);
        std::longjmp(self->return_point_, 1);
    }
    static void on_message(j_common_ptr, int) {}

    jpeg_compress_struct state_{};
    jpeg_error_mgr errors_{};
    std::jmp_buf return_point_;
    char message_[JMSG_LENGTH_MAX] = "";
    unsigned char* bytes_ = nullptr;
    unsigned long size_ = 0;
};

bool JpegEncoder::compress(ImageView<const std::uint8_t> pixels, int quality) {
    state_.err = jpeg_std_error(&errors_);
    errors_.error_exit = on_error;
    errors_.emit_message = on_message;
    state_.client_data = this;
    if (setjmp(return_point_)) {
        bytes_ = nullptr;  // libjpeg may have replaced and freed this buffer without notice
        return false;
    }
    jpeg_create_compress(&state_);
    jpeg_mem_dest(&state_, &bytes_, &size_);
    state_.image_width = JDIMENSION(pixels.width);
    state_.image_height = JDIMENSION(pixels.height);
    state_.input_components = pixels.channels;
    state_.in_color_space = pixels.channels == 1 ? JCS_GRAYSCALE : JCS_RGB;
    jpeg_set_defaults(&state_);
    jpeg_set_quality(&state_, quality, TRUE);
    state_.optimize_coding = TRUE;
    // Colour at full resolution: coloured edges (plots, heat maps, small lights) would smear at half of it.
    state_.comp_info[0].h_samp_factor = state_.comp_info[0].v_samp_factor = 1;
    jpeg_start_compress(&state_, TRUE);
    while (state_.next_scanline < state_.image_height) {
        JSAMPROW row = const_cast<JSAMPROW>(pixels.row(int(state_.next_scanline)));
        jpeg_write_scanlines(&state_, &row, 1);
    }
    jpeg_finish_compress(&state_);
    return true;
}

}  // namespace

Result<void> write_jpeg(const std::filesystem::path& file, ImageView<const std::uint8_t> pixels, int quality) {
    if (pixels.channels != 1 && pixels.channels != 3)
        return Error{fmt::format("a JPEG has 1 or 3 channels, not {}", pixels.channels), "",
                     "JPEG holds no opacity: write a .png."};
    if (pixels.width < 1 || pixels.height < 1 || pixels.width > JPEG_MAX_DIMENSION ||
        pixels.height > JPEG_MAX_DIMENSION)
        return Error{fmt::format("picture is {} x {}, but a JPEG's sides are from 1 to {}", pixels.width, pixels.height,
                                 JPEG_MAX_DIMENSION),
                     "", "Write a .png."};
    JpegEncoder encoder;
    if (!encoder.compress(pixels, quality)) return Error{fmt::format("libjpeg: {}", encoder.message()), "", ""};
    return write_file_atomically(file, encoder.bytes());
}

}  // namespace domelight
