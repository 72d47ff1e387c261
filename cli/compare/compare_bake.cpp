#include "cli/compare/compare_bake.h"

#include "domelight/compare/bake_audit.h"
#include "domelight/compare/read_error.h"
#include "domelight/engines/engine.h"
#include "domelight/io/environment/open_environment.h"

#include "cli/console/environment_options.h"
#include "cli/console/field_options.h"
#include "cli/console/print.h"
#include "compare/audit_json.h"
#include "compare/stored_bake.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace domelight::cli {
namespace {

std::string percent(double v) {
    return fmt::format("{:.3g} %", 100 * v);
}

/// A level's roughness, or its exponent, and how far from it the fit stays nearly as good.
std::string width_text(const LevelAudit& l) {
    if (!l.roughness_known) return "any fits";
    if (!l.exponent) return fmt::format("{:.4f} ± {:<6.2g}", l.roughness, l.roughness_within);
    if (std::isinf(*l.exponent)) return "inf         ";
    const double from_roughness = 2 * std::pow(l.roughness, -5);  // of the exponent (1 / r^4 - 1) / 2
    return fmt::format("{:.4g} ± {:<6.2g}", *l.exponent, from_roughness * l.roughness_within);
}

const char* width_legend(Lobe lobe) {
    switch (lobe) {
        case Lobe::ggx:
            return "roughness     of GGX (n = v = r) that fits best, 0: the environment itself";
        case Lobe::charlie:
            return "roughness     of Charlie's lobe that fits best";
        case Lobe::phong_brdf:
            return "exponent      n of (n + 2) cos^(n+1) that fits best, inf: the environment itself";
        case Lobe::phong_plain:
            return "exponent      n of (n + 1) cos^n that fits best, inf: the environment itself";
    }
    return "";
}

void print_text(const BakeWords& w, const StoredBake& bake, const BakeAudit& audit, const std::string& as_convention) {
    const CubeOrientation& o = audit.orientation;
    print("{}: {}, {}², {} level{}\n", join(w.bake, " "), bake.format, bake.levels[0].cube.size(), bake.levels.size(),
          bake.levels.size() == 1 ? "" : "s");
    print("against the exact filter ({}) of {}\n\n", name_of(audit.lobe),
          w.env.empty() ? "the built-in sky" : join(w.env, " "));
    print("  verdict       {}\n", audit.verdict);
    for (const std::string& note : audit.notes) print("                {}\n", note);
    if (o.error > AuditOptions{}.same) {  // no orientation fits, so the figures say nothing
        print("                --json has the figures of the best orientation\n");
        return;
    }
    print("  orientation   {}\n", o.words);
    if (!as_convention.empty()) print("                that is as ours with --latlong {}\n", as_convention);
    if (const auto lies = lies_as_read(bake, audit))
        print("                {}as {} reads it, which looks up {} for direction d = (x, y, z)\n", *lies ? "" : "NOT ",
              bake.engine->name, cube_mirror_direction(bake.engine->mirror));
    print("                error {}, the next best orientation {}{}\n\n", percent(o.error), percent(o.next_error),
          o.certain || !audit.of_source ? "" : ": the light cannot tell them apart");
    const bool stated = std::any_of(audit.levels.begin(), audit.levels.end(),
                                    [](const LevelAudit& l) { return l.stated_roughness.has_value(); });
    print("  {:>5}  {:>5}  {:>16}  {:>7}  {:>7}  {:>8}  {:>8}  {:>8}", "level", "size",
          audit.levels[0].exponent ? "exponent" : "roughness", "scale", "energy", "error", "RMSE", "largest");
    if (stated) print("  | {:>7}  {:>8}  {:>8}", "stated", "error", "RMSE");
    print("\n");
    for (std::size_t i = 0; i < audit.levels.size(); ++i) {
        const LevelAudit& l = audit.levels[i];
        print("  {:>5}  {:>5}  {:>16}  {:>7.4f}  {:>7.4f}  {:>8}  {:>8}  {:>8}", i, l.size, width_text(l), l.scale,
              l.energy, percent(l.error), percent(l.relative_rmse), percent(l.largest));
        if (l.stated_roughness)
            print("  | {:>7.4g}  {:>8}  {:>8}", bake.levels[i].exponent.value_or(*l.stated_roughness),
                  percent(l.stated_error), percent(l.stated_relative_rmse));
        print("\n");
    }
    print(
        "\n  {}\n"
        "  scale         median of theirs / exact          energy   ratio of the means over the sphere\n"
        "  error         RMS of (theirs - fit) / max(theirs, fit), every direction alike; RMSE relative, the brightest "
        "count most\n",
        width_legend(audit.lobe));
    if (stated) print("  stated        by {}; errors there, at scale 1\n", bake.stated_by);
}

void print_as_read(const StoredBake& bake, const ReadErrors& errors) {
    print("\n  as a shader reads it, between texels{}\n", bake.levels.size() > 1 ? " and between levels" : "");
    print("  {:>9}  {:>6}  {:>8}  {:>8}\n", "roughness", "level", "RMSE", "largest");
    const auto row = [](const ReadErrorAt& at) {
        print("  {:>9.3f}  {:>6.2f}  {:>8}  {:>8}\n", at.roughness, at.level, percent(at.relative_rmse),
              percent(at.largest));
    };
    for (const ReadErrorAt& at : errors.levels) row(at);
    print("  {:>9}  {:>6}  {:>8}  {:>8}\n", "0.1 to 1", "all", percent(errors.relative_rmse), percent(errors.largest));
}

}  // namespace

void add_bake_options(Arguments& a, BakeWords& w) {
    std::vector<std::string> names;
    for (const Engine& engine : engines()) names.push_back(engine.name);
    a.group("A bake against its source");
    a.texts("--bake", "FILE", w.bake,
            "a baked specular cube or lat-long map: KTX2, KTX or DDS with its levels, or a picture or folder of faces "
            "for each level");
    a.texts("--env", "SRC", w.env, fmt::format("the environment it was baked from ({})", k_built_in_sky));
    a.choice("--for", w.engine, names,
             "the engine whose roughness curve the bake should have; not needed for a Domelight file, which states it");
    a.choice("--lobe", w.lobe, "the lobe that the levels were filtered with (what the file states, otherwise ggx)");
    a.number(
        "--within", "ERROR", w.within,
        "the largest error that a level may have, above 0 and up to 1: 0.01 is 1 %. If the error of a level is "
        "larger, the exit status is 1. What counts is the error at the roughness that the file or --for states, "
        "at scale 1; where none is stated, that of the best fit. Without this option the status is 0 for any bake of "
        "the environment");
    a.integer("--texels", "N", w.texels,
              "texels compared in each level, 96 to 10000000, a quarter of them the brightest (6144)");
    a.flag("--as-read", w.as_read,
           "also measure what a shader reads, between texels and between levels, in random directions for random "
           "roughnesses from 0.1 to 1; between levels by the curve of --for, or of the engine whose curve has the "
           "roughnesses that "
           "the file states, otherwise linearly in the roughness");
    add_environment_options(a, w.environment);
}

int compare_bake(const BakeWords& w, const CommonOptions& common) {
    const int threads = common.threads.value_or(0);
    if (w.texels && (*w.texels < 96 || *w.texels > 10'000'000))
        return print_error({"is not from 96 to 10000000", "--texels", ""}, exit_usage);
    if (!std::isnan(w.within) && !(w.within > 0 && w.within <= 1))
        return print_error({fmt::format("is {}, not above 0 and at most 1", w.within), "--within", ""}, exit_usage);
    EnvironmentOptions options = w.environment;
    options.threads = threads;
    const auto bake = read_stored_bake(w.bake, {w.engine, w.lobe, threads});
    if (!bake) return print_error(with_options(bake.error()));
    auto environment = open_environment_or_sky(w.env, options);
    if (!environment) return print_error(environment.error());
    if (!environment->cube())
        if (const auto pixels = environment->latlong(); !pixels)
            return print_error(pixels.error().at(join(w.env, " ")));
    AuditOptions audit_options;
    audit_options.threads = threads;
    audit_options.lobe = bake->lobe;
    audit_options.texels_hold = bake->texels;
    if (!std::isnan(w.within)) audit_options.within = w.within;
    audit_options.texels = w.texels.value_or(audit_options.texels);
    Result<BakeAudit> audit = Error{};
    {
        ProgressBar bar(w.bake[0], common);
        audit_options.progress = bar.callback();
        audit = audit_bake(bake->levels, *environment, audit_options);
    }
    if (!audit) return print_error(audit.error().at(w.bake[0]));
    Result<std::optional<ReadErrors>> as_read = std::optional<ReadErrors>();
    if (w.as_read) as_read = read_errors_of(*bake, *audit, *environment, threads);
    if (!as_read) return print_error(with_options(as_read.error()));
    print_warnings(environment->report().lines(), common, join(w.env, " "));
    const std::string convention =
        environment->cube() ? "" : convention_of(audit->orientation.ours_from_theirs, environment->world_to_source);
    if (common.json)
        print_document(audit_json(w.bake, w.env, *bake, *audit, *as_read, convention,
                                  with_options(environment->report().lines())));
    else if (!common.quiet) {
        print_text(w, *bake, *audit, convention);
        if (*as_read) print_as_read(*bake, **as_read);
    }
    return audit->passed() ? exit_done : exit_failed;
}

}  // namespace domelight::cli
