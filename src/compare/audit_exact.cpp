#include "compare/audit_exact.h"

#include "compare/audit_lobe.h"

#include <algorithm>

namespace domelight {
namespace {

constexpr std::int64_t k_most_bytes = std::int64_t(512) << 20;  ///< of the exact levels in memory at the same time

std::int64_t bytes_of(const ExactLevel& level) {
    return std::int64_t(6) * level.size * level.size * 12;
}

/// How many of the first levels fit in memory together; at least one.
std::size_t fitting(std::span<const ExactLevel> levels) {
    std::int64_t bytes = 0;
    std::size_t count = 0;
    while (count < levels.size() && (count == 0 || bytes + bytes_of(levels[count]) <= k_most_bytes))
        bytes += bytes_of(levels[count++]);
    return count;
}

}  // namespace

Result<void> ExactFilter::make(std::span<const ExactLevel> levels, const Progress& progress,
                               const std::function<void(std::size_t, Cubemap)>& use) const {
    for (std::size_t first = 0; first < levels.size();) {
        const std::size_t count = fitting(levels.subspan(first));
        const double all = double(levels.size());
        auto filtered =
            filter(levels.subspan(first, count), piece_of(progress, double(first) / all, double(first + count) / all));
        if (!filtered) return filtered.error();
        for (std::size_t i = 0; i < count; ++i) use(first + i, std::move(filtered->specular[i]).cube());
        first += count;
    }
    return {};
}

Result<FilterResult> ExactFilter::filter(std::span<const ExactLevel> levels, const Progress& progress) const {
    FilterOptions options;
    options.sh_bands = 0;
    options.texels = texels_;
    options.threads = threads_;
    options.progress = progress;
    for (const ExactLevel& level : levels)
        options.specular.push_back(level.roughness > 0
                                       ? LevelSpec{level.size, false, lobe_at_roughness(lobe_, level.roughness)}
                                       : LevelSpec{level.size, true, {}});
    return prefilter(source_, options);
}

Progress piece_of(const Progress& whole, double begin, double end) {
    if (!whole) return {};
    return [&whole, begin, end](std::string_view stage, double done) {
        const double part = stage == "read" ? 0.3 * done : stage == "filter" ? 0.3 + 0.7 * done : done;
        return whole("audit", begin + part * (end - begin));
    };
}

}  // namespace domelight
