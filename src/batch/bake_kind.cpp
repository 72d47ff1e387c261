// Jobs that bake an environment for engines.
#include "domelight/bake/bake.h"
#include "domelight/engines/engine.h"
#include "domelight/io/environment/open_environment.h"

#include "batch/job_kind.h"
#include "batch/option_reader.h"

#include <algorithm>
#include <cmath>

namespace domelight {
namespace {

/// The two words of the command line for what an irradiance map holds.
void read_irradiance(OptionReader& reader, BakeOptions& options) {
    if (!reader.given("irradiance")) return reader.know("irradiance");
    std::string word = "e";
    reader.read_word("irradiance", word, {"e", "over-pi"}, "a quantity");
    options.irradiance_quantity = word == "e" ? Quantity::irradiance : Quantity::irradiance_over_pi;
}

void read_plain_methods(OptionReader& reader, BakeOptions& options) {
    reader.read("method", options.method);
    reader.read("samples", options.points.count, 1, 1 << 24);
    reader.read("sequence", options.points.sequence);
    reader.read("seed", options.points.seed);
    std::vector<double> steps;
    reader.read("riemann_steps", steps);
    if (steps.size() == 2) {
        options.riemann.phi_steps = int(steps[0]);
        options.riemann.theta_steps = int(steps[1]);
    } else if (!steps.empty()) {
        reader.fail({"is not two numbers", field_place("riemann_steps"), "[K, J]: K steps of phi by J of theta."});
    }
    std::string sum = options.riemann.normalised ? "normalised" : "plain";
    reader.read_word("riemann_sum", sum, {"normalised", "plain"}, "a Riemann sum");
    options.riemann.normalised = sum == "normalised";
}

Result<BakeOptions> options_of(const Json& json) {
    OptionReader reader(json);
    BakeOptions o;
    reader.read("for", o.engines);
    reader.read("layout", o.layout);
    reader.read("size", o.size);
    reader.read("levels", o.levels);
    reader.read("roughness", o.roughness);
    reader.read("lobe", o.lobe);
    reader.read("exponents", o.exponents);
    reader.read("texels", o.texels);
    read_plain_methods(reader, o);
    reader.read("encoding", o.encoding);
    reader.read("encoding_quality", o.encoding_quality);
    reader.read("format", o.format);
    reader.read("zstd", o.zstd);
    reader.read("cube_picture", o.cube_picture);
    reader.read("latlong_out", o.latlong_out);
    read_irradiance(reader, o);
    reader.read("irradiance_size", o.irradiance_size);
    reader.read("sh_bands", o.sh_bands);
    reader.read("sh_window", o.sh_window);
    reader.read("brdf_g", o.brdf_g);
    reader.read("brdf_form", o.brdf_form);
    reader.read("brdf_size", o.brdf_size);
    reader.read("brdf_float", o.brdf_float);
    reader.read("as_read", o.as_read);
    reader.read("preview", o.preview);
    reader.read("hashes", o.hashes);
    read_environment_options(reader, o.environment);
    if (auto ok = reader.finish(); !ok) return ok.error();
    if (auto ok = check_bake_options(o); !ok) return ok.error();
    return o;
}

/// Seconds for each texel of encodings that search, beyond what the plain ones take.
double search_seconds(Encoding encoding, EncodingQuality quality) {
    const double effort = quality == EncodingQuality::exhaustive ? 50 : quality == EncodingQuality::high ? 4 : 1;
    switch (encoding) {
        case Encoding::bc6h:
            return 0.33e-6 * effort;
        case Encoding::uastc_hdr:
            return 0.1e-6 * effort;
        case Encoding::astc4x4_hdr:
        case Encoding::astc6x6_hdr:
            return 1.2e-6 * effort;
        default:
            return 0;
    }
}

/// CPU seconds of an engine's files at its own sizes, without what all share, and further ones for each texel of the
/// source where an engine gets an image as large as that. The means over nine environments of 512 x 256 to 4096 x 2048,
/// on one core of 2021. Light from small bright sources takes the filters of khronos and unreal five times as long as
/// that of an overcast sky.
struct EngineCost {
    const char* engine;
    double seconds, per_source_texel;
};
constexpr EngineCost k_engine_costs[] = {
    {"generic", 0.17, 0},       {"three", 0.65, 0},       {"three-latlong", 0.3, 0}, {"babylon", 0.65, 0},
    {"filament", 0.12, 0},      {"khronos", 4.2, 0},      {"unity", 0.55, 0},        {"playcanvas", 0.24, 0},
    {"gltf", 0.45, 0},          {"unreal", 3, 0},         {"bevy", 0.22, 0},         {"materialx", 0.17, 0},
    {"blender", 0.15, 0.14e-6}, {"godot", 0.15, 0.13e-6}, {"usd", 0.15, 0.13e-6},    {"mitsuba", 0.2, 0.34e-6},
    {"pbrt", 0.25, 0.3e-6},
};

EngineCost cost_of(const std::string& engine) {
    for (const EngineCost& cost : k_engine_costs)
        if (engine == cost.engine) return cost;
    return {"", 0.5, 0};
}

JobEstimate estimate(const Json& json, std::span<const InputFacts> inputs) {
    const auto options = options_of(json);
    if (!options) return {1, 1 << 28};
    std::int64_t texels = 0;
    for (const InputFacts& input : inputs) texels += input.texels();
    JobEstimate estimate{0.13 + 0.015e-6 * double(texels), (std::int64_t(45) << 20) + 4 * texels};
    for (const std::string& name : options->engines) {
        const Engine& engine = **find_engine(name);
        const EngineCost cost = cost_of(name);
        const double own = engine.size > 0 ? engine.size : std::sqrt(double(texels) / 8);
        const double size = options->size.value_or(int(own)), larger = size * size / std::max(1.0, own * own);
        const bool cube = !engine.environment_only && options->layout.value_or(engine.layout) == Layout::cube;
        const double out = cube ? 8 * size * size : 3 * size * size;
        estimate.seconds += cost.seconds * (0.3 + 0.7 * larger) + cost.per_source_texel * double(texels) * larger;
        if (options->encoding && *options->encoding != engine.encoding)
            estimate.seconds += out * search_seconds(*options->encoding, options->encoding_quality);
        if (options->method != BakeMethod::exact) estimate.seconds += 1e-3 * out;
        if (options->as_read) estimate.seconds += 0.15e-6 * out;
        estimate.memory += std::int64_t(out * (engine.sheen_file.empty() ? 28 : 600));
    }
    return estimate;
}

/// The largest relative error that storing a level brought, over all maps.
double largest_error(const BakeReport& report) {
    double error = 0;
    for (const EngineReport& engine : report.engines)
        for (const BakedMap& map : engine.maps)
            for (const BakedLevel& level : map.levels) error = std::max(error, level.encoding.rms_error);
    return error;
}

/// The hashes of the files that a bake has written, by their names in `folder`.
std::map<std::string, std::string> hashes_of(const BakeReport& report, const std::filesystem::path& folder) {
    std::map<std::string, std::string> hashes;
    for (const EngineReport& engine : report.engines) {
        const auto add = [&](const BakedFile& file) {
            if (!file.sha256.empty())
                hashes[(engine.folder / file.file).lexically_relative(folder).generic_string()] = file.sha256;
        };
        for (const BakedMap& map : engine.maps) {
            add(map.file);
            for (const BakedLevel& level : map.levels) std::ranges::for_each(level.files, add);
        }
        std::ranges::for_each(engine.sh.files, add);
        add(engine.brdf.file);
        if (engine.preview) add(*engine.preview);
    }
    return hashes;
}

Result<JobReport> run(const JobCall& call) {
    auto options = options_of(call.options);
    if (!options) return options.error();
    options->threads = options->environment.threads = call.threads;
    options->source_files = call.files("environment");
    const auto environment = open_environment(options->source_files, options->environment);
    if (!environment) return environment.error();
    const auto baked = bake(*environment, *options, call.folder);
    if (!baked) return baked.error();
    JobReport report;
    report.warnings = baked->warnings;
    report.repaired = baked->repaired.repaired();
    report.error = largest_error(*baked);
    report.error_of = "RMS error of the encoding of the worst level";
    report.hashes = hashes_of(*baked, call.folder);
    const EngineReport& first = baked->engines.front();
    if (first.preview) report.preview = (first.folder / first.preview->file).lexically_relative(call.folder).string();
    return report;
}

}  // namespace

JobKind bake_kind() {
    return {.name = "bake",
            .does = "bakes an environment for engines, as `domelight bake` does",
            .roles = {"environment"},
            .makes_folder = true,
            .file_name = no_file,
            .check = check_options<options_of>,
            .estimate = estimate,
            .run = run};
}

}  // namespace domelight
