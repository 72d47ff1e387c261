#pragma once

#include <cstdint>

namespace domelight {

/// Bytes of memory that this process and its children may still use: what the system has available, within the limits of
/// its control group and of a Slurm job.
std::int64_t available_memory();

}  // namespace domelight
