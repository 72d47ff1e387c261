#include "domelight/base/large_allocator.h"

#include "base/aligned.h"
#include "base/large_memory.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

using namespace domelight;

TEST_CASE("large memory: reused arrays are zeroed when asked for") {
    const LargeMemoryReuse reuse;
    constexpr std::size_t count = 3 << 20;
    for (int round = 0; round < 3; ++round) {
        AlignedArray<float> array(count);
        CHECK(std::all_of(array.data(), array.data() + count, [](float v) { return v == 0; }));
        std::fill_n(array.data(), count, 7.f);
    }
    // Smaller and larger requests in between, and several alive at the same time.
    std::vector<AlignedArray<float>> arrays;
    for (std::size_t n : {count, count / 2, 2 * count, count / 3}) {
        arrays.emplace_back(n);
        CHECK(std::all_of(arrays.back().data(), arrays.back().data() + n, [](float v) { return v == 0; }));
        arrays.back()[n - 1] = 1;
    }
    arrays.erase(arrays.begin(), arrays.begin() + 2);
    AlignedArray<float> again(count / 2);
    CHECK(again[count / 2 - 1] == 0);
}

TEST_CASE("large memory: arrays may outlive the object that keeps freed ones") {
    std::vector<float, LargeAllocator<float>> kept;
    {
        const LargeMemoryReuse reuse;
        kept = std::vector<float, LargeAllocator<float>>(1 << 21, 1.f);
        std::vector<float, LargeAllocator<float>>(1 << 21, 2.f).clear();
    }
    CHECK(kept.front() == 1);
    CHECK(kept.back() == 1);
}
