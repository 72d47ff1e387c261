#include "domelight/bake/bake.h"
#include "domelight/bake/brdf_file.h"
#include "domelight/filtering/kernel/lobe_names.h"
#include "domelight/io/environment/open_environment.h"

#include "cli/bake/bake_report.h"
#include "cli/commands.h"
#include "cli/console/console.h"
#include "cli/console/environment_options.h"
#include "cli/console/point_options.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>

namespace domelight::cli {
namespace {

/// The words of the command line before they become BakeOptions.
struct BakeWords {
    CommonOptions common;
    std::vector<std::string> environments, engines;
    std::string output, lobe, method = "exact", riemann_steps, riemann_sum = "normalised", layout, encoding,
                              encoding_quality, format, cube_picture = "cross";
    std::string irradiance, latlong_out;
    std::string sh_window = "none", brdf_g = "correlated", brdf_form;
    std::optional<int> size, levels, irradiance_size, sh_bands, brdf_size;
    std::vector<double> roughness, exponents;
    PointWords points;
    bool zstd = false, no_zstd = false, brdf_float = false, no_preview = false, no_hashes = false, force = false;
    EnvironmentOptions environment;
};

/// Each engine with what is baked for it.
std::vector<std::pair<std::string, std::string>> engine_table() {
    std::vector<std::pair<std::string, std::string>> table;
    for (const Engine& engine : engines()) table.emplace_back(engine.name, engine.loads);
    return table;
}

void declare(Arguments& a, BakeWords& w) {
    a.positional(
        "ENV", w.environments,
        "environments; without one, the built-in sky, darkened by eight stops; six faces (px nx py ny pz nz) are one "
        "cube");
    a.group("What to bake");
    a.text("-o,--output", "DIR", w.output,
           "folder for the results; several environments go to DIR/NAME, several engines to DIR/ENGINE");
    a.choices("--for", "ENGINE", w.engines, engine_table(),
              "the engine whose files and conventions to make; several are allowed (generic)");
    a.choice("--layout", w.layout, {"cube", "latlong"}, "cube maps, or lat-long maps with levels (cube)");
    a.integer("--size", "N", w.size,
              "level 0: cube face size, or height of the lat-long map (the engine's; else the source's)");
    a.integer("--levels", "N", w.levels, "number of levels, each half the size (the engine's)");
    a.numbers("--roughness", "r0,r1,...", w.roughness, "roughness of each level, 0 to 1 (the engine's curve)");
    a.choice("--lobe", w.lobe, {"ggx", "charlie", "phong", "phong-plain"},
             "ggx; charlie (sheen); phong, (n + 2) cos^(n+1) of the modified BRDF; phong-plain, (n + 1) cos^n (ggx)");
    a.numbers("--exponents", "n0,n1,...", w.exponents,
              "Phong exponent of each level; inf is the environment itself (inf, 2048, 512, ...)");
    a.choice("--method", w.method, {"exact", "bruteforce", "riemann", "montecarlo"},
             "exact, or one of the plain, slow methods (exact)");
    add_point_options(a, w.points);
    a.text("--riemann-steps", "KxJ", w.riemann_steps,
           "riemann: K steps of phi (azimuth, to 2 pi) by J of theta (polar angle, to pi/2), as in the lectures "
           "(256x64)");
    a.choice("--riemann-sum", w.riemann_sum, {"normalised", "plain"},
             "riemann: normalised, divided by the sum of its weights; plain, the lectures' sum as it stands, which "
             "gives E = 3.224 and not pi for L = 1 and J = 4 (normalised)");
    a.choice(
        "--irradiance", w.irradiance, {"e", "over-pi"},
        "values of the irradiance map: E, or E / pi, which a shader multiplies by the albedo alone (the engine's)");
    a.integer("--irradiance-size", "N", w.irradiance_size, "face size of the irradiance cube (the engine's)");
    a.integer("--sh-bands", "N", w.sh_bands, "bands of spherical harmonics, 1 to 64 (3)");
    a.choice("--sh-window", w.sh_window, {"none", "hann", "lanczos"}, "window against ringing of the harmonics (none)");
    a.choice("--brdf-g", w.brdf_g, {"correlated", "smith", "karis"}, "masking function of the BRDF table (correlated)");
    a.choice("--brdf-form", w.brdf_form, {"none", "scale-bias", "multiscatter", "scale-bias-charlie"},
             "channels of the BRDF table (the engine's)");
    a.integer("--brdf-size", "N", w.brdf_size, "width and height of the BRDF table (128)");
    a.group("How to store it");
    a.choice("--encoding", w.encoding,
             {"rgba16f", "rgba32f", "rgb9e5", "r11g11b10f", "bc6h", "uastc-hdr", "astc4x4-hdr", "astc6x6-hdr", "rgbm",
              "rgbd", "rgbp"},
             "texels of the maps; left out, an EXR holds halves, or rgba32f where halves would clip (the engine's)");
    a.choice("--encoding-quality", w.encoding_quality, {"fast", "default", "high", "exhaustive"},
             "how thoroughly bc6h, uastc-hdr and astc search for the best block; exhaustive takes minutes (default)");
    a.choice("--format", w.format, {"ktx2", "ktx1", "dds", "dds9", "exr", "exr-mip", "hdr"},
             "container of the maps; dds9 is DDS with the old header; exr and hdr are one file for each level, "
             "exr-mip one file with all levels and OpenEXR's envmap attribute (the engine's)");
    a.choice("--cube-picture", w.cube_picture, {"cross", "strip", "faces"},
             "layout of a cube in exr and hdr: one picture or six (cross)");
    a.text("--latlong-out", "CONVENTION", w.latlong_out,
           "convention of lat-long maps and of the environment as a lat-long image: default, usd, mitsuba, openexr, "
           "materialx, mod or centre=+X,right=+Z[,up=+Y] (the engine's)");
    a.flag("--zstd", w.zstd, "compress ktx2 without loss");
    a.flag("--no-zstd", w.no_zstd, "do not compress, even if the engine's default is to do so");
    a.flag("--brdf-float", w.brdf_float, "32-bit floats in the BRDF table");
    a.flag("--no-preview", w.no_preview, "no preview.png");
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
    static const std::map<std::string, BakeMethod> methods{{"exact", BakeMethod::exact},
                                                           {"bruteforce", BakeMethod::bruteforce},
                                                           {"riemann", BakeMethod::riemann},
                                                           {"montecarlo", BakeMethod::montecarlo}};
    static const std::map<std::string, CubePicture> pictures{
        {"cross", CubePicture::cross}, {"strip", CubePicture::strip}, {"faces", CubePicture::faces}};
    static const std::map<std::string, ShWindow> windows{
        {"none", ShWindow::none}, {"hann", ShWindow::hann}, {"lanczos", ShWindow::lanczos}};
    BakeOptions o;
    if (!w.engines.empty()) o.engines = w.engines;
    if (!w.layout.empty()) o.layout = w.layout == "cube" ? Layout::cube : Layout::latlong;
    o.size = w.size;
    o.levels = w.levels;
    o.roughness = w.roughness;
    o.exponents = w.exponents;
    if (!w.lobe.empty()) o.lobe = *lobe_from_name(w.lobe);
    o.method = methods.at(w.method);
    const auto points = montecarlo_points(w.points, w.method);
    if (!points) return points.error();
    o.points = *points;
    if (!w.riemann_steps.empty())
        if (auto ok = parse_riemann_steps(w.riemann_steps, o); !ok) return ok.error();
    o.riemann.normalised = w.riemann_sum == "normalised";
    if (!w.encoding.empty()) o.encoding = *encoding_from_name(w.encoding);
    if (!w.encoding_quality.empty()) o.encoding_quality = *encoding_quality_from_name(w.encoding_quality);
    if (!w.format.empty()) o.format = *container_from_name(w.format);
    if (!w.latlong_out.empty()) o.latlong_out = w.latlong_out;
    if (w.zstd && w.no_zstd) return Error{"contradicts --no-zstd", "--zstd", "Give one of them."};
    if (w.zstd || w.no_zstd) o.zstd = w.zstd;
    o.cube_picture = pictures.at(w.cube_picture);
    if (!w.irradiance.empty())
        o.irradiance_quantity = w.irradiance == "e" ? Quantity::irradiance : Quantity::irradiance_over_pi;
    o.irradiance_size = w.irradiance_size;
    o.sh_bands = w.sh_bands.value_or(o.sh_bands);
    o.sh_window = windows.at(w.sh_window);
    o.brdf_g = *brdf_g_from_name(w.brdf_g);
    if (!w.brdf_form.empty()) o.brdf_form = *brdf_form_from_name(w.brdf_form);
    o.brdf_size = w.brdf_size;
    o.brdf_float = w.brdf_float;
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

Result<std::vector<Job>> list_jobs(const BakeWords& w) {
    if (w.output.empty()) return Error{"is missing", "--output", "Say where the results go: -o DIR."};
    if (w.environments.size() <= 1 || w.environment.projection == "cube-faces" || are_cube_faces(w.environments))
        return std::vector<Job>{{w.environments, w.output}};
    std::vector<Job> jobs;
    std::map<std::string, std::string> stems;
    for (const std::string& file : w.environments) {
        // A folder of faces goes by its own name, with or without a slash behind it.
        const std::filesystem::path path = std::filesystem::path(file).has_filename()
                                               ? std::filesystem::path(file)
                                               : std::filesystem::path(file).parent_path();
        const std::string stem = path.stem().string();
        if (const auto [at, is_new] = stems.emplace(stem, file); !is_new)
            return Error{fmt::format("{} and {} would both go to {}", at->second, file,
                                     (std::filesystem::path(w.output) / stem).string()),
                         "--output", "Bake them one by one into folders of your choice."};
        jobs.push_back({{file}, std::filesystem::path(w.output) / stem});
    }
    return jobs;
}

BakeOutcome run_job(const Job& job, bool skip_up_to_date, BakeOptions options, const CommonOptions& common) {
    BakeOutcome outcome;
    outcome.environment = job.environment;
    outcome.folder = job.folder;
    const Stopwatch stopwatch;
    if (!job.environment.empty()) options.source_files = environment_files(job.environment);
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
    Arguments arguments("bake",
                        "Bakes environments (Radiance HDR, OpenEXR, PNG, JPEG; lat-long or cube) for real-time "
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
