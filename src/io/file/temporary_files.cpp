#include "io/file/temporary_files.h"

#include "domelight/io/file/atomic_file.h"

#include <fcntl.h>
#include <limits.h>
#include <sched.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstring>
#include <mutex>
#include <string_view>
#include <system_error>

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

namespace fs = std::filesystem;

namespace {

constexpr std::string_view k_owner = ".domelight-";

/// Eight hexadecimal digits for this machine and its view of processes (FNV-1a): a process of another container is
/// another one, whatever its number.
std::string place_mark() {
    std::error_code ignored;
    char host[256] = {};
    ::gethostname(host, sizeof host - 1);
    std::uint32_t hash = 2166136261u;
    for (const char c : host + fs::read_symlink("/proc/self/ns/pid", ignored).string())
        hash = (hash ^ std::uint8_t(c)) * 16777619u;
    std::string digits;
    for (int shift = 28; shift >= 0; shift -= 4) digits += "0123456789abcdef"[hash >> shift & 15];
    return digits;
}

/// The process that a temporary file's name states; 0 for any other name, and for those of another machine.
pid_t owner_of(std::string_view name, std::string_view mark) {
    const std::size_t at = name.rfind(k_owner);
    if (!name.starts_with('.') || at == name.npos) return 0;
    name.remove_prefix(at + k_owner.size());
    if (!name.starts_with(mark) || !name.substr(mark.size()).starts_with('-')) return 0;
    name.remove_prefix(mark.size() + 1);
    pid_t owner = 0;
    unsigned number = 0;
    const char* const end = name.data() + name.size();
    const auto process = std::from_chars(name.data(), end, owner);
    if (process.ec != std::errc() || process.ptr == end || *process.ptr != '-') return 0;
    const auto count = std::from_chars(process.ptr + 1, end, number);
    if (count.ec != std::errc() || !std::string_view(count.ptr, end).starts_with(".tmp")) return 0;
    return owner;
}

}  // namespace

fs::path temporary_name(const fs::path& target) {
    static std::atomic<unsigned> counter{0};
    static const std::string mark = place_mark();
    const std::string ending = target.extension().string().substr(0, 16);
    // The leading dot hides it from globs; the name is shortened so that it stays below NAME_MAX.
    return target.parent_path() / ('.' + target.filename().string().substr(0, 180) + std::string(k_owner) + mark + '-' +
                                   std::to_string(::getpid()) + '-' + std::to_string(counter++) + ".tmp" + ending);
}

Result<TemporaryFile> create_temporary(const fs::path& target) {
    for (int attempt = 0; attempt < 1000; ++attempt) {
        const std::string path = temporary_name(target).string();
        const TemporaryFileCreation creation;
        const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (descriptor < 0 && errno == EEXIST) continue;
        if (descriptor < 0) return system_error("create a file there", errno);
        struct stat old = {};
        if (::stat(target.c_str(), &old) == 0) (void)!::fchmod(descriptor, old.st_mode & 0777);
        ::close(descriptor);
        return TemporaryFile{path, std::make_unique<TemporaryFileGuard>(path)};
    }
    return system_error("create a file there", EEXIST);
}

void remove_abandoned_temporaries(const fs::path& folder) {
    const std::string mark = place_mark();
    std::error_code failure;
    for (auto entry = fs::directory_iterator(folder.empty() ? "." : folder, failure);
         !failure && entry != fs::directory_iterator(); entry.increment(failure)) {
        const pid_t owner = owner_of(entry->path().filename().string(), mark);
        struct stat about = {};
        if (owner <= 0 || ::kill(owner, 0) == 0 || errno != ESRCH) continue;
        if (::lstat(entry->path().c_str(), &about) == 0 && S_ISREG(about.st_mode) && about.st_uid == ::geteuid())
            ::unlink(entry->path().c_str());
    }
}

Error system_error(const char* doing, int code) {
    return {std::string("cannot ") + doing + ": " + std::generic_category().message(code), "", ""};
}

bool is_device(const fs::file_status& status) {
    return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

Result<fs::path> end_of_links(fs::path file) {
    constexpr int k_most_links = 40;  // as many as Linux follows
    std::error_code failure;
    for (int links = 0; fs::is_symlink(fs::symlink_status(file, failure)); ++links) {
        if (links == k_most_links) return system_error("follow its links", ELOOP);
        const fs::path next = fs::read_symlink(file, failure);
        if (failure) return system_error("follow its links", failure.value());
        file = file.parent_path() / next;  // `next` alone where that is absolute
    }
    return file;
}

}  // namespace domelight
