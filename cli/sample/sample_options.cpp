#include "cli/sample/sample_options.h"

#include "domelight/io/write_image.h"
#include "domelight/study/strategy_study.h"

#include "cli/console/environment_options.h"
#include "cli/console/output_endings.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace domelight::cli {
namespace {

const std::string k_sample_endings[] = {".csv", ".json"};

Result<Vec3d> direction(const char* option, const std::vector<double>& v) {
    if (v.size() != 3) return Error{fmt::format("has {} numbers instead of three", v.size()), option, "As in 0,1,0."};
    const Vec3d d{v[0], v[1], v[2]};
    const double l = length(d);
    if (!std::isfinite(l) || !(l > 1e-12)) return Error{"is not a direction", option, "It needs a length: 0,1,0."};
    return d / l;
}

Result<void> check_surface(const Arguments& arguments, SampleWords& w) {
    if (!w.estimate) {
        for (const char* option :
             {"--plot", "--strategy", "--normal", "--view", "--brdf", "--roughness", "--exponent", "--metal-f0"})
            if (arguments.given(option)) return Error{"has no meaning without --estimate", option, ""};
        return {};
    }
    if (w.sampler.compensate)
        return Error{"is not needed with --estimate", "--compensate",
                     "The table has MIS with and without it; alone a compensated sampler would miss light."};
    const struct {
        const char *option, *brdf, *other;
    } belongs[] = {{"--roughness", "ggx", "charlie"}, {"--exponent", "phong", ""}, {"--metal-f0", "ggx", ""}};
    for (const auto& b : belongs)
        if (arguments.given(b.option) && w.brdf != b.brdf && w.brdf != b.other)
            return Error{fmt::format("is none of {}'s", w.brdf), b.option,
                         fmt::format("It belongs to --brdf {}{}{}.", b.brdf, *b.other ? " and " : "", b.other)};
    if (auto ok = within("--roughness", w.roughness, 0, 1); !ok) return ok;
    if (auto ok = within("--exponent", w.exponent, 0, 1e5); !ok) return ok;
    if (w.metal_f0.size() != 1 && w.metal_f0.size() != 3)
        return Error{fmt::format("has {} numbers instead of one or three", w.metal_f0.size()), "--metal-f0", ""};
    for (const double f0 : w.metal_f0)
        if (auto ok = within("--metal-f0", f0, 0, 1); !ok) return ok;
    auto normal = direction("--normal", w.normal);
    if (!normal) return normal.error();
    w.normal_world = *normal;
    w.view_world = *normal;
    if (!w.view.empty()) {
        auto view = direction("--view", w.view);
        if (!view) return view.error();
        w.view_world = *view;
    }
    if (!(dot(w.normal_world, w.view_world) > 0))
        return Error{"lies below the surface", "--view", "Its angle with --normal must be less than 90 degrees."};
    return {};
}

bool searches_rows(DistributionMethod method) {
    return method != DistributionMethod::alias && method != DistributionMethod::hierarchical;
}

std::vector<std::string> methods_that_search_rows() {
    std::vector<std::string> names;
    for (const auto& [method, name] : EnumNames<DistributionMethod>::table)
        if (searches_rows(method)) names.emplace_back(name);
    return names;
}

Result<void> check_explain(const Arguments& arguments, const SampleWords& w) {
    if (!arguments.given("--explain")) {
        if (!w.explain_picture.empty()) return Error{"has no meaning without --explain", "--explain-picture", ""};
        return {};
    }
    if (w.explain.size() != 2) return Error{"needs two numbers", "--explain", "As in 0.25,0.5."};
    for (const double u : w.explain)
        if (!(u >= 0 && u < 1)) return Error{fmt::format("{:g} is not in [0, 1)", u), "--explain", ""};
    if (!searches_rows(w.sampler.method))
        return Error{
            fmt::format("explains a search in rows and columns, which {} does not make", name_of(w.sampler.method)),
            "--explain", fmt::format("Accepted with --method {}.", join(methods_that_search_rows(), ", "))};
    if (w.sampler.uniform_share > 0) return Error{"does not go with --uniform-share", "--explain", ""};
    return {};
}

}  // namespace

std::string SampleWords::environment_name() const {
    return inputs.empty() ? "built-in sky" : inputs[0];
}

void declare_sample_options(Arguments& a, SampleWords& w) {
    a.positional("ENV", w.inputs,
                 fmt::format("one image, or the six faces of a cube; without one, {}", k_built_in_sky));
    a.group("What to draw");
    a.integer("-n,--count", "N", w.count,
              "the number of samples (1024); with --estimate the largest number for each "
              "strategy (4096)");
    a.text("-o,--output", "FILE", w.output,
           "file for the samples, .csv or .json; without it, and if nothing else is asked for, CSV on stdout");
    a.choice(
        "--method", w.sampler.method,
        "sampling method; linear, binary: linear or binary search of cumulative sums; walk: a shader's loop that "
        "subtracts weights; guided: guide tables; alias: alias tables; hierarchical: warping down a pyramid. The "
        "density of these six is constant in each texel; that of bilinear and of bilinear-plain (the same by linear "
        "search) is interpolated between texels (bilinear)");
    a.choice(
        "--weight", w.sampler.weight,
        "the weight of a texel: luminance times sin theta, or grayscale: 0.2989 R + 0.5866 G + 0.1145 B without sin "
        "theta (radiant-power)");
    a.flag("--compensate", w.sampler.compensate,
           "subtract the mean (MIS compensation): only for use together with BRDF "
           "sampling");
    a.number("--uniform-share", "SHARE", w.sampler.uniform_share,
             "draw this part of the samples uniformly over the sphere, 0 to 1 (0)");
    a.choice(
        "--sequence", w.sequence,
        "the sequence that the sample points are taken from (sobol; with --estimate random, for which its standard "
        "errors hold)");
    a.text("--seed", "N", w.seed,
           "selects the randomisation of the points; 0: none for hammersley, halton, sobol and r2 (1)");
    a.group("Pictures and tables");
    a.text("--picture", "FILE", w.picture,
           "the environment as it is stored, with the samples drawn on it, .png or "
           ".jpg");
    a.text("--heat", "FILE", w.heat, "the density as a heat map, .png or .jpg");
    a.choice("--heat-measure", w.heat_measure, "the density per steradian or over the image (solid-angle)");
    a.integer("--picture-width", "PIXELS", w.picture_width,
              "width of the environment in these pictures, 256 to 8192 "
              "(1024)");
    a.text("--tables", "DIR", w.tables,
           "folder for the textures with which a shader samples: the cumulative functions rows.* and columns.* (RG "
           "float), and row_averages.* (R float) for a shader that adds up weights in a loop");
    a.choice("--tables-format", w.tables_format, with_names({Container::ktx2, Container::exr}),
             "format of these textures (ktx2)");
    a.group("How good each strategy is");
    a.flag("--estimate", w.estimate, "estimate the light that a surface reflects by every strategy, and compare them");
    a.choices("--strategy", w.strategies, studied_strategies(),
              "the strategies to compare; environment is always among them (all)");
    a.text("--plot", "FILE", w.plot,
           "plot of each strategy's error over the number of samples, with slopes, .png or .jpg");
    a.numbers("--normal", "X,Y,Z", w.normal, "the surface's normal (0,1,0)");
    a.numbers("--view", "X,Y,Z", w.view, "direction towards the viewer (the normal)");
    a.choice("--brdf", w.brdf, {"lambert", "phong", "ggx", "charlie"}, "the surface (lambert)");
    a.number("--roughness", "R", w.roughness, "roughness of ggx and charlie, 0 to 1 (0.3)");
    a.number("--exponent", "N", w.exponent, "phong: the exponent n, 0 to 1e5 (32)");
    a.numbers("--metal-f0", "F0", w.metal_f0, "ggx: reflectance at normal incidence, one number or R,G,B (1)");
    a.group("How it works");
    a.numbers("--explain", "U,V", w.explain,
              "show how this point of the unit square, each coordinate in [0, 1), becomes a direction: row, column, "
              "density; not with --method alias or hierarchical, nor with --uniform-share");
    a.text("--explain-picture", "FILE", w.explain_picture, "the explanation of --explain as a picture, .png or .jpg");
    add_environment_options(a, w.environment);
    add_common_options(a, w.common);
}

Result<void> check_sample_options(const Arguments& arguments, SampleWords& w) {
    if (auto ok = check_one_environment(w.inputs, w.environment); !ok) return ok;
    const int most = w.estimate ? 1 << 24 : 100'000'000;
    if (auto ok = within("--count", w.count.value_or(1), 1, most); !ok) return ok;
    if (auto ok = check_ending("--output", w.output, k_sample_endings); !ok) return ok;
    if (auto ok = check_ending("--picture", w.picture, screen_picture_extensions()); !ok) return ok;
    if (auto ok = check_ending("--heat", w.heat, screen_picture_extensions()); !ok) return ok;
    if (auto ok = check_ending("--plot", w.plot, screen_picture_extensions()); !ok) return ok;
    if (auto ok = check_ending("--explain-picture", w.explain_picture, screen_picture_extensions()); !ok) return ok;
    if (auto ok = within("--picture-width", w.picture_width.value_or(1024), 256, 8192); !ok) return ok;
    if (auto ok = within("--uniform-share", w.sampler.uniform_share, 0, 1); !ok) return ok;
    if (arguments.given("--heat-measure") && w.heat.empty())
        return Error{"has no meaning without --heat", "--heat-measure", ""};
    if (arguments.given("--tables-format") && w.tables.empty())
        return Error{"has no meaning without --tables", "--tables-format", ""};
    if (!w.picture.empty() && w.count.value_or(1024) > 1'000'000 && !w.estimate)
        return Error{"a picture can show at most a million samples", "--picture", "Ask for fewer with -n."};
    const auto seed = parse_seed(w.seed);
    if (!seed) return seed.error().at("--seed");
    w.seed_number = *seed;
    if (auto ok = check_explain(arguments, w); !ok) return ok;
    if (auto ok = check_surface(arguments, w); !ok) return ok;

    if (w.estimate && !arguments.given("--sequence")) w.sequence = Sequence::random;
    w.sampler.threads = w.environment.threads = w.threads();
    return {};
}

}  // namespace domelight::cli
