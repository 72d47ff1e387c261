#include "cli/sample/sample_explain.h"

#include "domelight/image/colour.h"
#include "domelight/io/write_image.h"
#include "domelight/study/explanation_picture.h"

#include "io/file/json.h"
#include "io/file/printable.h"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>

namespace domelight::cli {
namespace {

/// The pieces around the one that was found, which is marked by an arrow.
std::string neighbours(const CumulativeSearch& f, const char* piece, const char* axis) {
    const int n = int(f.cumulative.size()) - 1;
    std::string text = fmt::format("   {:>8}{:>16}{:>16}{:>14}\n", piece, "C at its begin", "C at its end",
                                   fmt::format("{} from", axis));
    for (int i = std::max(0, f.index - 2); i <= std::min(n - 1, f.index + 2); ++i)
        text += fmt::format("   {:>8}{:>16.9f}{:>16.9f}{:>14.7f}{}\n", i, f.cumulative[i], f.cumulative[i + 1],
                            f.places[i], i == f.index ? "   <- xi is in here" : "");
    return text;
}

std::string position_text(const CumulativeSearch& f, const char* axis, bool continuous) {
    std::string text;
    const double s = (f.xi - f.begin) / (f.end - f.begin);
    text += fmt::format(
        "   share of the piece  s = (xi - C_begin) / (C_end - C_begin) = ({:.9f} - {:.9f}) / {:.9f} = {:.6f}\n", f.xi,
        f.begin, f.end - f.begin, s);
    if (continuous)
        text += fmt::format(
            "   density linear from a = {:.6g} to b = {:.6g}:  t = s (a + b) / (a + sqrt(a^2 + s (b^2 - a^2))) = "
            "{:.6f}\n",
            f.density_begin, f.density_end, f.fraction);
    text +=
        fmt::format("   {} = begin + {} x length = {:.7f} + {:.6f} x {:.7f} = {:.7f}\n", axis, continuous ? "t" : "s",
                    f.places[f.index], f.fraction, f.places[f.index + 1] - f.places[f.index], f.position);
    return text;
}

std::string text_of(const SampleWords& w, const EnvironmentSampler& sampler, const SampleExplanation& e) {
    const int width = sampler.image().width, height = sampler.image().height;
    std::string t = fmt::format("{}, {} x {} texels, {}: the point ({:g}, {:g}) of the unit square\n\n",
                                w.environment_name(), width, height, name_of(w.sampler.method), e.point[0], e.point[1]);
    t += fmt::format("1. The row, from xi = {:g}: marginal cumulative function C, the share of the weight above v\n",
                     e.row.xi);
    t += neighbours(e.row, e.continuous ? "piece" : "row", "v") + position_text(e.row, "v", e.continuous);
    t += fmt::format("   p(v) = {:.6g}", e.row.pdf);
    t += e.continuous ? " = a + t (b - a)\n" : fmt::format(" = {} (C_end - C_begin)\n", height);
    if (!e.row.search.empty()) t += "   " + e.row.search + "\n";
    if (e.continuous)
        t += fmt::format(
            "   that lies between the centres of rows {} and {}, of which the column's density is the mixture {:.4f} : "
            "{:.4f}\n",
            e.row_above, e.row_below, 1 - e.share_below, e.share_below);
    t += fmt::format("\n2. The column, from xi = {:g}: conditional cumulative function of {}\n", e.column.xi,
                     e.continuous ? fmt::format("the mixture of rows {} and {}", e.row_above, e.row_below)
                                  : fmt::format("row {}", e.row_above));
    t += neighbours(e.column, e.continuous ? "piece" : "column", "u") + position_text(e.column, "u", e.continuous);
    t += fmt::format("   p(u | v) = {:.6g}", e.column.pdf);
    t += e.continuous ? " = a + t (b - a)\n" : fmt::format(" = {} (C_end - C_begin)\n", width);
    if (!e.column.search.empty()) t += "   " + e.column.search + "\n";
    t += fmt::format("\n3. The density\n   pdf_uv = p(v) p(u | v) = {:.6g}\n", e.pdf_uv);
    t += fmt::format(
        "   theta = pi v = {:.4f} degrees;  d omega = 2 pi^2 sin(theta) du dv;  2 pi^2 sin(theta) = {:.6g}\n",
        e.theta * 180 / k_pi, e.jacobian);
    t += fmt::format("   pdf_solid_angle = pdf_uv / (2 pi^2 sin(theta)) = {:.6g} per steradian\n",
                     e.pdf_uv / e.jacobian);
    const LightSample& s = e.sample;
    t += fmt::format(
        "\n4. What the sampler gives\n   (u, v) = ({:.7f}, {:.7f})\n   direction = ({:.6f}, {:.6f}, {:.6f})\n   "
        "radiance = ({:.6g}, {:.6g}, {:.6g}), {}\n",
        s.u, s.v, s.direction.x, s.direction.y, s.direction.z, s.radiance.x, s.radiance.y, s.radiance.z,
        e.continuous ? "bilinear" : "of the texel");
    const double light = luminance(Vec3d(s.radiance));
    t += fmt::format("   pdf_solid_angle = {:.6g}\n   luminance / pdf_solid_angle = {:.6g}", s.pdf_solid_angle,
                     light / s.pdf_solid_angle);
    if (!w.sampler.compensate && w.sampler.weight == LightWeight::radiant_power)
        t += ": about the same wherever the point falls, so that little noise is left";
    return t + "\n";
}

Json found_json(const CumulativeSearch& f, const char* axis) {
    return {{"xi", f.xi},       {"index", f.index}, {"begin", f.begin},  {"end", f.end}, {"fraction", f.fraction},
            {axis, f.position}, {"pdf", f.pdf},     {"search", f.search}};
}

Json json_of(const SampleExplanation& e) {
    const LightSample& s = e.sample;
    Json row = found_json(e.row, "v"), column = found_json(e.column, "u");
    column["rows"] = {e.row_above, e.row_below};
    column["share_of_lower_row"] = e.share_below;
    return {{"point", e.point},
            {"row", std::move(row)},
            {"column", std::move(column)},
            {"pdf_uv", e.pdf_uv},
            {"theta_deg", e.theta * 180 / k_pi},
            {"jacobian", e.jacobian},
            {"pdf_solid_angle", e.pdf_uv / e.jacobian},
            {"sample",
             {{"u", s.u},
              {"v", s.v},
              {"direction", {s.direction.x, s.direction.y, s.direction.z}},
              {"radiance", {s.radiance.x, s.radiance.y, s.radiance.z}},
              {"pdf_solid_angle", s.pdf_solid_angle}}}};
}

}  // namespace

Result<Told> told_explanation(const SampleWords& w, const EnvironmentSampler& sampler) {
    const SampleExplanation e = explain_sample(sampler, {w.explain[0], w.explain[1]});
    Told told{text_of(w, sampler, e), json_of(e)};
    if (!w.explain_picture.empty()) {
        const std::string title = std::filesystem::path(w.environment_name()).filename().string();
        if (auto ok =
                write_screen_picture(w.explain_picture, explanation_picture(sampler, e, title, w.threads()).view());
            !ok)
            return ok.error().at(w.explain_picture);
        told.text += "\n" + escaped(w.explain_picture) + "\n";
        told.json["picture"] = w.explain_picture;
    }
    return told;
}

}  // namespace domelight::cli
