#include "baking.h"

#include "domelight/bake/bake.h"

#include "base/field_place.h"
#include "environment.h"
#include "environment_words.h"
#include "keywords.h"
#include "work.h"

#include <fmt/format.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/vector.h>

#include <array>
#include <filesystem>
#include <string_view>
#include <utility>

namespace domelight::python {
namespace {

/// The two words of the command line for what an irradiance map holds.
void read_irradiance(const Keywords& words, BakeOptions& options) {
    std::string word;
    words.read("irradiance", word);
    if (word.empty()) return;
    if (word != "e" && word != "over-pi")
        throw Failure(unknown_name(word, "a quantity", std::array<std::string, 2>{"e", "over-pi"})
                          .at(field_place("irradiance")));
    options.irradiance_quantity = word == "e" ? Quantity::irradiance : Quantity::irradiance_over_pi;
}

void read_plain_methods(const Keywords& words, BakeOptions& options) {
    words.read("method", options.method);
    words.read("samples", options.points.count);
    words.read("sequence", options.points.sequence);
    words.read("seed", options.points.seed);
    std::vector<double> steps;
    words.read("riemann_steps", steps);
    if (!steps.empty()) {
        if (steps.size() != 2)
            throw Failure({fmt::format("{} numbers, expected two", steps.size()), field_place("riemann_steps"),
                           "(K, J): K steps of phi by J of theta."});
        options.riemann.phi_steps = int(steps[0]);
        options.riemann.theta_steps = int(steps[1]);
    }
    words.read("riemann_normalised", options.riemann.normalised);
}

BakeOptions bake_options(const Keywords& words) {
    BakeOptions options;
    words.read("engines", options.engines);
    words.read("layout", options.layout);
    words.read("size", options.size);
    words.read("levels", options.levels);
    words.read("roughness", options.roughness);
    words.read("lobe", options.lobe);
    words.read("exponents", options.exponents);
    words.read("texels", options.texels);
    read_plain_methods(words, options);
    words.read("encoding", options.encoding);
    words.read("encoding_quality", options.encoding_quality);
    words.read("format", options.format);
    words.read("zstd", options.zstd);
    words.read("cube_picture", options.cube_picture);
    words.read("latlong_out", options.latlong_out);
    read_irradiance(words, options);
    words.read("irradiance_size", options.irradiance_size);
    words.read("sh_bands", options.sh_bands);
    words.read("sh_window", options.sh_window);
    words.read("brdf_g", options.brdf_g);
    words.read("brdf_form", options.brdf_form);
    words.read("brdf_size", options.brdf_size);
    words.read("brdf_float", options.brdf_float);
    words.read("as_read", options.as_read);
    words.read("preview", options.preview);
    words.read("hashes", options.hashes);
    words.read("threads", options.threads);
    return options;
}

/// The keywords that have another name than the library's field.
constexpr std::pair<const char*, const char*> k_other_names[] = {
    {"`irradiance_quantity`", "`irradiance`"}, {"`points`", "`samples`"}, {"`riemann`", "`riemann_steps`"}};

std::string with_keywords(std::string text) {
    for (const auto& [field, keyword] : k_other_names)
        for (std::size_t at; (at = text.find(field)) != std::string::npos;)
            text.replace(at, std::string_view(field).size(), keyword);
    return text;
}

Result<BakeReport> with_keywords(Result<BakeReport> report) {
    if (report) return report;
    const Error& error = report.error();
    return Error{with_keywords(error.what), with_keywords(error.where), with_keywords(error.hint)};
}

nb::dict told(const BakeReport& report) {
    nb::list engines, stages;
    for (const EngineReport& engine : report.engines) {
        nb::dict of_engine;
        of_engine["name"] = engine.name;
        of_engine["folder"] = engine.folder;
        of_engine["manifest"] = engine.manifest;
        of_engine["preview"] = engine.preview ? nb::cast(engine.preview->file) : nb::none();
        engines.append(of_engine);
    }
    for (const StageTime& stage : report.stages)
        stages.append(nb::make_tuple(stage.stage, stage.seconds, stage.cpu_seconds));
    nb::dict all;
    all["engines"] = engines;
    all["warnings"] = report.warnings;
    all["mean"] = tuple_of(report.mean_radiance);
    all["stages"] = stages;
    return all;
}

nb::dict run_bake(const Environment& environment, const std::filesystem::path& folder, const nb::dict& dictionary,
                  const nb::dict& reading, const nb::object& progress) {
    BakeOptions options = bake_options(Keywords(dictionary));
    options.environment = environment_options(Keywords(reading));
    options.environment.threads = options.threads;
    return told(run_work_for(progress, [&](const Progress& report) {
        options.progress = report;
        return value_of(with_keywords(bake(environment, options, folder)));
    }));
}

}  // namespace

void declare_baking(nb::module_& module) {
    module.def("bake", &run_bake, nb::arg("environment"), nb::arg("folder"), nb::arg("options"), nb::arg("reading"),
               nb::arg("progress") = nb::none());
    module.def("engines", [] {
        nb::dict names;
        for (const Engine& engine : engines()) names[engine.name.c_str()] = engine.loads;
        return names;
    });
}

}  // namespace domelight::python
