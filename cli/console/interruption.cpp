#include "cli/console/interruption.h"

#include "cli/console/console.h"
#include "cli/console/print.h"

#include <fmt/core.h>
#include <signal.h>

#include <cstdio>

namespace domelight::cli {
namespace {

constexpr int k_signals[] = {SIGINT, SIGTERM};
volatile sig_atomic_t g_signal = 0;
struct sigaction g_before[2];

extern "C" void remember(int number) {
    // A second one: back to what was there before, which ends the program.
    if (g_signal != 0) {
        for (int i = 0; i < 2; ++i)
            if (k_signals[i] == number) ::sigaction(number, &g_before[i], nullptr);
        ::raise(number);
        return;
    }
    g_signal = number;
}

}  // namespace

Interruption::Interruption() {
    g_signal = 0;
    for (int i = 0; i < 2; ++i) {
        ::sigaction(k_signals[i], nullptr, &g_before[i]);
        if (g_before[i].sa_handler == SIG_IGN) continue;  // nohup, or in the background
        struct sigaction action = {};
        action.sa_handler = remember;
        action.sa_flags = SA_RESTART;
        sigemptyset(&action.sa_mask);
        ::sigaction(k_signals[i], &action, nullptr);
    }
}

void Interruption::restore() {
    for (int i = 0; i < 2; ++i) ::sigaction(k_signals[i], &g_before[i], nullptr);
}

Interruption::~Interruption() {
    restore();
}

bool Interruption::wanted() {
    return g_signal != 0;
}

int Interruption::end(const std::string& what) {
    print_to_stderr(fmt::format("interrupted: {}\n", escaped(what)));
    std::fflush(nullptr);
    restore();
    if (g_signal != 0) ::raise(g_signal);
    return exit_failed;
}

}  // namespace domelight::cli
