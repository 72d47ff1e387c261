#include "domelight/base/version.h"
#include "domelight/io/write_image.h"

#include "cli/commands.h"
#include "cli/console/console.h"
#include "cli/console/environment_options.h"
#include "cli/console/output_endings.h"
#include "cli/console/print.h"
#include "cli/sample/sample_estimate.h"
#include "cli/sample/sample_explain.h"
#include "cli/sample/sample_options.h"
#include "cli/sample/sample_output.h"
#include "io/file/json.h"
#include "io/file/output_place.h"
#include "preview/sample_picture.h"

#include <fmt/core.h>
#include <unistd.h>

namespace domelight::cli {
namespace {

std::vector<LightSample> draw(const SampleWords& w, const EnvironmentSampler& sampler) {
    const int count = w.count.value_or(1024);
    std::vector<LightSample> samples(count);
    for (int i = 0; i < count; ++i)
        samples[i] = sampler.sample(unit_point(w.sequence, w.seed_number, std::uint32_t(i), std::uint32_t(count)));
    return samples;
}

std::string drawn_how(const SampleWords& w) {
    std::string text = fmt::format("{} · {}", name_of(w.sampler.method), name_of(w.sampler.weight));
    if (w.sampler.compensate) text += " · compensated";
    if (w.sampler.uniform_share > 0) text += fmt::format(" · {:g} uniform", w.sampler.uniform_share);
    return text;
}

Result<void> write_pictures(const SampleWords& w, const EnvironmentSampler& sampler) {
    SamplePictureOptions options;
    options.title = std::filesystem::path(w.environment_name()).filename().string();
    options.width = w.picture_width.value_or(1024);
    options.threads = w.threads();
    if (!w.picture.empty()) {
        options.subtitle = fmt::format("{} samples · {} · {}, seed {}", w.count.value_or(1024), drawn_how(w),
                                       name_of(w.sequence), w.seed_number);
        if (auto ok = write_screen_picture(w.picture, sample_picture(sampler, draw(w, sampler), options).view()); !ok)
            return ok.error().at(w.picture);
    }
    if (!w.heat.empty()) {
        const bool uv = w.heat_measure == DensityMeasure::uv;
        options.subtitle = fmt::format("density {} · {}",
                                       uv ? "over the image, pdf_uv" : "per steradian, pdf_solid_angle", drawn_how(w));
        if (auto ok = write_screen_picture(w.heat, density_picture(sampler, w.heat_measure, options).view()); !ok)
            return ok.error().at(w.heat);
    }
    return {};
}

/// Does the parts of the work one after the other. `json` collects their results.
Result<void> work(const SampleWords& w, const EnvironmentSampler& sampler, Json& json) {
    const bool only_samples =
        w.picture.empty() && w.heat.empty() && w.tables.empty() && !w.estimate && w.explain.empty();
    if (!w.output.empty() || only_samples) {
        ProgressBar bar(w.environment_name(), w.common);
        if (auto ok = write_samples(w, sampler, w.output.empty() && isatty(1) ? Progress{} : bar.callback()); !ok)
            return ok.error().at(w.output);
        if (w.output.empty()) return {};
    }
    if (auto ok = write_pictures(w, sampler); !ok) return ok;
    Json files = Json::array();
    for (const std::string& file : {w.output, w.picture, w.heat})
        if (!file.empty()) files.push_back(file);
    if (!w.tables.empty()) {
        auto tables = write_tables(w, sampler);
        if (!tables) return tables.error();
        for (const std::string& name : tables->files)
            files.push_back((std::filesystem::path(w.tables) / name).string());
        json["tables"] = Json{{"total_average", tables->total_average}};
    }
    const bool text = !w.common.json && !w.common.quiet;
    if (text)
        for (const Json& file : files.elements()) print("{}\n", file.get<std::string>());
    json["files"] = std::move(files);
    if (!w.explain.empty()) {
        auto told = told_explanation(w, sampler);
        if (!told) return told.error();
        if (!w.common.json) print_lines(told->text);
        json["explanation"] = std::move(told->json);
    }
    if (w.estimate) {
        ProgressBar bar(w.environment_name(), w.common);
        auto study = estimate_by_all_strategies(w, sampler, bar.callback());
        if (!study) return study.error();
        if (!w.common.json) print_lines(study->text);
        json["estimate"] = std::move(study->json);
    }
    return {};
}

}  // namespace

int run_sample(const std::vector<std::string>& words) {
    SampleWords w;
    Arguments arguments("sample",
                        "Draws light directions from an environment in proportion to its radiance, shows where they "
                        "lie, explains how one is found, and compares the error of each strategy for the light that a "
                        "surface reflects.",
                        {"domelight sample studio.hdr -n 8",
                         "domelight sample studio.hdr -n 4096 -o samples.json --picture samples.png --heat density.png",
                         "domelight sample studio.hdr --explain 0.25,0.5 --method binary",
                         "domelight sample studio.hdr --estimate --brdf ggx --roughness 0.4 --view 1,1,0 -n 1024 "
                         "--plot convergence.png",
                         "domelight sample studio.hdr --tables shader"});
    declare_sample_options(arguments, w);
    if (const auto code = begin_command(arguments, words, w.common)) return *code;
    if (auto ok = check_sample_options(arguments, w); !ok) return print_error(ok.error(), exit_usage);
    if (auto ok =
            check_output_places({w.output, w.picture, w.heat, w.plot, w.explain_picture}, environment_files(w.inputs));
        !ok)
        return print_error(ok.error());
    if (!w.tables.empty())
        if (auto ok = check_output_folder(w.tables); !ok) return print_error(ok.error());

    auto environment = open_light_to_draw_from(w.inputs, w.environment);
    if (!environment) return print_error(environment.error());
    auto sampler = EnvironmentSampler::build(*environment, w.sampler);
    if (!sampler) return print_error(sampler.error().at(w.environment_name()));
    print_warnings(environment->report().lines(), w.common, w.environment_name());
    if (w.sampler.compensate && !w.common.quiet && sampler->compensation() > 0)
        print_warnings({"compensated samples leave out the light below the mean: use them only beside BRDF sampling"},
                       w.common);

    const bool plain_points = w.seed_number == 0 && (w.sequence == Sequence::sobol || w.sequence == Sequence::halton);
    if (w.sampler.method == DistributionMethod::alias && (w.sequence == Sequence::hammersley || plain_points))
        print_warnings({fmt::format("an alias table chooses by the lower bits of a point, which all points of {} "
                                    "share: these samples do not follow the density; "
                                    "take --sequence random or another method",
                                    plain_points ? "a sequence with seed 0" : "hammersley")},
                       w.common);

    Json json{{"version", version()},
              {"environment", w.environment_name()},
              {"width", sampler->image().width},
              {"height", sampler->image().height},
              {"method", name_of(w.sampler.method)},
              {"weight", name_of(w.sampler.weight)},
              {"sequence", name_of(w.sequence)},
              {"seed", w.seed_number}};
    const auto done = work(w, *sampler, json);
    if (!done) return print_error(done.error());
    if (w.common.json && json.contains("files")) print_document(json);
    return exit_done;
}

}  // namespace domelight::cli
