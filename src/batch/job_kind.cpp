#include "batch/job_kind.h"

#include "domelight/base/names.h"

namespace domelight {

std::string with_ending(const std::string& name, const std::string& ending) {
    return name.ends_with(ending) ? name : name + ending;
}

std::string no_file(const Json&, const std::string&) {
    return {};
}

void note_repairs(const Environment& environment, JobReport& report) {
    const RepairReport repaired = environment.report();
    const auto lines = repaired.lines();
    report.warnings.insert(report.warnings.end(), lines.begin(), lines.end());
    report.repaired = repaired.repaired();
}

std::span<const JobKind> job_kinds() {
    static const JobKind table[] = {bake_kind(), convert_kind(), audit_kind(), render_kind(), probes_kind()};
    return table;
}

Result<const JobKind*> find_job_kind(const std::string& name) {
    std::vector<std::string> accepted;
    for (const JobKind& kind : job_kinds()) {
        if (kind.name == name) return &kind;
        accepted.emplace_back(kind.name);
    }
    return unknown_name(name, "a kind of job", accepted);
}

std::vector<BatchKind> batch_kinds() {
    std::vector<BatchKind> kinds;
    for (const JobKind& kind : job_kinds()) kinds.push_back({kind.name, kind.does});
    return kinds;
}

}  // namespace domelight
