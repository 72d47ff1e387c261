#include "io/file/temporary_files.h"

#include "domelight/io/file/atomic_file.h"

#include <limits.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstring>

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

TemporaryFileGuard::TemporaryFileGuard(const std::string& path) {
    if (path.size() >= PATH_MAX) return;  // no system call would accept it either
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

void remove_registered_temporaries() {
    using Slot = TemporaryFileGuard::Slot;
    for (Slot* s = Slot::head.load(); s; s = s->next)
        if (s->state.load() == Slot::k_live) ::unlink(s->path);
}

namespace {

extern "C" void remove_temporaries_and_die(int signal) {
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
    for (int signal : {SIGINT, SIGTERM, SIGHUP}) {
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
