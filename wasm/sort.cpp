#include "base/sort.h"

#include <cstdint>
#include <cstring>
#include <vector>

namespace domelight {

namespace {

/// Fewer items than this are inserted one by one.
constexpr std::size_t k_few = 8;
constexpr std::size_t k_most_bytes_of_few = 128;

struct Sorting {
    std::size_t bytes;
    ComesBefore comes_before;
    const void* order;

    bool few(std::size_t count) const { return count < k_few && bytes <= k_most_bytes_of_few; }
    bool before(const std::uint8_t* a, const std::uint8_t* b) const { return comes_before(order, a, b); }

    void insert_each(std::uint8_t* items, std::size_t count) const {
        std::uint8_t held[k_most_bytes_of_few];
        for (std::size_t i = 1; i < count; ++i) {
            std::uint8_t *const item = items + i * bytes, *place = item;
            while (place != items && before(item, place - bytes)) place -= bytes;
            if (place == item) continue;
            std::memcpy(held, item, bytes);
            std::memmove(place + bytes, place, std::size_t(item - place));
            std::memcpy(place, held, bytes);
        }
    }

    /// Sorts each half, and merges: the first is copied to `spare`, which has room for half of the items.
    void sort(std::uint8_t* items, std::size_t count, std::uint8_t* spare) const {
        if (count <= 1) return;
        if (few(count)) return insert_each(items, count);
        const std::size_t half = count / 2;
        std::uint8_t *second = items + half * bytes, *const end = items + count * bytes;
        sort(items, half, spare);
        sort(second, count - half, spare);
        if (!before(second, second - bytes)) return;
        std::memcpy(spare, items, half * bytes);
        const std::uint8_t *first = spare, *const first_end = spare + half * bytes;
        for (std::uint8_t* out = items; first != first_end; out += bytes) {
            const bool later = second != end && before(second, first);
            std::memcpy(out, later ? second : first, bytes);
            if (later)
                second += bytes;
            else
                first += bytes;
        }
    }
};

}  // namespace

void sort_bytes(void* items, std::size_t count, std::size_t bytes, ComesBefore comes_before, const void* order) {
    const Sorting sorting{bytes, comes_before, order};
    std::vector<std::uint8_t> spare(sorting.few(count) ? 0 : count / 2 * bytes);
    sorting.sort(static_cast<std::uint8_t*>(items), count, spare.data());
}

}  // namespace domelight
