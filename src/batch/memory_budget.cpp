#include "batch/memory_budget.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <string>

namespace domelight {
namespace {

/// MemAvailable of /proc/meminfo; 8 GiB where there is no such file.
std::int64_t available_in_system() {
    std::ifstream in("/proc/meminfo");
    std::string key, unit;
    std::int64_t kilobytes = 0;
    while (in >> key >> kilobytes && std::getline(in, unit))
        if (key == "MemAvailable:") return kilobytes * 1024;
    return std::int64_t(8) << 30;
}

/// A number in a file of the control group; -1 where it says "max" or is not there.
std::int64_t number_in(const char* file) {
    std::ifstream in(file);
    std::int64_t number = -1;
    return in >> number ? number : -1;
}

}  // namespace

std::int64_t available_memory() {
    std::int64_t bytes = available_in_system();
    const std::int64_t limit = number_in("/sys/fs/cgroup/memory.max"),
                       used = number_in("/sys/fs/cgroup/memory.current");
    if (limit > 0 && used >= 0) bytes = std::min(bytes, std::max<std::int64_t>(0, limit - used));
    if (const char* megabytes = std::getenv("SLURM_MEM_PER_NODE"))
        if (const long long asked = std::atoll(megabytes); asked > 0)
            bytes = std::min(bytes, std::int64_t(asked) << 20);
    return bytes;
}

}  // namespace domelight
