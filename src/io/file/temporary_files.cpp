#include "io/file/temporary_files.h"

#include "domelight/io/file/atomic_file.h"

#include <limits.h>
#include <sched.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstring>
#include <mutex>

namespace domelight {

/// A slot for one path. Slots are linked once and reused, never freed, so a signal handler may walk the list at any
/// time.
struct TemporaryFileGuard::Slot {
    enum State { k_free, k_filling, k_live };
    std::atomic<int> state{k_filling};
    Slot* next = nullptr;
    char path[PATH_MAX] = {};
    static std::atomic<Slot*> head;
};

std::atomic<TemporaryFileGuard::Slot*> TemporaryFileGuard::Slot::head{nullptr};

namespace {

/// Held while paths are written and compared; the signal handler does without.
std::mutex paths_mutex;

std::atomic<bool> ending{false};          // a signal has come, and the temporary files are being removed
std::atomic<int> files_being_created{0};  // objects of TemporaryFileCreation

/// The signals that remove the temporary files.
constexpr int k_ending_signals[] = {SIGINT, SIGTERM, SIGHUP};

}  // namespace

TemporaryFileGuard::TemporaryFileGuard(const std::string& path) {
    if (path.size() >= PATH_MAX) return;  // no system call would take it either
    const std::lock_guard lock(paths_mutex);
    for (Slot* s = Slot::head.load(); s && !slot_; s = s->next) {
        int expected = Slot::k_free;
        if (s->state.compare_exchange_strong(expected, Slot::k_filling)) slot_ = s;
    }
    if (!slot_) {
        slot_ = new Slot;
        slot_->next = Slot::head.load();
        while (!Slot::head.compare_exchange_weak(slot_->next, slot_)) {
        }
    }
    std::memcpy(slot_->path, path.c_str(), path.size() + 1);
    slot_->state.store(Slot::k_live);
}

TemporaryFileGuard::~TemporaryFileGuard() {
    if (slot_) slot_->state.store(Slot::k_free);
}

bool TemporaryFileGuard::guards(const std::string& path) {
    const std::lock_guard lock(paths_mutex);
    for (Slot* s = Slot::head.load(); s; s = s->next)
        if (s->state.load() == Slot::k_live && path == s->path) return true;
    return false;
}

// The handler waits for the threads that are creating files, so it must not run in one of them: the signals are blocked
// there. A thread that begins after the signal came waits for the end of the program.
TemporaryFileCreation::TemporaryFileCreation() {
    sigset_t ending_signals;
    sigemptyset(&ending_signals);
    for (const int signal : k_ending_signals) sigaddset(&ending_signals, signal);
    ::pthread_sigmask(SIG_BLOCK, &ending_signals, &signals_before_);
    ++files_being_created;
    if (!ending) return;
    --files_being_created;
    for (;;) ::pause();
}

TemporaryFileCreation::~TemporaryFileCreation() {
    --files_being_created;
    ::pthread_sigmask(SIG_SETMASK, &signals_before_, nullptr);
}

void remove_registered_temporaries() {
    using Slot = TemporaryFileGuard::Slot;
    for (Slot* s = Slot::head.load(); s; s = s->next)
        if (s->state.load() == Slot::k_live) ::unlink(s->path);
}

namespace {

extern "C" void remove_temporaries_and_die(int signal) {
    ending = true;
    while (files_being_created > 0) ::sched_yield();
    remove_registered_temporaries();
    // The default action (SA_RESETHAND restored it) ends the program as its parent expects of an interrupted one.
    ::raise(signal);
}

}  // namespace

void remove_temporaries_on_signals() {
    struct sigaction action = {};
    action.sa_handler = remove_temporaries_and_die;
    action.sa_flags = int(SA_RESETHAND);
    sigemptyset(&action.sa_mask);
    for (const int signal : k_ending_signals) {
        struct sigaction old = {};
        // A program started with nohup or in the background keeps ignoring the signal.
        if (::sigaction(signal, nullptr, &old) == 0 && old.sa_handler == SIG_IGN) continue;
        ::sigaction(signal, &action, nullptr);
    }
    // At a file-size limit the write then fails (EFBIG), which is reported and cleaned up, instead of the program being
    // killed.
    ::signal(SIGXFSZ, SIG_IGN);
}

}  // namespace domelight
