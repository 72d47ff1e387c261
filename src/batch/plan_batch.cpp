#include "domelight/base/parallel.h"
#include "domelight/base/version.h"
#include "domelight/batch/batch_plan.h"

#include "batch/job_kind.h"
#include "batch/plan_file.h"
#include "batch/plan_source.h"
#include "compare/manifest_entry.h"
#include "io/file/file_reader.h"
#include "io/file/sha256.h"
#include "io/image_reader.h"
#include "scene/scene_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <unordered_map>

namespace domelight {
namespace {

namespace fs = std::filesystem;

/// The width and height of the picture in a file; without them, those of a lat-long image of eight bytes a texel.
void find_size(std::shared_ptr<const FileBytes> bytes, InputFacts& facts) {
    ReaderOptions options;
    options.threads = 1;
    const auto reader = open_image_reader(std::move(bytes), options);
    facts.size_known = bool(reader);
    if (reader) {
        facts.width = (*reader)->facts().width;
        facts.height = (*reader)->facts().height;
    } else {
        facts.height = std::max(1, int(std::sqrt(double(facts.bytes) / 16)));
        facts.width = 2 * facts.height;
    }
}

Result<InputFacts> facts_of(const fs::path& file) {
    const auto bytes = FileBytes::open(file, k_most_file_bytes, FileKinds::regular);
    if (!bytes) return bytes.error().at(file.string());
    InputFacts facts;
    facts.bytes = std::int64_t((*bytes)->bytes().size());
    facts.sha256 = sha256((*bytes)->bytes());
    find_size(*bytes, facts);
    return facts;
}

/// Every input once, in the order of its first use.
class Inputs {
  public:
    explicit Inputs(fs::path root) : root_(std::move(root)) {}

    void add(const std::string& file) {
        if (index_.emplace(file, files_.size()).second) files_.push_back(file);
    }

    /// Errors: the inputs that cannot be read, up to ten of them.
    Result<void> read(const BatchPlanOptions& options) {
        facts_.resize(files_.size());
        std::vector<std::string> faults(files_.size());
        std::atomic<std::size_t> done{0};
        std::atomic<bool> cancelled{false};
        constexpr std::size_t block = 256;  // between two calls of `progress`
        for (std::size_t begin = 0; begin < files_.size() && !cancelled; begin += block) {
            const std::size_t count = std::min(block, files_.size() - begin);
            parallel_for(int(count), options.threads, [&](int i) {
                const std::size_t at = begin + std::size_t(i);
                auto facts = facts_of(root_ / files_[at]);
                if (facts)
                    facts_[at] = *std::move(facts);
                else
                    faults[at] = facts.error().format();
            });
            done += count;
            if (options.progress && !options.progress("read", double(done) / double(files_.size()))) cancelled = true;
        }
        if (cancelled) return Error{"cancelled", "", ""};
        return told(faults);
    }

    const InputFacts& of(const std::string& file) const { return facts_[index_.at(file)]; }

  private:
    static Result<void> told(const std::vector<std::string>& faults) {
        std::string lines;
        std::size_t count = 0;
        for (const std::string& fault : faults)
            if (!fault.empty() && ++count <= 10) lines += (lines.empty() ? "" : "\n") + fault;
        if (count == 0) return {};
        if (count > 10) lines += fmt::format("\nand {} more inputs", count - 10);
        return Error{lines, "", "A plan names only inputs that can be read."};
    }

    fs::path root_;
    std::vector<std::string> files_;
    std::unordered_map<std::string, std::size_t> index_;
    std::vector<InputFacts> facts_;
};

/// Options are checked once for all jobs that have the same.
class CheckedOptions {
  public:
    Result<void> check(const JobKind& kind, const Json& options, const std::string& text, const std::string& place) {
        const std::string key = std::string(kind.name) + text;
        if (good_.contains(key)) return {};
        if (auto ok = kind.check(options); !ok)
            return Error{(ok.error().where.empty() ? "" : ok.error().where + ": ") + ok.error().what, place,
                         ok.error().hint};
        good_.emplace(key, true);
        return {};
    }

  private:
    std::unordered_map<std::string, bool> good_;
};

/// A kind that takes a scene needs one: a file, or the name of a built-in one.
Result<void> check_scene(const JobKind& kind, const PlanEntry& entry) {
    if (std::ranges::find(kind.roles, "scene?") == kind.roles.end()) return {};
    const bool file = std::ranges::any_of(entry.inputs, [](const BatchInput& input) { return input.role == "scene"; });
    if (file != entry.options.contains("scene")) return {};
    return Error{"needs one scene", entry.place, "A file as the key \"scene\", or a built-in one as the option scene."};
}

/// Files that decide a result though no job names them: those that a scene names, and the manifest beside a bake, by
/// which an audit knows how the bake was made. Each scene is read once.
class FurtherInputs {
  public:
    explicit FurtherInputs(fs::path root) : root_(std::move(root)) {}

    Result<void> add_to(std::vector<BatchInput>& inputs) {
        for (std::size_t i = 0, count = inputs.size(); i < count; ++i) {
            const std::string role = inputs[i].role, file = inputs[i].file;
            if (role != "scene" && role != "bake") continue;
            const auto further = of(role, file);
            if (!further) return further.error();
            for (const std::string& name : **further) inputs.push_back({further_role(role), name, "", 0});
        }
        return {};
    }

  private:
    static const char* further_role(const std::string& role) { return role == "scene" ? "scene_file" : "manifest"; }

    Result<const std::vector<std::string>*> of(const std::string& role, const std::string& file) {
        const auto [known, is_new] = named_.emplace(role + " " + file, std::vector<std::string>());
        if (!is_new) return &known->second;
        if (role == "bake") {
            if (const auto entry = ManifestEntry::of(root_ / file)) {
                const fs::path& manifest = entry->manifest();
                known->second.push_back(
                    (fs::path(file).is_absolute() ? manifest : manifest.lexically_relative(root_)).generic_string());
            }
            return &known->second;
        }
        const auto files = files_named_by_scene(root_ / file);
        if (!files) return files.error();
        for (const fs::path& name : *files)
            known->second.push_back((fs::path(file).parent_path() / name).generic_string());
        return &known->second;
    }

    fs::path root_;
    std::unordered_map<std::string, std::vector<std::string>> named_;
};

}  // namespace

Result<BatchPlan> plan_batch(const fs::path& source, const BatchPlanOptions& options) {
    if (const auto kind = find_job_kind(options.kind); !kind) return kind.error();
    auto asked = read_plan_source(source, options);
    if (!asked) return asked.error();
    BatchPlan plan{version(), asked->root, {}, asked->warnings};
    Inputs inputs(asked->root);
    CheckedOptions checked;
    FurtherInputs further(asked->root);
    plan.jobs.reserve(asked->entries.size());
    for (PlanEntry& entry : asked->entries) {
        const JobKind& kind = **find_job_kind(entry.kind);
        if (auto ok = check_scene(kind, entry); !ok) return ok.error();
        BatchJob job{"", entry.kind, entry.output, std::move(entry.inputs), entry.options.dump(), 0, 0};
        if (auto ok = checked.check(kind, entry.options, job.options, entry.place); !ok) return ok.error();
        if (!kind.makes_folder)
            job.output = (fs::path(job.output).parent_path() /
                          kind.file_name(entry.options, fs::path(job.output).filename().string()))
                             .generic_string();
        if (auto ok = further.add_to(job.inputs); !ok) return ok.error();
        for (const BatchInput& input : job.inputs) inputs.add(input.file);
        plan.jobs.push_back(std::move(job));
    }
    const auto place = [&](std::size_t i) { return asked->entries[i].place; };
    if (auto ok = check_outputs(plan, place); !ok) return ok.error();
    if (auto ok = inputs.read(options); !ok) return ok.error();

    std::unordered_map<std::string, JobEstimate> estimates;
    std::size_t unknown = 0;
    for (std::size_t i = 0; i < plan.jobs.size(); ++i) {
        BatchJob& job = plan.jobs[i];
        const JobKind& kind = **find_job_kind(job.kind);
        std::vector<InputFacts> facts;
        std::string key = job.kind + job.options;
        for (BatchInput& input : job.inputs) {
            facts.push_back(inputs.of(input.file));
            input.sha256 = facts.back().sha256;
            input.bytes = facts.back().bytes;
            key += fmt::format(" {}x{}", facts.back().width, facts.back().height);
            unknown += input.role == "environment" && !facts.back().size_known;
        }
        const auto [known, is_new] = estimates.emplace(key, JobEstimate());
        if (is_new) {
            known->second = kind.estimate(asked->entries[i].options, facts);
            // As the file of the plan has it, so that shards of a plan that was read are the same.
            known->second.seconds = std::stod(fmt::format("{:.3g}", known->second.seconds));
        }
        job.seconds = known->second.seconds;
        job.memory = known->second.memory;
        job.id = job_id(job, kind.makes_folder);
    }
    if (unknown)
        plan.warnings.push_back(
            fmt::format("the size of {} environment{} is not known from a header: {} guessed from the bytes", unknown,
                        unknown == 1 ? "" : "s", unknown == 1 ? "its cost is" : "their costs are"));
    return plan;
}

std::vector<std::vector<std::size_t>> plan_shards(const BatchPlan& plan, int count) {
    std::vector<std::size_t> order(plan.jobs.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return plan.jobs[a].seconds > plan.jobs[b].seconds; });
    // A heap of (load, shard): the front has the least to do.
    std::vector<std::pair<double, int>> loads;
    for (int s = 0; s < count; ++s) loads.emplace_back(0.0, s);
    std::vector<std::vector<std::size_t>> shards(static_cast<std::size_t>(count));
    for (const std::size_t job : order) {
        std::ranges::pop_heap(loads, std::greater<>());
        shards[std::size_t(loads.back().second)].push_back(job);
        loads.back().first += plan.jobs[job].seconds;
        std::ranges::push_heap(loads, std::greater<>());
    }
    return shards;
}

}  // namespace domelight
