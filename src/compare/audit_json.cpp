#include "compare/audit_json.h"

#include "domelight/base/version.h"

#include "compare/read_error_json.h"

#include <cmath>

namespace domelight {
namespace {

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

}  // namespace

Json audit_json(const std::vector<std::string>& bake_files, const std::vector<std::string>& env_files,
                const StoredBake& bake, const BakeAudit& audit, const std::optional<ReadErrors>& as_read,
                const std::string& as_convention, std::vector<std::string> warnings) {
    warnings.insert(warnings.end(), audit.notes.begin(), audit.notes.end());
    const CubeOrientation& o = audit.orientation;
    Json matrix = Json::array(), levels = Json::array();
    for (const Vec3d& row : o.ours_from_theirs.row) matrix.push_back({row.x, row.y, row.z});
    for (std::size_t l = 0; l < audit.levels.size(); ++l) levels.push_back(level_json(int(l), audit.levels[l]));
    Json json{{"version", version()},
              {"kind", "audit"},
              {"bake", Json(bake_files)},
              {"format", bake.format},
              {"env", Json(env_files)},
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
              {"warnings", Json(warnings)}};
    if (const auto lies = lies_as_read(bake, audit)) json["orientation"]["as_engine_reads"] = *lies;
    if (as_read) json["as_read"] = read_errors_json(*as_read);
    return json;
}

}  // namespace domelight
