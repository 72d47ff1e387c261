// domelight batch slurm: an array of Slurm whose members are shards, and a job after it that merges.
#include "domelight/base/version.h"
#include "domelight/batch/batch_results.h"
#include "domelight/io/file/atomic_file.h"

#include "cli/batch/batch_words.h"
#include "cli/batch/shell_word.h"
#include "cli/console/print.h"
#include "io/file/json.h"

#include <fmt/core.h>
#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

namespace domelight::cli {
namespace {

namespace fs = std::filesystem;

/// What a program printed, without the line end. Errors: it cannot be started, or fails; they have what it printed.
Result<std::string> output_of(const std::string& command) {
    std::FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
    if (!pipe) return Error{"cannot be started", command, ""};
    std::string text;
    char piece[4096];
    while (const std::size_t n = std::fread(piece, 1, sizeof piece, pipe)) text.append(piece, n);
    const int status = ::pclose(pipe);
    while (!text.empty() && text.back() == '\n') text.pop_back();
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return text;
    return Error{text.empty() ? "failed" : text, command.substr(0, command.find(' ')),
                 "Is Slurm installed here, and does its controller answer? --no-submit writes the scripts alone."};
}

/// The largest array that the cluster takes: indices are below MaxArraySize.
Result<int> most_members() {
    const auto config = output_of("scontrol show config");
    if (!config) return config.error();
    const std::size_t at = config->find("MaxArraySize");
    const std::size_t number = at == config->npos ? at : config->find_first_of("0123456789", at);
    return number == config->npos ? 1000 : std::max(1, std::atoi(config->c_str() + number) - 1);
}

/// Indices as sbatch takes them: "1-3,7".
std::string ranges_of(const std::vector<int>& indices) {
    std::string text;
    for (std::size_t i = 0; i < indices.size();) {
        std::size_t last = i;
        while (last + 1 < indices.size() && indices[last + 1] == indices[last] + 1) ++last;
        text += fmt::format("{}{}", text.empty() ? "" : ",", indices[i]);
        if (last > i) text += fmt::format("-{}", indices[last]);
        i = last + 1;
    }
    return text;
}

/// What is asked of the cluster for the members of the array.
struct Request {
    int shards = 1, cpus = 1;
    std::vector<int> members;  ///< shards with jobs that are not done
    int minutes = 10;          ///< for the longest of them
    std::int64_t megabytes = 512;
    std::size_t jobs_left = 0;
};

/// Time: twice the estimate and ten minutes, because machines differ. Memory: as many of the largest jobs as there are
/// cores; half as much again, of which `batch run` leaves a quarter free.
Request request_of(const BatchPlan& plan, const BatchWords& w, int shards) {
    Request request{shards, w.cpus.value_or(1), {}, 10, 512, 0};
    const auto states = batch_shard_states(plan, w.plan(), shards);
    double seconds = 0;
    std::int64_t memory = 0;
    for (std::size_t s = 0; s < states.size(); ++s) {
        if (states[s].left == 0) continue;
        request.members.push_back(int(s) + 1);
        request.jobs_left += states[s].left;
        seconds = std::max(seconds, states[s].seconds_left);
        memory =
            std::max(memory, states[s].memory * std::min<std::int64_t>(request.cpus, std::int64_t(states[s].left)));
    }
    request.minutes = 10 + int(std::ceil(2 * seconds / request.cpus / 60));
    request.megabytes = 256 + (memory >> 20) * 3 / 2;
    return request;
}

fs::path own_program() {
    std::error_code failure;
    const fs::path self = fs::read_symlink("/proc/self/exe", failure);
    return failure ? fs::path("domelight") : self;
}

std::string header(const BatchWords& w, const fs::path& place, const char* log, const std::string& more) {
    std::string text = fmt::format(
        "#!/bin/sh\n# Written by domelight {} batch slurm.\n#SBATCH --job-name=domelight-{}\n"
        "#SBATCH --output={}\n#SBATCH --open-mode=append\n{}",
        version(), place.filename().string(), (place / "slurm" / log).string(), more);
    for (const std::string& option : w.sbatch) text += "#SBATCH " + option + "\n";
    return text;
}

/// No time and nothing of the members: the script is the same for a part of the array that is submitted again.
std::string array_script(const BatchWords& w, const fs::path& place, const Request& r) {
    const std::string more =
        fmt::format("#SBATCH --cpus-per-task={}\n#SBATCH --time={}\n#SBATCH --mem={}M\n#SBATCH --requeue\n", r.cpus,
                    r.minutes, r.megabytes);
    return header(w, place, "shard-%a.log", more) +
           fmt::format("exec {} batch run {} --shards {} --threads {} --help-others\n",
                       shell_word(own_program().string()), shell_word(place.string()), r.shards, r.cpus);
}

std::string merge_script(const BatchWords& w, const fs::path& place) {
    const std::string program = shell_word(own_program().string()), folder = shell_word(place.string());
    return header(w, place, "merge.log", "#SBATCH --time=60\n#SBATCH --requeue\n") +
           fmt::format("{0} batch merge {1}\nstatus=$?\n{0} batch report {1}\nexit $status\n", program, folder);
}

/// The number of shards of the array that was submitted before, and its job; 0 and empty where there is none.
std::pair<int, std::string> submitted_before(const fs::path& place) {
    const auto json = Json::read(place / "slurm/submitted.json");
    if (!json || !(*json)["shards"].is_number() || !(*json)["array"].is_string()) return {};
    return {(*json)["shards"].get<int>(), (*json)["array"].get<std::string>()};
}

/// An error while members of the array submitted before wait or run.
Result<void> check_no_array_runs(const std::string& job) {
    if (job.empty()) return {};
    const auto queue = output_of("squeue --noheader --jobs=" + shell_word(job));
    if (!queue || queue->empty()) return {};  // a job that Slurm has forgotten is an error of squeue
    return Error{fmt::format("the array {} that was submitted for it still waits or runs", job), "",
                 fmt::format("Wait for it, or end it: scancel {}", job)};
}

/// Number of the array job and of the merge job.
Result<std::pair<std::string, std::string>> submit(const fs::path& place, const Request& request) {
    const auto array = output_of(fmt::format("sbatch --parsable --array={} {}", ranges_of(request.members),
                                             shell_word((place / "slurm/array.sh").string())));
    if (!array) return array.error();
    const std::string number = array->substr(0, array->find(';'));
    const auto merge = output_of(fmt::format("sbatch --parsable --dependency=afterany:{} {}", shell_word(number),
                                             shell_word((place / "slurm/merge.sh").string())));
    if (!merge) return merge.error();
    return std::pair{number, merge->substr(0, merge->find(';'))};
}

void print_result(const BatchWords& w, const fs::path& place, const Request& r, const std::string& array,
                  const std::string& merge) {
    if (w.common.json) {
        print_document(Json{{"version", version()},
                            {"shards", r.shards},
                            {"members", ranges_of(r.members)},
                            {"jobs_left", r.jobs_left},
                            {"minutes", r.minutes},
                            {"megabytes", r.megabytes},
                            {"array", array.empty() ? Json() : Json(array)},
                            {"merge", merge.empty() ? Json() : Json(merge)}});
    } else if (!w.common.quiet) {
        print("{} jobs in shards {} of {}: {} minutes, {} MB and {} cores each\n", r.jobs_left, ranges_of(r.members),
              r.shards, r.minutes, r.megabytes, r.cpus);
        if (array.empty())
            print("  {}\n", (place / "slurm/array.sh").string());
        else
            print("array {}, merged by {}; the same command submits again what fails\n", array, merge);
    }
}

}  // namespace

int batch_slurm(const BatchWords& w) {
    for (const auto& [option, value, most] :
         {std::tuple{"--shards", w.shards, 1e6}, std::tuple{"--cpus", w.cpus, 1024.0}})
        if (value)
            if (auto ok = within(option, *value, 1, most); !ok) return print_error(ok.error(), exit_usage);
    const auto plan = read_plan(w.plan());
    if (!plan) return print_error(plan.error());
    std::error_code failure;
    const fs::path place = fs::canonical(w.plan(), failure);
    const auto [before, running] = submitted_before(place);
    int shards = w.shards.value_or(before > 0 ? before : 16);
    shards = int(std::min(std::size_t(shards), plan->jobs.size()));
    if (!w.no_submit) {
        if (auto ok = check_no_array_runs(running); !ok) return print_error(ok.error().at(w.plan()));
        const auto most = most_members();
        if (!most) return print_error(most.error());
        if (shards > *most)
            print_warnings(
                {fmt::format("the cluster takes arrays of {} members: {} shards became as many", *most, shards)},
                w.common);
        shards = std::min(shards, *most);
    }
    const Request request = request_of(*plan, w, shards);
    if (request.members.empty()) {
        if (!w.common.quiet) print("every job has its result; domelight batch merge {} puts them together\n", w.plan());
        return exit_done;
    }
    fs::create_directories(place / "slurm", failure);
    if (auto ok = write_file_atomically(place / "slurm/array.sh", array_script(w, place, request)); !ok)
        return print_error(ok.error());
    if (auto ok = write_file_atomically(place / "slurm/merge.sh", merge_script(w, place)); !ok)
        return print_error(ok.error());
    std::pair<std::string, std::string> jobs;
    if (!w.no_submit) {
        const auto submitted = submit(place, request);
        if (!submitted) return print_error(submitted.error());
        jobs = *submitted;
        const Json json{{"shards", shards}, {"array", jobs.first}, {"merge", jobs.second}};
        if (auto ok = write_file_atomically(place / "slurm/submitted.json", json.dump(1) + "\n"); !ok)
            return print_error(ok.error());
    }
    print_result(w, place, request, jobs.first, jobs.second);
    return exit_done;
}

}  // namespace domelight::cli
