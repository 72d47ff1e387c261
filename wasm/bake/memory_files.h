#pragma once
// The files that the module writes: they stay in its memory, by name, until JavaScript has taken them.

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace domelight {

/// All of them, by the paths that they were written to.
std::map<std::string, std::vector<std::uint8_t>>& memory_files();

}  // namespace domelight
