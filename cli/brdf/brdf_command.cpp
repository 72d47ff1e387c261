#include "domelight/bake/bake.h"
#include "domelight/bake/brdf_file.h"
#include "domelight/base/version.h"
#include "domelight/io/file/file_extension.h"

#include "cli/commands.h"
#include "cli/console/console.h"
#include "cli/console/output_endings.h"
#include "cli/console/point_options.h"
#include "cli/console/print.h"
#include "io/file/json.h"

#include <fmt/core.h>

namespace domelight::cli {
namespace {

struct BrdfWords {
    CommonOptions common;
    std::string output, engine;
    std::optional<BrdfForm> form;
    BrdfG g = BrdfG::correlated;
    BakeMethod method = BakeMethod::exact;
    std::optional<int> size;
    PointWords points;
    bool single_precision = false;
};

std::vector<std::string> engine_names() {
    std::vector<std::string> names;
    for (const Engine& engine : engines()) names.push_back(engine.name);
    return names;
}

void declare(Arguments& a, BrdfWords& w) {
    a.group("The table");
    a.text("-o,--output", "FILE", w.output,
           "where to write it: .ktx2, .ktx, .dds, .exr, .hdr, or .png with 8 bits, linear");
    a.choice("--for", w.engine, engine_names(), "the engine whose form and size to use (generic)");
    a.choice(
        "--form", w.form, with_names({BrdfForm::scale_bias, BrdfForm::multiscatter, BrdfForm::scale_bias_charlie}),
        "channels: scale and bias of F0; bias and scale + bias, as Filament reads them for multiple scattering; or "
        "scale, bias and the albedo of sheen (the engine's)");
    a.integer("--size", "N", w.size, "width and height, 1 to 4096 (the engine's)");
    a.choice("--g", w.g, "masking function (correlated)");
    a.flag("--float", w.single_precision, "32-bit floats in .ktx2, .ktx, .dds and .exr, instead of 16");
    a.choice("--method", w.method, with_names({BakeMethod::exact, BakeMethod::montecarlo}),
             "exact: by quadrature, to 1e-5; montecarlo: by a sum over sampled half vectors (exact)");
    add_point_options(a, w.points);
    add_common_options(a, w.common);
}

Result<BrdfFileOptions> brdf_options(const BrdfWords& w) {
    if (w.output.empty()) return Error{"is missing", "--output", "Say where the table goes: -o brdf.ktx2."};
    if (auto ok = check_ending("--output", w.output, brdf_file_extensions()); !ok) return ok.error();
    const auto engine = find_engine(w.engine.empty() ? engines().front().name : w.engine);
    if (!engine) return engine.error().at("--for");
    BrdfFileOptions o;
    o.form = w.form.value_or((*engine)->brdf_form);
    if (o.form == BrdfForm::none)
        return Error{w.engine + " loads no such table: it has its own", "--for",
                     "Say which channels: --form scale-bias."};
    o.size = w.size.value_or((*engine)->brdf_size);
    if (o.size < 1 || o.size > 4096) return Error{fmt::format("{} is not from 1 to 4096", o.size), "--size", ""};
    o.g = w.g;
    o.single_precision = w.single_precision;
    o.threads = w.common.threads.value_or(0);
    auto points = montecarlo_points(w.points, w.method);
    if (!points) return points.error();
    if (w.method == BakeMethod::montecarlo) o.points = *points;
    return o;
}

void print_result(const BrdfWords& w, const BrdfFileOptions& o) {
    if (w.common.json) {
        Json json{{"version", version()},    {"file", w.output}, {"form", name_of(o.form)},
                  {"masking", name_of(o.g)}, {"size", o.size},   {"method", name_of(w.method)},
                  {"axes", k_brdf_axes}};
        if (o.points) {
            json["samples"] = o.points->count;
            json["sequence"] = name_of(o.points->sequence);
            json["seed"] = o.points->seed;
        }
        print_document(json);
    } else if (!w.common.quiet) {
        print("{}: {}, {} x {}, {}\n", w.output, name_of(o.form), o.size, o.size, k_brdf_axes);
    }
}

}  // namespace

int run_brdf(const std::vector<std::string>& words) {
    BrdfWords w;
    Arguments arguments(
        "brdf",
        "Writes the BRDF table of the split sum alone, which is the same for every environment. A shader reads it "
        "at (NdotV, roughness).",
        {"domelight brdf -o brdf.ktx2", "domelight brdf -o dfg.exr --for filament",
         "domelight brdf -o lut.png --size 64 --form scale-bias-charlie",
         "domelight brdf -o lecture.hdr --size 32 --method montecarlo --g karis"});
    declare(arguments, w);
    if (const auto code = begin_command(arguments, words, w.common)) return *code;
    const auto options = brdf_options(w);
    if (!options) return print_error(options.error(), exit_usage);
    if (auto ok = check_output_places({w.output}); !ok) return print_error(ok.error());
    const std::string ending = lower_case_extension(w.output);
    warn_of_idle_options(arguments, {{"--float", ending != ".hdr" && ending != ".png", "a .ktx2, .ktx, .dds or .exr"}},
                         w.common);
    if (auto ok = write_brdf_file(w.output, *options); !ok) return print_error(ok.error().at(w.output));
    print_result(w, *options);
    return exit_done;
}

}  // namespace domelight::cli
