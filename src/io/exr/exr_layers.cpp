#include "io/exr/exr_layers.h"

#include "domelight/base/parallel.h"

#include "io/exr/exr_header_reader.h"
#include "io/exr/exr_stream.h"
#include "io/file/printable.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfOpaqueAttribute.h>
#include <ImfStringAttribute.h>
#include <fmt/format.h>

#include <algorithm>

namespace domelight {

namespace {

class Layers : public ExrLayers {
  public:
    Layers(std::shared_ptr<const FileBytes> bytes, ExrPreflight preflight, const ReaderOptions& options)
        : options_(options), stream_(std::move(bytes), std::move(preflight.headers)) {}

    /// Throws OpenEXR's exceptions, like read_from().
    Result<void> open();
    int width() const override { return window_.max.x - window_.min.x + 1; }
    int height() const override { return window_.max.y - window_.min.y + 1; }
    const ExrChannels& table() const override { return *channels_; }
    std::optional<std::string> attribute(const std::string& name) const override;
    Result<ImageF> read(std::span<const std::string> names) override;

  private:
    Result<void> read_from(int part, const std::vector<std::pair<std::string, int>>& channels, ImageF& into);

    ReaderOptions options_;
    ExrStream stream_;
    std::unique_ptr<Imf::MultiPartInputFile> file_;
    Imath::Box2i window_;
    std::optional<ExrChannels> channels_;
};

Result<void> Layers::open() {
    const int threads = resolve_threads(options_.threads);
    provide_exr_threads(threads);
    file_ = std::make_unique<Imf::MultiPartInputFile>(stream_, threads > 1 ? threads : 0, false);
    channels_.emplace(exr_parts(*file_));
    if (channels_->all().empty()) return Error{"no channels that could be read", "", ""};
    window_ = file_->header(channels_->all()[0].part).displayWindow();
    const std::int64_t width = std::int64_t(window_.max.x) - window_.min.x + 1,
                       height = std::int64_t(window_.max.y) - window_.min.y + 1;
    return check_image_size(width, height);
}

std::optional<std::string> Layers::attribute(const std::string& name) const {
    const Imf::Header& header = file_->header(0);
    if (const auto* text = header.findTypedAttribute<Imf::StringAttribute>(name)) return text->value();
    // The check of the headers has replaced the types of attributes that decoding does not need.
    if (const auto* bytes = header.findTypedAttribute<Imf::OpaqueAttribute>(name))
        return std::string(&bytes->data()[0], std::size_t(std::max(bytes->dataSize(), 0)));
    return std::nullopt;
}

Result<ImageF> Layers::read(std::span<const std::string> names) {
    const std::int64_t bytes = std::int64_t(width()) * height() * std::int64_t(names.size()) * 4;
    if (bytes > options_.max_bytes)
        return Error{fmt::format("{} channels of {} x {} need {} bytes, more than the limit of {}", names.size(),
                                 width(), height(), bytes, options_.max_bytes),
                     "", ""};
    ImageF image(width(), height(), int(names.size()));
    for (int p = 0; p < file_->parts(); ++p) {
        std::vector<std::pair<std::string, int>> wanted;
        for (std::size_t i = 0; i < names.size(); ++i) {
            const ExrChannel* channel = channels_->find(names[i]);
            if (!channel) return Error{fmt::format("no channel {}", printable(names[i])), "", ""};
            const bool first = std::find(names.begin(), names.begin() + std::ptrdiff_t(i), names[i]) ==
                               names.begin() + std::ptrdiff_t(i);
            if (channel->part == p && first) wanted.emplace_back(channel->name, int(i));
        }
        if (wanted.empty()) continue;
        try {
            if (auto ok = read_from(p, wanted, image); !ok) return ok.error();
        } catch (const std::exception& e) {
            return Error{"decoding failed: " + exr_message(e), "", "The file is truncated or damaged."};
        }
    }
    // OpenEXR reads a channel into one place only.
    for (std::size_t i = 1; i < names.size(); ++i)
        if (const auto first = std::size_t(std::find(names.begin(), names.end(), names[i]) - names.begin()); first < i)
            for (int y = 0; y < image.height(); ++y)
                for (int x = 0; x < image.width(); ++x) image.at(x, y)[i] = image.at(x, y)[first];
    return image;
}

Result<void> Layers::read_from(int part, const std::vector<std::pair<std::string, int>>& channels, ImageF& into) {
    const Imf::Header& header = file_->header(part);
    if (header.displayWindow() != window_) return Error{"parts of different sizes", "", ""};
    if (!file_->partComplete(part)) return Error{"file is incomplete: some of its texels were never written", "", ""};
    const Imath::Box2i data = header.dataWindow();
    if (auto ok = check_exr_black(exr_window(window_), exr_window(data), options_); !ok) return ok;
    const bool inside = data.min.x >= window_.min.x && data.max.x <= window_.max.x && data.min.y >= window_.min.y &&
                        data.max.y <= window_.max.y;
    const std::int64_t width = std::int64_t(data.max.x) - data.min.x + 1,
                       height = std::int64_t(data.max.y) - data.min.y + 1;
    if (auto sized = check_image_size(width, height); !sized) return sized;
    const int count = int(channels.size());
    if (width * height * count * 4 > options_.max_bytes)
        return Error{"data window needs more memory than the limit", "", ""};
    // A data window that extends beyond the display window is read into a buffer and cropped.
    ImageF aside;
    if (!inside) aside = ImageF(int(width), int(height), count);
    Imf::InputPart input(*file_, part);
    Imf::FrameBuffer buffer;
    for (int i = 0; i < count; ++i) {
        const auto& [name, place] = channels[std::size_t(i)];
        const Imf::Channel* channel = header.channels().findChannel(name);
        if (channel->xSampling != 1 || channel->ySampling != 1)
            return Error{fmt::format("channel {} is subsampled", printable(name)), "", ""};
        float* first =
            inside ? into.at(data.min.x - window_.min.x, data.min.y - window_.min.y) + place : aside.row(0) + i;
        const std::size_t pixel = std::size_t(inside ? into.channels() : count) * sizeof(float);
        const std::size_t row = std::size_t(inside ? into.width() : width) * pixel;
        buffer.insert(name, Imf::Slice::Make(Imf::FLOAT, first, data.min, width, height, pixel, row));
    }
    input.setFrameBuffer(buffer);
    input.readPixels(data.min.y, data.max.y);
    if (inside) return {};
    const Imath::V2i from(std::max(data.min.x, window_.min.x), std::max(data.min.y, window_.min.y)),
        to(std::min(data.max.x, window_.max.x), std::min(data.max.y, window_.max.y));
    for (int y = from.y; y <= to.y; ++y)
        for (int x = from.x; x <= to.x; ++x)
            for (int i = 0; i < count; ++i)
                into.at(x - window_.min.x, y - window_.min.y)[channels[std::size_t(i)].second] =
                    aside.at(x - data.min.x, y - data.min.y)[i];
    return {};
}

}  // namespace

std::vector<std::string> ExrLayers::channels() const {
    std::vector<std::string> names;
    for (const ExrChannel& channel : table().all()) names.push_back(channel.full());
    return names;
}

bool ExrLayers::has(const std::string& channel) const {
    return table().find(channel) != nullptr;
}

Result<std::vector<std::string>> ExrLayers::colour_of(const std::string& layer) const {
    const auto colour = table().colour(layer);
    if (!colour) return colour.error();
    const bool grey = colour->kind == ExrColour::Kind::luminance;
    std::vector<std::string> names;
    for (int c = 0; c < 3; ++c) {
        const std::string& name = colour->names[grey ? 0 : c];
        for (const ExrChannel& channel : table().all())
            if (channel.part == colour->part && channel.name == name) names.push_back(channel.full());
    }
    if (names.size() == 3) return names;
    return Error{fmt::format("layer {} has no colour of three channels", printable(layer)), "", ""};
}

Result<std::unique_ptr<ExrLayers>> open_exr_layers(std::shared_ptr<const FileBytes> bytes,
                                                   const ReaderOptions& options) {
    Result<ExrPreflight> preflight = check_exr_headers(bytes->bytes(), options.max_bytes);
    if (!preflight) return preflight.error();
    auto layers = std::make_unique<Layers>(std::move(bytes), std::move(*preflight), options);
    try {
        if (const auto opened = layers->open(); !opened) return opened.error();
    } catch (const std::exception& e) {
        return Error{"not a readable OpenEXR file: " + exr_message(e), "", "The file is truncated or damaged."};
    }
    return std::unique_ptr<ExrLayers>(std::move(layers));
}

}  // namespace domelight
