#include "cli/console/print.h"

namespace domelight::cli {

void print_lines(std::string_view text, std::FILE* to) {
    fmt::print(to, "{}", text);
}

void print_document(const Json& json) {
    fmt::print("{}\n", escaped_json(json.dump(2)));
}

}  // namespace domelight::cli
