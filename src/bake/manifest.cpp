#include "bake/manifest.h"

#include "domelight/bake/brdf_file.h"
#include "domelight/base/version.h"
#include "domelight/io/environment/open_environment.h"
#include "domelight/projection/projections.h"

#include "compare/read_error_json.h"
#include "io/file/json.h"
#include "io/file/sha256.h"
#include "projection/convention_text.h"

#include <fmt/core.h>

#include <cmath>

namespace domelight {
namespace {

const char* const k_cube_convention =
    "faces +X -X +Y -Y +Z -Z with OpenGL's orientation of each; texture(cube, d) is the light arriving from world "
    "direction d; right-handed, +Y up";
const char* const k_latlong_convention =
    "u = 1/2 + atan2(z, x) / 2 pi, v = theta / pi from +Y; the centre looks along +X, to the right of it lies +Z; "
    "right-handed, +Y up";

/// The default convention by its formula, others by their axes.
std::string latlong_text(const std::string& projection) {
    if (projection == "latlong" || projection == "latlong/default") return k_latlong_convention;
    return projection_convention(projection) + "; right-handed, +Y up";
}

/// File names may hold bytes that are not UTF-8: those become replacement characters.
std::string json_text(const Json& json) {
    return json.dump(2) + "\n";
}

Json hash_json(const std::string& sha256) {
    return sha256.empty() ? Json(nullptr) : Json(sha256);
}

void add_file(Json& json, const BakedFile& file) {
    json["file"] = file.file;
    json["sha256"] = hash_json(file.sha256);
}

/// Infinity (a Phong level that is the environment itself) has no number in JSON.
Json exponent_json(double exponent) {
    return std::isfinite(exponent) ? Json(exponent) : Json("inf");
}

Json environment_json(const EnvironmentOptions& e) {
    Json json{{"projection", e.projection},     {"latlong", e.latlong}, {"decode", name_of(e.decode)},
              {"rotate_y_deg", e.rotate_y_deg}, {"up", e.up},           {"exposure", e.exposure}};
    // What few files need stands there only where it was given.
    if (!e.layer.empty()) json["layer"] = e.layer;
    if (!e.faces.empty()) json["faces"] = e.faces;
    if (e.face_orientation) json["face_orientation"] = name_of(*e.face_orientation);
    if (e.negatives != Negatives::balance) json["negatives"] = name_of(e.negatives);
    return json;
}

/// Every option that affects the bytes, with defaults filled in: two bakes of equal sources with equal options are
/// equal.
Json options_json(const EnginePlan& plan, const BakeOptions& o) {
    Json json{{"for", plan.engine->name},
              {"layout", name_of(plan.layout)},
              {"size", plan.specular.front().spec.size},
              {"levels", plan.specular.size()},
              {"lobe", name_of(plan.lobe)}};
    if (plan.size_of_source) json["size_of_source"] = true;
    Json widths = Json::array();
    const bool phong = is_phong(plan.lobe);
    for (const LevelPlan& level : plan.specular)
        widths.push_back(phong ? exponent_json(level.exponent) : Json(level.roughness));
    json[phong ? "exponents" : "roughness"] = widths;
    if (!plan.engine->environment_only) json["texels"] = name_of(plan.texels);
    json["method"] = name_of(o.method);
    if (o.method == BakeMethod::montecarlo) {
        json["samples"] = o.points.count;
        json["sequence"] = name_of(o.points.sequence);
        json["seed"] = o.points.seed;
    }
    if (o.method == BakeMethod::riemann) {
        json["riemann_steps"] = {{"phi", o.riemann.phi_steps}, {"theta", o.riemann.theta_steps}};
        json["riemann_sum"] = o.riemann.normalised ? "normalised" : "plain";
    }
    json["encoding"] = plan.container == Container::hdr ? "rgbe" : name_of(plan.encoding);
    if (plan.container != Container::hdr && encoding_block(plan.encoding) > 1)
        json["encoding_quality"] = name_of(o.encoding_quality);
    json["format"] = name_of(plan.container);
    json["zstd"] = plan.zstd;
    if (plan.container == Container::exr || plan.container == Container::hdr)
        json["cube_picture"] = name_of(o.cube_picture);
    if (o.latlong_out) json["latlong_out"] = *o.latlong_out;
    if (o.irradiance_quantity) json["irradiance"] = name_of(*o.irradiance_quantity);
    json["irradiance_size"] = plan.irradiance_size;
    json["sh_bands"] = o.sh_bands;
    json["sh_window"] = name_of(o.sh_window);
    json["brdf_form"] = name_of(plan.brdf_form);
    json["brdf_g"] = name_of(o.brdf_g);
    json["brdf_size"] = plan.brdf_size;
    json["brdf_float"] = o.brdf_float;
    json["preview"] = o.preview;
    json["hashes"] = o.hashes;
    if (o.as_read) json["as_read"] = true;
    json["environment"] = environment_json(o.environment);
    return json;
}

Json level_json(const BakedMap& map, const BakedLevel& level) {
    Json json{{"level", level.level}, {"size", level.size}};
    if (map.quantity == Quantity::radiance) {
        if (is_phong(map.lobe)) {
            json["exponent"] = exponent_json(level.exponent);
        } else {
            json["roughness"] = level.roughness;
            json["alpha"] = level.alpha;
        }
        json["environment_itself"] = level.mirror;
    }
    json["clipped_texels"] = level.encoding.clipped_texels;
    json["clipped_energy"] = level.encoding.clipped_energy;
    json["encoding_rms_error"] = level.encoding.rms_error;
    json["encoding_log_psnr"] = std::isfinite(level.encoding.log_psnr) ? Json(level.encoding.log_psnr) : Json(nullptr);
    if (level.files.size() == 1) add_file(json, level.files[0]);
    if (level.files.size() > 1)
        for (const BakedFile& file : level.files) {
            Json face;
            add_file(face, file);
            json["faces"].push_back(face);
        }
    return json;
}

Json map_json(const BakedMap& map) {
    Json json = Json::object();
    if (!map.file.file.empty()) add_file(json, map.file);
    json["quantity"] = name_of(map.quantity);
    if (map.quantity == Quantity::radiance) json["lobe"] = name_of(map.lobe);
    if (map.lobe == Lobe::charlie) json["least_roughness"] = k_charlie_least_roughness;
    const auto projection = projection_from_name(map.projection);
    json["layout"] = map.layout == Layout::latlong && projection ? projection->name() : name_of(map.layout);
    if (!map.projection.empty()) {
        json["projection"] = map.projection;
        json["convention"] = latlong_text(map.projection);
    }
    json["container"] = map.container;
    json["encoding"] = map.encoding;
    json["zstd"] = map.zstd;
    for (const BakedLevel& level : map.levels) json["levels"].push_back(level_json(map, level));
    if (!map.level_text.empty()) json["level_for_roughness"] = map.level_text;
    if (map.as_read) json["as_read"] = read_errors_json(*map.as_read);
    for (const PhongGap& gap : map.gaps)
        json["between_levels"].push_back(
            {{"exponent", gap.exponent}, {"median_error", gap.median_error}, {"worst_error", gap.worst_error}});
    return json;
}

Json sh_summary(const ShReport& sh) {
    Json json = Json::object();
    if (!sh.files.empty()) add_file(json, sh.files[0]);
    json["quantity"] = name_of(Quantity::radiance);
    json["bands"] = sh.bands;
    json["window"] = name_of(sh.window);
    json["irradiance_error"] = {{"rms", sh.rms_error}, {"max", sh.max_error}};
    for (std::size_t i = 1; i < sh.files.size(); ++i) {
        Json text;
        add_file(text, sh.files[i]);
        text["quantity"] = name_of(Quantity::irradiance_over_pi);
        json["text"] = text;
    }
    return json;
}

Json brdf_json(const BrdfReport& brdf) {
    if (brdf.file.file.empty()) return nullptr;
    Json json = Json::object();
    add_file(json, brdf.file);
    json["form"] = name_of(brdf.form);
    json["masking"] = name_of(brdf.g);
    json["size"] = brdf.size;
    json["encoding"] = brdf.encoding;
    json["axes"] = k_brdf_axes;
    return json;
}

Json convention_json(const EnginePlan& plan) {
    const Engine& engine = *plan.engine;
    if (engine.environment_only) return latlong_text(plan.panorama->projection);
    if (plan.layout == Layout::latlong) return latlong_text(plan.projection);
    if (engine.mirror == CubeMirror::none) return k_cube_convention;
    return fmt::format("{}; mirrored for {}, which reads texture(cube, {})", k_cube_convention, engine.name,
                       cube_mirror_direction(engine.mirror));
}

Json vectors_json(const std::vector<Vec3d>& vectors) {
    Json json = Json::array();
    for (const Vec3d& v : vectors) json.push_back({v.x, v.y, v.z});
    return json;
}

/// Every {"file", "sha256"} below `json` names a file in `folder` with that hash, and none lacks its hash.
bool files_match(const Json& json, const std::filesystem::path& folder, int depth = 0) {
    if (depth > 16) return false;  // not a manifest of ours
    if (json.is_object() && json.contains("file") && json.contains("sha256")) {
        if (!json["file"].is_string() || !json["sha256"].is_string()) return false;
        const auto hash = sha256_in_folder(folder, json["file"].get<std::string>());
        if (!hash || *hash != json["sha256"].get<std::string>()) return false;
    }
    for (const auto& [key, value] : json.items())
        if (!files_match(value, folder, depth + 1)) return false;
    for (const Json& element : json.elements())
        if (!files_match(element, folder, depth + 1)) return false;
    return true;
}

}  // namespace

std::string manifest_json(const EngineReport& report, const EnginePlan& plan, const BakeOptions& options,
                          const SourceReport& source, const Vec3d& mean_radiance) {
    Json json{{"version", version()}};
    json["source"] = {{"file", source.file},
                      {"sha256", hash_json(source.sha256)},
                      {"format", source.format},
                      {"width", source.width},
                      {"height", source.height},
                      {"projection", source.projection},
                      {"mean_radiance", {mean_radiance.x, mean_radiance.y, mean_radiance.z}},
                      {"repaired",
                       {{"not_a_number", source.repaired.not_a_number},
                        {"infinite", source.repaired.infinite},
                        {"negative", source.repaired.negative},
                        {"most_negative", source.repaired.negative_radiance}}}};
    if (!source.layer.empty()) json["source"]["layer"] = source.layer;
    if (source.repaired.repaired()) {
        const Vec3d added = source.repaired.share_added();
        json["source"]["repaired"]["light_added"] = {added.x, added.y, added.z};
    }
    json["engine"] = {{"name", report.name}, {"loads", plan.engine->loads}, {"note", plan.engine->note}};
    json["convention"] = convention_json(plan);
    json["options"] = options_json(plan, options);
    for (const BakedMap& map : report.maps) json[map.role] = map_json(map);
    if (!json.contains("irradiance")) json["irradiance"] = nullptr;
    json["sh"] = sh_summary(report.sh);
    json["brdf"] = brdf_json(report.brdf);
    json["preview"] = nullptr;
    if (report.preview) {
        json["preview"] = Json::object();
        add_file(json["preview"], *report.preview);
    }
    return json_text(json);
}

std::string sh_json(const ShReport& sh) {
    Json json{{"bands", sh.bands},
              {"window", name_of(sh.window)},
              {"convention",
               "real orthonormal spherical harmonics without the Condon-Shortley sign, order l^2 + l + m, polar axis "
               "+Z of a right-handed world "
               "with +Y up: Y_1 = sqrt(3 / 4 pi) (y, z, x); linear Rec. 709"},
              {"radiance", vectors_json(sh.radiance)},
              {"irradiance", vectors_json(sh.irradiance)},
              {"irradiance_error",
               {{"rms", sh.rms_error},
                {"max", sh.max_error},
                {"against",
                 "the exact irradiance E, over the irradiance map; the maximum relative to max(E, 1 % of its mean), "
                 "per channel"}}}};
    return json_text(json);
}

bool manifest_matches(const std::filesystem::path& folder, const EnginePlan& plan, const BakeOptions& options,
                      const std::string& source_sha256) {
    const auto parsed = Json::read(folder / "manifest.json");
    if (!parsed) return false;
    const Json& json = *parsed;
    if (!json.is_object() || !json.contains("version") || !json.contains("source") || !json.contains("options"))
        return false;
    if (json["version"] != Json(version()) || !json["source"].is_object() || !json["source"].contains("sha256"))
        return false;
    if (json["source"]["sha256"] != Json(source_sha256)) return false;
    Json wanted = options_json(plan, options);
    // This plan was made without opening the source. The hashes are equal, so the source's size is the stored one.
    if (plan.size_of_source && json["options"].is_object() && json["options"].contains("size"))
        wanted["size"] = json["options"]["size"];
    // Compared by their text, in which they were stored.
    if (json_text(json["options"]) != json_text(wanted)) return false;
    for (const auto& [key, value] : json.items())
        if (key != "source" && !files_match(value, folder)) return false;
    return true;
}

}  // namespace domelight
