#include "domelight/compare/bake_audit.h"
#include "domelight/base/parallel.h"

#include "compare/audit_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace domelight {
namespace {

/// Where the search begins, beside 0: the environment itself, averaged over texels.
constexpr double k_ladder[] = {0.02, 0.03, 0.04, 0.06, 0.09, 0.13, 0.18, 0.24,
                               0.31, 0.39, 0.48, 0.58, 0.69, 0.8,  0.9,  1};

/// The least roughness worth telling from 0 on faces of `size`^2: its lobe, 2 alpha wide, is as wide as a texel. (Much
/// narrower lobes also take seconds to filter by.)
double least_roughness(int size) {
    return std::sqrt(k_pi / (4 * size));
}
std::vector<double> ladder(int size) {
    std::vector<double> values{0};
    for (const double r : k_ladder)
        if (r >= least_roughness(size)) values.push_back(r);
    return values;
}

constexpr std::int64_t k_most_bytes = std::int64_t(512) << 20;  ///< of exact levels held at once

constexpr double k_good_fit = 5e-3;  ///< an error below which a guess is taken to be right: encodings leave up to 0.005

/// The exact filter of the source on demand.
class Exact {
  public:
    Exact(const AuditSource& source, int threads) : source_(source), threads_(threads) {}

    /// Cubes of `size`, one for each roughness; `use(i, cube)` in order. Few at a time, so that large ones fit in
    /// memory.
    template <typename F>
    Result<void> levels(int size, std::span<const double> roughness, F use) const {
        const std::int64_t bytes = std::int64_t(6) * size * size * 12;
        const int at_once = int(std::max<std::int64_t>(1, k_most_bytes / bytes));
        for (std::size_t first = 0; first < roughness.size(); first += std::size_t(at_once)) {
            const auto some =
                roughness.subspan(first, std::min<std::size_t>(std::size_t(at_once), roughness.size() - first));
            FilterOptions options;
            options.sh_bands = 0;
            options.threads = threads_;
            options.world_to_source = source_.world_to_source;
            for (const double r : some)
                options.specular.push_back(r > 0 ? LevelSpec{size, false, ZonalKernel::ggx(r)}
                                                 : LevelSpec{size, true, {}});
            auto filtered = filter(options);
            if (!filtered) return filtered.error();
            for (std::size_t i = 0; i < some.size(); ++i) use(int(first + i), filtered->specular[i].cube);
        }
        return {};
    }

  private:
    Result<FilterResult> filter(const FilterOptions& options) const {
        if (source_.cube) return prefilter(*source_.cube, options);
        ImageRowSource rows(source_.latlong);
        return prefilter(rows, options);
    }
    const AuditSource& source_;
    int threads_;
};

/// The level that tells orientations apart best at little cost: the one nearest to 32 texels.
std::size_t level_for_orientation(std::span<const TexelSample> samples) {
    std::size_t best = 0;
    const auto distance = [&](std::size_t i) { return std::abs(std::log2(samples[i].size / 32.0)); };
    for (std::size_t i = 1; i < samples.size(); ++i)
        if (distance(i) < distance(best)) best = i;
    return best;
}

Result<CubeOrientation> find_orientation(const TexelSample& sample, const Exact& exact, int threads) {
    const std::vector<Mat3>& all = cube_orientations();
    std::vector<std::vector<int>> turned(all.size());
    for (std::size_t o = 0; o < all.size(); ++o) turned[o] = turned_texels(sample, all[o]);
    std::vector<double> errors(all.size(), 2);
    const auto use = [&](int, const Cubemap& cube) {
        parallel_for(int(all.size()), threads, [&](int o) {
            auto& error = errors[std::size_t(o)];
            error = std::min(error, fit_level(sample, cube, turned[std::size_t(o)], 0, true).error);
        });
    };
    if (auto ok = exact.levels(sample.size, ladder(sample.size), use); !ok) return ok.error();
    const auto best = std::min_element(errors.begin(), errors.end());
    std::size_t chosen = std::size_t(best - errors.begin());
    // Where the light cannot tell, what needs no explanation is the likeliest.
    const auto as_good = [&](std::size_t o) { return errors[o] <= 1.02 * *best + 1e-4; };
    if (as_good(0)) chosen = 0;
    CubeOrientation found;
    found.ours_from_theirs = all[chosen];
    found.words = orientation_words(all[chosen]);
    found.error = errors[chosen];
    found.next_error = 2;
    for (std::size_t o = 0; o < all.size(); ++o)
        if (o != chosen) found.next_error = std::min(found.next_error, errors[o]);
    found.certain = found.next_error > 1.25 * found.error + 1e-3;
    return found;
}

struct Candidate {
    double roughness = 0;
    Fit fit;
    double mean =
        0;  ///< luminance over the sphere, of the same texels as the level's: coarse faces are a coarse quadrature
};

/// Fits at further roughnesses, kept in rising order.
Result<void> try_roughness(const TexelSample& sample, const std::vector<int>& turned, const Exact& exact,
                           std::span<const double> roughness, std::vector<Candidate>& tried) {
    const auto ok = exact.levels(sample.size, roughness, [&](int i, const Cubemap& cube) {
        tried.push_back({roughness[std::size_t(i)], fit_level(sample, cube, turned), mean_luminance(cube)});
    });
    std::sort(tried.begin(), tried.end(),
              [](const Candidate& a, const Candidate& b) { return a.roughness < b.roughness; });
    return ok;
}

std::size_t best_of(const std::vector<Candidate>& tried) {
    const auto less = [](const Candidate& a, const Candidate& b) { return a.fit.error < b.fit.error; };
    return std::size_t(std::min_element(tried.begin(), tried.end(), less) - tried.begin());
}

/// The minimum of a parabola through the squared errors of three neighbours, if it has one between them.
std::optional<double> parabola_minimum(const Candidate& a, const Candidate& b, const Candidate& c) {
    const auto square = [](const Candidate& p) { return p.fit.error * p.fit.error; };
    const double ab = b.roughness - a.roughness, cb = b.roughness - c.roughness;
    const double p = ab * (square(b) - square(c)), q = cb * (square(b) - square(a));
    if (p == q) return std::nullopt;
    const double x = b.roughness - 0.5 * (ab * p - cb * q) / (p - q);
    if (!(x > a.roughness && x < c.roughness)) return std::nullopt;
    return x;
}

/// How far from the best the fit stays nearly as good.
double width_of_minimum(const std::vector<Candidate>& tried, std::size_t best) {
    const double limit = 1.05 * tried[best].fit.error + 5e-4, at = tried[best].roughness;
    double low = at, high = at;
    for (std::size_t i = best; i-- > 0 && tried[i].fit.error <= limit;) low = tried[i].roughness;
    for (std::size_t i = best + 1; i < tried.size() && tried[i].fit.error <= limit; ++i) high = tried[i].roughness;
    return std::max(at - low, high - at);
}

Result<LevelAudit> audit_level(const CubeLevel& level, const TexelSample& sample, const Mat3& orientation,
                               const Exact& exact) {
    const std::vector<int> turned = turned_texels(sample, orientation);
    // Where the stated roughness fits as well as any could, only its neighbourhood is searched.
    const double guess = level.roughness.value_or(0);
    std::vector<Candidate> tried;
    if (auto ok = try_roughness(sample, turned, exact, std::span(&guess, 1), tried); !ok) return ok.error();
    const bool guessed = tried[0].fit.error < k_good_fit;
    std::vector<double> first =
        guessed ? std::vector<double>{guess - 0.1, guess - 0.02, guess + 0.02, guess + 0.1} : ladder(sample.size);
    if (guessed && guess == 0) first = {least_roughness(sample.size), least_roughness(sample.size) + 0.1};
    std::erase_if(first, [&](double r) { return r == guess || r > 1 || (r != 0 && r < least_roughness(sample.size)); });
    if (auto ok = try_roughness(sample, turned, exact, first, tried); !ok) return ok.error();
    double worst = 0;
    for (const Candidate& c : tried) worst = std::max(worst, c.fit.error);
    for (int round = guessed ? 1 : 0; round < 2; ++round) {
        const std::size_t best = best_of(tried);
        const double low = tried[best > 0 ? best - 1 : 0].roughness, at = tried[best].roughness,
                     high = tried[std::min(best + 1, tried.size() - 1)].roughness;
        constexpr int k_between = 2;
        std::vector<double> finer;
        for (int i = 1; i <= k_between; ++i) {
            const double t = double(i) / (k_between + 1);
            if (low < at) finer.push_back(low + t * (at - low));
            if (high > at) finer.push_back(at + t * (high - at));
        }
        std::erase_if(finer, [&](double r) { return r < least_roughness(sample.size); });
        if (auto ok = try_roughness(sample, turned, exact, finer, tried); !ok) return ok.error();
    }
    std::size_t best = best_of(tried);
    if (best > 0 && best + 1 < tried.size() && tried[best - 1].roughness > 0)
        if (const auto x = parabola_minimum(tried[best - 1], tried[best], tried[best + 1])) {
            if (auto ok = try_roughness(sample, turned, exact, std::span(&*x, 1), tried); !ok) return ok.error();
            best = best_of(tried);
        }
    const Candidate& found = tried[best];
    LevelAudit audit;
    audit.size = sample.size;
    audit.roughness = found.roughness;
    audit.roughness_within = width_of_minimum(tried, best);
    audit.roughness_known = worst > 1.05 * found.fit.error + 5e-4;
    audit.scale = found.fit.scale;
    audit.error = found.fit.error;
    audit.relative_rmse = found.fit.relative_rmse;
    audit.largest = found.fit.largest;
    audit.energy = found.mean > 0 ? sample.mean / found.mean : 1;
    audit.stated_roughness = level.roughness;
    if (level.roughness) {
        const double r = *level.roughness;
        const auto ok = exact.levels(sample.size, std::span(&r, 1), [&](int, const Cubemap& cube) {
            const Fit fit = fit_level(sample, cube, turned, 1);
            audit.stated_error = fit.error;
            audit.stated_relative_rmse = fit.relative_rmse;
        });
        if (!ok) return ok.error();
    }
    return audit;
}

}  // namespace

std::string orientation_words(const Mat3& m) {
    const Mat3 identity, mirror_x{{Vec3d{-1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}}};
    if (m == identity) return "as ours";
    const auto axis_mirrored = [&](int axis) {
        Mat3 mirror;
        mirror.row[std::size_t(axis)] = -mirror.row[std::size_t(axis)];
        return m == mirror;
    };
    if (axis_mirrored(0)) return "mirrored in x";
    if (axis_mirrored(1)) return "mirrored in y (upside down)";
    if (axis_mirrored(2)) return "mirrored in z";
    const double determinant = dot(m.row[0], cross(m.row[1], m.row[2]));
    // theirs(d) = ours(M d); light that was turned by R about +Y has M = R^T, mirrored in x before that: M = mirror
    // R^T.
    if (m.row[1] == Vec3d{0, 1, 0}) {
        const Mat3 turn = (determinant > 0 ? m : mirror_x * m).transposed();
        for (const int angle : {90, 180, 270}) {
            const double c = angle == 180 ? -1 : 0, s = angle == 90 ? 1 : angle == 270 ? -1 : 0;
            if (turn == Mat3{{Vec3d{c, 0, -s}, Vec3d{0, 1, 0}, Vec3d{s, 0, c}}})
                return fmt::format("{}turned by {} degrees about +Y", determinant > 0 ? "" : "mirrored in x, then ",
                                   angle);
        }
    }
    std::string text = determinant > 0 ? "turned:" : "mirrored and turned:";
    const char* names[3] = {"X", "Y", "Z"};
    for (int column = 0; column < 3; ++column) {
        const Vec3d d{m.row[0].x * (column == 0) + m.row[0].y * (column == 1) + m.row[0].z * (column == 2),
                      m.row[1].x * (column == 0) + m.row[1].y * (column == 1) + m.row[1].z * (column == 2),
                      m.row[2].x * (column == 0) + m.row[2].y * (column == 1) + m.row[2].z * (column == 2)};
        const int axis = d.x != 0 ? 0 : d.y != 0 ? 1 : 2;
        text += fmt::format("{} its +{} shows our {}{}", column ? "," : "", names[column],
                            d.x + d.y + d.z > 0 ? "+" : "-", names[axis]);
    }
    return text;
}

Result<BakeAudit> audit_bake(std::span<const CubeLevel> levels, const AuditSource& source,
                             const AuditOptions& options) {
    if (levels.empty()) return Error{"no levels to audit", "", ""};
    const auto tell = [&](double done) { return !options.progress || options.progress("audit", done); };
    std::vector<TexelSample> samples;
    for (std::size_t l = 0; l < levels.size(); ++l) {
        samples.push_back(sample_texels(levels[l].cube, std::max(options.texels, 96)));
        if (!(samples.back().mean > 0))
            return Error{fmt::format("level {} is black: nothing can be found out about it", l), "", ""};
    }
    const Exact exact(source, options.threads);
    auto orientation = find_orientation(samples[level_for_orientation(samples)], exact, options.threads);
    if (!orientation) return orientation.error();
    BakeAudit audit{std::move(*orientation), {}};
    for (std::size_t l = 0; l < levels.size(); ++l) {
        if (!tell(double(l) / double(levels.size()))) return Error{"cancelled", "", ""};
        auto level = audit_level(levels[l], samples[l], audit.orientation.ours_from_theirs, exact);
        if (!level) return level.error();
        audit.levels.push_back(*level);
    }
    return audit;
}

}  // namespace domelight
