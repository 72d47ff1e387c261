#pragma once

#include "io/file/json.h"

#include <string>

namespace domelight {

/// A member of an object of a log or a record; what is missing or of another kind gives the fallback.
inline std::string text_in(const Json& json, const char* key) {
    const Json* value = json.find(key);
    return value && value->is_string() ? value->get<std::string>() : std::string();
}
inline double number_in(const Json& json, const char* key, double fallback = 0) {
    const Json* value = json.find(key);
    return value && value->is_number() ? value->get<double>() : fallback;
}

}  // namespace domelight
