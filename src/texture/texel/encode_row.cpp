// Texels to bytes and back, one at a time: the plain form.
#include "texture/texel/encode_row.h"

#include "texture/texel/half.h"
#include "texture/texel/r11g11b10f.h"
#include "texture/texel/rgb9e5.h"
#include "texture/texel/rgba8_ranges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>

namespace domelight {

namespace {

template <typename T>
void store(std::uint8_t* out, T value) {
    std::memcpy(out, &value, sizeof value);
}

template <typename T>
T load(const std::uint8_t* in) {
    T value;
    std::memcpy(&value, in, sizeof value);
    return value;
}

/// One coder an encoding: whether it keeps every float, its range per channel, and the conversion of one texel (already
/// inside the range, never NaN) to bytes and back.
struct HalfCoder {
    static constexpr bool k_exact = false;
    static constexpr std::array<float, 3> k_min{-k_half_max, -k_half_max, -k_half_max},
        k_max{k_half_max, k_half_max, k_half_max};
};
struct Rgba16f : HalfCoder {
    static constexpr int k_bytes = 8, k_channels = 3;
    static void encode(const Vec3f& v, std::uint8_t* out) {
        store(out,
              std::array<std::uint16_t, 4>{half_from_float(v.x), half_from_float(v.y), half_from_float(v.z), 0x3c00});
    }
    static Vec3f decode(const std::uint8_t* in) {
        const auto h = load<std::array<std::uint16_t, 4>>(in);
        return {float_from_half(h[0]), float_from_half(h[1]), float_from_half(h[2])};
    }
};
struct Rg16f : HalfCoder {
    static constexpr int k_bytes = 4, k_channels = 2;
    static void encode(const Vec3f& v, std::uint8_t* out) {
        store(out, std::array<std::uint16_t, 2>{half_from_float(v.x), half_from_float(v.y)});
    }
    static Vec3f decode(const std::uint8_t* in) {
        const auto h = load<std::array<std::uint16_t, 2>>(in);
        return {float_from_half(h[0]), float_from_half(h[1]), 0};
    }
};
struct FloatCoder {
    static constexpr bool k_exact = true;
    static constexpr float k_top = std::numeric_limits<float>::max();
    static constexpr std::array<float, 3> k_min{-k_top, -k_top, -k_top}, k_max{k_top, k_top, k_top};
};
struct Rgba32f : FloatCoder {
    static constexpr int k_bytes = 16, k_channels = 3;
    static void encode(const Vec3f& v, std::uint8_t* out) { store(out, std::array<float, 4>{v.x, v.y, v.z, 1.0f}); }
    static Vec3f decode(const std::uint8_t* in) {
        const auto f = load<std::array<float, 4>>(in);
        return {f[0], f[1], f[2]};
    }
};
struct Rg32f : FloatCoder {
    static constexpr int k_bytes = 8, k_channels = 2;
    static void encode(const Vec3f& v, std::uint8_t* out) { store(out, std::array<float, 2>{v.x, v.y}); }
    static Vec3f decode(const std::uint8_t* in) {
        const auto f = load<std::array<float, 2>>(in);
        return {f[0], f[1], 0};
    }
};
struct R32f : FloatCoder {
    static constexpr int k_bytes = 4, k_channels = 1;
    static void encode(const Vec3f& v, std::uint8_t* out) { store(out, v.x); }
    static Vec3f decode(const std::uint8_t* in) { return {load<float>(in), 0, 0}; }
};
struct Rgb9e5 {
    static constexpr bool k_exact = false;
    static constexpr int k_bytes = 4, k_channels = 3;
    static constexpr std::array<float, 3> k_min{0, 0, 0}, k_max{k_rgb9e5_max, k_rgb9e5_max, k_rgb9e5_max};
    static void encode(const Vec3f& v, std::uint8_t* out) { store(out, rgb9e5_from_rgb(v)); }
    static Vec3f decode(const std::uint8_t* in) { return rgb_from_rgb9e5(load<std::uint32_t>(in)); }
};
struct R11g11b10f {
    static constexpr bool k_exact = false;
    static constexpr int k_bytes = 4, k_channels = 3;
    static constexpr std::array<float, 3> k_min{0, 0, 0}, k_max{k_float11_max, k_float11_max, k_float10_max};
    static void encode(const Vec3f& v, std::uint8_t* out) { store(out, r11g11b10f_from_rgb(v)); }
    static Vec3f decode(const std::uint8_t* in) { return rgb_from_r11g11b10f(load<std::uint32_t>(in)); }
};

template <Rgba8 (*from)(const Vec3f&), Vec3f (*back)(const Rgba8&)>
struct ScaledBytes {
    static constexpr bool k_exact = false;
    static constexpr int k_bytes = 4, k_channels = 3;
    static void encode(const Vec3f& v, std::uint8_t* out) { store(out, from(v)); }
    static Vec3f decode(const std::uint8_t* in) { return back(load<Rgba8>(in)); }
};
struct Rgbm : ScaledBytes<rgbm_from_rgb, rgb_from_rgbm> {
    static constexpr std::array<float, 3> k_min{0, 0, 0}, k_max{k_rgbm_max, k_rgbm_max, k_rgbm_max};
};
struct Rgbd : ScaledBytes<rgbd_from_rgb, rgb_from_rgbd> {
    static constexpr std::array<float, 3> k_min{0, 0, 0}, k_max{k_rgbd_max, k_rgbd_max, k_rgbd_max};
};
struct Rgbp : ScaledBytes<rgbp_from_rgb, rgb_from_rgbp> {
    static constexpr std::array<float, 3> k_min{0, 0, 0}, k_max{k_rgbp_max, k_rgbp_max, k_rgbp_max};
};

/// Calls `use` with the coder of `encoding`.
template <typename Use>
auto with_coder(Encoding encoding, Use use) {
    switch (encoding) {
        case Encoding::rgba16f:
            return use(Rgba16f{});
        case Encoding::rgba32f:
            return use(Rgba32f{});
        case Encoding::rgb9e5:
            return use(Rgb9e5{});
        case Encoding::r11g11b10f:
            return use(R11g11b10f{});
        case Encoding::rg16f:
            return use(Rg16f{});
        case Encoding::r32f:
            return use(R32f{});
        case Encoding::rgbm:
            return use(Rgbm{});
        case Encoding::rgbd:
            return use(Rgbd{});
        case Encoding::rgbp:
            return use(Rgbp{});
        case Encoding::rg32f:
        case Encoding::bc6h:  // these have no texels by themselves
        case Encoding::uastc_hdr:
        case Encoding::astc4x4_hdr:
        case Encoding::astc6x6_hdr:
            break;
    }
    return use(Rg32f{});
}

template <typename Coder>
Vec3f clamp_to_range(const Vec3f& v) {
    return {limit_to(v.x, Coder::k_min[0], Coder::k_max[0]), limit_to(v.y, Coder::k_min[1], Coder::k_max[1]),
            limit_to(v.z, Coder::k_min[2], Coder::k_max[2])};
}

template <typename Coder>
EncodeSums encode_row_with(const float* rgb, int count, const float* weight, float log_floor, std::uint8_t* out) {
    EncodeSums sums;
    for (int i = 0; i < count; ++i, rgb += 3, out += Coder::k_bytes) {
        const Vec3f read{rgb[0], Coder::k_channels >= 2 ? rgb[1] : 0.0f, Coder::k_channels == 3 ? rgb[2] : 0.0f};
        const Vec3f inside = clamp_to_range<Coder>(read);
        Coder::encode(inside, out);
        sums.add(read, inside, Coder::decode(out), weight[i], log_floor);
    }
    if (Coder::k_exact) sums.error = sums.norm = sums.log_error = 0;
    return sums;
}

}  // namespace

EncodeSums encode_row_scalar(Encoding encoding, const float* rgb, int count, const float* weight, float log_floor,
                             std::uint8_t* out) {
    return with_coder(encoding,
                      [&](auto coder) { return encode_row_with<decltype(coder)>(rgb, count, weight, log_floor, out); });
}

EncodeSums compare_row_scalar(const float* rgb, const float* stored, int count, const float* weight, float low,
                              float high, float log_floor) {
    EncodeSums sums;
    for (int i = 0; i < count; ++i, rgb += 3, stored += 3) {
        const Vec3f read{rgb[0], rgb[1], rgb[2]};
        const Vec3f inside{limit_to(read.x, low, high), limit_to(read.y, low, high), limit_to(read.z, low, high)};
        sums.add(read, inside, {stored[0], stored[1], stored[2]}, weight[i], log_floor);
    }
    return sums;
}

LogScale log_scale_of(std::span<const float> rgb) {
    LogScaleSums sums;
    sums.add(rgb);
    return sums.scale();
}

void LogScaleSums::add(std::span<const float> rgb) {
    count_ += rgb.size();
    if (begun_count_ > 0) {
        const std::size_t taken = std::min(rgb.size(), k_chunk - begun_count_);
        std::copy_n(rgb.begin(), taken, begun_.begin() + std::ptrdiff_t(begun_count_));
        begun_count_ += taken;
        rgb = rgb.subspan(taken);
        if (begun_count_ < k_chunk) return;
        add_chunk(begun_);
        begun_count_ = 0;
    }
    for (; rgb.size() >= k_chunk; rgb = rgb.subspan(k_chunk)) add_chunk(rgb.first(k_chunk));
    std::ranges::copy(rgb, begun_.begin());
    begun_count_ = rgb.size();
}

void LogScaleSums::add_chunk(std::span<const float> rgb) {
    // Eight sums side by side: their order is part of the result's definition, and a vector has them at once.
    constexpr std::size_t k_texels_at_once = 8;
    const auto number = [](float v) { return v == v ? v : 0.0f; };
    float part[3 * k_texels_at_once] = {}, least[3 * k_texels_at_once], most[3 * k_texels_at_once];
    std::fill(std::begin(least), std::end(least), low_);
    std::fill(std::begin(most), std::end(most), high_);
    for (std::size_t begin = 0; begin < rgb.size(); begin += 3 * k_texels_at_once) {
        const std::size_t lanes = std::min(rgb.size() - begin, 3 * k_texels_at_once);
        for (std::size_t i = 0; i < lanes; ++i) {
            const float v = number(rgb[begin + i]);
            part[i] += v;
            least[i] = v < least[i] ? v : least[i];
            most[i] = v > most[i] ? v : most[i];
        }
    }
    for (std::size_t i = 0; i < 3 * k_texels_at_once; ++i) sum_[i % 3] += double(part[i]);
    low_ = *std::min_element(std::begin(least), std::end(least));
    high_ = *std::max_element(std::begin(most), std::end(most));
}

LogScale LogScaleSums::scale() {
    add_chunk(std::span(begun_).first(begun_count_));
    begun_count_ = 0;
    const double mean =
        count_ == 0 ? 0 : (0.2126 * sum_[0] + 0.7152 * sum_[1] + 0.0722 * sum_[2]) / (double(count_) / 3);
    LogScale scale;
    if (mean > 0) scale.floor = float(1e-4 * mean);
    if (!(scale.floor > 0 && std::isfinite(scale.floor))) scale.floor = 1;
    scale.range = std::log2((std::max(high_, 0.0f) + scale.floor) / (std::max(low_, 0.0f) + scale.floor));
    return scale;
}

void encode_texels(Encoding encoding, const float* texels, int channels, int count, std::uint8_t* out) {
    with_coder(encoding, [&](auto coder) {
        using Coder = decltype(coder);
        for (int i = 0; i < count; ++i, texels += channels, out += Coder::k_bytes) {
            const Vec3f v{texels[0], channels > 1 ? texels[1] : 0.0f, channels > 2 ? texels[2] : 0.0f};
            Coder::encode(clamp_to_range<Coder>(v), out);
        }
    });
}

void decode_texels(Encoding encoding, const std::uint8_t* texels, int count, float* out) {
    with_coder(encoding, [&](auto coder) {
        using Coder = decltype(coder);
        for (int i = 0; i < count; ++i, texels += Coder::k_bytes) {
            const Vec3f v = Coder::decode(texels);
            *out++ = v.x;
            if constexpr (Coder::k_channels >= 2) *out++ = v.y;
            if constexpr (Coder::k_channels == 3) *out++ = v.z;
        }
    });
}

}  // namespace domelight
