#include "io/file/input_guard.h"

#include <system_error>

namespace domelight {

Result<void> check_not_an_input(const std::filesystem::path& output, std::span<const std::filesystem::path> inputs) {
    for (const std::filesystem::path& input : inputs) {
        std::error_code missing;
        if (std::filesystem::equivalent(output, input, missing) && !missing)
            return Error{"is read here, and would be overwritten", output.string(),
                         "Name another place for the output."};
    }
    return {};
}

}  // namespace domelight
