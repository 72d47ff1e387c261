#include "cli/sample/sample_estimate.h"

#include "domelight/image/colour.h"
#include "domelight/io/write_image.h"
#include "domelight/study/strategy_study.h"

#include "cli/console/vector_json.h"
#include "io/file/json.h"
#include "io/file/printable.h"
#include "preview/plot.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace domelight::cli {
namespace {

/// Infinity as null, because JSON has no infinity.
Json number_json(double v) {
    return std::isfinite(v) ? Json(v) : Json(nullptr);
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

/// "MIS compensation: 7.3 times the efficiency of mis-balance".
std::string gain_text(const StrategyStudy& study, const char* what, const std::string& name, const std::string& than) {
    const double gain = study.efficiency_ratio(name, than);
    if (!std::isfinite(gain) || !(gain > 0)) return "";
    return fmt::format("{}: {} times the efficiency of {} ({})\n", what, times_text(gain), than,
                       gain > 1.1   ? "a gain"
                       : gain < 0.9 ? "a loss"
                                    : "about the same");
}

std::string table(const SampleWords& w, const StrategyStudy& study) {
    std::string text = fmt::format("{}: {}\n", escaped(w.environment_name()), surface_text(w));
    text += fmt::format("reference  {:.6g} {:.6g} {:.6g}  ± {:.1e}   ({})\n\n", study.reference.x, study.reference.y,
                        study.reference.z, luminance(study.reference_error), study.reference_method);
    text += fmt::format("{} samples, {}, seed {}; errors over {} runs\n", study.samples, name_of(w.sequence),
                        w.seed_number, study.runs);
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
    text += gain_text(study, "MIS compensation", k_compensated_mis, name_of(Strategy::mis_balance));
    text += gain_text(study, "product by resampling", name_of(Strategy::product), name_of(Strategy::environment));
    const double rays = study.product_gain_per_ray();
    if (rays > 0)
        text += fmt::format("   and {} times per shadow ray, of which it needs one for {} candidates\n",
                            times_text(rays), study.candidates);
    return text;
}

Json document(const SampleWords& w, const StrategyStudy& study) {
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
    return {
        {"surface", std::move(surface)},
        {"reference",
         {{"radiance", vector_json(study.reference)},
          {"standard_error", vector_json(study.reference_error)},
          {"method", study.reference_method}}},
        {"runs", study.runs},
        {"gains",
         {{"mis_compensation", number_json(study.efficiency_ratio(k_compensated_mis, name_of(Strategy::mis_balance)))},
          {"product", number_json(study.efficiency_ratio(name_of(Strategy::product), name_of(Strategy::environment)))},
          {"product_per_ray", number_json(study.product_gain_per_ray())}}},
        {"strategies", std::move(strategies)}};
}

/// Measured errors are dots. If the variance is known and shows that the runs missed most of it, the error that follows
/// from it is drawn as a line as well.
Plot convergence_plot(const SampleWords& w, const StrategyStudy& study) {
    Plot plot;
    plot.title = std::filesystem::path(w.environment_name()).filename().string();
    plot.subtitle = fmt::format("{}; {} points, {} runs; beside each name its slope", surface_text(w),
                                name_of(w.sequence), study.runs);
    plot.x = {"samples", PlotScale::logarithmic, {}};
    plot.y = {"RMS error over the reference's luminance", PlotScale::logarithmic, {}};
    bool computed = false;
    const std::vector<std::string>& names = studied_strategies();
    for (const StrategyResult& r : study.strategies) {
        PlotSeries s;
        s.name = fmt::format("{}  {}{}", r.name, r.slope < 0 ? "−" : "", slope_text(std::abs(r.slope)));
        s.points = r.curve;
        s.marks = true;
        // Some lines lie on top of others: on a Lambert surface "brdf" equals "cosine", and the two heuristics seldom
        // differ much.
        const auto is = [&](Strategy strategy) { return r.name == name_of(strategy); };
        s.line =
            is(Strategy::brdf) || is(Strategy::mis_power) || is(Strategy::product) ? PlotLine::dashed : PlotLine::solid;
        // A strategy has the same colour in every plot.
        s.colour = plot_colour(std::size_t(std::find(names.begin(), names.end(), r.name) - names.begin()));
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

StrategyStudyOptions study_options(const SampleWords& w, const Progress& progress) {
    StrategyStudyOptions o;
    const float alpha = float(w.roughness * w.roughness);
    const Vec3f f0 = w.metal_f0.size() == 3 ? Vec3f(Vec3d{w.metal_f0[0], w.metal_f0[1], w.metal_f0[2]})
                                            : Vec3f{1, 1, 1} * float(w.metal_f0[0]);
    if (w.brdf == "phong") o.brdf = PhongBrdf{float(w.exponent), {1, 1, 1}};
    if (w.brdf == "ggx") o.brdf = GgxBrdf{alpha, f0, {1, 1, 1}};
    if (w.brdf == "charlie") o.brdf = CharlieBrdf{alpha, {1, 1, 1}};
    o.normal = w.normal_world;
    o.view = w.view_world;
    o.samples = w.count.value_or(o.samples);
    o.sequence = w.sequence;
    o.seed = w.seed_number;
    o.strategies = w.strategies;
    o.threads = w.threads();
    o.progress = progress;
    return o;
}

}  // namespace

Result<Told> estimate_by_all_strategies(const SampleWords& w, const EnvironmentSampler& sampler,
                                        const Progress& progress) {
    const auto study = study_strategies(sampler, study_options(w, progress));
    if (!study) return study.error().at(w.environment_name());
    Told told{table(w, *study), document(w, *study)};
    if (!w.plot.empty()) {
        if (auto ok = write_screen_picture(w.plot, draw_plot(convergence_plot(w, *study)).view()); !ok)
            return ok.error().at(w.plot);
        told.json["plot"] = w.plot;
        told.text += escaped(w.plot) + "\n";
    }
    return told;
}

}  // namespace domelight::cli
