#include "cli/sample/sample_estimate.h"

#include "domelight/image/colour.h"
#include "domelight/io/write_image.h"

#include "base/json.h"
#include "preview/plot.h"
#include "cli/sample/sample_study.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace domelight::cli {
namespace {

/// JSON has no infinity: null, as everywhere where there is no number.
Json number_json(double v) {
    return std::isfinite(v) ? Json(v) : Json(nullptr);
}
Json vector_json(const Vec3d& v) {
    return Json::array({v.x, v.y, v.z});
}
std::string surface_text(const SampleWords& w) {
    const double cosine = dot(w.normal_world, w.view_world), angle = std::acos(std::min(1.0, cosine)) * 180 / k_pi;
    std::string text = w.brdf;
    if (w.brdf == "ggx" || w.brdf == "charlie") text += fmt::format(" {:g}", w.roughness);
    if (w.brdf == "phong") text += fmt::format(" {:g}", w.exponent);
    return text + fmt::format(", normal ({:.3g}, {:.3g}, {:.3g}), seen at {:.0f}°", w.normal_world.x, w.normal_world.y,
                              w.normal_world.z, angle);
}

std::string count_text(double n) {
    if (!std::isfinite(n)) return "never";
    return n < 1e7 ? fmt::format("{:.0f}", n) : fmt::format("{:.2g}", n);
}
std::string times_text(double f) {
    return !std::isfinite(f) ? "inf" : f >= 100 ? fmt::format("{:.0f}", f) : fmt::format("{:.3g}", f);
}
std::string slope_text(double s) {
    return std::isfinite(s) ? fmt::format("{:.2f}", s) : "-";
}

/// NaN where one of the two was not asked for.
double efficiency_ratio(const Study& study, const char* name, const char* than) {
    const StrategyResult *one = study.find(name), *other = study.find(than);
    return one && other ? one->efficiency / other->efficiency : NAN;
}

/// "MIS compensation: 7.3 times the efficiency of mis-balance".
std::string gain_text(const Study& study, const char* what, const char* name, const char* than) {
    const double gain = efficiency_ratio(study, name, than);
    if (!std::isfinite(gain) || !(gain > 0)) return "";
    return fmt::format("{}: {} times the efficiency of {} ({})\n", what, times_text(gain), than,
                       gain > 1.1   ? "a gain"
                       : gain < 0.9 ? "a loss"
                                    : "about the same");
}

/// What a kept direction of the product form is worth in directions from the environment, where the ray is what costs;
/// 0: unknown.
double per_ray(const Study& study) {
    if (!study.find("product")) return 0;
    const StrategyResult &product = *study.find("product"), &environment = *study.find("environment");
    const double kept = product.error * product.error * product.estimate.samples / study.candidates;
    const double drawn = environment.error * environment.error * environment.estimate.samples;
    return kept > 0 && drawn > 0 ? drawn / kept : 0;
}

std::string table(const SampleWords& w, const Study& study) {
    std::string text = fmt::format("{}: {}\n", w.environment_name(), surface_text(w));
    text += fmt::format("reference  {:.6g} {:.6g} {:.6g}  ± {:.1e}   ({})\n\n", study.reference.x, study.reference.y,
                        study.reference.z, luminance(study.reference_error), study.reference_method);
    text += fmt::format("{} samples, {}, seed {}; errors over {} runs\n", study.samples, w.sequence, w.seed_number,
                        study.runs);
    text += fmt::format("{:<24}{:>30}{:>12}{:>11}{:>7}{:>11}{:>12}{:>11}\n", "strategy", "estimate (R G B)",
                        "std. error", "error", "slope", "ns/sample", "efficiency", "for 1 %");
    bool unmet = false;
    for (const StrategyResult& r : study.strategies) {
        const Estimate& e = r.estimate;
        const bool rare = r.missed();
        unmet |= rare;
        text += fmt::format("{:<24}{:>10.4g}{:>10.4g}{:>10.4g}{:>12.2e}{:>9.3g} %{:>7}{:>11.0f}{:>12}{:>11}{}\n",
                            r.name, e.radiance.x, e.radiance.y, e.radiance.z, luminance(e.standard_error),
                            100 * (rare ? r.expected_error() : r.error), slope_text(r.slope),
                            1e9 * r.cpu_seconds / e.samples, times_text(r.efficiency), count_text(r.for_one_percent),
                            rare ? " *" : "");
    }
    if (unmet)
        text +=
            "* few or no runs met the bright light: the error is the one computed from the variance, not the one "
            "measured\n";
    text +=
        "\nerror: RMS of luminance over the reference's; efficiency: 1 / (squared error x CPU time), environment = 1\n";
    text += gain_text(study, "MIS compensation", "mis-balance-compensated", "mis-balance");
    text += gain_text(study, "product by resampling", "product", "environment");
    const double rays = per_ray(study);
    if (rays > 0)
        text += fmt::format("   and {} times per shadow ray, of which it needs one for {} candidates\n",
                            times_text(rays), study.candidates);
    return text;
}

Json document(const SampleWords& w, const Study& study) {
    Json strategies = Json::array();
    for (const StrategyResult& r : study.strategies) {
        Json curve = Json::array();
        for (const auto& p : r.curve) curve.push_back({{"samples", int(p[0])}, {"error", number_json(p[1])}});
        strategies.push_back({{"strategy", r.name},
                              {"samples", r.estimate.samples},
                              {"radiance", vector_json(r.estimate.radiance)},
                              {"standard_error", vector_json(r.estimate.standard_error)},
                              {"error", number_json(r.error)},
                              {"variance", r.variance ? number_json(*r.variance) : Json(nullptr)},
                              {"slope", number_json(r.slope)},
                              {"cpu_seconds", r.cpu_seconds},
                              {"efficiency", number_json(r.efficiency)},
                              {"samples_for_one_percent", number_json(r.for_one_percent)},
                              {"convergence", std::move(curve)}});
    }
    Json surface{{"brdf", w.brdf}, {"normal", vector_json(w.normal_world)}, {"view", vector_json(w.view_world)}};
    if (w.brdf == "ggx" || w.brdf == "charlie") surface["roughness"] = w.roughness;
    if (w.brdf == "phong") surface["exponent"] = w.exponent;
    return {{"surface", std::move(surface)},
            {"reference",
             {{"radiance", vector_json(study.reference)},
              {"standard_error", vector_json(study.reference_error)},
              {"method", study.reference_method}}},
            {"runs", study.runs},
            {"gains",
             {{"mis_compensation", number_json(efficiency_ratio(study, "mis-balance-compensated", "mis-balance"))},
              {"product", number_json(efficiency_ratio(study, "product", "environment"))},
              {"product_per_ray", number_json(per_ray(study))}}},
            {"strategies", std::move(strategies)}};
}

/// Measured errors as dots; where the variance is known and says that the runs missed most of it, its own line too.
Plot convergence_plot(const SampleWords& w, const Study& study) {
    Plot plot;
    plot.title = std::filesystem::path(w.environment_name()).filename().string();
    plot.subtitle =
        fmt::format("{}; {} points, {} runs; beside each name its slope", surface_text(w), w.sequence, study.runs);
    plot.x = {"samples", PlotScale::logarithmic, {}};
    plot.y = {"RMS error over the reference's luminance", PlotScale::logarithmic, {}};
    bool computed = false;
    for (const StrategyResult& r : study.strategies) {
        PlotSeries s;
        s.name = fmt::format("{}  {}{}", r.name, r.slope < 0 ? "−" : "", slope_text(std::abs(r.slope)));
        s.points = r.curve;
        s.marks = true;
        // Some lie on top of others: with a Lambert surface brdf is cosine, and the two heuristics are seldom far
        // apart.
        s.line = r.name == "brdf" || r.name == "mis-power" || r.name == "product" ? PlotLine::dashed : PlotLine::solid;
        // A strategy keeps its colour whatever it is compared with.
        s.colour = plot_colour(std::size_t(std::find(k_strategy_words.begin(), k_strategy_words.end(), r.name) -
                                           k_strategy_words.begin()));
        plot.series.push_back(s);
        if (!r.missed()) continue;
        computed = true;
        s.name.clear();
        s.marks = false;
        s.line = PlotLine::dotted;
        for (auto& [n, error] : s.points) error = std::sqrt(*r.variance / n);
        plot.series.push_back(std::move(s));
    }
    if (computed) {
        PlotSeries key;
        key.name = "by the variance";
        key.line = PlotLine::dotted;
        key.colour = Colour8{60, 64, 70};
        plot.series.push_back(std::move(key));
    }
    return plot;
}

}  // namespace

Result<Told> estimate_by_all_strategies(const SampleWords& w, const EnvironmentSampler& sampler,
                                        const Progress& progress) {
    const auto study = study_strategies(w, sampler, progress);
    if (!study) return study.error();
    Told told{table(w, *study), document(w, *study)};
    if (!w.plot.empty()) {
        if (auto ok = write_screen_picture(w.plot, draw_plot(convergence_plot(w, *study)).view()); !ok)
            return ok.error().at(w.plot);
        told.json["plot"] = w.plot;
        told.text += w.plot + "\n";
    }
    return told;
}

}  // namespace domelight::cli
