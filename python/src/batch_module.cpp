// domelight._batch: planned jobs. A module of its own, which is loaded when a batch is asked for.

#include "domelight/batch/batch_plan.h"
#include "domelight/batch/batch_results.h"
#include "domelight/batch/batch_run.h"

#include "errors.h"
#include "work.h"

#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/vector.h>

#include <string>
#include <utility>
#include <vector>

namespace domelight::python {
namespace {

namespace fs = std::filesystem;

BatchPlan make_plan(const fs::path& source, const fs::path& folder, const std::string& kind,
                    const std::vector<std::pair<std::string, std::string>>& options, int threads,
                    const nb::object& progress) {
    return run_work_for(progress, [&](const Progress& report) {
        BatchPlan plan = value_of(plan_batch(source, {kind, options, threads, report}));
        value_of(write_plan(plan, folder));
        return plan;
    });
}

BatchPlan open_plan(const fs::path& folder) {
    return run_work_for(nb::none(), [&](const Progress&) { return value_of(read_plan(folder)); });
}

nb::dict job_of(const BatchPlan& plan, std::size_t index) {
    if (index >= plan.jobs.size()) throw nb::index_error();
    const BatchJob& job = plan.jobs[index];
    nb::list inputs;
    for (const BatchInput& input : job.inputs) inputs.append(nb::make_tuple(input.role, input.file, input.sha256));
    nb::dict told;
    told["id"] = job.id;
    told["kind"] = job.kind;
    told["output"] = job.output;
    told["options"] = job.options;
    told["inputs"] = inputs;
    told["seconds"] = job.seconds;
    told["memory"] = job.memory;
    return told;
}

nb::dict run_job(const BatchPlan& plan, const fs::path& folder, std::size_t index, int threads) {
    const BatchOutcome outcome = run_work_for(nb::none(), [&](const Progress&) {
        return value_of(run_batch_job(plan, folder, index, threads));
    });
    nb::dict told;
    told["status"] = name_of(outcome.status);
    told["seconds"] = outcome.seconds;
    return told;
}

nb::list problems_of(const std::vector<BatchProblem>& problems) {
    nb::list told;
    for (const BatchProblem& problem : problems) told.append(nb::make_tuple(problem.output, problem.what));
    return told;
}

/// The outputs that are missing, and what else there is to tell.
nb::tuple merge(const BatchPlan& plan, const fs::path& folder, const std::string& place, const nb::object& progress) {
    const BatchPlacing placing = value_of(from_name<BatchPlacing>(place));
    const BatchMerge made = run_work_for(progress, [&](const Progress& report) {
        return value_of(merge_batch(plan, folder, placing, report));
    });
    return nb::make_tuple(problems_of(made.missing), made.notes);
}

nb::list verify(const BatchPlan& plan, const fs::path& folder, int threads, const nb::object& progress) {
    return problems_of(run_work_for(progress, [&](const Progress& report) {
                           return value_of(verify_batch(plan, folder, threads, report));
                       }).problems);
}

fs::path report(const BatchPlan& plan, const fs::path& folder, int threads, const nb::object& progress) {
    return run_work_for(progress, [&](const Progress& report) {
        return value_of(write_batch_report(plan, folder, threads, report));
    });
}

}  // namespace
}  // namespace domelight::python

NB_MODULE(_batch, module) {
    using namespace domelight::python;
    nb::set_leak_warnings(false);
    register_errors();
    nb::class_<domelight::BatchPlan>(module, "Plan")
        .def_prop_ro("count", [](const domelight::BatchPlan& plan) { return plan.jobs.size(); })
        .def_ro("root", &domelight::BatchPlan::root)
        .def_ro("version", &domelight::BatchPlan::version)
        .def_ro("warnings", &domelight::BatchPlan::warnings)
        .def("job", &job_of, nb::arg("index"))
        .def("shards", &domelight::plan_shards, nb::arg("count"));
    module.def("make_plan", &make_plan, nb::arg("source"), nb::arg("folder"), nb::arg("kind"), nb::arg("options"),
               nb::arg("threads"), nb::arg("progress") = nb::none());
    module.def("open_plan", &open_plan, nb::arg("folder"));
    module.def("run_job", &run_job, nb::arg("plan"), nb::arg("folder"), nb::arg("index"), nb::arg("threads"));
    module.def("merge", &merge, nb::arg("plan"), nb::arg("folder"), nb::arg("place"), nb::arg("progress") = nb::none());
    module.def("verify", &verify, nb::arg("plan"), nb::arg("folder"), nb::arg("threads"),
               nb::arg("progress") = nb::none());
    module.def("report", &report, nb::arg("plan"), nb::arg("folder"), nb::arg("threads"),
               nb::arg("progress") = nb::none());
}
