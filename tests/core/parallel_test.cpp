#include "domelight/parallel.h"

#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <thread>
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

TEST_CASE("parallel_for: callers on several threads, and calls within calls, all get their work done") {
    std::atomic<int> sum{0};
    const auto work = [&] {
        for (int repeat = 0; repeat < 50; ++repeat)
            domelight::parallel_for(20, 3, [&](int) { ++sum; });
    };
    {
        std::jthread a(work), b(work);
        work();
    }
    CHECK(sum == 3 * 50 * 20);
    domelight::parallel_for(4, 2, [&](int) { domelight::parallel_for(5, 2, [&](int) { ++sum; }); });
    CHECK(sum == 3 * 50 * 20 + 20);
}

TEST_CASE("parallel_for: a forked child has threads of its own") {
    domelight::parallel_for(8, 2, [](int) {});
    const pid_t child = fork();
    REQUIRE(child >= 0);
    if (child == 0) {
        std::atomic<int> sum{0};
        domelight::parallel_for(100, 3, [&](int) { ++sum; });
        _exit(sum == 100 ? 0 : 1);
    }
    int status = -1;
    REQUIRE(waitpid(child, &status, 0) == child);
    CHECK(WEXITSTATUS(status) == 0);
}
