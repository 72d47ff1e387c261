#include "texture/block/astc_codec.h"

#include <astcenc.h>

#include <algorithm>
#include <cassert>
#include <memory>
#include <mutex>
#include <new>
#include <vector>

namespace domelight {

namespace {

/// Blocks side by side that make the image of one call.
constexpr int k_most_blocks = 16;

/// The parameters that a context is made for.
struct Purpose {
    int side;
    bool encodes;
    EncodingQuality quality;
    bool operator==(const Purpose&) const = default;
};

struct ContextDeleter {
    void operator()(astcenc_context* context) const { astcenc_context_free(context); }
};
using Context = std::unique_ptr<astcenc_context, ContextDeleter>;

float effort(EncodingQuality quality) {
    switch (quality) {
        case EncodingQuality::fast:
            return ASTCENC_PRE_FASTEST;
        case EncodingQuality::standard:
            return ASTCENC_PRE_FAST;
        case EncodingQuality::high:
            return ASTCENC_PRE_MEDIUM;
        case EncodingQuality::exhaustive:
            break;
    }
    return ASTCENC_PRE_EXHAUSTIVE;
}

Context make_context(const Purpose& purpose) {
    astcenc_config config;
    const unsigned side = unsigned(purpose.side);
    astcenc_error error =
        astcenc_config_init(ASTCENC_PRF_HDR, side, side, 1, purpose.encodes ? effort(purpose.quality) : 0,
                            purpose.encodes ? 0 : ASTCENC_FLG_DECOMPRESS_ONLY, &config);
    astcenc_context* context = nullptr;
    if (error == ASTCENC_SUCCESS) error = astcenc_context_alloc(&config, 1, &context);
    // The arguments are valid: only memory can be lacking.
    if (error != ASTCENC_SUCCESS) throw std::bad_alloc();
    return Context(context);
}

/// A context takes milliseconds to make and can be used by one thread at a time, so contexts are kept and reused.
class Contexts {
  public:
    static Contexts& instance() {
        static Contexts contexts;
        return contexts;
    }
    Context take(const Purpose& purpose) {
        {
            const std::lock_guard lock(mutex_);
            const auto at =
                std::find_if(idle_.begin(), idle_.end(), [&](const Idle& i) { return i.purpose == purpose; });
            if (at != idle_.end()) {
                Context context = std::move(at->context);
                idle_.erase(at);
                return context;
            }
        }
        return make_context(purpose);
    }
    void give_back(const Purpose& purpose, Context context) {
        const std::lock_guard lock(mutex_);
        idle_.push_back({purpose, std::move(context)});
    }

  private:
    struct Idle {
        Purpose purpose;
        Context context;
    };
    std::mutex mutex_;
    std::vector<Idle> idle_;
};

constexpr astcenc_swizzle k_straight{ASTCENC_SWZ_R, ASTCENC_SWZ_G, ASTCENC_SWZ_B, ASTCENC_SWZ_A};

/// Calls use(texel of the blocks, texel of the strip of blocks) for every texel.
template <typename Use>
void for_strip(int side, int count, Use use) {
    for (int b = 0; b < count; ++b)
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x)
                use(std::size_t((b * side + y) * side + x), std::size_t((y * count + b) * side + x));
}

void encode_strip(astcenc_context* context, int side, const float* rgb, int count, std::uint8_t* blocks) {
    std::vector<float> rgba(std::size_t(4 * side * side * count));
    for_strip(side, count, [&](std::size_t from, std::size_t to) {
        for (std::size_t c = 0; c < 3; ++c) rgba[4 * to + c] = rgb[3 * from + c];
        rgba[4 * to + 3] = 1;
    });
    void* slice = rgba.data();
    astcenc_image image{unsigned(side * count), unsigned(side), 1, ASTCENC_TYPE_F32, &slice};
    [[maybe_unused]] const astcenc_error error =
        astcenc_compress_image(context, &image, &k_straight, blocks, std::size_t(16 * count), 0);
    assert(error == ASTCENC_SUCCESS);
    astcenc_compress_reset(context);
}

void decode_strip(astcenc_context* context, int side, const std::uint8_t* blocks, int count, float* rgb) {
    std::vector<float> rgba(std::size_t(4 * side * side * count));
    void* slice = rgba.data();
    astcenc_image image{unsigned(side * count), unsigned(side), 1, ASTCENC_TYPE_F32, &slice};
    [[maybe_unused]] const astcenc_error error =
        astcenc_decompress_image(context, blocks, std::size_t(16 * count), &image, &k_straight, 0);
    assert(error == ASTCENC_SUCCESS);
    astcenc_decompress_reset(context);
    for_strip(side, count, [&](std::size_t to, std::size_t from) {
        for (std::size_t c = 0; c < 3; ++c) {
            const float v = rgba[4 * from + c];
            rgb[3 * to + c] = v == v ? v : 0;  // the codec marks what is not valid by NaN
        }
    });
}

template <typename Work>
void with_context(const Purpose& purpose, int count, Work work) {
    Context context = Contexts::instance().take(purpose);
    for (int first = 0; first < count; first += k_most_blocks)
        work(context.get(), first, std::min(k_most_blocks, count - first));
    Contexts::instance().give_back(purpose, std::move(context));
}

}  // namespace

bool has_astc_codec() {
    return true;
}

void encode_astc_hdr(int side, const float* rgb, int count, EncodingQuality quality, std::uint8_t* blocks) {
    with_context({side, true, quality}, count, [&](astcenc_context* context, int first, int here) {
        encode_strip(context, side, rgb + 3 * side * side * first, here, blocks + 16 * first);
    });
}

void decode_astc_hdr(int side, const std::uint8_t* blocks, int count, float* rgb) {
    with_context({side, false, EncodingQuality::fast}, count, [&](astcenc_context* context, int first, int here) {
        decode_strip(context, side, blocks + 16 * first, here, rgb + 3 * side * side * first);
    });
}

}  // namespace domelight
