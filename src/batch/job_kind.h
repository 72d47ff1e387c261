#pragma once
// The kinds of jobs: one row each in job_kind.cpp. A new kind is a file with its functions and a row.

#include "domelight/base/result.h"
#include "domelight/batch/batch_plan.h"
#include "domelight/environment/environment.h"

#include "io/file/json.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace domelight {

/// What is known of an input before a job is run.
struct InputFacts {
    std::string sha256;
    std::int64_t bytes = 0;
    /// Of the picture in it; for a file that is not a picture, guessed from its bytes.
    int width = 0, height = 0;
    bool size_known = false;
    std::int64_t texels() const { return std::int64_t(width) * height; }
};

struct JobEstimate {
    double seconds = 0;       ///< of CPU time
    std::int64_t memory = 0;  ///< bytes
};

/// A job as its kind runs it.
struct JobCall {
    std::map<std::string, std::vector<std::filesystem::path>> inputs;  ///< by their role
    Json options;
    std::string name;              ///< the last part of the output: of its folder, or of its file
    std::filesystem::path folder;  ///< exists and is empty; the job's files go there
    int threads = 1;
    const std::vector<std::filesystem::path>& files(const std::string& role) const { return inputs.at(role); }
};

/// What a job tells of its result. It does not depend on time, place or number of threads.
struct JobReport {
    std::vector<std::string> warnings;
    std::int64_t repaired = 0;  ///< bad texels of the source
    double error = -1;          ///< of the result, as `error_of` says; < 0: none is known
    std::string error_of;
    std::string preview;  ///< the file to show; empty: there is none
    /// The SHA-256 of files that the job has hashed already, by their names in its folder. Not stored here.
    std::map<std::string, std::string> hashes;
};

struct JobKind {
    const char* name;
    const char* does;
    std::vector<std::string> roles;  ///< of the inputs; each is needed unless it ends in '?'
    bool makes_folder;               ///< false: the result is one file, or several with one beginning
    /// The file that it makes, for an output of this name; empty for a folder.
    std::string (*file_name)(const Json& options, const std::string& name);
    Result<void> (*check)(const Json& options);
    JobEstimate (*estimate)(const Json& options, std::span<const InputFacts> inputs);
    Result<JobReport> (*run)(const JobCall& call);
};

/// JobKind::check for a function that reads the options into a struct of the kind's own, and checks them.
template <auto options_of>
Result<void> check_options(const Json& json) {
    const auto options = options_of(json);
    return options ? Result<void>() : options.error();
}
/// The name of a file with this ending, ".exr", which is put behind it unless it is there.
std::string with_ending(const std::string& name, const std::string& ending);
/// JobKind::file_name of a kind whose result is a folder.
std::string no_file(const Json& options, const std::string& name);
/// Adds what was repaired in an environment to a report.
void note_repairs(const Environment& environment, JobReport& report);

std::span<const JobKind> job_kinds();
/// Errors: there is no kind of that name; the error lists those that there are.
Result<const JobKind*> find_job_kind(const std::string& name);

// The kinds, each in a file of its own.
JobKind bake_kind();
JobKind convert_kind();
JobKind audit_kind();
JobKind render_kind();
JobKind probes_kind();

}  // namespace domelight
