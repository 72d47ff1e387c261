// OpenEXR by its C library, because its C++ library needs exceptions and threads. What is read, and what is said about it, is decided by the
// same functions as in io/exr/exr_reader.cpp.

#include "io/exr/exr_channels.h"
#include "io/exr/exr_facts.h"
#include "io/exr/exr_header_reader.h"
#include "io/file/printable.h"
#include "io/image_reader.h"

#include <fmt/format.h>
#include <openexr.h>

#include <algorithm>
#include <cstring>

namespace domelight {

namespace {

constexpr const char* k_damaged = "The file is truncated or damaged.";

class ExrCoreReader : public ImageReader {
  public:
    ExrCoreReader(std::shared_ptr<const FileBytes> bytes, ExrPreflight preflight, const ReaderOptions& options)
        : bytes_(std::move(bytes)), headers_(std::move(preflight.headers)), options_(options) {}
    ~ExrCoreReader() override {
        if (decoding_) exr_decoding_destroy(context_, &pipeline_);
        if (context_) exr_finish(&context_);
    }

    Result<void> open();
    Result<bool> read(ImageView<float> rows) override;

  private:
    static int64_t read_bytes(exr_const_context_t, void* self, void* out, uint64_t size, uint64_t offset,
                              exr_stream_error_func_ptr_t);
    static void on_error(exr_const_context_t context, exr_result_t code, const char* message);

    std::vector<ExrPart> parts() const;
    ExrHeader header() const;
    Result<void> check_channels() const;
    Result<void> decode_all();
    bool decode_chunk(const exr_chunk_info_t& chunk);
    Error failure(const std::string& what) const {
        return {what + (message_.empty() ? "" : ": " + printable(message_, 200)), "", k_damaged};
    }

    std::shared_ptr<const FileBytes> bytes_;
    std::vector<char> headers_;
    ReaderOptions options_;
    exr_context_t context_ = nullptr;
    exr_decode_pipeline_t pipeline_{};
    bool decoding_ = false;
    std::string message_;
    ExrColour colour_;
    ExrWindow window_{}, data_{};
    ImageF pixels_;  ///< the data window, once it has been decoded
    int next_row_ = 0;
};

int64_t ExrCoreReader::read_bytes(exr_const_context_t, void* user, void* out, uint64_t size, uint64_t offset,
                                  exr_stream_error_func_ptr_t) {
    const auto& self = *static_cast<ExrCoreReader*>(user);
    const auto all = self.bytes_->bytes();
    if (offset > all.size()) return -1;
    const std::size_t count = std::size_t(std::min<uint64_t>(size, all.size() - offset)), at = std::size_t(offset);
    std::memcpy(out, all.data() + at, count);
    // The headers are those that have been checked.
    if (at < self.headers_.size()) std::memcpy(out, self.headers_.data() + at, std::min(count, self.headers_.size() - at));
    return int64_t(count);
}

void ExrCoreReader::on_error(exr_const_context_t context, exr_result_t, const char* message) {
    void* user = nullptr;
    if (exr_get_user_data(context, &user) == EXR_ERR_SUCCESS && user)
        static_cast<ExrCoreReader*>(user)->message_ = message;
}

std::vector<ExrPart> ExrCoreReader::parts() const {
    int count = 0;
    exr_get_count(context_, &count);
    std::vector<ExrPart> parts(std::size_t(std::max(count, 0)));
    for (int p = 0; p < count; ++p) {
        ExrPart& part = parts[std::size_t(p)];
        const char* text = nullptr;
        int32_t length = 0;
        if (count > 1 && exr_get_name(context_, p, &text) == EXR_ERR_SUCCESS && text) part.name = text;
        if (exr_attr_get_string(context_, p, "view", &length, &text) == EXR_ERR_SUCCESS && text) part.view = text;
        exr_storage_t storage = EXR_STORAGE_SCANLINE;
        exr_get_storage(context_, p, &storage);
        part.deep = storage == EXR_STORAGE_DEEP_SCANLINE || storage == EXR_STORAGE_DEEP_TILED;
        const exr_attr_chlist_t* channels = nullptr;
        if (exr_get_channels(context_, p, &channels) == EXR_ERR_SUCCESS)
            for (int c = 0; c < channels->num_channels; ++c) part.channels.push_back(channels->entries[c].name.str);
    }
    return parts;
}

ExrHeader ExrCoreReader::header() const {
    ExrHeader header;
    const auto window = [](const exr_attr_box2i_t& box) { return ExrWindow{box.min.x, box.min.y, box.max.x, box.max.y}; };
    exr_attr_box2i_t box{};
    if (exr_get_display_window(context_, colour_.part, &box) == EXR_ERR_SUCCESS) header.display = window(box);
    if (exr_get_data_window(context_, colour_.part, &box) == EXR_ERR_SUCCESS) header.data = window(box);
    const exr_attr_chlist_t* channels = nullptr;
    if (exr_get_channels(context_, colour_.part, &channels) == EXR_ERR_SUCCESS)
        for (const std::string& name : colour_.names) {
            const auto* end = channels->entries + channels->num_channels;
            const auto* found = std::find_if(channels->entries, end, [&](const auto& c) { return name == c.name.str; });
            if (name.empty() || found == end) continue;
            header.half = found->pixel_type == EXR_PIXEL_HALF;
            break;
        }
    exr_envmap_t envmap{};
    if (exr_attr_get_envmap(context_, colour_.part, "envmap", &envmap) == EXR_ERR_SUCCESS)
        header.envmap = envmap == EXR_ENVMAP_CUBE ? ImageFacts::Envmap::cube : ImageFacts::Envmap::latlong;
    exr_attr_chromaticities_t c{};
    if (exr_attr_get_chromaticities(context_, colour_.part, "chromaticities", &c) == EXR_ERR_SUCCESS)
        header.primaries = ColourPrimaries{
            {c.red_x, c.red_y}, {c.green_x, c.green_y}, {c.blue_x, c.blue_y}, {c.white_x, c.white_y}};
    return header;
}

/// An error if a channel of the colour is subsampled.
Result<void> ExrCoreReader::check_channels() const {
    const exr_attr_chlist_t* channels = nullptr;
    if (exr_get_channels(context_, colour_.part, &channels) != EXR_ERR_SUCCESS) return failure("no channels");
    for (int c = 0; c < channels->num_channels; ++c) {
        const exr_attr_chlist_entry_t& channel = channels->entries[c];
        const bool read = std::find(std::begin(colour_.names), std::end(colour_.names), channel.name.str) != std::end(colour_.names);
        if (read && (channel.x_sampling != 1 || channel.y_sampling != 1))
            return Error{fmt::format("channel {} is subsampled", printable(channel.name.str)), "", ""};
    }
    return {};
}

Result<void> ExrCoreReader::open() {
    exr_context_initializer_t start = EXR_DEFAULT_CONTEXT_INITIALIZER;
    start.user_data = this;
    start.read_fn = read_bytes;
    start.size_fn = [](exr_const_context_t, void* user) {
        return int64_t(static_cast<ExrCoreReader*>(user)->bytes_->bytes().size());
    };
    start.error_handler_fn = on_error;
    if (exr_start_read(&context_, "image", &start) != EXR_ERR_SUCCESS) return failure("not a readable OpenEXR file");
    const ExrChannels channels(parts());
    auto colour = channels.colour(options_.layer);
    if (!colour) return colour.error();
    colour_ = *std::move(colour);
    if (colour_.kind == ExrColour::Kind::luminance_chroma)
        return Error{"luminance and chroma are not read by the WebAssembly module", "", "Convert the picture to RGB."};
    if (auto ok = check_channels(); !ok) return ok;
    const ExrHeader facts = header();
    const auto window = exr_picture_window(facts, options_);
    if (!window) return window.error();
    window_ = *window, data_ = facts.data;
    const std::int64_t bytes = (std::int64_t(data_[2]) - data_[0] + 1) * (std::int64_t(data_[3]) - data_[1] + 1) * 12;
    if (bytes > options_.max_bytes)
        return Error{fmt::format("decoding it needs {} bytes, more than the limit of {}", bytes, options_.max_bytes), "", ""};
    facts_ = exr_facts(facts, window_, colour_, channels);
    return {};
}

/// Decodes a chunk into pixels_.
bool ExrCoreReader::decode_chunk(const exr_chunk_info_t& chunk) {
    const bool first = !decoding_;
    if ((first ? exr_decoding_initialize(context_, colour_.part, &chunk, &pipeline_)
               : exr_decoding_update(context_, colour_.part, &chunk, &pipeline_)) != EXR_ERR_SUCCESS)
        return false;
    decoding_ = true;
    // A tile states its place from the data window's corner, a scan line its own number.
    exr_storage_t storage = EXR_STORAGE_SCANLINE;
    exr_get_storage(context_, colour_.part, &storage);
    int left = 0, top = chunk.start_y - data_[1];
    if (storage == EXR_STORAGE_TILED) {
        int32_t width = 0, height = 0;
        exr_get_tile_sizes(context_, colour_.part, 0, 0, &width, &height);
        left = chunk.start_x * width, top = chunk.start_y * height;
    }
    for (int16_t c = 0; c < pipeline_.channel_count; ++c) {
        exr_coding_channel_info_t& channel = pipeline_.channels[c];
        channel.decode_to_ptr = nullptr;
        for (int i = 0; i < 3; ++i) {
            if (colour_.names[i].empty() || colour_.names[i] != channel.channel_name) continue;
            channel.decode_to_ptr = reinterpret_cast<uint8_t*>(pixels_.at(left, top) + i);
            channel.user_pixel_stride = 3 * sizeof(float);
            channel.user_line_stride = pixels_.width() * 3 * int(sizeof(float));
            channel.user_bytes_per_element = sizeof(float);
            channel.user_data_type = EXR_PIXEL_FLOAT;
            break;
        }
    }
    if (first && exr_decoding_choose_default_routines(context_, colour_.part, &pipeline_) != EXR_ERR_SUCCESS) return false;
    return exr_decoding_run(context_, colour_.part, &pipeline_) == EXR_ERR_SUCCESS;
}

Result<void> ExrCoreReader::decode_all() {
    pixels_ = ImageF(data_[2] - data_[0] + 1, data_[3] - data_[1] + 1, 3);
    exr_storage_t storage = EXR_STORAGE_SCANLINE;
    exr_get_storage(context_, colour_.part, &storage);
    exr_chunk_info_t chunk{};
    if (storage == EXR_STORAGE_TILED) {
        int32_t columns = 0, rows = 0;
        if (exr_get_tile_counts(context_, colour_.part, 0, 0, &columns, &rows) != EXR_ERR_SUCCESS) return failure("no tiles");
        for (int y = 0; y < rows; ++y)
            for (int x = 0; x < columns; ++x)
                if (exr_read_tile_chunk_info(context_, colour_.part, x, y, 0, 0, &chunk) != EXR_ERR_SUCCESS || !decode_chunk(chunk))
                    return failure(fmt::format("decoding tile ({}, {}) failed", x, y));
    } else {
        int32_t lines = 1;
        exr_get_scanlines_per_chunk(context_, colour_.part, &lines);
        for (std::int64_t y = data_[1]; y <= data_[3]; y += lines)
            if (exr_read_scanline_chunk_info(context_, colour_.part, int(y), &chunk) != EXR_ERR_SUCCESS || !decode_chunk(chunk))
                return failure(fmt::format("decoding near row {} failed", y - window_[1]));
    }
    if (colour_.kind == ExrColour::Kind::luminance)
        for (int y = 0; y < pixels_.height(); ++y)
            for (int x = 0; x < pixels_.width(); ++x) {
                float* texel = pixels_.at(x, y);
                texel[1] = texel[2] = texel[0];
            }
    return {};
}

Result<bool> ExrCoreReader::read(ImageView<float> rows) {
    if (pixels_.width() == 0)
        if (auto ok = decode_all(); !ok) return ok.error();
    const int from = std::max(data_[0], window_[0]), to = std::min(data_[2], window_[2]);
    for (int r = 0; r < rows.height; ++r, ++next_row_) {
        const int y = window_[1] + next_row_;
        std::fill_n(rows.row(r), 3 * rows.width, 0.0f);
        if (y < data_[1] || y > data_[3]) continue;
        std::copy_n(pixels_.at(from - data_[0], y - data_[1]), 3 * (to - from + 1), rows.at(from - window_[0], r));
    }
    return false;
}

}  // namespace

Result<std::unique_ptr<ImageReader>> open_exr_reader(std::shared_ptr<const FileBytes> bytes, const ReaderOptions& options) {
    Result<ExrPreflight> preflight = check_exr_headers(bytes->bytes(), options.max_bytes);
    if (!preflight) return preflight.error();
    auto reader = std::make_unique<ExrCoreReader>(std::move(bytes), std::move(*preflight), options);
    if (const auto opened = reader->open(); !opened) return opened.error();
    return std::unique_ptr<ImageReader>(std::move(reader));
}

}  // namespace domelight
