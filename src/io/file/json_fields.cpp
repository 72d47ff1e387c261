#include "io/file/json_fields.h"

#include "io/file/json.h"
#include "io/file/printable.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace domelight {

namespace {

const Json k_nothing;

}  // namespace

Result<Json> parse_json(std::string_view text) {
    auto json = Json::parse(text);
    if (!json) return Error{printable(json.error().what, 173), "", ""};
    return json;
}

JsonFields::JsonFields(const Json& value, std::string place, std::optional<Error>& error)
    : value_(&value), place_(std::move(place)), error_(&error) {}

const Json* JsonFields::find(const char* key) const {
    return value_->find(key);
}

std::string JsonFields::path(std::string_view key) const {
    if (key.empty()) return place_.empty() ? "the file" : place_;
    return place_.empty() ? std::string(key) : place_ + "." + std::string(key);
}

void JsonFields::fail(const std::string& key, const std::string& what) {
    if (!*error_) *error_ = Error{printable(path(key), 120) + ": " + what, "", ""};
}

JsonFields& JsonFields::require(const char* key) {
    if (!find(key)) fail(key, "is missing");
    return *this;
}

float JsonFields::number(const char* key, float fallback) {
    const Json* member = find(key);
    if (!member) return fallback;
    const double value = member->is_number() ? member->get<double>() : std::numeric_limits<double>::infinity();
    if (std::abs(value) <= std::numeric_limits<float>::max()) return float(value);
    fail(key, "is not a number");
    return fallback;
}

float JsonFields::number(const char* key, float fallback, float low, float high) {
    return std::fmin(std::fmax(number(key, fallback), low), high);
}

std::vector<float> JsonFields::numbers(const char* key, std::size_t count) {
    const Json* member = find(key);
    if (!member) return {};
    std::vector<float> values;
    if (member->is_array() && (count == 0 || member->size() == count))
        for (const Json& element : member->elements())
            if (element.is_number() && std::abs(element.get<double>()) <= std::numeric_limits<float>::max())
                values.push_back(element.get<float>());
    if (member->is_array() && values.size() == member->size() && (count == 0 || values.size() == count)) return values;
    fail(key, count ? fmt::format("is not {} numbers", count) : "is not an array of numbers");
    return {};
}

std::uint64_t JsonFields::size(const char* key, std::uint64_t fallback) {
    const Json* member = find(key);
    if (!member) return fallback;
    if (member->is_number_unsigned()) return member->get<std::uint64_t>();
    // "16.0" is a whole number too.
    if (member->is_number_float()) {
        const double value = member->get<double>();
        if (value >= 0 && value < 9e15 && value == std::floor(value)) return std::uint64_t(value);
    }
    fail(key, "is not a whole number >= 0");
    return fallback;
}

int JsonFields::index(const char* key, std::size_t limit) {
    if (!find(key)) return -1;
    const std::uint64_t value = size(key, 0);
    if (value < limit && value < std::uint64_t(std::numeric_limits<int>::max())) return int(value);
    fail(key, fmt::format("there is no {}, only {} of them", value, limit));
    return -1;
}

std::vector<int> JsonFields::indices(const char* key, std::size_t limit) {
    const Json* member = find(key);
    if (!member) return {};
    if (!member->is_array()) {
        fail(key, "is not an array");
        return {};
    }
    std::vector<int> values;
    values.reserve(member->size());
    for (const Json& element : member->elements()) {
        const bool whole = element.is_number_unsigned();
        const std::uint64_t value = whole ? element.get<std::uint64_t>() : 0;
        if (!whole || value >= limit) {
            fail(key,
                 whole ? fmt::format("there is no {}, only {} of them", value, limit) : "is not an array of indices");
            return {};
        }
        values.push_back(int(value));
    }
    return values;
}

bool JsonFields::flag(const char* key, bool fallback) {
    const Json* member = find(key);
    if (!member) return fallback;
    if (member->is_boolean()) return member->get<bool>();
    fail(key, "is not true or false");
    return fallback;
}

bool JsonFields::flag_in(const char* owner, const char* key) const {
    const Json* object = find(owner);
    if (!object || !object->is_object()) return false;
    const Json* member = object->find(key);
    return member && member->is_boolean() && member->get<bool>();
}

std::optional<float> JsonFields::number_in(const char* owner, const char* key) const {
    const Json* members = find(owner);
    if (!members || !members->is_object()) return std::nullopt;
    const Json* member = members->find(key);
    if (!member || !member->is_number()) return std::nullopt;
    const double value = member->get<double>();
    if (!(std::abs(value) <= std::numeric_limits<float>::max())) return std::nullopt;
    return float(value);
}

std::string JsonFields::text(const char* key, const std::string& fallback) {
    const Json* member = find(key);
    if (!member) return fallback;
    if (member->is_string()) return member->get<std::string>();
    fail(key, "is not a string");
    return fallback;
}

std::vector<std::string> JsonFields::texts(const char* key) {
    const Json* member = find(key);
    if (!member) return {};
    std::vector<std::string> values;
    if (member->is_array())
        for (const Json& element : member->elements())
            if (element.is_string()) values.push_back(element.get<std::string>());
    if (!member->is_array() || values.size() != member->size()) fail(key, "is not an array of strings");
    return values;
}

JsonFields JsonFields::object(const char* key) {
    const Json* member = find(key);
    if (!member) return {k_nothing, path(key), *error_};
    if (member->is_object()) return {*member, path(key), *error_};
    fail(key, "is not an object");
    return {k_nothing, path(key), *error_};
}

std::vector<JsonFields> JsonFields::array(const char* key) {
    const Json* member = find(key);
    if (!member) return {};
    if (!member->is_array()) {
        fail(key, "is not an array");
        return {};
    }
    std::vector<JsonFields> elements;
    elements.reserve(member->size());
    for (const Json& element : member->elements()) {
        std::string place = fmt::format("{}[{}]", path(key), elements.size());
        if (element.is_object()) {
            elements.push_back({element, std::move(place), *error_});
        } else {
            fail(fmt::format("{}[{}]", key, elements.size()), "is not an object");
            return {};
        }
    }
    return elements;
}

std::vector<std::pair<std::string, int>> JsonFields::named_indices(std::size_t limit) {
    std::vector<std::pair<std::string, int>> members;
    if (!value_->is_object()) return members;
    for (const auto& [key, value] : value_->items()) members.emplace_back(key, index(key.c_str(), limit));
    std::ranges::sort(members);
    return members;
}

}  // namespace domelight
