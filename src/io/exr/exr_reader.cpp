#include "domelight/base/parallel.h"

#include "io/exr/exr_channels.h"
#include "io/exr/exr_facts.h"
#include "io/exr/exr_header_reader.h"
#include "io/exr/exr_stream.h"
#include "io/file/printable.h"
#include "io/image_reader.h"

#include <ImfChannelList.h>
#include <ImfChromaticitiesAttribute.h>
#include <ImfEnvmapAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfRgbaFile.h>
#include <ImfStandardAttributes.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

namespace domelight {

namespace {

class ExrReader : public ImageReader {
  public:
    ExrReader(std::shared_ptr<const FileBytes> bytes, ExrPreflight preflight, const ReaderOptions& options)
        : options_(options), threads_(resolve_threads(options.threads)), stream_(bytes, std::move(preflight.headers)) {}

    /// Throws OpenEXR's exceptions.
    Result<void> open();
    Result<bool> read(ImageView<float> rows) override;

  private:
    ExrHeader facts_of(const Imf::Header& header) const;
    void read_rgb(ImageView<float> rows, int y);
    void read_luminance_chroma(ImageView<float> rows, int y);

    ReaderOptions options_;
    int threads_;
    ExrStream stream_;
    std::unique_ptr<Imf::MultiPartInputFile> file_;
    std::unique_ptr<Imf::InputPart> part_;
    std::unique_ptr<Imf::RgbaInputFile> rgba_;  // luminance-chroma: the library upsamples
    ExrColour colour_;
    Imath::Box2i window_;  // of the picture that is read
    Imath::Box2i data_;    // of the texels in the file
    int next_row_ = 0;
    bool fills_rows_ = false;  // every value of the picture is in the file
    ImageF band_;              // if the data window extends beyond the picture
    std::vector<Imf::Rgba> rgba_band_;
};

Result<void> ExrReader::open() {
    provide_exr_threads(threads_);
    const int line_threads = threads_ > 1 ? threads_ : 0;
    file_ = std::make_unique<Imf::MultiPartInputFile>(stream_, line_threads, false);
    const ExrChannels channels(exr_parts(*file_));
    auto colour = channels.colour(options_.layer);
    if (!colour) return colour.error();
    colour_ = *std::move(colour);
    const Imf::Header header = file_->header(colour_.part);
    if (!file_->partComplete(colour_.part))
        return Error{"file is incomplete: some of its texels were never written", "", ""};

    const ExrHeader facts = facts_of(header);
    const auto window = exr_picture_window(facts, options_);
    if (!window) return window.error();
    data_ = header.dataWindow();
    window_ = Imath::Box2i({(*window)[0], (*window)[1]}, {(*window)[2], (*window)[3]});

    if (colour_.kind == ExrColour::Kind::luminance_chroma) {
        if (colour_.part != 0) return Error{"luminance and chroma are read from the first part only", "", ""};
        file_.reset();
        stream_.seekg(0);
        const std::string& y = colour_.names[0];  // "Y", or "layer.Y"
        rgba_ = std::make_unique<Imf::RgbaInputFile>(stream_, y.substr(0, std::max(y.size(), std::size_t(2)) - 2),
                                                     line_threads);
    } else {
        for (const std::string& name : colour_.names) {
            const Imf::Channel* channel = header.channels().findChannel(name);
            if (channel && (channel->xSampling != 1 || channel->ySampling != 1))
                return Error{fmt::format("channel {} is subsampled", printable(name)), "", ""};
        }
        part_ = std::make_unique<Imf::InputPart>(*file_, colour_.part);
    }
    fills_rows_ = exr_is_filled(colour_, *window, facts.data);
    facts_ = exr_facts(facts, *window, colour_, channels);
    return {};
}

/// What the header of the part states.
ExrHeader ExrReader::facts_of(const Imf::Header& header) const {
    ExrHeader facts;
    facts.display = exr_window(header.displayWindow());
    facts.data = exr_window(header.dataWindow());
    const Imf::Channel* first = nullptr;
    for (const std::string& name : colour_.names)
        if (!first && !name.empty()) first = header.channels().findChannel(name);
    // OpenEXR turns luminance and chroma into half floats.
    facts.half = colour_.kind == ExrColour::Kind::luminance_chroma || (first && first->type == Imf::HALF);
    if (Imf::hasEnvmap(header))
        facts.envmap =
            Imf::envmap(header) == Imf::ENVMAP_CUBE ? ImageFacts::Envmap::cube : ImageFacts::Envmap::latlong;
    if (Imf::hasChromaticities(header)) {
        const Imf::Chromaticities& c = Imf::chromaticities(header);
        const auto xy = [](const Imath::V2f& v) { return ColourPrimaries::Xy{v.x, v.y}; };
        facts.primaries = ColourPrimaries{xy(c.red), xy(c.green), xy(c.blue), xy(c.white)};
    }
    return facts;
}

/// Rows y .. of the file, all of them within the data window, into `rows` (window_ wide).
void ExrReader::read_rgb(ImageView<float> rows, int y) {
    const bool inside = data_.min.x >= window_.min.x && data_.max.x <= window_.max.x;
    const int data_width = data_.max.x - data_.min.x + 1;
    if (!inside && (band_.width() != data_width || band_.height() < rows.height))
        band_ = ImageF(data_width, rows.height, 3);
    const ImageView<float> target = inside ? rows : band_.view();
    float* first = target.data + (inside ? 3 * (data_.min.x - window_.min.x) : 0);

    Imf::FrameBuffer buffer;
    const bool grey = colour_.kind == ExrColour::Kind::luminance;
    for (int c = 0; c < (grey ? 1 : 3); ++c)
        if (!colour_.names[c].empty())
            buffer.insert(colour_.names[c],
                          Imf::Slice::Make(Imf::FLOAT, first + c, Imath::V2i(data_.min.x, y), data_width, rows.height,
                                           3 * sizeof(float), std::size_t(target.stride) * sizeof(float)));
    part_->setFrameBuffer(buffer);
    part_->readPixels(y, y + rows.height - 1);

    const int from = std::max(data_.min.x, window_.min.x), to = std::min(data_.max.x, window_.max.x);
    for (int r = 0; r < rows.height; ++r) {
        float* out = rows.row(r) + 3 * std::ptrdiff_t(from - window_.min.x);
        if (!inside) std::copy_n(band_.row(r) + 3 * std::ptrdiff_t(from - data_.min.x), 3 * (to - from + 1), out);
        if (grey)
            for (int x = 0; x <= to - from; ++x) out[3 * x + 1] = out[3 * x + 2] = out[3 * x];
    }
}

void ExrReader::read_luminance_chroma(ImageView<float> rows, int y) {
    const int data_width = data_.max.x - data_.min.x + 1;
    rgba_band_.resize(std::size_t(data_width) * rows.height);
    rgba_->setFrameBuffer(rgba_band_.data() - data_.min.x - std::ptrdiff_t(y) * data_width, 1, std::size_t(data_width));
    rgba_->readPixels(y, y + rows.height - 1);
    const int from = std::max(data_.min.x, window_.min.x), to = std::min(data_.max.x, window_.max.x);
    for (int r = 0; r < rows.height; ++r)
        for (int x = from; x <= to; ++x) {
            const Imf::Rgba& texel = rgba_band_[std::size_t(r) * data_width + (x - data_.min.x)];
            float* out = rows.at(x - window_.min.x, r);
            out[0] = texel.r, out[1] = texel.g, out[2] = texel.b;
        }
}

Result<bool> ExrReader::read(ImageView<float> rows) {
    // Where every value is decoded, nothing is written before: a truncated file fails with little memory touched.
    if (!fills_rows_)
        for (int r = 0; r < rows.height; ++r) std::fill_n(rows.row(r), 3 * rows.width, 0.0f);
    const int first = std::max(window_.min.y + next_row_, data_.min.y);
    const int last = std::min(window_.min.y + next_row_ + rows.height - 1, data_.max.y);
    try {
        if (first <= last) {
            const ImageView<float> part = rows.rows(first - window_.min.y - next_row_, last - first + 1);
            rgba_ ? read_luminance_chroma(part, first) : read_rgb(part, first);
        }
    } catch (const std::exception& e) {
        return Error{fmt::format("decoding near row {} failed: {}", next_row_, exr_message(e)), "",
                     "The file is truncated or damaged."};
    }
    next_row_ += rows.height;
    return false;
}

}  // namespace

Result<std::unique_ptr<ImageReader>> open_exr_reader(std::shared_ptr<const FileBytes> bytes,
                                                     const ReaderOptions& options) {
    Result<ExrPreflight> preflight = check_exr_headers(bytes->bytes(), options.max_bytes);
    if (!preflight) return preflight.error();
    auto reader = std::make_unique<ExrReader>(std::move(bytes), std::move(*preflight), options);
    try {
        if (const auto opened = reader->open(); !opened) return opened.error();
    } catch (const std::exception& e) {
        return Error{fmt::format("not a readable OpenEXR file: {}", exr_message(e)), "",
                     "The file is truncated or damaged."};
    }
    return std::unique_ptr<ImageReader>(std::move(reader));
}

}  // namespace domelight
