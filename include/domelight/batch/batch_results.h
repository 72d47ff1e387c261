#pragma once
// What is done with the results of a batch: put together under the names of the outputs, verified, and shown on a page.

#include "domelight/base/names.h"
#include "domelight/base/progress.h"
#include "domelight/base/result.h"
#include "domelight/batch/batch_plan.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace domelight {

/// How results come under the names of the outputs.
enum class BatchPlacing {
    link,      ///< relative symbolic links to the results: no room is taken, and the folder can be moved as a whole
    hardlink,  ///< further names of the same files, for systems that do not follow links
    copy       ///< copies, which may be taken elsewhere without the batch's folder
};
template <>
struct EnumNames<BatchPlacing> {
    static constexpr const char* kind = "a way of placing results";
    static constexpr NamedValue<BatchPlacing> table[] = {
        {BatchPlacing::link, "link"},
        {BatchPlacing::hardlink, "hardlink"},
        {BatchPlacing::copy, "copy"},
    };
};

/// A job whose result is not as it should be, or something in the folder of outputs that is not.
struct BatchProblem {
    std::string output;  ///< the job's, or the path of what does not belong there
    std::string what;    ///< "has no result", "specular.ktx2: its contents are not those that were written"
};

struct BatchMerge {
    std::size_t placed = 0;             ///< outputs that were put in place now
    std::size_t kept = 0;               ///< outputs that were in place
    std::vector<BatchProblem> missing;  ///< jobs without a result: the set has holes
    std::vector<std::string> notes;     ///< what was removed, or is in the folder and not of this plan
    bool complete() const { return missing.empty(); }
};

/// Puts every result under the name of its output, in `folder`/out, and writes `folder`/index.jsonl: a line an output,
/// with its job and the size and hash of each file. Results are placed also where others are missing; index.jsonl is
/// written only where none is. Links of an earlier plan are removed; anything else in `out` stays and is told of. What
/// ended processes have left of unfinished results is removed where no job is missing.
/// Errors: those of the file system.
Result<BatchMerge> merge_batch(const BatchPlan& plan, const std::filesystem::path& folder,
                               BatchPlacing placing = BatchPlacing::link, const Progress& progress = {});

/// What a shard has still to do.
struct BatchShardState {
    std::size_t jobs = 0, left = 0;  ///< of the shard; without a result
    double seconds_left = 0;         ///< estimated CPU time of those without
    std::int64_t memory = 0;         ///< estimated bytes of the largest of them
};

/// The state of each of `count` shards, for schedulers that are asked for time and memory.
std::vector<BatchShardState> batch_shard_states(const BatchPlan& plan, const std::filesystem::path& folder, int count);

struct BatchVerification {
    std::size_t jobs = 0, files = 0;
    std::int64_t bytes = 0;
    std::vector<BatchProblem> problems;  ///< in the order of the plan
};

/// Hashes every file of every result, and of every output that is in place.
/// Errors: "cancelled".
Result<BatchVerification> verify_batch(const BatchPlan& plan, const std::filesystem::path& folder, int threads = 0,
                                       const Progress& progress = {});

/// Writes `folder`/report/index.html, a page with a picture, the times, sizes, errors and repairs of each job, which can
/// be sorted and searched, and the pictures beside it. The page loads nothing else.
/// Errors: those of writing; "cancelled".
Result<std::filesystem::path> write_batch_report(const BatchPlan& plan, const std::filesystem::path& folder,
                                                 int threads = 0, const Progress& progress = {});

}  // namespace domelight
