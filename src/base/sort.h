#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <iterator>
#include <type_traits>

namespace domelight {

#ifdef __wasm__
/// Whether `a` comes before `b`, by an order that `order` points at.
using ComesBefore = bool (*)(const void* order, const void* a, const void* b);

/// Sorts `count` items of `bytes` bytes each, which may be copied as bytes; equal items stay in their order. The
/// standard library's templates are 4 KB for each type and order; this is one function for all.
void sort_bytes(void* items, std::size_t count, std::size_t bytes, ComesBefore comes_before, const void* order);
#endif

/// Sorts items that lie one after the other, such as a vector; equal items stay in their order.
/// less(a, b): whether a comes before b.
template <typename Items, typename Less = std::less<>>
void sort_stably(Items&& items, const Less& less = {}) {
#ifdef __wasm__
    using Item = std::remove_reference_t<decltype(*std::data(items))>;
    if constexpr (std::is_trivially_copyable_v<Item>) {
        const ComesBefore comes_before = [](const void* order, const void* a, const void* b) {
            return bool((*static_cast<const Less*>(order))(*static_cast<const Item*>(a), *static_cast<const Item*>(b)));
        };
        sort_bytes(std::data(items), std::size(items), sizeof(Item), comes_before, &less);
        return;
    }
#endif
    std::stable_sort(std::begin(items), std::end(items), less);
}

/// The same, where no two items are equal or equal items are alike, so that there is one result.
template <typename Items, typename Less = std::less<>>
void sort_items(Items&& items, const Less& less = {}) {
#ifdef __wasm__
    sort_stably(items, less);
#else
    std::sort(std::begin(items), std::end(items), less);
#endif
}

}  // namespace domelight
