#include "batch/worker.h"

#include "batch/job_run.h"
#include "io/file/temporary_files.h"

#include <fmt/format.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif

#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstring>

namespace domelight {
namespace {

/// The whole text, over short writes. False: nobody reads it any more.
bool write_all(int descriptor, const std::string& text) {
    std::size_t at = 0;
    while (at < text.size()) {
        const ssize_t n = ::write(descriptor, text.data() + at, text.size() - at);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return false;
        at += std::size_t(n);
    }
    return true;
}

/// Reads more into `received`. False at the end.
bool read_more(int descriptor, std::string& received) {
    char piece[4096];
    ssize_t n;
    do n = ::read(descriptor, piece, sizeof piece);
    while (n < 0 && errno == EINTR);
    if (n <= 0) return false;
    received.append(piece, std::size_t(n));
    return true;
}

double cpu_seconds(const rusage& usage) {
    const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

rusage usage_now() {
    rusage usage = {};
    ::getrusage(RUSAGE_SELF, &usage);
    return usage;
}

std::string answer_to(const BatchPlan& plan, const ResultStore& store, std::size_t job, int threads) {
    const auto start = std::chrono::steady_clock::now();
    const double cpu = cpu_seconds(usage_now());
    bool changed = false;
    const auto ok = do_job(plan, plan.jobs[job], store, threads, changed);
    const rusage usage = usage_now();
    const Json json{{"done", bool(ok)},
                    {"changed", changed},
                    {"reason", ok ? std::string() : one_line(ok.error())},
                    {"seconds", std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()},
                    {"cpu_seconds", cpu_seconds(usage) - cpu},
                    {"peak_bytes", std::int64_t(usage.ru_maxrss) * 1024}};
    return json.dump() + "\n";
}

/// What a worker does: answers lines of "JOB THREADS" until there are no more.
[[noreturn]] void serve(const BatchPlan& plan, const ResultStore& store, int questions, int answers) {
    std::string received;
    for (;;) {
        std::size_t end;
        while ((end = received.find('\n')) == received.npos)
            if (!read_more(questions, received)) ::_exit(0);
        std::size_t job = 0;
        int threads = 1;
        const char* const last = received.data() + end;
        const auto number = std::from_chars(received.data(), last, job);
        std::from_chars(number.ptr + 1, last, threads);
        received.erase(0, end + 1);
        if (!write_all(answers, answer_to(plan, store, job, threads))) ::_exit(0);
    }
}

std::string how_it_ended(int status) {
    if (WIFSIGNALED(status)) {
        const int number = WTERMSIG(status);
        return fmt::format("its process was ended by signal {} ({}){}", number, ::strsignal(number),
                           number == SIGKILL ? ", as the system does where memory runs out" : "");
    }
    return fmt::format("its process ended with status {}", WEXITSTATUS(status));
}

}  // namespace

Result<std::unique_ptr<Worker>> Worker::start(const BatchPlan& plan, const ResultStore& store) {
    int questions[2], answers[2];
    if (::pipe(questions) != 0) return system_error("make a pipe", errno);
    if (::pipe(answers) != 0) {
        const int code = errno;
        ::close(questions[0]), ::close(questions[1]);
        return system_error("make a pipe", code);
    }
    const pid_t parent = ::getpid(), process = ::fork();
    if (process < 0) return system_error("start a process", errno);
    if (process == 0) {
#ifdef __linux__
        ::prctl(PR_SET_PDEATHSIG, SIGKILL);
#endif
        if (::getppid() != parent) ::_exit(0);
        ::signal(SIGPIPE, SIG_IGN);
        ::signal(SIGINT, SIG_IGN);  // a terminal sends it to all: the parent ends its workers
        ::close(questions[1]);
        ::close(answers[0]);
        serve(plan, store, questions[0], answers[1]);
    }
    ::close(questions[0]);
    ::close(answers[1]);
    return std::unique_ptr<Worker>(new Worker(process, questions[1], answers[0]));
}

Worker::~Worker() {
    if (questions_ >= 0) ::close(questions_);
    if (answers_ >= 0) ::close(answers_);
    if (process_ <= 0) return;
    ::kill(process_, SIGKILL);
    while (::waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
    }
}

void Worker::give(std::size_t job, int threads) {
    (void)write_all(questions_, fmt::format("{} {}\n", job, threads));
}

WorkerAnswer Worker::answer() {
    std::size_t end;
    while ((end = received_.find('\n')) == received_.npos)
        if (!read_more(answers_, received_)) {
            int status = 0;
            while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
            }
            process_ = 0;
            WorkerAnswer answer;
            answer.ended = true;
            answer.reason = how_it_ended(status);
            return answer;
        }
    const auto json = Json::parse(std::string_view(received_).substr(0, end));
    received_.erase(0, end + 1);
    WorkerAnswer answer;
    if (!json) return answer;
    answer.done = (*json)["done"].get<bool>();
    answer.changed = (*json)["changed"].get<bool>();
    answer.reason = (*json)["reason"].get<std::string>();
    answer.seconds = (*json)["seconds"].get<double>();
    answer.cpu_seconds = (*json)["cpu_seconds"].get<double>();
    answer.peak_bytes = (*json)["peak_bytes"].get<std::int64_t>();
    return answer;
}

}  // namespace domelight
