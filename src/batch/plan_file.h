#pragma once
// plan.jsonl, and what is checked of it.

#include "domelight/batch/batch_plan.h"

#include <cstddef>
#include <functional>
#include <string>

namespace domelight {

inline constexpr const char* k_plan_file = "plan.jsonl";

/// BatchJob::id of a job whose other members are set.
std::string job_id(const BatchJob& job, bool makes_folder);

/// Errors: two outputs that are the same, or one that lies in another one's folder. `place` says where a job stands.
Result<void> check_outputs(const BatchPlan& plan, const std::function<std::string(std::size_t)>& place);

}  // namespace domelight
