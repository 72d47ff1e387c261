#include "domelight/io/file/atomic_file.h"
#include "domelight/io/picture/animation.h"

#include <fmt/core.h>
#include <webp/encode.h>
#include <webp/mux.h>

#include <cmath>
#include <memory>

namespace domelight {
namespace {

struct Deleter {
    void operator()(WebPAnimEncoder* e) const { WebPAnimEncoderDelete(e); }
};
using Encoder = std::unique_ptr<WebPAnimEncoder, Deleter>;

/// libwebp's view of the pixels; freed with it.
class Frame {
  public:
    Frame() { made_ = WebPPictureInit(&picture_); }
    ~Frame() { WebPPictureFree(&picture_); }
    Frame(const Frame&) = delete;
    Frame& operator=(const Frame&) = delete;
    bool take(ImageView<const std::uint8_t> pixels) {
        if (!made_) return false;
        picture_.use_argb = 1;
        picture_.width = pixels.width;
        picture_.height = pixels.height;
        const int stride = int(pixels.stride);
        return pixels.channels == 4 ? WebPPictureImportRGBA(&picture_, pixels.data, stride)
                                    : WebPPictureImportRGB(&picture_, pixels.data, stride);
    }
    WebPPicture* get() { return &picture_; }

  private:
    WebPPicture picture_;
    bool made_ = false;
};

Error failed(WebPAnimEncoder* encoder) {
    const char* text = encoder ? WebPAnimEncoderGetError(encoder) : "";
    return {fmt::format("the animation cannot be encoded: {}", text && *text ? text : "out of memory"), "", ""};
}

}  // namespace

Result<void> write_webp_animation(const std::filesystem::path& file, int frames,
                                  const std::function<Result<Image<std::uint8_t>>(int)>& frame,
                                  const AnimationOptions& o) {
    if (frames < 1) return Error{"an animation needs a frame", file.string(), ""};
    WebPAnimEncoderOptions options;
    WebPConfig config;
    if (!WebPAnimEncoderOptionsInit(&options) || !WebPConfigInit(&config))
        return Error{"libwebp is of another version than its headers", file.string(), ""};
    // A key frame from time to time, so that players can seek.
    options.kmin = 9, options.kmax = 17;
    config.lossless = o.lossless;
    config.quality = o.quality;
    config.method = 4;
    config.use_sharp_yuv = 1;
    config.thread_level = 0;

    Encoder encoder;
    int width = 0, height = 0;
    const auto time_of = [&](int i) { return int(std::lround(1000.0 * i / o.frames_per_second)); };
    for (int i = 0; i < frames; ++i) {
        const auto pixels = frame(i);
        if (!pixels) return pixels.error();
        if (!encoder) {
            width = pixels->width(), height = pixels->height();
            if (std::max(width, height) > WEBP_MAX_DIMENSION)
                return Error{fmt::format("{} x {} is larger than WebP allows", width, height), file.string(),
                             "At most 16383 pixels on a side."};
            encoder.reset(WebPAnimEncoderNew(width, height, &options));
            if (!encoder) return failed(nullptr).at(file.string());
        }
        if (pixels->width() != width || pixels->height() != height)
            return Error{fmt::format("frame {} is {} x {}, the first one {} x {}", i + 1, pixels->width(),
                                     pixels->height(), width, height),
                         file.string(), ""};
        Frame picture;
        if (!picture.take(*pixels) || !WebPAnimEncoderAdd(encoder.get(), picture.get(), time_of(i), &config))
            return failed(encoder.get()).at(file.string());
    }
    if (!WebPAnimEncoderAdd(encoder.get(), nullptr, time_of(frames), nullptr))
        return failed(encoder.get()).at(file.string());
    WebPData data;
    WebPDataInit(&data);
    const std::unique_ptr<WebPData, void (*)(WebPData*)> guard(&data, WebPDataClear);
    if (!WebPAnimEncoderAssemble(encoder.get(), &data)) return failed(encoder.get()).at(file.string());
    return write_file_atomically(file, std::span(data.bytes, data.size));
}

}  // namespace domelight
