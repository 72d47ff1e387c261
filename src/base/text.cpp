#include "base/text.h"

#include <charconv>

namespace domelight {

namespace {

template <typename Number>
std::string shortest(Number value) {
    char digits[64];
    const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
    return {digits, end};
}

}  // namespace

std::string decimal(double value) {
    return shortest(value);
}

std::string decimal(float value) {
    return shortest(value);
}

std::string decimal(std::int64_t value) {
    return shortest(value);
}

}  // namespace domelight
