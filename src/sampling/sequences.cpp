#include "domelight/sampling/sequences.h"

namespace domelight {
namespace {

constexpr std::array<std::string_view, 6> k_names{"random", "stratified", "hammersley", "halton", "sobol", "r2"};

}  // namespace

std::string sequence_name(Sequence sequence) {
    return std::string(k_names[std::size_t(sequence)]);
}

std::vector<std::string> sequence_names() {
    return {k_names.begin(), k_names.end()};
}

std::optional<Sequence> sequence_from_name(std::string_view name) {
    for (std::size_t i = 0; i < k_names.size(); ++i)
        if (k_names[i] == name) return Sequence(i);
    return std::nullopt;
}

}  // namespace domelight
