#include "cli/bake/bake_report.h"

#include "domelight/base/version.h"

#include "cli/console/console.h"
#include "cli/console/field_options.h"
#include "cli/console/print.h"
#include "io/file/json.h"

#include <fmt/core.h>

#include <algorithm>

namespace domelight::cli {
namespace {

std::string shown_name(const BakedMap& map) {
    if (!map.file.file.empty()) return map.file.file;
    const auto& first = map.levels.front().files;
    return first.empty() ? "" : first.front().file + (map.levels.size() > 1 || first.size() > 1 ? ", ..." : "");
}

/// Two digits, but never 1.5e+03.
std::string percent(double part) {
    return part < 1 ? fmt::format("{:.2g} %", 100 * part) : fmt::format("{:.0f} %", 100 * part);
}

void print_map(const BakedMap& map) {
    const int size = map.levels.front().size;
    const std::string shape = map.layout == Layout::cube ? fmt::format("6 x {}^2", size)
                                                         : fmt::format("{} x {}", map.levels.front().width, size);
    std::string line = fmt::format("  {:<28} {}: {}, {}", shown_name(map), map.role, shape, map.encoding);
    if (map.widened) line += fmt::format(" ({})", k_why_float_channels);
    if (map.levels.size() > 1) line += fmt::format(", {} levels to {}", map.levels.size(), map.levels.back().size);
    if (map.quantity != Quantity::radiance) line += ", " + name_of(map.quantity);
    print("{}\n", line);
}

/// The error of reading exponents between two levels: the largest median of a gap, and the largest error anywhere.
void print_gaps(const BakedMap& map) {
    if (map.gaps.empty()) return;
    const auto median = std::ranges::max_element(map.gaps, {}, &PhongGap::median_error),
               worst = std::ranges::max_element(map.gaps, {}, &PhongGap::worst_error);
    print("  {:<28} exponents between levels: error {} median (at {:.3g}), {} worst (at {:.3g})\n", "",
          percent(median->median_error), median->exponent, percent(worst->worst_error), worst->exponent);
}

}  // namespace

void print_summary(const BakeOutcome& outcome) {
    if (outcome.up_to_date) {
        print("{}: up to date\n", outcome.folder.string());
        return;
    }
    for (const EngineReport& engine : outcome.report.engines) {
        print("{}: {} for {}\n", engine.folder.string(),
              outcome.environment.empty() ? "the built-in sky" : outcome.environment.front(), engine.name);
        for (const BakedMap& map : engine.maps) {
            print_map(map);
            print_gaps(map);
        }
        print("  {:<28} harmonics: {} bands; their irradiance differs from the exact one by {} RMS, {} at most\n",
              engine.sh.files.front().file, engine.sh.bands, percent(engine.sh.rms_error),
              percent(engine.sh.max_error));
        if (!engine.brdf.file.file.empty())
            print("  {:<28} BRDF table: {}^2, {}, {}\n", engine.brdf.file.file, engine.brdf.size, engine.brdf.encoding,
                  name_of(engine.brdf.form));
        if (engine.preview) print("  {:<28} a picture of it all\n", engine.preview->file);
        print("  {:<28} what everything is\n", "manifest.json");
        for (const Engine& e : engines())
            if (e.name == engine.name && !e.note.empty()) print("  note: {}\n", e.note);
    }
    print("{:.2f} s\n", outcome.seconds);
}

void print_json(const std::vector<BakeOutcome>& outcomes) {
    Json bakes = Json::array();
    for (const BakeOutcome& o : outcomes) {
        Json bake{{"environment", o.environment},
                  {"folder", o.folder.string()},
                  {"status", o.error        ? "failed"
                             : o.up_to_date ? "up to date"
                                            : "baked"},
                  {"error", o.error ? Json(with_options(*o.error).format()) : Json(nullptr)},
                  {"seconds", o.seconds},
                  {"band_limit", o.report.band_limit},
                  {"negative_texels_set_to_0", o.report.clamped},
                  {"warnings", with_options(o.report.warnings)}};
        bake["stages"] = Json::array();
        for (const StageTime& s : o.report.stages)
            bake["stages"].push_back({{"stage", s.stage}, {"seconds", s.seconds}, {"cpu_seconds", s.cpu_seconds}});
        bake["engines"] = Json::array();
        for (const EngineReport& e : o.report.engines)
            bake["engines"].push_back(
                {{"engine", e.name}, {"folder", e.folder.string()}, {"manifest", *Json::parse(e.manifest)}});
        bakes.push_back(bake);
    }
    print_document(Json{{"version", version()}, {"bakes", bakes}});
}

}  // namespace domelight::cli
