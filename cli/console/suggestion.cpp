#include "cli/console/suggestion.h"

#include <algorithm>

namespace domelight::cli {

int edit_distance(const std::string& a, const std::string& b) {
    // d[i][j] is the distance of the first i letters of a from the first j of b (optimal string alignment).
    std::vector<std::vector<int>> d(a.size() + 1, std::vector<int>(b.size() + 1));
    for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = int(i);
    for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = int(j);
    for (std::size_t i = 1; i <= a.size(); ++i)
        for (std::size_t j = 1; j <= b.size(); ++j) {
            d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] != b[j - 1])});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
        }
    return d[a.size()][b.size()];
}

std::optional<std::string> closest_name(const std::string& word, const std::vector<std::string>& names) {
    if (word.empty() || word.size() > 100) return std::nullopt;  // longer than any name
    const auto nearest = std::min_element(names.begin(), names.end(), [&](const auto& a, const auto& b) {
        return edit_distance(word, a) < edit_distance(word, b);
    });
    if (nearest == names.end()) return std::nullopt;
    if (edit_distance(word, *nearest) <= std::max(1, int(word.size()) / 3)) return *nearest;
    const auto begins = [&](const std::string& name) { return name.starts_with(word); };
    if (std::count_if(names.begin(), names.end(), begins) != 1) return std::nullopt;
    return *std::find_if(names.begin(), names.end(), begins);
}

std::string did_you_mean(const std::string& word, const std::vector<std::string>& names) {
    const auto name = closest_name(word, names);
    return name ? "Did you mean " + *name + "? " : "";
}

}  // namespace domelight::cli
