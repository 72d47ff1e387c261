#include "domelight/base/parallel.h"

#include "test.h"

#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <new>
#include <thread>
#include <vector>

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

TEST_CASE("parallel_for: many short loops in a row, of changing numbers of threads, from several threads at once") {
    std::vector<std::jthread> callers;
    std::vector<int> wrong(3, 0);
    for (int caller = 0; caller < 3; ++caller)
        callers.emplace_back([&wrong, caller] {
            for (int round = 0; round < 2000; ++round) {
                const int count = round % 7;
                std::vector<int> seen(7, 0);
                domelight::parallel_for(count, 1 + round % 5, [&](int i) { ++seen[i]; });
                for (int i = 0; i < 7; ++i) wrong[caller] += seen[i] != (i < count);
            }
        });
    callers.clear();
    for (int w : wrong) CHECK(w == 0);
}

TEST_CASE("parallel_for: what a task throws reaches the caller, whichever thread ran it") {
    for (int threads : {1, 2, 4})
        for (int at : {0, 50, 99}) {
            CHECK_THROWS_AS(domelight::parallel_for(100, threads,
                                                    [&](int i) {
                                                        if (i == at) throw std::bad_alloc();
                                                    }),
                            std::bad_alloc);
            std::atomic<int> sum{0};
            domelight::parallel_for(100, threads, [&](int i) { sum += i; });
            CHECK(sum == 4950);
        }
}

TEST_CASE("parallel_for: loops inside loops end too") {
    std::atomic<int> sum{0};
    domelight::parallel_for(4, 3, [&](int) { domelight::parallel_for(5, 2, [&](int j) { sum += j; }); });
    CHECK(sum == 40);
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
