#include "base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "filtering/cube/sparse_pixels.simd.cpp"
// clang-format off: the order is Highway's
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
#include "filtering/cube/sparse_pixels.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace domelight::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// `channels` sums in registers.
template <int channels, int most_lanes>
HWY_INLINE void weigh(const float* pixels, const PixelRun* runs, const std::int32_t* first_run, const float* weights,
                      const std::int32_t* first_weight, int count, float* out, std::ptrdiff_t out_stride) {
    const hn::CappedTag<float, most_lanes> d;
    constexpr int lanes = int(hn::MaxLanes(d)), vectors = channels / lanes;
    for (int i = 0; i < count; ++i, out += out_stride) {
        hn::Vec<decltype(d)> sum[vectors];
        for (int v = 0; v < vectors; ++v) sum[v] = hn::Zero(d);
        const float* w = weights + first_weight[i];
        for (int r = first_run[i]; r < first_run[i + 1]; ++r) {
            const float* p = pixels + std::ptrdiff_t(runs[r].first) * channels;
            for (int k = 0; k < runs[r].count; ++k, ++w, p += channels) {
                const auto weight = hn::Set(d, *w);
                for (int v = 0; v < vectors; ++v) sum[v] = hn::MulAdd(hn::LoadU(d, p + v * lanes), weight, sum[v]);
            }
        }
        for (int v = 0; v < vectors; ++v) hn::StoreU(sum[v], d, out + v * lanes);
    }
}

void weigh_pixels(const float* pixels, int channels, const PixelRun* runs, const std::int32_t* first_run,
                  const float* weights, const std::int32_t* first_weight, int count, float* out,
                  std::ptrdiff_t out_stride) {
    if (channels == 24) return weigh<24, 8>(pixels, runs, first_run, weights, first_weight, count, out, out_stride);
    if (channels == 12) return weigh<12, 4>(pixels, runs, first_run, weights, first_weight, count, out, out_stride);
}

}  // namespace domelight::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace domelight {
namespace simd {

HWY_EXPORT(weigh_pixels);

void weigh_pixels(const float* pixels, int channels, const PixelRun* runs, const std::int32_t* first_run,
                  const float* weights, const std::int32_t* first_weight, int count, float* out,
                  std::ptrdiff_t out_stride) {
    HWY_DYNAMIC_DISPATCH(weigh_pixels)(pixels, channels, runs, first_run, weights, first_weight, count, out, out_stride);
}

}  // namespace simd

void SparsePixels::finish() {
    for (const auto& of_point : entries_) {
        first_run_.push_back(std::int32_t(runs_.size()));
        first_weight_.push_back(std::int32_t(weights_.size()));
        const Entry* before = nullptr;
        for (const Entry& entry : of_point) {
            if (!before || entry.pixel != before->pixel + 1) runs_.push_back({entry.pixel, 0});
            ++runs_.back().count;
            weights_.push_back(float(entry.weight));
            before = &entry;
        }
    }
    first_run_.push_back(std::int32_t(runs_.size()));
    first_weight_.push_back(std::int32_t(weights_.size()));
    entries_ = {};
}

}  // namespace domelight
#endif
