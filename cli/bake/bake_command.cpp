#include "domelight/bake/bake.h"
#include "domelight/io/environment/open_environment.h"

#include "cli/bake/bake_report.h"
#include "cli/commands.h"
#include "cli/console/console.h"
#include "cli/console/environment_options.h"
#include "cli/console/output_endings.h"
#include "cli/console/point_options.h"
#include "projection/latlong_convention.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>

namespace domelight::cli {
namespace {

/// The words of the command line before they become BakeOptions.
struct BakeWords {
    CommonOptions common;
    std::vector<std::string> environments, engines;
    std::string output, riemann_steps, latlong_out;
    std::optional<int> sh_bands;
    PointWords points;
    bool zstd = false, no_zstd = false, no_preview = false, no_hashes = false, force = false;
    EnvironmentOptions environment;
    BakeOptions options;  ///< what needs no more than its own option
};

/// Each engine with what is baked for it.
std::vector<std::pair<std::string, std::string>> engine_table() {
    std::vector<std::pair<std::string, std::string>> table;
    for (const Engine& engine : engines()) table.emplace_back(engine.name, engine.loads);
    return table;
}

/// The engines that get an image as large as the source where no size is given: "godot, blender, ...".
std::string engines_of_the_source_size() {
    std::vector<std::string> names;
    for (const Engine& engine : engines())
        if (engine.size == 0) names.push_back(engine.name);
    return join(names, ", ");
}

/// The encodings with room for a colour.
std::vector<NamedValue<Encoding>> colour_encodings() {
    std::vector<NamedValue<Encoding>> rows;
    for (const auto& row : EnumNames<Encoding>::table)
        if (encoding_channels(row.value) == 3) rows.push_back(row);
    return rows;
}

void declare(Arguments& a, BakeWords& w) {
    a.positional(
        "ENV", w.environments,
        fmt::format("environments; without one, {}; six faces (px nx py ny pz nz) are one cube", k_built_in_sky));
    a.group("What to bake");
    a.text("-o,--output", "DIR", w.output,
           "folder for the results; several environments go to DIR/NAME, several engines to DIR/ENGINE");
    a.choices(
        "--for", "ENGINE", w.engines, engine_table(),
        "the engine to bake for: it decides the files, sizes and conventions; may be given several times; the list "
        "below says what each engine loads (generic)");
    a.choice("--layout", w.options.layout, "cube maps, or lat-long maps with levels (the engine's)");
    a.integer("--size", "N", w.options.size,
              "size of level 0 in texels, 1 to 16384: of a cube's face, or the height of the lat-long map (the "
              "engine's; " +
                  engines_of_the_source_size() + ": as fine as the source)");
    a.integer("--levels", "N", w.options.levels,
              "number of levels, each half as large as the one before (the engine's)");
    a.numbers("--roughness", "r0,r1,...", w.options.roughness, "roughness of each level, 0 to 1 (the engine's curve)");
    a.choice("--lobe", w.options.lobe,
             "charlie: sheen; phong: (n + 2) / (2 pi) cos^(n+1), from the modified Phong BRDF; phong-plain: (n + 1) / "
             "(2 pi) cos^n (ggx)");
    a.numbers("--exponents", "n0,n1,...", w.options.exponents,
              "Phong exponent of each level; inf is the environment itself (inf, 2048, 512, ...)");
    a.choice(
        "--texels", w.options.texels,
        "what the texels of the specular cubes hold: read, the values whose interpolation between texels is nearest "
        "to the filtered light; or centre, the light in the direction of each texel's centre (read for cubes by the "
        "exact method, otherwise centre)");
    a.choice("--method", w.options.method, "exact, or one of the plain, slow methods (exact)");
    add_point_options(a, w.points);
    a.text("--riemann-steps", "KxJ", w.riemann_steps,
           "riemann: K steps of the azimuth phi, 0 to 2 pi, by J steps of the polar angle theta, 0 to pi/2; 1 to 65536 "
           "each (256x64)");
    a.choice("--riemann-sum", w.options.riemann.normalised,
             std::vector<NamedValue<bool>>{{true, "normalised"}, {false, "plain"}},
             "riemann: normalised divides the sum by the sum of its weights; plain does not, so that with J = 4 a "
             "constant L = 1 gives E = 3.224 instead of pi (normalised)");
    a.choice(
        "--irradiance", w.options.irradiance_quantity,
        std::vector<NamedValue<Quantity>>{{Quantity::irradiance, "e"}, {Quantity::irradiance_over_pi, "over-pi"}},
        "values of the irradiance map: E, or E / pi, which a shader multiplies by the albedo alone (the engine's)");
    a.integer("--irradiance-size", "N", w.options.irradiance_size,
              "face size of the irradiance cube, or half the height of a lat-long irradiance map, 1 to 4096 (the "
              "engine's)");
    a.integer("--sh-bands", "N", w.sh_bands, "bands of spherical harmonics, 1 to 64 (3)");
    a.choice("--sh-window", w.options.sh_window, "window against ringing of the harmonics (none)");
    a.choice("--brdf-g", w.options.brdf_g, "masking function of the BRDF table (correlated)");
    a.choice("--brdf-form", w.options.brdf_form, "channels of the BRDF table (the engine's)");
    a.integer("--brdf-size", "N", w.options.brdf_size, "width and height of the BRDF table, 1 to 4096 (128)");
    a.group("How to store it");
    a.choice(
        "--encoding", w.options.encoding, colour_encodings(),
        "how the texels of the maps are stored; without this option an EXR has half floats, or 32-bit floats where "
        "half floats would clip (the engine's)");
    a.choice("--encoding-quality", w.options.encoding_quality,
             "how thoroughly bc6h, uastc-hdr and astc search for the best block; exhaustive takes minutes (default)");
    a.choice("--format", w.options.format, with_names(containers_for_any_engine()),
             "container of the maps; dds9 is DDS with the old header; exr and hdr write one file for each level, "
             "exr-mip one file with all levels and OpenEXR's envmap attribute (the engine's)");
    a.choice("--cube-picture", w.options.cube_picture, "layout of a cube in exr and hdr: one picture or six (cross)");
    a.text("--latlong-out", "CONVENTION", w.latlong_out,
           "convention of lat-long maps and of the environment as a lat-long image: " +
               join(latlong_convention_names(), ", ") + k_other_conventions + " (the engine's)");
    a.flag("--zstd", w.zstd, "compress .ktx2 with zstd, without loss");
    a.flag("--no-zstd", w.no_zstd, "do not compress .ktx2, even where zstd is the engine's default");
    a.flag("--brdf-float", w.options.brdf_float, "32-bit floats in the BRDF table");
    a.flag("--no-preview", w.no_preview, "no preview.png");
    a.flag(
        "--as-read", w.options.as_read,
        "measure what a shader reads, between texels and between levels, against the exact filter, and put the errors "
        "into the manifest");
    a.flag("--no-hashes", w.no_hashes, "no SHA-256 in the manifest");
    a.flag("--force", w.force, "with several environments: also bake those that are up to date");
    add_environment_options(a, w.environment);
    add_common_options(a, w.common);
}

Result<void> parse_riemann_steps(const std::string& words, BakeOptions& options) {
    const auto steps = split(words, 'x');
    const auto k = parse_integer(steps[0]), j = parse_integer(steps.size() == 2 ? steps[1] : "");
    if (!k || !j)
        return Error{"\"" + words + "\" is not two whole numbers", "--riemann-steps",
                     "Write KxJ: K steps of phi by J of theta, as in 256x64."};
    options.riemann.phi_steps = *k;
    options.riemann.theta_steps = *j;
    return {};
}

Result<BakeOptions> bake_options(const BakeWords& w) {
    BakeOptions o = w.options;
    if (!w.engines.empty()) o.engines = w.engines;
    const auto points = montecarlo_points(w.points, o.method);
    if (!points) return points.error();
    o.points = *points;
    if (!w.riemann_steps.empty())
        if (auto ok = parse_riemann_steps(w.riemann_steps, o); !ok) return ok.error();
    if (!w.latlong_out.empty()) o.latlong_out = w.latlong_out;
    if (w.zstd && w.no_zstd) return Error{"contradicts --no-zstd", "--zstd", "Give one of them."};
    if (w.zstd || w.no_zstd) o.zstd = w.zstd;
    o.sh_bands = w.sh_bands.value_or(o.sh_bands);
    o.preview = !w.no_preview;
    o.hashes = !w.no_hashes;
    o.threads = w.common.threads.value_or(0);
    o.environment = w.environment;
    o.environment.threads = o.threads;
    if (auto ok = check_bake_options(o); !ok) return ok.error();
    return o;
}

/// One environment's files and where its bake goes.
struct Job {
    std::vector<std::string> environment;
    std::filesystem::path folder;
};

/// The name of an environment's folder below the folder for all: that of its file without the ending. What would lead
/// out of that folder or be the folder itself ("...hdr" without its ending is "..") is replaced.
std::string folder_name(const std::filesystem::path& file) {
    const auto leads_away = [](const std::string& name) { return name.empty() || name == "." || name == ".."; };
    std::error_code failure;
    for (const std::string& name :
         {file.stem().string(), file.filename().string(),
          std::filesystem::weakly_canonical(std::filesystem::absolute(file, failure), failure).filename().string()})
        if (!leads_away(name)) return name;
    return "environment";
}

Result<std::vector<Job>> list_jobs(const BakeWords& w) {
    if (w.output.empty()) return Error{"is missing", "--output", "Say where the results go: -o DIR."};
    if (auto ok = check_folder("--output", w.output); !ok) return ok.error();
    if (is_one_environment(w.environments, w.environment)) return std::vector<Job>{{w.environments, w.output}};
    std::vector<Job> jobs;
    std::map<std::string, std::string> stems;
    for (const std::string& file : w.environments) {
        // A folder of faces goes by its own name, with or without a slash behind it.
        const std::filesystem::path path = std::filesystem::path(file).has_filename()
                                               ? std::filesystem::path(file)
                                               : std::filesystem::path(file).parent_path();
        const std::string stem = folder_name(path);
        if (const auto [at, is_new] = stems.emplace(stem, file); !is_new)
            return Error{fmt::format("{} and {} would both go to {}", at->second, file,
                                     (std::filesystem::path(w.output) / stem).string()),
                         "--output", "Bake them one by one into folders of your choice."};
        jobs.push_back({{file}, std::filesystem::path(w.output) / stem});
    }
    return jobs;
}

void warn_of_idle(const BakeWords& w, const BakeOptions& o, const Arguments& arguments, std::size_t jobs) {
    bool searched = false, pictures = false, tables = false, maps = false, ktx2 = false;
    for (const std::string& name : o.engines) {
        const auto found = find_engine(name);
        if (!found) continue;
        const Engine& engine = **found;
        const Container container = o.format.value_or(engine.container);
        const Encoding encoding =
            o.encoding.value_or(container == engine.container ? engine.encoding : Encoding::rgba16f);
        searched |= encoding == Encoding::bc6h || encoding == Encoding::uastc_hdr ||
                    encoding == Encoding::astc4x4_hdr || encoding == Encoding::astc6x6_hdr;
        pictures |= (container == Container::exr || container == Container::hdr) &&
                    o.layout.value_or(engine.layout) == Layout::cube && !engine.environment_only;
        tables |= !engine.environment_only && o.brdf_form.value_or(engine.brdf_form) != BrdfForm::none;
        maps |= !engine.environment_only;
        ktx2 |= container == Container::ktx2;
    }
    const char* const table = "an engine that loads a BRDF table";
    warn_of_idle_options(arguments,
                         {{"--riemann-steps", o.method == BakeMethod::riemann, "--method riemann"},
                          {"--riemann-sum", o.method == BakeMethod::riemann, "--method riemann"},
                          {"--encoding-quality", searched, "--encoding bc6h, uastc-hdr, astc4x4-hdr or astc6x6-hdr"},
                          {"--cube-picture", pictures, "cubes in --format exr or hdr"},
                          {"--no-zstd", ktx2, "--format ktx2"},
                          {"--brdf-g", tables, table},
                          {"--brdf-size", tables, table},
                          {"--brdf-float", tables, table},
                          {"--brdf-form", tables || o.brdf_form == BrdfForm::none, table},
                          {"--irradiance-size", maps, "an engine that loads filtered maps"},
                          {"--force", jobs > 1, "several environments"}},
                         w.common);
}

BakeOutcome run_job(const Job& job, bool skip_up_to_date, BakeOptions options, const CommonOptions& common) {
    BakeOutcome outcome;
    outcome.environment = job.environment;
    outcome.folder = job.folder;
    const Stopwatch stopwatch;
    if (!job.environment.empty()) options.source_files = environment_files(job.environment, options.environment);
    if (skip_up_to_date && bake_is_up_to_date(options.source_files, options, job.folder)) {
        outcome.up_to_date = true;
        return outcome;
    }
    ProgressBar bar(job.environment.empty() ? "sky" : std::filesystem::path(job.environment[0]).filename().string(),
                    common);
    options.progress = bar.callback();
    auto environment = open_environment_or_sky(job.environment, options.environment);
    if (!environment) {
        outcome.error = environment.error();
        return outcome;
    }
    auto report = bake(*environment, options, job.folder);
    if (report)
        outcome.report = *std::move(report);
    else
        outcome.error = report.error();
    outcome.seconds = stopwatch.seconds();
    return outcome;
}

}  // namespace

int run_bake(const std::vector<std::string>& words) {
    BakeWords w;
    Arguments arguments(
        "bake",
        "Bakes environments (Radiance HDR, OpenEXR, PNG, JPEG, or a cube in KTX2, KTX, DDS or .env) for real-time "
        "engines: specular levels, "
        "irradiance, spherical harmonics, BRDF table, a picture of them, and a manifest that "
        "describes every file.",
        {"domelight bake studio.hdr -o out",
         "domelight bake studio.hdr evening.hdr -o lights --for khronos --for filament",
         "domelight bake studio.hdr -o small --size 128 --levels 5 --encoding rgb9e5 --zstd",
         "domelight bake studio.hdr -o tiny --size 128 --encoding bc6h --encoding-quality high"});
    declare(arguments, w);
    if (const auto code = begin_command(arguments, words, w.common)) return *code;
    const auto options = bake_options(w);
    if (!options) return print_error(options.error(), exit_usage);
    const auto jobs = list_jobs(w);
    if (!jobs) return print_error(jobs.error(), exit_usage);
    warn_of_idle(w, *options, arguments, jobs->size());

    std::vector<BakeOutcome> outcomes;
    int status = exit_done;
    for (const Job& job : *jobs) {
        outcomes.push_back(run_job(job, jobs->size() > 1 && !w.force, *options, w.common));
        const BakeOutcome& outcome = outcomes.back();
        if (outcome.error) {
            status = std::max(status, print_error(*outcome.error));
        } else {
            print_warnings(outcome.report.warnings, w.common, jobs->size() > 1 ? job.environment[0] : "");
            if (!w.common.json && !w.common.quiet) print_summary(outcome);
        }
    }
    if (w.common.json) print_json(outcomes);
    return status;
}

}  // namespace domelight::cli
