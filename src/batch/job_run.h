#pragma once

#include "domelight/batch/batch_plan.h"

#include "batch/result_store.h"

#include <filesystem>
#include <optional>
#include <string>

namespace domelight {

/// An error on one line: "WHERE: WHAT. HINT".
std::string one_line(const Error& error);

/// What is wrong with a job's inputs now; empty: they are those of the plan. `since`: inputs of the planned size that
/// were not written after it are not hashed again.
std::string changed_input(const BatchPlan& plan, const BatchJob& job,
                          std::optional<std::filesystem::file_time_type> since = std::nullopt);

/// Does a job in this process and stores its result. Errors: those of the job, of storing, and inputs that changed
/// (`changed` is then set).
Result<void> do_job(const BatchPlan& plan, const BatchJob& job, const ResultStore& store, int threads, bool& changed);

}  // namespace domelight
