#pragma once

#include "domelight/base/result.h"
#include "domelight/batch/batch_plan.h"

#include "batch/job_kind.h"
#include "io/file/json.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace domelight {

/// A file of a result.
struct ResultFile {
    std::string name;  ///< relative to the result's folder of files
    std::int64_t bytes = 0;
    std::string sha256;
};

/// done.json: what a finished job has made. Equal results have equal bytes: no times, no places.
struct ResultRecord {
    std::string job, kind;
    std::vector<ResultFile> files;  ///< sorted by name
    JobReport report;
};

/// Results by the id of their job: results/ab/abcd.../ with done.json and the folder `files`. A result appears there in
/// one step, by renaming a folder that is complete. Nothing is flushed to the disk, because that takes longer than a
/// bake: after a power cut, verify() finds what was lost.
class ResultStore {
  public:
    explicit ResultStore(std::filesystem::path batch) : batch_(std::move(batch)) {}

    std::filesystem::path folder(const std::string& job) const { return batch_ / "results" / job.substr(0, 2) / job; }
    std::filesystem::path files(const std::string& job) const { return folder(job) / "files"; }

    /// The record of a result, if it is there and every file has its size.
    std::optional<ResultRecord> find(const std::string& job) const;
    /// When the result was finished, for comparing with times of inputs.
    std::optional<std::filesystem::file_time_type> finished_at(const std::string& job) const;
    /// Errors: a file is missing, or has another size or hash than the record says.
    Result<void> verify(const ResultRecord& record) const;

    /// A new empty folder for the files of a job that this process does.
    Result<std::filesystem::path> begin(const std::string& job) const;
    /// Hashes the files that begin() gave the folder for, writes the record and moves both to their place.
    /// If another process was first, its result stays. Errors: those of the system, such as a full disk.
    Result<void> finish(const BatchJob& job, const JobReport& report) const;
    /// Removes a result.
    void remove(const std::string& job) const;
    /// Removes what begin() made and finish() did not take.
    void abandon(const std::string& job) const;
    /// Removes unfinished results of processes of this machine that have ended, or, with `all`, of any.
    /// returns  how many
    int remove_leftovers(bool all) const;

  private:
    std::filesystem::path work(const std::string& job) const;
    std::filesystem::path batch_;
};

/// The name of this machine, without characters that a file's name should not have.
std::string host_name();

}  // namespace domelight
