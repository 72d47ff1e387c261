// Jobs that audit a bake by any tool against the exact filter of its source.
#include "domelight/compare/bake_audit.h"
#include "domelight/engines/engine.h"
#include "domelight/io/environment/open_environment.h"
#include "domelight/io/file/atomic_file.h"

#include "batch/job_kind.h"
#include "batch/option_reader.h"
#include "compare/audit_json.h"
#include "compare/stored_bake.h"

#include <algorithm>

namespace domelight {
namespace {

struct AuditJob {
    StoredBakeOptions bake;
    AuditOptions audit;
    bool as_read = false;
    EnvironmentOptions environment;
};

Result<AuditJob> options_of(const Json& json) {
    OptionReader reader(json);
    AuditJob job;
    reader.read("for", job.bake.engine);
    reader.read("lobe", job.bake.lobe);
    reader.read("texels", job.audit.texels, 96, 1e7);
    if (reader.given("within")) {
        job.audit.within = 1;
        reader.read("within", *job.audit.within, 1e-9, 1);
    } else {
        reader.know("within");
    }
    reader.read("as_read", job.as_read);
    read_environment_options(reader, job.environment);
    if (auto ok = reader.finish(); !ok) return ok.error();
    if (!job.bake.engine.empty())
        if (const auto engine = find_engine(job.bake.engine); !engine) return engine.error().at(field_place("for"));
    return job;
}

std::string file_name(const Json&, const std::string& name) {
    return with_ending(name, ".json");
}

/// Audits filter the source some five times, at the sizes of the levels.
JobEstimate estimate(const Json&, std::span<const InputFacts> inputs) {
    std::int64_t bytes = 0;
    for (const InputFacts& input : inputs) bytes += input.bytes;
    return {1.5 + 0.1e-6 * double(bytes), (std::int64_t(100) << 20) + 12 * bytes};
}

std::vector<std::string> names_of_files(const std::vector<std::filesystem::path>& files) {
    std::vector<std::string> names;
    for (const std::filesystem::path& file : files) names.push_back(file.filename().string());
    return names;
}

Result<JobReport> run(const JobCall& call) {
    auto job = options_of(call.options);
    if (!job) return job.error();
    job->bake.threads = job->audit.threads = job->environment.threads = call.threads;
    std::vector<std::string> files;
    for (const std::filesystem::path& file : call.files("bake")) files.push_back(file.string());
    const auto bake = read_stored_bake(files, job->bake);
    if (!bake) return bake.error();
    const auto environment = open_environment(call.files("environment"), job->environment);
    if (!environment) return environment.error();
    job->audit.lobe = bake->lobe;
    job->audit.texels_hold = bake->texels;
    const auto audit = audit_bake(bake->levels, *environment, job->audit);
    if (!audit) return audit.error().at(files[0]);
    Result<std::optional<ReadErrors>> as_read = std::optional<ReadErrors>();
    if (job->as_read) as_read = read_errors_of(*bake, *audit, *environment, call.threads);
    if (!as_read) return as_read.error();
    const std::string convention =
        environment->cube() ? "" : convention_of(audit->orientation.ours_from_theirs, environment->world_to_source);
    const std::string text = audit_json(names_of_files(call.files("bake")), names_of_files(call.files("environment")),
                                        *bake, *audit, *as_read, convention, environment->report().lines())
                                 .dump(2) +
                             "\n";
    if (auto ok = write_file_atomically(call.folder / call.name, text); !ok) return ok.error();
    JobReport report;
    note_repairs(*environment, report);
    if (!audit->passed()) report.warnings.push_back("the audit was not passed: " + audit->verdict);
    report.warnings.insert(report.warnings.end(), audit->notes.begin(), audit->notes.end());
    report.error = 0;
    for (const LevelAudit& level : audit->levels)
        report.error = std::max(report.error, level.stated_roughness ? level.stated_error : level.error);
    report.error_of = "error of the worst level against the exact filter";
    return report;
}

}  // namespace

JobKind audit_kind() {
    return {.name = "audit",
            .does = "compares a bake by any tool with the exact filter of its source, as `domelight compare` does",
            .roles = {"bake", "environment"},
            .makes_folder = false,
            .file_name = file_name,
            .check = check_options<options_of>,
            .estimate = estimate,
            .run = run};
}

}  // namespace domelight
