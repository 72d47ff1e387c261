#pragma once
// A batch is planned first: every job with its inputs, options, output and estimated cost, in a file that one can read,
// compare and give to any scheduler.

#include "domelight/base/progress.h"
#include "domelight/base/result.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace domelight {

/// A file that a job reads.
struct BatchInput {
    std::string role;    ///< what the job takes it for: "environment", "bake", "scene"
    std::string file;    ///< absolute, or relative to BatchPlan::root
    std::string sha256;  ///< of its contents when the plan was made
    std::int64_t bytes = 0;
};

/// One job: what `domelight COMMAND` does once, with the same bytes.
struct BatchJob {
    /// 32 hexadecimal digits: the first half of the SHA-256 of everything that decides the result's bytes, which is the
    /// version, the kind, the options, the output's name, and the name and contents of each input.
    std::string id;
    std::string kind;    ///< one of batch_kinds()
    std::string output;  ///< relative path below the batch's folder `out`: of the result's folder, or of its file
    std::vector<BatchInput> inputs;
    std::string options;      ///< a JSON object on one line, as in the manifest
    double seconds = 0;       ///< estimated CPU time
    std::int64_t memory = 0;  ///< estimated bytes of memory
};

struct BatchPlan {
    std::string version;         ///< of the library that made the plan; another version does not run it
    std::filesystem::path root;  ///< where relative inputs lie; absolute
    std::vector<BatchJob> jobs;
    /// What the plan cannot say for sure, such as that an input's size is unknown. Not stored.
    std::vector<std::string> warnings;
};

/// A kind of job, and what it does, for lists.
struct BatchKind {
    std::string name, does;
};
std::vector<BatchKind> batch_kinds();

struct BatchPlanOptions {
    std::string kind = "bake";  ///< of the environments in a folder, and of manifest entries that name none
    /// Options for every job, each a name and a value: a JSON value, or a word that is none and is taken as a text.
    /// An entry of a manifest may override them.
    std::vector<std::pair<std::string, std::string>> options;
    int threads = 0;  ///< for hashing; 0: all
    Progress progress = {};
};

/// Plans a batch. Every input is hashed once, however many jobs read it.
///
/// source   a folder: one job for each environment below it (.hdr and .exr; a folder of six faces is one environment),
///          whose output is the file's path without its ending. Or a manifest: a .jsonl file with one JSON object a
///          line, or a .json file with {"defaults": {...}, "jobs": [{...}]}. Each object has "output", the inputs of its
///          kind ("environment": a file or six; "bake"; "scene") and, optionally, "kind" and "options".
/// Errors: `source` cannot be read or holds no job; a key, kind or option that is not known; an output that is missing,
/// that leads out of the folder, that two jobs have, or that lies within another one's folder; an input that is missing.
/// Each names the line or the job.
Result<BatchPlan> plan_batch(const std::filesystem::path& source, const BatchPlanOptions& options = {});

/// Writes `folder`/plan.jsonl: a line about the plan, then one a job. Equal plans have equal bytes. Results of an earlier
/// plan in the folder stay: jobs with the same id are not done again.
Result<void> write_plan(const BatchPlan& plan, const std::filesystem::path& folder);

/// Reads what write_plan() wrote. Errors name the line: not a plan, an unknown format, a job whose id is not that of its
/// contents, outputs that two jobs have.
Result<BatchPlan> read_plan(const std::filesystem::path& folder);

/// Which jobs each of `count` shards does: the longest first, each to the shard that has the least to do so far (Graham
/// 1969), so that shards are equal in estimated cost and not in number. The same for equal plans, on any machine.
std::vector<std::vector<std::size_t>> plan_shards(const BatchPlan& plan, int count);

}  // namespace domelight
