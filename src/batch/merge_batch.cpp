#include "domelight/batch/batch_results.h"
#include "domelight/io/file/atomic_file.h"

#include "batch/result_store.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <set>

namespace domelight {
namespace {

namespace fs = std::filesystem;

/// A name in `out`, and what it stands for.
struct Place {
    fs::path name;    ///< below `out`
    fs::path source;  ///< a file of a result, or its folder of files
};

/// The names of one output: the folder, or each file.
std::vector<Place> places_of(const BatchJob& job, const ResultRecord& record, const ResultStore& store,
                             BatchPlacing placing) {
    const bool folder = (*find_job_kind(job.kind))->makes_folder;
    const fs::path files = store.files(job.id), output = job.output;
    if (folder && placing == BatchPlacing::link) return {{output, files}};
    std::vector<Place> places;
    for (const ResultFile& file : record.files)
        places.push_back({(folder ? output : output.parent_path()) / file.name, files / file.name});
    return places;
}

Error system_failure(const char* doing, const fs::path& path, const std::error_code& failure) {
    return {fmt::format("cannot be {}: {}", doing, failure.message()), path.string(), ""};
}

/// Puts results under names in `out`.
class Placer {
  public:
    Placer(fs::path out, BatchPlacing placing) : out_(std::move(out)), placing_(placing) {}

    /// Whether something had to be done.
    Result<bool> place(const Place& place) {
        const fs::path to = out_ / place.name;
        if (names_.contains(place.name.string()))
            return Error{"two outputs have this file", (out_ / place.name).string(), "Name one of them otherwise."};
        remember(place.name);
        // A folder that was a link must not be written through: it leads to a result.
        std::error_code failure;
        for (fs::path at = to.parent_path(); at != out_ && at.has_relative_path(); at = at.parent_path())
            if (fs::is_symlink(fs::symlink_status(at, failure))) fs::remove(at, failure);
        const fs::path link = place.source.lexically_relative(to.parent_path());
        if (is_there(to, place.source, link)) return false;
        fs::create_directories(to.parent_path(), failure);
        if (failure) return system_failure("created", to.parent_path(), failure);
        if (placing_ == BatchPlacing::copy) return copied(place.source, to);
        // A new name beside it, which then replaces the old one in one step.
        const fs::path temporary = to.string() + fmt::format(".{}.tmp", ::getpid());
        if (placing_ == BatchPlacing::link)
            fs::create_symlink(link, temporary, failure);
        else
            fs::create_hard_link(place.source, temporary, failure);
        if (failure) return system_failure("created", to, failure);
        fs::rename(temporary, to, failure);
        if (!failure) return true;
        std::error_code ignored;
        fs::remove(temporary, ignored);
        return system_failure("replaced", to, failure);
    }

    /// Removes what was placed as files of a folder that is to be a link now. Other files stay, and so does the folder.
    void unplace(const fs::path& output, const ResultRecord& record) const {
        const fs::path to = out_ / output;
        std::error_code failure;
        if (!fs::is_directory(fs::symlink_status(to, failure))) return;
        for (const ResultFile& file : record.files) fs::remove(to / file.name, failure);
        for (const ResultFile& file : record.files)
            for (fs::path at = fs::path(file.name).parent_path(); !at.empty(); at = at.parent_path())
                fs::remove(to / at, failure);  // only if it is empty
        fs::remove(to, failure);
    }

    /// Removes links of an earlier plan, and lists what else does not belong here.
    std::vector<std::string> clean() const {
        std::vector<std::string> notes;
        std::vector<fs::path> stale, folders;
        std::error_code failure;
        for (fs::recursive_directory_iterator at(out_, failure), end; !failure && at != end; at.increment(failure)) {
            const fs::path name = at->path().lexically_relative(out_);
            if (names_.contains(name.string())) continue;
            if (at->is_symlink(failure))
                stale.push_back(name);
            else if (at->is_directory(failure))
                folders.push_back(name);
            else
                notes.push_back(fmt::format("{} is not an output of this plan", (out_ / name).string()));
        }
        for (const fs::path& name : stale) {
            fs::remove(out_ / name, failure);
            notes.push_back(fmt::format("{}, a link of an earlier plan, was removed", (out_ / name).string()));
        }
        std::reverse(folders.begin(), folders.end());
        for (const fs::path& name : folders) fs::remove(out_ / name, failure);  // only if it is empty
        return notes;
    }

  private:
    void remember(fs::path name) {
        for (; !name.empty(); name = name.parent_path())
            if (!names_.insert(name.string()).second) break;
    }

    bool is_there(const fs::path& to, const fs::path& source, const fs::path& link) const {
        std::error_code failure;
        const fs::file_status status = fs::symlink_status(to, failure);
        if (placing_ == BatchPlacing::link) return fs::is_symlink(status) && fs::read_symlink(to, failure) == link;
        if (!fs::is_regular_file(status)) return false;
        if (placing_ == BatchPlacing::hardlink) return fs::equivalent(to, source, failure);
        return fs::file_size(to, failure) == fs::file_size(source, failure) &&
               fs::last_write_time(to, failure) >= fs::last_write_time(source, failure);
    }

    static Result<bool> copied(const fs::path& source, const fs::path& to) {
        std::error_code failure;
        if (fs::is_symlink(fs::symlink_status(to, failure))) fs::remove(to, failure);
        const auto write = [&](const fs::path& temporary) -> Result<void> {
            std::error_code failed;
            fs::copy_file(source, temporary, fs::copy_options::overwrite_existing, failed);
            return failed ? Result<void>(system_failure("written", to, failed)) : Result<void>();
        };
        if (auto ok = write_file_atomically(to, write); !ok) return ok.error();
        return true;
    }

    fs::path out_;
    BatchPlacing placing_;
    std::set<std::string> names_;
};

std::string index_line(const BatchJob& job, const ResultRecord& record) {
    Json files = Json::array();
    for (const ResultFile& file : record.files)
        files.push_back({{"file", file.name}, {"bytes", file.bytes}, {"sha256", file.sha256}});
    return Json{{"output", job.output}, {"job", job.id}, {"files", files}}.dump() + "\n";
}

}  // namespace

std::vector<BatchShardState> batch_shard_states(const BatchPlan& plan, const fs::path& folder, int count) {
    const ResultStore store(folder);
    std::vector<BatchShardState> states;
    for (const auto& shard : plan_shards(plan, count)) {
        BatchShardState& state = states.emplace_back();
        state.jobs = shard.size();
        for (const std::size_t index : shard) {
            const BatchJob& job = plan.jobs[index];
            if (store.find(job.id)) continue;
            ++state.left;
            state.seconds_left += job.seconds;
            state.memory = std::max(state.memory, job.memory);
        }
    }
    return states;
}

Result<BatchMerge> merge_batch(const BatchPlan& plan, const fs::path& folder, BatchPlacing placing,
                               const Progress& progress) {
    std::error_code failure;
    const fs::path batch = fs::absolute(folder, failure).lexically_normal();
    const ResultStore store(batch);
    Placer placer(batch / "out", placing);
    BatchMerge merge;
    std::string index;
    for (std::size_t i = 0; i < plan.jobs.size(); ++i) {
        const BatchJob& job = plan.jobs[i];
        if (progress && i % 64 == 0 && !progress("merge", double(i) / double(plan.jobs.size())))
            return Error{"cancelled", "", ""};
        const auto record = store.find(job.id);
        if (!record) {
            merge.missing.push_back({job.output, "has no result"});
            continue;
        }
        bool changed = false;
        if (placing == BatchPlacing::link && (*find_job_kind(job.kind))->makes_folder)
            placer.unplace(job.output, *record);
        for (const Place& place : places_of(job, *record, store, placing)) {
            const auto placed = placer.place(place);
            if (!placed) return placed.error();
            changed |= *placed;
        }
        ++(changed ? merge.placed : merge.kept);
        index += index_line(job, *record);
    }
    merge.notes = placer.clean();
    if (!merge.complete()) {
        fs::remove(batch / "index.jsonl", failure);
        return merge;
    }
    store.remove_leftovers(true);
    const auto ok = write_file_atomically(batch / "index.jsonl", index);
    return ok ? Result<BatchMerge>(std::move(merge)) : ok.error();
}

}  // namespace domelight
