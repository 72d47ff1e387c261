#include "cli/compare/compare_bake.h"

#include "domelight/base/version.h"
#include "domelight/compare/bake_audit.h"
#include "domelight/compare/read_error.h"
#include "domelight/engines/engine.h"
#include "domelight/image/row_source.h"
#include "domelight/io/environment/open_environment.h"
#include "domelight/texture/texture.h"

#include "cli/console/environment_options.h"
#include "cli/console/field_options.h"
#include "cli/console/print.h"
#include "compare/latlong_level.h"
#include "compare/read_error_json.h"
#include "io/environment/cube_texture_reader.h"
#include "io/file/file_reader.h"
#include "io/file/json.h"
#include "projection/convention_text.h"
#include "projection/latlong_convention.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace domelight::cli {
namespace {

/// A bake as read: its levels, and what it is.
struct Bake {
    std::vector<CubeLevel> levels;
    std::string format;
    std::string stated_by;  ///< who says which roughness the levels have
    Lobe lobe = Lobe::ggx;
    Texels texels = Texels::centre;
    std::function<double(double)> level_of;  ///< by the engine's curve; empty: linear between the levels
};

/// "0 0.25 0.5" or "0,0.25,0.5": one number from 0 to `most` a level, else nothing.
std::vector<double> numbers_in(std::string text, std::size_t count, double most) {
    std::replace(text.begin(), text.end(), ',', ' ');
    std::vector<double> values;
    for (const std::string& word : split(text, ' ')) {
        if (word.empty()) continue;
        const auto value = parse_number(word);
        if (!value || !(*value >= 0 && *value <= most)) return {};
        values.push_back(*value);
    }
    return values.size() == count ? values : std::vector<double>{};
}

/// Which lobe the levels were filtered with, and how wide it is in each, where the file says so.
void read_keys(const std::map<std::string, std::string>& keys, Bake& bake) {
    const auto value = [&](const char* name) {
        const auto key = keys.find(name);
        return key == keys.end() ? std::string() : key->second;
    };
    bake.lobe = from_name<Lobe>(value("domelight.lobe")).value_or(Lobe::ggx);
    bake.texels = from_name<Texels>(value("domelight.texels")).value_or(Texels::centre);
    const auto roughness = numbers_in(value("domelight.roughness"), bake.levels.size(), 1);
    const auto exponents =
        numbers_in(value("domelight.exponent"), bake.levels.size(), std::numeric_limits<double>::infinity());
    for (std::size_t l = 0; l < roughness.size(); ++l) bake.levels[l].roughness = roughness[l];
    for (std::size_t l = 0; l < exponents.size(); ++l) bake.levels[l].exponent = exponents[l];
    if (!roughness.empty() || !exponents.empty()) bake.stated_by = "the file";
}

/// The projection of a bake's lat-long file: by the manifest beside it, by its own key, or the default.
Projection latlong_of(const std::string& file, const std::string& convention) {
    const auto stated = projection_in_manifest(file);
    return *projection_from_name(stated ? *stated : latlong_of_convention(convention).value_or("latlong"));
}

/// The levels of a lat-long texture, each as a cube.
Result<std::vector<Cubemap>> decode_latlongs(const Texture& texture, const std::string& file, int threads) {
    if (texture.width != 2 * texture.height)
        return Error{fmt::format("{} x {} texels are not a cube, nor a lat-long map", texture.width, texture.height),
                     "", "Wanted is a specular cube or lat-long map, as a bake has it."};
    if (encoding_channels(texture.encoding) != 3)
        return Error{"texture has fewer than three channels: no colour", "", ""};
    const auto key = texture.metadata.find("domelight.convention");
    const Projection projection = latlong_of(file, key == texture.metadata.end() ? "" : key->second);
    std::vector<Cubemap> cubes;
    for (int l = 0; l < int(texture.levels.size()); ++l)
        cubes.push_back(cube_of_latlong_level({projection, decode_texture(texture, l, 0)}, threads));
    return cubes;
}

Result<Bake> read_chain(const std::string& file, int threads) {
    const auto texture = read_texture(file);
    if (!texture) return texture.error().at(file);
    auto cubes = texture->faces == 1 ? decode_latlongs(*texture, file, threads) : decode_cubes(*texture);
    if (!cubes) return cubes.error().at(file);
    const auto info = read_texture_info(file);
    Bake bake;
    bake.format = info ? fmt::format("{}, {}", info->container, info->format) : "texture";
    for (Cubemap& cube : *cubes) bake.levels.emplace_back().cube = std::move(cube);
    read_keys(texture->metadata, bake);
    return bake;
}

/// Whether a file begins as a texture does.
bool is_texture_file(const std::string& name) {
    const auto bytes = FileBytes::open(name, std::int64_t(1) << 31);
    return bytes && !texture_container((*bytes)->bytes()).empty();
}

/// A level that is a picture, as a cube.
Result<Cubemap> cube_of(const Environment& picture, const std::string& word, int threads) {
    if (picture.cube()) return *picture.cube();
    const auto image = picture.latlong();
    if (!image) return image.error().at(word);
    return cube_of_latlong_level({projection_from_name("latlong")->turned(picture.world_to_source), **image}, threads);
}

/// One level a word: a picture of a cube or in any other projection, or a folder of six faces.
Result<Bake> read_pictures(const std::vector<std::string>& words, int threads) {
    Bake bake;
    EnvironmentOptions options;
    options.threads = threads;
    for (const std::string& word : words) {
        options.projection = projection_in_manifest(word).value_or("auto");
        const auto picture = open_environment(environment_files({word}), options);
        if (!picture) return picture.error();
        auto cube = cube_of(*picture, word, threads);
        if (!cube) return cube.error();
        bake.format = picture->format;
        bake.levels.emplace_back().cube = *std::move(cube);
    }
    return bake;
}

/// The level that an engine's shader reads for a roughness.
std::function<double(double)> curve_of(const Engine& engine, const Bake& bake) {
    return [&engine, count = int(bake.levels.size()), size = bake.levels[0].cube.size()](double roughness) {
        return level_of_roughness(engine, roughness, count, size);
    };
}

/// The same for the engine whose curve has the roughnesses that the file states.
std::function<double(double)> curve_of_stated(const Bake& bake) {
    std::vector<double> roughness;
    for (const CubeLevel& level : bake.levels) roughness.push_back(level.roughness.value_or(-1));
    const Engine* engine = engine_with_curve(roughness, bake.levels[0].cube.size());
    return engine ? curve_of(*engine, bake) : nullptr;
}

Result<Bake> read_bake(const BakeWords& w, int threads) {
    auto bake = w.bake.size() == 1 && is_texture_file(w.bake[0]) ? read_chain(w.bake[0], threads)
                                                                 : read_pictures(w.bake, threads);
    if (bake) {
        bake->lobe = w.lobe.value_or(bake->lobe);
        bake->level_of = curve_of_stated(*bake);
    }
    if (!bake || w.engine.empty()) return bake;
    const auto engine = find_engine(w.engine);
    if (!engine) return engine.error();
    if (!(*engine)->roughness) return Error{w.engine + " filters by itself: it has no roughness curve", "--for", ""};
    const int count = int(bake->levels.size());
    for (int l = 0; l < count; ++l)
        bake->levels[std::size_t(l)].roughness = (*engine)->roughness(l, count, bake->levels[0].cube.size());
    bake->stated_by = w.engine + "'s curve";
    bake->level_of = curve_of(**engine, *bake);
    return bake;
}

/// The named lat-long convention by which the baker read the source, where that explains the orientation.
std::string convention_of(const Mat3& ours_from_theirs, const Mat3& world_to_source) {
    if (ours_from_theirs == Mat3()) return "";
    const Mat3 read = world_to_source * ours_from_theirs;
    for (const std::string& name : latlong_convention_names())
        if (const auto convention = latlong_convention(name); convention && convention->world_to_default() == read)
            return name;
    return "";
}

/// The bake as a shader reads it; nothing where it was not asked for, or where no orientation fits.
Result<std::optional<ReadErrors>> read_errors_of(const BakeWords& w, const Bake& bake, const BakeAudit& audit,
                                                 const Environment& environment, int threads) {
    if (!w.as_read || audit.orientation.error > AuditOptions{}.same) return std::optional<ReadErrors>();
    ReadChain chain;
    chain.lobe = bake.lobe;
    chain.level_of = bake.level_of;
    chain.map_from_world = audit.orientation.ours_from_theirs.transposed();
    for (std::size_t l = 0; l < bake.levels.size(); ++l) {
        chain.levels.emplace_back(bake.levels[l].cube);
        chain.roughness.push_back(bake.levels[l].roughness.value_or(audit.levels[l].roughness));
    }
    ReadErrorOptions options;
    options.threads = threads;
    auto errors = measure_as_read(chain, environment, options);
    if (!errors) return errors.error().at("--as-read");
    return std::optional(*std::move(errors));
}

// --- telling ---

/// A number, or "inf" as in a manifest.
Json exponent_json(double exponent) {
    return std::isinf(exponent) ? Json("inf") : Json(exponent);
}

Json level_json(int index, const LevelAudit& l) {
    Json json{{"level", index},
              {"size", l.size},
              {"roughness", l.roughness_known ? Json(l.roughness) : Json()},
              {"exponent", l.roughness_known && l.exponent ? exponent_json(*l.exponent) : Json()},
              {"roughness_within", l.roughness_within},
              {"scale", l.scale},
              {"energy", l.energy},
              {"error", l.error},
              {"broad_error", l.broad_error},
              {"relative_rmse", l.relative_rmse},
              {"largest", l.largest}};
    if (l.stated_roughness) {
        json["stated_roughness"] = *l.stated_roughness;
        json["stated_error"] = l.stated_error;
        json["stated_relative_rmse"] = l.stated_relative_rmse;
    }
    return json;
}

void print_json(const BakeWords& w, const Bake& bake, const BakeAudit& audit, const std::optional<ReadErrors>& as_read,
                const std::string& as_convention, std::vector<std::string> warnings) {
    warnings.insert(warnings.end(), audit.notes.begin(), audit.notes.end());
    const CubeOrientation& o = audit.orientation;
    Json matrix = Json::array(), levels = Json::array();
    for (const Vec3d& row : o.ours_from_theirs.row) matrix.push_back({row.x, row.y, row.z});
    for (std::size_t l = 0; l < audit.levels.size(); ++l) levels.push_back(level_json(int(l), audit.levels[l]));
    Json json{{"version", version()},
              {"kind", "audit"},
              {"bake", w.bake},
              {"format", bake.format},
              {"env", w.env},
              {"verdict", audit.verdict},
              {"of_source", audit.of_source},
              {"within", audit.within},
              {"lobe", name_of(audit.lobe)},
              {"orientation",
               {{"words", o.words},
                {"ours_from_theirs", matrix},
                {"latlong", as_convention.empty() ? Json() : Json(as_convention)},
                {"certain", o.certain},
                {"error", o.error},
                {"next_error", o.next_error}}},
              {"roughness_stated_by", bake.stated_by},
              {"levels", levels},
              {"warnings", with_options(warnings)}};
    if (as_read) json["as_read"] = read_errors_json(*as_read);
    print_document(json);
}

std::string percent(double v) {
    return fmt::format("{:.3g} %", 100 * v);
}

/// A level's roughness, or its exponent, and how far from it the fit stays nearly as good.
std::string width_text(const LevelAudit& l) {
    if (!l.roughness_known) return "any fits";
    if (!l.exponent) return fmt::format("{:.4f} ± {:<6.2g}", l.roughness, l.roughness_within);
    if (std::isinf(*l.exponent)) return "inf         ";
    const double from_roughness = 2 * std::pow(l.roughness, -5);  // of the exponent (1 / r^4 - 1) / 2
    return fmt::format("{:.4g} ± {:<6.2g}", *l.exponent, from_roughness * l.roughness_within);
}

const char* width_legend(Lobe lobe) {
    switch (lobe) {
        case Lobe::ggx:
            return "roughness     of GGX (n = v = r) that fits best, 0: the environment itself";
        case Lobe::charlie:
            return "roughness     of Charlie's lobe that fits best";
        case Lobe::phong_brdf:
            return "exponent      n of (n + 2) cos^(n+1) that fits best, inf: the environment itself";
        case Lobe::phong_plain:
            return "exponent      n of (n + 1) cos^n that fits best, inf: the environment itself";
    }
    return "";
}

void print_text(const BakeWords& w, const Bake& bake, const BakeAudit& audit, const std::string& as_convention) {
    const CubeOrientation& o = audit.orientation;
    print("{}: {}, {}², {} level{}\n", join(w.bake, " "), bake.format, bake.levels[0].cube.size(), bake.levels.size(),
          bake.levels.size() == 1 ? "" : "s");
    print("against the exact filter ({}) of {}\n\n", name_of(audit.lobe),
          w.env.empty() ? "the built-in sky" : join(w.env, " "));
    print("  verdict       {}\n", audit.verdict);
    for (const std::string& note : audit.notes) print("                {}\n", note);
    if (o.error > AuditOptions{}.same) {  // no orientation fits, so the figures say nothing
        print("                --json has the figures of the best orientation\n");
        return;
    }
    print("  orientation   {}\n", o.words);
    if (!as_convention.empty()) print("                that is as ours with --latlong {}\n", as_convention);
    print("                error {}, the next best orientation {}{}\n\n", percent(o.error), percent(o.next_error),
          o.certain || !audit.of_source ? "" : ": the light cannot tell them apart");
    const bool stated = std::any_of(audit.levels.begin(), audit.levels.end(),
                                    [](const LevelAudit& l) { return l.stated_roughness.has_value(); });
    print("  {:>5}  {:>5}  {:>16}  {:>7}  {:>7}  {:>8}  {:>8}  {:>8}", "level", "size",
          audit.levels[0].exponent ? "exponent" : "roughness", "scale", "energy", "error", "RMSE", "largest");
    if (stated) print("  | {:>7}  {:>8}  {:>8}", "stated", "error", "RMSE");
    print("\n");
    for (std::size_t i = 0; i < audit.levels.size(); ++i) {
        const LevelAudit& l = audit.levels[i];
        print("  {:>5}  {:>5}  {:>16}  {:>7.4f}  {:>7.4f}  {:>8}  {:>8}  {:>8}", i, l.size, width_text(l), l.scale,
              l.energy, percent(l.error), percent(l.relative_rmse), percent(l.largest));
        if (l.stated_roughness)
            print("  | {:>7.4g}  {:>8}  {:>8}", bake.levels[i].exponent.value_or(*l.stated_roughness),
                  percent(l.stated_error), percent(l.stated_relative_rmse));
        print("\n");
    }
    print(
        "\n  {}\n"
        "  scale         median of theirs / exact          energy   ratio of the means over the sphere\n"
        "  error         RMS of (theirs - fit) / max(theirs, fit), every direction alike; RMSE relative, the brightest "
        "count most\n",
        width_legend(audit.lobe));
    if (stated) print("  stated        by {}; errors there, at scale 1\n", bake.stated_by);
}

void print_as_read(const Bake& bake, const ReadErrors& errors) {
    print("\n  as a shader reads it, between texels{}\n", bake.levels.size() > 1 ? " and between levels" : "");
    print("  {:>9}  {:>6}  {:>8}  {:>8}\n", "roughness", "level", "RMSE", "largest");
    const auto row = [](const ReadErrorAt& at) {
        print("  {:>9.3f}  {:>6.2f}  {:>8}  {:>8}\n", at.roughness, at.level, percent(at.relative_rmse),
              percent(at.largest));
    };
    for (const ReadErrorAt& at : errors.levels) row(at);
    print("  {:>9}  {:>6}  {:>8}  {:>8}\n", "0.1 to 1", "all", percent(errors.relative_rmse), percent(errors.largest));
}

}  // namespace

void add_bake_options(Arguments& a, BakeWords& w) {
    std::vector<std::string> names;
    for (const Engine& engine : engines()) names.push_back(engine.name);
    a.group("A bake against its source");
    a.texts("--bake", "FILE", w.bake,
            "a baked specular cube or lat-long map: KTX2, KTX or DDS with its levels, or a picture or folder of faces "
            "for each level");
    a.texts("--env", "SRC", w.env, fmt::format("the environment it was baked from ({})", k_built_in_sky));
    a.choice("--for", w.engine, names,
             "the engine whose roughness curve the bake should have; not needed for a Domelight file, which states it");
    a.choice("--lobe", w.lobe, "the lobe that the levels were filtered with (what the file states, otherwise ggx)");
    a.number(
        "--within", "ERROR", w.within,
        "the largest error that a level may have, above 0 and up to 1: 0.01 is 1 %. If the error of a level is "
        "larger, the exit status is 1. What counts is the error at the roughness that the file or --for states, "
        "at scale 1; where none is stated, that of the best fit. Without this option the status is 0 for any bake of "
        "the environment");
    a.integer("--texels", "N", w.texels,
              "texels compared in each level, 96 to 10000000, a quarter of them the brightest (6144)");
    a.flag("--as-read", w.as_read,
           "also measure what a shader reads, between texels and between levels, in random directions for random "
           "roughnesses from 0.1 to 1; between levels by the curve of --for, or of the engine whose curve has the "
           "roughnesses that "
           "the file states, otherwise linearly in the roughness");
    add_environment_options(a, w.environment);
}

int compare_bake(const BakeWords& w, const CommonOptions& common) {
    const int threads = common.threads.value_or(0);
    if (w.texels && (*w.texels < 96 || *w.texels > 10'000'000))
        return print_error({"is not from 96 to 10000000", "--texels", ""}, exit_usage);
    if (!std::isnan(w.within) && !(w.within > 0 && w.within <= 1))
        return print_error({fmt::format("is {}, not above 0 and at most 1", w.within), "--within", ""}, exit_usage);
    EnvironmentOptions options = w.environment;
    options.threads = threads;
    auto bake = read_bake(w, threads);
    if (!bake) return print_error(bake.error());
    auto environment = open_environment_or_sky(w.env, options);
    if (!environment) return print_error(environment.error());
    if (!environment->cube())
        if (const auto pixels = environment->latlong(); !pixels)
            return print_error(pixels.error().at(join(w.env, " ")));
    AuditOptions audit_options;
    audit_options.threads = threads;
    audit_options.lobe = bake->lobe;
    audit_options.texels_hold = bake->texels;
    if (!std::isnan(w.within)) audit_options.within = w.within;
    audit_options.texels = w.texels.value_or(audit_options.texels);
    Result<BakeAudit> audit = Error{};
    {
        ProgressBar bar(w.bake[0], common);
        audit_options.progress = bar.callback();
        audit = audit_bake(bake->levels, *environment, audit_options);
    }
    if (!audit) return print_error(audit.error().at(w.bake[0]));
    const auto as_read = read_errors_of(w, *bake, *audit, *environment, threads);
    if (!as_read) return print_error(as_read.error());
    print_warnings(environment->report().lines(), common, join(w.env, " "));
    const std::string convention =
        environment->cube() ? "" : convention_of(audit->orientation.ours_from_theirs, environment->world_to_source);
    if (common.json)
        print_json(w, *bake, *audit, *as_read, convention, environment->report().lines());
    else if (!common.quiet) {
        print_text(w, *bake, *audit, convention);
        if (*as_read) print_as_read(*bake, **as_read);
    }
    return audit->passed() ? exit_done : exit_failed;
}

}  // namespace domelight::cli
