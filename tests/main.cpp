// The test program: doctest's runner, closing with the plain line "domelight-tests: N passed, N failed, N skipped".
#define DOCTEST_CONFIG_IMPLEMENT
#include "test.h"

#include <cstdio>

namespace {

int g_cases = 0, g_failed = 0, g_skipped = 0;
bool g_current_skipped = false;

struct Counter : doctest::IReporter {
    explicit Counter(const doctest::ContextOptions&) {}
    void report_query(const doctest::QueryData&) override {}
    void test_run_start() override {}
    void test_run_end(const doctest::TestRunStats&) override {}
    void test_case_start(const doctest::TestCaseData&) override { g_current_skipped = false; }
    void test_case_reenter(const doctest::TestCaseData&) override {}
    void test_case_end(const doctest::CurrentTestCaseStats& stats) override {
        ++g_cases;
        if (stats.failure_flags)
            ++g_failed;
        else if (g_current_skipped)
            ++g_skipped;
    }
    void test_case_exception(const doctest::TestCaseException&) override {}
    void subcase_start(const doctest::SubcaseSignature&) override {}
    void subcase_end() override {}
    void log_assert(const doctest::AssertData&) override {}
    void log_message(const doctest::MessageData&) override {}
    void test_case_skipped(const doctest::TestCaseData&) override {}
};
REGISTER_LISTENER("counter", 1, Counter);

}  // namespace

namespace domelight::test {

void note_skip(const char* why) {
    g_current_skipped = true;
    std::printf("skipped: %s\n", why);
}

}  // namespace domelight::test

int main(int argc, char** argv) {
    doctest::Context context(argc, argv);
    context.setOption("no-path-filenames", true);
    const int status = context.run();
    if (context.shouldExit()) return status;
    std::printf("domelight-tests: %d passed, %d failed, %d skipped\n", g_cases - g_failed - g_skipped, g_failed,
                g_skipped);
    return status;
}
