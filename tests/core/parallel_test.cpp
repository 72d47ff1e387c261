#include "domelight/parallel.h"

#include <atomic>
#include <vector>

#include "test.h"

TEST_CASE("parallel_for: every index once, on any number of threads") {
    for (int threads : {0, 1, 2, 3, 8}) {
        std::vector<std::atomic<int>> seen(1000);
        domelight::parallel_for(1000, threads, [&](int i) { ++seen[i]; });
        for (auto& s : seen) REQUIRE(s == 1);
    }
}

TEST_CASE("parallel_ranges: pieces cover the range without overlap") {
    std::vector<int> owner(1001, 0);
    domelight::parallel_ranges(1001, 64, 3, [&](int begin, int end) {
        for (int i = begin; i < end; ++i) owner[i] += 1;
    });
    for (int o : owner) REQUIRE(o == 1);
}
