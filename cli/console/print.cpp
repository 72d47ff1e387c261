#include "cli/console/print.h"

namespace domelight::cli {

void print_lines(std::string_view text) {
    fmt::print("{}", text);
}

void print_to_stderr(std::string_view text) noexcept {
    (void)!std::fwrite(text.data(), 1, text.size(), stderr);
    (void)!std::fflush(stderr);
}

void print_document(const Json& json) {
    fmt::print("{}\n", escaped_json(json.dump(2)));
}

}  // namespace domelight::cli
