#include "base/read_number.h"

#include <charconv>

namespace domelight {

const char* read_number(const char* begin, const char* end, double& value) {
    const auto [stopped, code] = std::from_chars(begin, end, value);
    return code == std::errc() ? stopped : nullptr;
}

}  // namespace domelight
