#include "batch/option_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace domelight {

const Json* OptionReader::find(const char* name) {
    known_.emplace_back(name);
    return error_ ? nullptr : options_.find(name);
}

void OptionReader::read_word(const char* name, std::string& field, const std::vector<std::string>& accepted,
                             const char* kind) {
    read(name, field);
    if (std::ranges::find(accepted, field) == accepted.end())
        fail(unknown_name(field, kind, accepted).at(field_place(name)));
}

void OptionReader::fail(Error error) {
    if (!error_) error_ = std::move(error);
}

void OptionReader::wrong_type(const char* name, const char* expected) {
    fail({fmt::format("{} is not {}", options_[name].dump(), expected), field_place(name), ""});
}

void OptionReader::check_range(const char* name, double value, double low, double high) {
    if (given(name) && !(value >= low && value <= high))
        fail({fmt::format("{:g} is not from {:g} to {:g}", value, low, high), field_place(name), ""});
}

void OptionReader::read(const char* name, bool& field) {
    const Json* value = find(name);
    if (!value) return;
    if (!value->is_boolean()) return wrong_type(name, "true or false");
    field = value->get<bool>();
}

void OptionReader::read(const char* name, int& field) {
    const Json* value = find(name);
    if (!value) return;
    const double number = value->is_number() ? value->get<double>() : std::nan("");
    if (number != std::floor(number) || std::abs(number) > std::numeric_limits<int>::max())
        return wrong_type(name, "a whole number");
    field = int(number);
}

void OptionReader::read(const char* name, std::uint64_t& field) {
    const Json* value = find(name);
    if (!value) return;
    if (!value->is_number_unsigned()) return wrong_type(name, "a whole number of at least 0");
    field = value->get<std::uint64_t>();
}

void OptionReader::read(const char* name, double& field) {
    const Json* value = find(name);
    if (!value) return;
    if (!value->is_number()) return wrong_type(name, "a number");
    field = value->get<double>();
}

void OptionReader::read(const char* name, std::string& field) {
    const Json* value = find(name);
    if (!value) return;
    if (!value->is_string()) return wrong_type(name, "a text");
    field = value->get<std::string>();
}

void OptionReader::read(const char* name, std::vector<double>& field) {
    const Json* value = find(name);
    if (!value) return;
    std::vector<double> numbers;
    for (const Json& element : value->elements()) {
        const bool infinite = element.is_string() && element.get<std::string>() == "inf";
        if (!infinite && !element.is_number()) return wrong_type(name, "an array of numbers");
        numbers.push_back(infinite ? std::numeric_limits<double>::infinity() : element.get<double>());
    }
    if (!value->is_array()) return wrong_type(name, "an array of numbers");
    field = std::move(numbers);
}

void OptionReader::read(const char* name, std::vector<std::string>& field) {
    const Json* value = find(name);
    if (!value) return;
    if (value->is_string()) {
        field = {value->get<std::string>()};
        return;
    }
    std::vector<std::string> texts;
    for (const Json& element : value->elements()) {
        if (!element.is_string()) return wrong_type(name, "an array of texts");
        texts.push_back(element.get<std::string>());
    }
    if (!value->is_array()) return wrong_type(name, "a text or an array of texts");
    field = std::move(texts);
}

Result<void> OptionReader::finish() const {
    if (error_) return *error_;
    for (const auto& [name, value] : options_.items())
        if (std::find(known_.begin(), known_.end(), name) == known_.end())
            return Error{"is not an option of this kind of job", field_place(name),
                         fmt::format("Accepted: {}.", fmt::join(known_, ", "))};
    return {};
}

void read_environment_options(OptionReader& reader, EnvironmentOptions& options) {
    reader.read("projection", options.projection);
    reader.read("latlong", options.latlong);
    reader.read("layer", options.layer);
    reader.read("faces", options.faces);
    reader.read("face_orientation", options.face_orientation);
    reader.read("decode", options.decode);
    reader.read("rotate_y_deg", options.rotate_y_deg);
    reader.read("up", options.up);
    reader.read("exposure", options.exposure);
    reader.read("negatives", options.negatives);
}

}  // namespace domelight
