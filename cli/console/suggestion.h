#pragma once

#include <optional>
#include <string>
#include <vector>

namespace domelight::cli {

/// How many letters have to be inserted, left out, replaced, or exchanged with their neighbour to make one word of the
/// other.
int edit_distance(const std::string& a, const std::string& b);

/// The name that was probably meant by `word`: the closest one, if no more than a third of the word's letters (and at
/// least one) differ; else the only one that begins with the word.
std::optional<std::string> closest_name(const std::string& word, const std::vector<std::string>& names);

/// "Did you mean --roughness? ", or nothing where no name is close.
std::string did_you_mean(const std::string& word, const std::vector<std::string>& names);

}  // namespace domelight::cli
