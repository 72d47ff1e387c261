#include "cli/console/field_options.h"

#include <algorithm>
#include <string_view>

namespace domelight::cli {
namespace {

/// The options that have another name than their field.
struct OtherName {
    std::string_view field, option;
};
constexpr OtherName k_other_names[] = {
    {"engines", "--for"},
    {"irradiance_quantity", "--irradiance"},
    {"points", "--samples"},
    {"riemann", "--riemann-steps"},
};

bool is_field(std::string_view word) {
    return !word.empty() &&
           std::all_of(word.begin(), word.end(), [](char c) { return (c >= 'a' && c <= 'z') || c == '_'; });
}

}  // namespace

std::string option_of_field(std::string field) {
    for (const OtherName& other : k_other_names)
        if (field == other.field) return std::string(other.option);
    std::replace(field.begin(), field.end(), '_', '-');
    return "--" + field;
}

std::string with_options(const std::string& text) {
    std::string told;
    std::size_t at = 0;
    for (std::size_t open; (open = text.find('`', at)) != std::string::npos;) {
        const std::size_t close = text.find('`', open + 1);
        if (close == std::string::npos) break;
        const std::string word = text.substr(open + 1, close - open - 1);
        told += text.substr(at, open - at);
        if (is_field(word)) {
            told += option_of_field(word);
            at = close + 1;
        } else {  // the second backtick may begin the name of a field
            told += "`" + word;
            at = close;
        }
    }
    return told + text.substr(at);
}

std::vector<std::string> with_options(std::vector<std::string> texts) {
    for (std::string& text : texts) text = with_options(text);
    return texts;
}

Error with_options(const Error& error) {
    return {with_options(error.what), with_options(error.where), with_options(error.hint)};
}

}  // namespace domelight::cli
