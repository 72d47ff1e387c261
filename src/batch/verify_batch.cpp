#include "domelight/base/parallel.h"
#include "domelight/batch/batch_results.h"

#include "batch/job_run.h"
#include "batch/result_store.h"
#include "io/file/sha256.h"

#include <algorithm>

namespace domelight {
namespace {

namespace fs = std::filesystem;

/// What is wrong with one job; the sizes of its files are added to `sum`.
std::vector<BatchProblem> check_job(const BatchJob& job, const ResultStore& store, const fs::path& out,
                                    BatchVerification& sum) {
    const auto record = store.find(job.id);
    if (!record) return {{job.output, fs::exists(store.folder(job.id)) ? "its result is not whole" : "has no result"}};
    std::vector<BatchProblem> problems;
    const bool folder = (*find_job_kind(job.kind))->makes_folder;
    const fs::path place = folder ? fs::path(job.output) : fs::path(job.output).parent_path();
    for (const ResultFile& file : record->files) {
        sum.bytes += file.bytes;
        ++sum.files;
        const auto check = [&](const fs::path& path) {
            const auto hash = sha256_file(path);
            if (!hash)
                problems.push_back({job.output, one_line(hash.error())});
            else if (*hash != file.sha256)
                problems.push_back({job.output, path.string() + ": its contents are not those that were written"});
        };
        const fs::path stored = store.files(job.id) / file.name, placed = out / place / file.name;
        check(stored);
        std::error_code failure;
        if (fs::exists(fs::symlink_status(out, failure)) && !fs::equivalent(stored, placed, failure)) check(placed);
    }
    return problems;
}

}  // namespace

Result<BatchVerification> verify_batch(const BatchPlan& plan, const fs::path& folder, int threads,
                                       const Progress& progress) {
    const ResultStore store(folder);
    BatchVerification verification;
    constexpr std::size_t block = 64;  // jobs between two calls of `progress`
    for (std::size_t begin = 0; begin < plan.jobs.size(); begin += block) {
        const std::size_t count = std::min(block, plan.jobs.size() - begin);
        std::vector<BatchVerification> sums(count);
        parallel_for(int(count), threads, [&](int i) {
            BatchVerification& sum = sums[std::size_t(i)];
            sum.problems = check_job(plan.jobs[begin + std::size_t(i)], store, folder / "out", sum);
        });
        for (const BatchVerification& sum : sums) {
            ++verification.jobs;
            verification.files += sum.files;
            verification.bytes += sum.bytes;
            verification.problems.insert(verification.problems.end(), sum.problems.begin(), sum.problems.end());
        }
        if (progress && !progress("verify", double(begin + count) / double(plan.jobs.size())))
            return Error{"cancelled", "", ""};
    }
    return verification;
}

}  // namespace domelight
