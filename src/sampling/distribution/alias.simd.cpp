#include "base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sampling/distribution/alias.simd.cpp"
// clang-format off: the order is Highway's
#include <hwy/foreach_target.h>
#include <hwy/cache_control.h>
#include <hwy/highway.h>
#include "sampling/distribution/alias_simd.h"
#include "sampling/distribution/float-inl.h"
#include <algorithm>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace domelight::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Items drawn, their positions as offset / length, and their quanta.
struct Drawn {
    alignas(64) double item[k_batch], offset[k_batch], length[k_batch], quanta[k_batch];
};

/// One draw from the table's entry of the cell; returns the item. Selects, not branches: which part is drawn cannot be
/// guessed.
HWY_INLINE std::uint32_t choose(std::uint32_t packed, std::uint32_t xi, int split_bits, Drawn& to, int k) {
    const std::uint32_t mask = (1u << split_bits) - 1, place = xi & mask, split = packed & mask;
    const std::uint32_t alias = 0u - std::uint32_t(place >= split);  // all ones where the alias is drawn
    const std::uint32_t cell = xi >> split_bits, item = cell ^ ((cell ^ (packed >> split_bits)) & alias);
    const std::uint32_t begin = split & alias, end = split ^ ((split ^ (mask + 1)) & alias);
    to.item[k] = double(std::int64_t(item));
    to.offset[k] = double(std::int64_t(place - begin));
    to.length[k] = double(std::int64_t(end - begin));
    return item;
}

void sample_alias(const AliasRows& marginal, const AliasRows& conditional, const UnitPoint* points, std::size_t count,
                  float* u, float* v, float* pdf_uv) {
    const AliasRows::Entry* rows_entries = marginal.row(0);
    const int row_split = 32 - marginal.bits, column_split = 32 - conditional.bits;
    const double width = conditional.items, height = conditional.count;
    const AliasRows::Entry* entry[k_batch];
    Drawn rows, columns;
    for (Drawn* drawn : {&rows, &columns})
        for (int k = 0; k < k_batch; ++k)
            drawn->item[k] = drawn->offset[k] = 0, drawn->length[k] = drawn->quanta[k] = 1;

    for (std::size_t start = 0; start < count; start += k_batch) {
        const int n = int(std::min<std::size_t>(k_batch, count - start));
        const UnitPoint* p = points + start;
        for (int k = 0; k < n; ++k) {
            const std::uint32_t j =
                choose(rows_entries[p[k].y >> row_split].alias_and_split, p[k].y, row_split, rows, k);
            rows.quanta[k] = double(std::int64_t(rows_entries[j].last_quantum)) + 1;
            entry[k] = conditional.entries.data() + (std::size_t(j) << conditional.bits);
            hwy::Prefetch(entry[k] + (p[k].x >> column_split));
        }
        for (int k = 0; k < n; ++k) {
            const std::uint32_t i =
                choose(entry[k][p[k].x >> column_split].alias_and_split, p[k].x, column_split, columns, k);
            entry[k] += i;
            hwy::Prefetch(entry[k]);
        }
        for (int k = 0; k < n; ++k) columns.quanta[k] = double(std::int64_t(entry[k]->last_quantum)) + 1;

        const BatchOutput out(u + start, v + start, pdf_uv + start, n);
        store_texel_draws({columns.item, columns.offset, columns.length, columns.quanta, width},
                          {rows.item, rows.offset, rows.length, rows.quanta, height}, out);
        out.finish();
    }
}

}  // namespace domelight::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace domelight::simd {

HWY_EXPORT(sample_alias);

void sample_alias(const AliasRows& marginal, const AliasRows& conditional, std::span<const UnitPoint> points, float* u,
                  float* v, float* pdf_uv) {
    HWY_DYNAMIC_DISPATCH(sample_alias)(marginal, conditional, points.data(), points.size(), u, v, pdf_uv);
}

}  // namespace domelight::simd
#endif
