#include "domelight/base/parallel.h"

#include "image/repair.h"

#include <fmt/format.h>

#include <algorithm>
#include <csetjmp>
#include <cstdio>
#include <cstring>

// jpeglib.h requires <cstdio> before it.
#include "io/picture/gain_map.h"
#include "io/picture/icc_profile.h"
#include "io/picture/jpeg_segments.h"
#include "io/picture/oriented_reader.h"

#include <jerror.h>
#include <jpeglib.h>

namespace domelight {

namespace {

/// Each scan of a progressive JPEG covers the whole image. A file with more scans than any encoder writes is meant to
/// waste time.
constexpr int k_most_scans = 200;

/// A JPEG, row by row.
///
/// On an error libjpeg calls longjmp. Each method that calls libjpeg sets its own return point and has no local with a
/// destructor after that.
class JpegReader : public ImageReader {
  public:
    JpegReader(std::shared_ptr<const FileBytes> bytes, const ReaderOptions& options)
        : bytes_(std::move(bytes)), decode_(options.decode), max_bytes_(options.max_bytes), threads_(options.threads) {}
    ~JpegReader() override { jpeg_destroy_decompress(&state_); }

    Result<void> open();
    Result<bool> read(ImageView<float> rows) override;

  private:
    bool read_header();
    void set_colour();
    void add_gain_map(const std::vector<JpegSegment>& segments);
    bool start_rows();
    bool read_row(unsigned char* row);
    Error failure() const {
        return {fmt::format("not a readable JPEG: {}", message_), "", "The file is truncated or damaged."};
    }

    static void on_error(j_common_ptr state);
    static void on_message(j_common_ptr state, int level);
    static void on_progress(j_common_ptr state);

    std::shared_ptr<const FileBytes> bytes_;
    Decode decode_;
    std::int64_t max_bytes_;
    int threads_;
    jpeg_decompress_struct state_{};
    jpeg_error_mgr errors_{};
    jpeg_progress_mgr progress_{};
    std::jmp_buf return_point_;
    char message_[JMSG_LENGTH_MAX] = "";
    ScreenColour colour_;
    std::optional<GainMap> gain_map_;
    int next_row_ = 0;
    std::vector<unsigned char> row_;
};

void JpegReader::on_error(j_common_ptr state) {
    auto* self = static_cast<JpegReader*>(state->client_data);
    state->err->format_message(state, self->message_);
    std::longjmp(self->return_point_, 1);
}

/// libjpeg fills missing parts with grey and only warns; for light this is an error.
void JpegReader::on_message(j_common_ptr state, int level) {
    const int code = state->err->msg_code;
    if (level < 0 && (code == JWRN_JPEG_EOF || code == JWRN_HIT_MARKER || code == JWRN_HUFF_BAD_CODE)) on_error(state);
}

void JpegReader::on_progress(j_common_ptr state) {
    if (reinterpret_cast<j_decompress_ptr>(state)->input_scan_number <= k_most_scans) return;
    auto* self = static_cast<JpegReader*>(state->client_data);
    std::snprintf(self->message_, sizeof self->message_, "more than %d scans", k_most_scans);
    std::longjmp(self->return_point_, 1);
}

bool JpegReader::read_header() {
    state_.err = jpeg_std_error(&errors_);
    errors_.error_exit = on_error;
    errors_.emit_message = on_message;
    state_.client_data = this;
    if (setjmp(return_point_)) return false;
    jpeg_create_decompress(&state_);
    progress_.progress_monitor = on_progress;
    state_.progress = &progress_;
    jpeg_mem_src(&state_, bytes_->bytes().data(), bytes_->bytes().size());
    jpeg_read_header(&state_, TRUE);
    return true;
}

bool JpegReader::start_rows() {
    if (setjmp(return_point_)) return false;
    state_.out_color_space = JCS_RGB;
    jpeg_start_decompress(&state_);
    return state_.output_components == 3;
}

bool JpegReader::read_row(unsigned char* row) {
    if (setjmp(return_point_)) return false;
    jpeg_read_scanlines(&state_, &row, 1);
    if (state_.output_scanline == state_.output_height) jpeg_finish_decompress(&state_);
    return true;
}

/// The colours that the file's ICC profile states, unless a decoding was asked for.
void JpegReader::set_colour() {
    colour_ = colour_of_decode(decode_, 256);
    bool assumed = decode_ == Decode::automatic;
    const std::vector<JpegSegment> segments = assumed ? jpeg_segments(bytes_->bytes()) : std::vector<JpegSegment>();
    const std::vector<std::uint8_t> profile = jpeg_icc_profile(segments);
    if (!profile.empty()) {
        auto said = colour_of_icc_profile(profile, 256);
        assumed = !said;
        if (said) colour_ = *std::move(said);
        if (!said) colour_.notes.push_back(said.error().what + ": ignored");
    }
    add_gain_map(segments);
    facts_.high_dynamic_range = colour_.hdr;
    facts_.always_light = !colour_.profile;
    facts_.largest = k_largest_radiance;
    facts_.to_rec709 = colour_.to_rec709;
    facts_.warnings = screen_warnings("JPEG", colour_, assumed);
}

void JpegReader::add_gain_map(const std::vector<JpegSegment>& segments) {
    std::string note;
    gain_map_ = find_gain_map(bytes_->bytes(), segments, note);
    if (gain_map_) {
        const GainMapFormula& formula = gain_map_->formula();
        colour_.hdr = true;
        note = fmt::format("the gain map ({}) was applied: light up to {:.3g} times the white of a screen{}",
                           formula.kind, gain_map_->largest(),
                           formula.in_other_colours ? "; it is meant in other colours than the picture's" : "");
    }
    if (!note.empty()) colour_.notes.push_back(note);
}

Result<void> JpegReader::open() {
    if (!read_header()) return failure();
    const std::int64_t width = state_.image_width, height = state_.image_height;
    if (const auto sized = check_image_size(width, height); !sized) return sized.error();
    if (state_.jpeg_color_space == JCS_CMYK || state_.jpeg_color_space == JCS_YCCK)
        return Error{"JPEG of printing inks (CMYK) cannot be read", "", "Convert it to RGB first."};
    // Every block of 32 x 32 texels takes at least a bit.
    if (width * height / 1024 / 8 > std::int64_t(bytes_->bytes().size()))
        return Error{fmt::format("file ends too early: {} bytes cannot hold {} x {} texels", bytes_->bytes().size(),
                                 width, height),
                     "", "The file is truncated, or its header is wrong."};
    const std::int64_t held = jpeg_has_multiple_scans(&state_) ? width * height * state_.num_components * 2 : 0;
    if (held > max_bytes_)
        return Error{
            fmt::format("decoding {} x {} texels of a progressive JPEG needs {} bytes, more than the limit of {}",
                        width, height, held, max_bytes_),
            "", ""};
    if (!start_rows()) return failure();
    row_.resize(std::size_t(width) * 3);
    facts_.format = "JPEG";
    facts_.width = int(width);
    facts_.height = int(height);
    set_colour();
    return {};
}

Result<bool> JpegReader::read(ImageView<float> rows) {
    for (int y = 0; y < rows.height; ++y) {
        if (!read_row(row_.data())) return failure();
        float* out = rows.row(y);
        for (std::size_t i = 0; i < row_.size(); ++i) out[i] = colour_.curves[i % 3][row_[i]];
        if (colour_.profile) colour_.profile(out, rows.width);
    }
    if (gain_map_)
        parallel_for(rows.height, threads_,
                     [&](int y) { gain_map_->apply(rows.row(y), rows.width, next_row_ + y, facts_.height); });
    next_row_ += rows.height;
    return !colour_.profile;
}

}  // namespace

Result<std::unique_ptr<ImageReader>> open_jpeg_reader(std::shared_ptr<const FileBytes> bytes,
                                                      const ReaderOptions& options) {
    const int orientation = options.as_stored ? 1 : jpeg_orientation(jpeg_segments(bytes->bytes()));
    auto reader = std::make_unique<JpegReader>(std::move(bytes), options);
    if (const auto opened = reader->open(); !opened) return opened.error();
    return oriented_reader(std::move(reader), orientation, options.max_bytes);
}

}  // namespace domelight
