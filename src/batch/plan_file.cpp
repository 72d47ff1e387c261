#include "batch/plan_file.h"

#include "domelight/base/version.h"
#include "domelight/io/file/atomic_file.h"

#include "batch/job_kind.h"
#include "io/file/output_place.h"
#include "io/file/sha256.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <numeric>

namespace domelight {
namespace {

namespace fs = std::filesystem;

constexpr int k_plan_format = 1;

Json header(const BatchPlan& plan) {
    return {{"domelight_batch", k_plan_format},
            {"version", plan.version},
            {"root", plan.root.string()},
            {"jobs", plan.jobs.size()}};
}

/// One line. The options stand in it as they are: they are one line of JSON already.
std::string line_of(const BatchJob& job) {
    Json inputs = Json::array();
    for (const BatchInput& input : job.inputs)
        inputs.push_back({{"as", input.role}, {"file", input.file}, {"sha256", input.sha256}, {"bytes", input.bytes}});
    return fmt::format(
        R"({{"job":"{}","kind":"{}","output":{},"inputs":{},"options":{},"cost":{{"seconds":{:.3g},"memory":{}}}}})"
        "\n",
        job.id, job.kind, Json(job.output).dump(), inputs.dump(), job.options, job.seconds, job.memory);
}

std::span<const std::uint8_t> bytes_of(const std::string& text) {
    return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

/// The members of a line, each of its type.
class LineReader {
  public:
    explicit LineReader(const Json& json) : json_(json) {}
    std::string text(const char* key) {
        const Json* value = json_.find(key);
        good_ &= value && value->is_string();
        return good_ ? value->get<std::string>() : std::string();
    }
    double number(const char* key) {
        const Json* value = json_.find(key);
        good_ &= value && value->is_number();
        return good_ ? value->get<double>() : 0;
    }
    const Json& object(const char* key) {
        good_ &= json_[key].is_structured();
        return json_[key];
    }
    bool good() const { return good_; }

  private:
    const Json& json_;
    bool good_ = true;
};

Result<BatchJob> job_of(const Json& json) {
    const Error wrong{"is not the line of a job", "", "Was the plan edited? Plan again."};
    LineReader line(json);
    BatchJob job{line.text("job"), line.text("kind"), line.text("output"), {}, line.object("options").dump(), 0, 0};
    for (const Json& input : line.object("inputs").elements()) {
        LineReader reader(input);
        job.inputs.push_back(
            {reader.text("as"), reader.text("file"), reader.text("sha256"), std::int64_t(reader.number("bytes"))});
        if (!reader.good()) return wrong;
    }
    LineReader cost(line.object("cost"));
    job.seconds = cost.number("seconds");
    job.memory = std::int64_t(cost.number("memory"));
    if (!line.good() || !cost.good()) return wrong;
    const auto kind = find_job_kind(job.kind);
    if (!kind) return kind.error();
    if (job.id != job_id(job, (*kind)->makes_folder))
        return Error{"the job is not the one of its name: its inputs or options were changed", "", wrong.hint};
    return job;
}

}  // namespace

std::string job_id(const BatchJob& job, bool makes_folder) {
    std::string text = fmt::format("domelight batch {}\n{}\n{}\n{}\n", k_plan_format, version(), job.kind, job.options);
    if (!makes_folder) text += fs::path(job.output).filename().string() + "\n";
    for (const BatchInput& input : job.inputs)
        text += fmt::format("{} {} {}\n", input.role, input.sha256, fs::path(input.file).filename().string());
    return sha256(bytes_of(text)).substr(0, 32);
}

Result<void> check_outputs(const BatchPlan& plan, const std::function<std::string(std::size_t)>& place) {
    std::vector<std::size_t> order(plan.jobs.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    // With '/' before every other letter, what lies in a folder comes right behind it.
    const auto before = [&](std::size_t a, std::size_t b) {
        return std::ranges::lexicographical_compare(plan.jobs[a].output, plan.jobs[b].output, [](char x, char y) {
            return x != y && (x == '/' || (y != '/' && static_cast<unsigned char>(x) < static_cast<unsigned char>(y)));
        });
    };
    std::stable_sort(order.begin(), order.end(), before);
    for (std::size_t i = 1; i < order.size(); ++i) {
        const std::string &a = plan.jobs[order[i - 1]].output, &b = plan.jobs[order[i]].output;
        if (a == b)
            return Error{fmt::format("{} and {} would both go to \"{}\"", place(order[i - 1]), place(order[i]), a), "",
                         "Give each job an output of its own, in a manifest."};
        if (b.starts_with(a + "/"))
            return Error{fmt::format("the output \"{}\" of {} lies in that of {}, \"{}\"", b, place(order[i]),
                                     place(order[i - 1]), a),
                         "", "The folder of a result holds nothing else."};
    }
    return {};
}

Result<void> write_plan(const BatchPlan& plan, const fs::path& folder) {
    if (auto ok = check_output_folder(folder); !ok) return ok;
    std::error_code failure;
    fs::create_directories(folder, failure);
    if (failure) return Error{"cannot be created: " + failure.message(), folder.string(), ""};
    std::string text = header(plan).dump() + "\n";
    for (const BatchJob& job : plan.jobs) text += line_of(job);
    return write_file_atomically(folder / k_plan_file, bytes_of(text));
}

Result<BatchPlan> read_plan(const fs::path& folder) {
    const fs::path file = folder / k_plan_file;
    std::ifstream in(file);
    if (!in)
        return Error{"there is no plan in it", folder.string(),
                     "Make one first: domelight batch plan SOURCE, or plan_batch()."};
    BatchPlan plan;
    std::string line;
    std::size_t promised = 0;
    for (int number = 1; std::getline(in, line); ++number) {
        const std::string place = fmt::format("{} line {}", file.string(), number);
        const auto json = Json::parse(line);
        if (!json) return json.error().at(place);
        if (number == 1) {
            LineReader reader(*json);
            if (int(reader.number("domelight_batch")) != k_plan_format)
                return Error{"is not the beginning of a plan of this format", place, "Plan again."};
            plan.version = reader.text("version");
            plan.root = reader.text("root");
            promised = std::size_t(reader.number("jobs"));
            if (!reader.good()) return Error{"is not the beginning of a plan", place, "Plan again."};
            if (plan.version != version())
                return Error{fmt::format("the plan was made by version {}, this is {}", plan.version, version()), place,
                             "Plan again: another version may write other bytes."};
            plan.jobs.reserve(std::min<std::size_t>(promised, 1 << 24));
            continue;
        }
        auto job = job_of(*json);
        if (!job) return job.error().at(place);
        plan.jobs.push_back(*std::move(job));
    }
    if (plan.jobs.size() != promised || plan.jobs.empty())
        return Error{fmt::format("holds {} jobs, but its first line says {}", plan.jobs.size(), promised),
                     file.string(), "Plan again."};
    const auto place = [&](std::size_t i) { return fmt::format("line {}", i + 2); };
    if (auto ok = check_outputs(plan, place); !ok) return ok.error().at(file.string());
    return plan;
}

}  // namespace domelight
