#pragma once
// What a batch is planned from: a folder of environments, or a manifest.

#include "domelight/batch/batch_plan.h"

#include "io/file/json.h"

#include <filesystem>
#include <string>
#include <vector>

namespace domelight {

/// A job as it is asked for, before its inputs were read.
struct PlanEntry {
    std::string place;  ///< where it stands, for errors: "jobs.jsonl line 3"
    std::string kind, output;
    std::vector<BatchInput> inputs;  ///< without hashes
    Json options = Json::object();
};

struct PlanSource {
    std::filesystem::path root;
    std::vector<PlanEntry> entries;
    std::vector<std::string> warnings;
};

/// As plan_batch() takes it. Errors: those that need no look at the inputs.
Result<PlanSource> read_plan_source(const std::filesystem::path& source, const BatchPlanOptions& options);

}  // namespace domelight
