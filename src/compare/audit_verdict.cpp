#include "compare/audit_verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace domelight {
namespace {

constexpr int k_least_decisive_size = 4;
constexpr double k_sure_of_source = 0.05;  ///< the error of averaged faces that no other environment has

std::string percent(double v) {
    return fmt::format("{:.2g} %", 100 * v);
}

/// The error that a user of the file sees: at the stated roughness and brightness, or of the best fit where a level
/// states no roughness.
double error_of(const LevelAudit& level) {
    return level.stated_roughness ? level.stated_error : level.error;
}

template <typename Error>
std::size_t worst_by(const std::vector<LevelAudit>& levels, Error error) {
    const auto less = [&](const LevelAudit& a, const LevelAudit& b) { return error(a) < error(b); };
    return std::size_t(std::max_element(levels.begin(), levels.end(), less) - levels.begin());
}

/// Whether a level can show that a bake is one of another environment. What a tool stores in faces of a few texels
/// depends on how it expects them to be read, more than on the environment.
bool decides(const LevelAudit& level, const BakeAudit& audit) {
    return level.size >= k_least_decisive_size || audit.levels[0].size < k_least_decisive_size;
}

std::string verdict_on_another(const BakeAudit& audit, double same) {
    if (audit.orientation.error > same)
        return fmt::format("not a bake of this environment: in the best of 48 orientations it is {} off",
                           percent(audit.orientation.error));
    const std::size_t l =
        worst_by(audit.levels, [&](const LevelAudit& level) { return decides(level, audit) ? level.broad_error : -1; });
    const double first = audit.levels[0].broad_error;
    return fmt::format("not a bake of this environment: level {} is {} off at every roughness{}", l,
                       percent(audit.levels[l].broad_error),
                       l > 0 && first <= k_sure_of_source
                           ? fmt::format(", or very noisy, because level 0 is only {} off", percent(first))
                           : "");
}

/// "as ours", followed by the brightness if that differs.
std::string how_baked(const BakeAudit& audit) {
    std::vector<double> scales;
    for (const LevelAudit& level : audit.levels) scales.push_back(level.scale);
    std::sort(scales.begin(), scales.end());
    const double scale = scales[scales.size() / 2];
    std::string words = audit.orientation.words;
    if (std::abs(std::log(scale)) > std::log(1.05)) words += fmt::format(", {:.3g} times as bright", scale);
    return words;
}

std::string verdict_on_bake(const BakeAudit& audit, const AuditOptions& options) {
    const std::size_t l = worst_by(audit.levels, error_of);
    const double worst = error_of(audit.levels[l]);
    std::string words = fmt::format("a bake of this environment, {}", how_baked(audit));
    const char* where = audit.levels[l].stated_roughness ? " at its stated roughness" : "";
    if (!audit.within)
        return fmt::format("{}, but level {} is {} off{}, more than the {} asked for", words, l, percent(worst), where,
                           percent(*options.within));
    return fmt::format("{}, every level within {}{}", words, percent(worst),
                       audit.levels[l].stated_roughness ? " at the stated roughness" : "");
}

/// Texels of a source along a quarter of its horizon.
double source_texels(const Environment& source) {
    return source.cube() ? source.cube()->size() : source.latlong_width() / 4.0;
}

std::string source_words(const Environment& source) {
    return source.cube() ? fmt::format("{}² faces", source.cube()->size())
                         : fmt::format("{} x {} pixels", source.latlong_width(), source.latlong_height());
}

/// Whether the source is too small for level 0: detail that the source lacks leaves an error that averaging removes.
bool too_small(const Environment& source, const LevelAudit& first) {
    return source_texels(source) < first.size && first.error >= 0.02 && first.error >= 1.5 * first.broad_error;
}

std::string small_source_note(const LevelAudit& first, const Environment& source) {
    return fmt::format(
        "the environment is too small for this bake: level 0 has faces of {}² and detail that the {} of the "
        "environment lack; its error of {} is mostly that (both averaged to 32²: {})",
        first.size, source_words(source), percent(first.error), percent(first.broad_error));
}

}  // namespace

BakeAudit judged(BakeAudit audit, const Environment& source, const AuditOptions& options) {
    const auto above = [&](const LevelAudit& level) {
        return decides(level, audit) && level.broad_error > options.same;
    };
    audit.of_source =
        !(audit.orientation.error > options.same) && !std::any_of(audit.levels.begin(), audit.levels.end(), above);
    const double worst = error_of(audit.levels[worst_by(audit.levels, error_of)]);
    audit.within = !options.within || worst <= *options.within;
    audit.verdict = audit.of_source ? verdict_on_bake(audit, options) : verdict_on_another(audit, options.same);
    if (audit.of_source && too_small(source, audit.levels[0]))
        audit.notes.push_back(small_source_note(audit.levels[0], source));
    return audit;
}

}  // namespace domelight
