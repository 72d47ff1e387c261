#include "base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sampling/distribution/guided.simd.cpp"
// clang-format off: the order is Highway's
#include <hwy/foreach_target.h>
#include <hwy/cache_control.h>
#include <hwy/highway.h>
#include "sampling/distribution/guided_simd.h"
#include "sampling/distribution/float-inl.h"
#include <algorithm>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace domelight::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The first item from `from` on whose last quantum is xi or more: a vector of them at a time. There is one: the last
/// item's is 2^32 - 1.
HWY_INLINE int find_from(const std::uint32_t* last, int from, std::uint32_t xi) {
    const hn::CappedTag<std::uint32_t, 16> d;
    const auto target = hn::Set(d, xi);
    for (;; from += int(hn::Lanes(d))) {
        const auto found = hn::FindFirstTrue(d, hn::Not(hn::Lt(hn::LoadU(d, last + from), target)));
        if (found >= 0) return from + int(found);
    }
}

/// Items drawn, and the numbers of their densities and positions.
struct Drawn {
    alignas(64) double item[k_batch], offset[k_batch], quanta[k_batch];
    HWY_INLINE void set(int k, const std::uint32_t* last, int i, std::uint32_t xi) {
        const std::uint32_t first = last[i - 1] + 1;
        item[k] = i;
        offset[k] = double(std::int64_t(xi - first));
        quanta[k] = double(std::int64_t(last[i] - first)) + 1;
    }
};

void sample_guided(const GuidedRows& marginal, const GuidedRows& conditional, const UnitPoint* points,
                   std::size_t count, float* u, float* v, float* pdf_uv) {
    const std::uint32_t *row_last = marginal.last_of(0), *column_last[k_batch];
    const std::uint16_t *row_guide = marginal.guide_of(0), *column_guide[k_batch];
    const std::size_t stride = std::size_t(conditional.items) + 1, cells = std::size_t(conditional.cells()) + 8;
    const double width = conditional.items, height = conditional.count;
    int from[k_batch];
    Drawn rows, columns;
    for (int k = 0; k < k_batch; ++k)
        columns.item[k] = columns.offset[k] = rows.item[k] = rows.offset[k] = 0, columns.quanta[k] = rows.quanta[k] = 1;

    for (std::size_t start = 0; start < count; start += k_batch) {
        const int n = int(std::min<std::size_t>(k_batch, count - start));
        const UnitPoint* p = points + start;
        // The fetches of a batch overlap: guide cells first, then the sums that they point to.
        for (int k = 0; k < n; ++k) {
            const int j = find_from(row_last, row_guide[std::uint64_t(p[k].y) >> marginal.shift], p[k].y);
            rows.set(k, row_last, j, p[k].y);
            column_guide[k] = conditional.guide.data() + j * cells + (std::uint64_t(p[k].x) >> conditional.shift);
            column_last[k] = conditional.last.data() + 1 + j * stride;
            hwy::Prefetch(column_guide[k]);
        }
        for (int k = 0; k < n; ++k) {
            from[k] = *column_guide[k];
            hwy::Prefetch(column_last[k] + from[k] - 1);
            hwy::Prefetch(column_last[k] + from[k] + 3);
        }
        for (int k = 0; k < n; ++k) columns.set(k, column_last[k], find_from(column_last[k], from[k], p[k].x), p[k].x);

        const BatchOutput out(u + start, v + start, pdf_uv + start, n);
        store_texel_draws({columns.item, columns.offset, columns.quanta, columns.quanta, width},
                          {rows.item, rows.offset, rows.quanta, rows.quanta, height}, out);
        out.finish();
    }
}

}  // namespace domelight::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace domelight::simd {

HWY_EXPORT(sample_guided);

void sample_guided(const GuidedRows& marginal, const GuidedRows& conditional, std::span<const UnitPoint> points,
                   float* u, float* v, float* pdf_uv) {
    HWY_DYNAMIC_DISPATCH(sample_guided)(marginal, conditional, points.data(), points.size(), u, v, pdf_uv);
}

}  // namespace domelight::simd
#endif
