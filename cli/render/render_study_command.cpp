#include "cli/render/render_study_command.h"

#include "domelight/base/version.h"
#include "domelight/io/file/atomic_file.h"
#include "domelight/io/write_image.h"
#include "domelight/study/render_study_pictures.h"

#include "cli/console/interruption.h"
#include "cli/console/print.h"
#include "io/file/json.h"

#include <fmt/core.h>

#include <chrono>
#include <cmath>

namespace domelight::cli {
namespace {

namespace fs = std::filesystem;

Json json_of(const StrategyFigure& f) {
    Json cells = Json::array();
    for (const StrategyCell& c : f.cells) {
        const StudyLight& light = f.lights[std::size_t(c.light)];
        cells.push_back({{"occlusion", c.occlusion},
                         {"roughness", c.roughness},
                         {"light_deg", light.diameter_deg > 0 ? Json(light.diameter_deg) : Json("environment")},
                         {"strategy", name_of(c.strategy)},
                         {"tone_mapped_rmse", c.error}});
    }
    return {{"samples", f.samples}, {"reference_samples", f.reference_samples}, {"cells", std::move(cells)}};
}

Json json_of(const NoiseFigure& f) {
    Json lines = Json::array();
    for (const NoiseLine& l : f.lines) {
        Json points = Json::array();
        for (const auto& p : l.points) points.push_back({{"samples", p.samples}, {"tone_mapped_rmse", p.error}});
        lines.push_back({{"occlusion", l.occlusion},
                         {"strategy", name_of(l.strategy)},
                         {"slope", l.slope},
                         {"points", std::move(points)}});
    }
    return {{"roughness", f.roughness}, {"reference_samples", f.reference_samples}, {"lines", std::move(lines)}};
}

/// The values of the bins, a row for each roughness; null for a bin without pixels.
Json rows_of(const ImageF& table) {
    Json rows = Json::array();
    for (int y = 0; y < table.height(); ++y) {
        Json row = Json::array();
        for (int x = 0; x < table.width(); ++x) {
            const float v = *table.at(x, y);
            row.push_back(std::isfinite(v) ? Json(v) : Json(nullptr));
        }
        rows.push_back(std::move(row));
    }
    return rows;
}

Json json_of(const SplitSumFigure& f) {
    Json parts = Json::array();
    for (const auto& p : f.parts)
        parts.push_back({{"occlusion", p.occlusion},
                         {"tone_mapped_rmse", p.rmse},
                         {"reference_noise", p.noise},
                         {"error", rows_of(p.error)},
                         {"difference", rows_of(p.difference)}});
    return {{"roughness", f.roughness},
            {"NdotV_bins", f.bins},
            {"samples", f.samples},
            {"views", f.views},
            {"parts", std::move(parts)}};
}

/// Writes each figure into the folder as soon as it is made, or keeps it for the sheet.
class Output {
  public:
    explicit Output(const std::string& place) : place_(place), sheet_(is_screen_picture(place)) {}
    Result<void> begin() {
        if (sheet_) return {};
        std::error_code failure;
        fs::create_directories(place_, failure);
        if (fs::is_directory(place_)) return {};
        return Error{"cannot make this folder", place_, "Is there a file of that name, and may you write there?"};
    }
    Result<void> add(const std::string& name, Image<std::uint8_t> picture) {
        if (sheet_) {
            pictures_.push_back(std::move(picture));
            return {};
        }
        const std::string file = (fs::path(place_) / name).string();
        if (auto ok = write_png(file, picture.view()); !ok) return ok.error().at(file);
        files_.push_back(file);
        return {};
    }
    /// Writes the numbers, or the sheet.
    Result<void> end(const Json& json) {
        if (sheet_) {
            files_ = {place_};
            if (auto ok = write_screen_picture(place_, stacked(pictures_).view()); !ok) return ok.error().at(place_);
            return {};
        }
        const std::string file = (fs::path(place_) / "study.json").string(), text = json.dump(2) + "\n";
        files_.push_back(file);
        return write_file_atomically(file, text);
    }
    const std::vector<std::string>& files() const { return files_; }

  private:
    std::string place_;
    bool sheet_;
    std::vector<Image<std::uint8_t>> pictures_;
    std::vector<std::string> files_;
};

Result<Json> study(const RenderWords& w, const StudyScene& scene, const StudyLight& light, Output& output,
                   ProgressBar& bar) {
    RenderStudyOptions o;
    o.size = w.width.value_or(o.size);
    o.samples = w.spp.value_or(o.samples);
    o.seed = std::uint64_t(w.seed.value_or(0));
    o.threads = w.threads();
    const auto progress = [&](double from, double to) -> Progress {
        return [&bar, from, to](std::string_view stage, double done) {
            bar.update(stage, from + (to - from) * done);
            return !Interruption::wanted();
        };
    };
    Json json{{"version", version()}, {"scene", scene.name}, {"environment", light.name}};
    // The parts of the progress are in proportion to the time that they take.
    o.progress = progress(0, 0.45);
    const auto strategies = study_light_strategies(scene, light, o);
    if (!strategies) return strategies.error();
    json["strategies"] = json_of(*strategies);
    if (auto ok = output.add("strategies.png", strategy_picture(*strategies, scene.name)); !ok) return ok.error();

    o.progress = progress(0.45, 0.65);
    const auto noise = study_noise(scene, light, o);
    if (!noise) return noise.error();
    json["noise"] = json_of(*noise);
    if (auto ok = output.add("noise.png", noise_picture(*noise, scene.name, light.name)); !ok) return ok.error();

    o.progress = progress(0.65, 1);
    const auto split_sum = study_split_sum(scene, light, o);
    if (!split_sum) return split_sum.error();
    json["split_sum"] = json_of(*split_sum);
    if (auto ok = output.add("split-sum.png", split_sum_picture(*split_sum, scene.name, light.name)); !ok)
        return ok.error();
    if (auto ok = output.end(json); !ok) return ok.error();
    return json;
}

}  // namespace

int run_study(const RenderWords& w, std::optional<Scene> given, const Environment& environment) {
    StudyScene scene;
    if (given) {
        const auto options = render_options(w, *given);
        if (!options) return print_error(options.error());
        scene = {std::move(*given), options->camera, w.scene_name(), 0};
    } else {
        scene = study_ball();
    }
    auto sampler = EnvironmentSampler::build(environment, reference_sampler_options(LightStrategy::mis, w.threads()));
    if (!sampler) return print_error(sampler.error());
    print_warnings(environment.report().lines(), w.common, join(w.environment_files, " "));
    StudyLight light;
    light.name = w.environment_files.empty() ? "sky" : fs::path(w.environment_files[0]).stem().string();
    light.world_to_source = sampler->world_to_source();
    const auto view = sampler->image();
    light.image = ImageF(view.width, view.height, 3);
    for (int y = 0; y < view.height; ++y) std::copy_n(view.row(y), std::size_t(3) * view.width, light.image.row(y));

    Interruption interruption;
    Output output(w.outputs[0]);
    if (auto ok = output.begin(); !ok) return print_error(ok.error());
    const auto start = std::chrono::steady_clock::now();
    Result<Json> json = Error{"", "", ""};
    {
        ProgressBar bar(scene.name, w.common);
        json = study(w, scene, light, output, bar);
    }
    if (!json && Interruption::wanted())
        return interruption.end(output.files().empty() ? fmt::format("nothing was written to {}", w.outputs[0])
                                                       : fmt::format("{} are complete", join(output.files(), ", ")));
    if (!json) return print_error(json.error());
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (w.common.json) {
        (*json)["files"] = output.files();
        (*json)["seconds"] = seconds;
        print_document(*json);
    } else if (!w.common.quiet) {
        print("{}: {:.1f} s\n", join(output.files(), ", "), seconds);
    }
    return exit_done;
}

}  // namespace domelight::cli
