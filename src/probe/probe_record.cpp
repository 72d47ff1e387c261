#include "probe/probe_record.h"

#include "io/file/json_fields.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace domelight {
namespace {

constexpr int k_format = 1;
/// More probes than this are refused.
constexpr std::size_t k_most_probes = 1 << 20;

/// The shortest decimal number that reads as this float.
Json number_json(float value) {
    const std::string text = fmt::format("{}", value);
    double number = value;
    std::from_chars(text.data(), text.data() + text.size(), number);
    return number;
}
const char* shape_name(ProbeInfluence::Shape shape) {
    return shape == ProbeInfluence::Shape::box      ? "box"
           : shape == ProbeInfluence::Shape::sphere ? "sphere"
                                                    : "everywhere";
}

}  // namespace

Json vector_json(const Vec3f& v) {
    return Json::array({number_json(v.x), number_json(v.y), number_json(v.z)});
}
Json box_json(const ProbeBox& box) {
    return {{"low", vector_json(box.low)}, {"high", vector_json(box.high)}};
}

Json influence_json(const ProbeInfluence& influence) {
    Json json{{"shape", shape_name(influence.shape)}};
    if (influence.shape == ProbeInfluence::Shape::box) json.update(box_json(influence.box));
    if (influence.shape == ProbeInfluence::Shape::sphere) json["radius"] = number_json(influence.radius);
    if (influence.shape != ProbeInfluence::Shape::everywhere) json["fade"] = number_json(influence.fade);
    return json;
}

std::vector<std::string> files_of(const ProbeSetRecord& record) {
    std::vector<std::string> files{k_probes_json, record.specular.file, record.irradiance.file};
    if (record.distance) files.push_back(record.distance->file);
    return files;
}

namespace {

Json source_json(const ProbeSource& source) {
    return {{"file", source.file}, {"sha256", source.sha256.empty() ? Json(nullptr) : Json(source.sha256)}};
}

Json probe_json(const Probe& probe, const std::array<Vec3d, 9>& harmonics) {
    Json json{{"place", vector_json(probe.place)},
              {"position", vector_json(probe.position)},
              {"valid", probe.valid},
              {"moved", probe.moved}};
    if (probe.filled_from >= 0) json["filled_from"] = probe.filled_from;
    json["influence"] = influence_json(probe.influence);
    if (probe.proxy) json["proxy"] = box_json(*probe.proxy);
    Json coefficients = Json::array();
    // As many digits as a float has.
    for (const Vec3d& c : harmonics) coefficients.push_back(vector_json(Vec3f(c)));
    json["harmonics"] = std::move(coefficients);
    return json;
}

Json map_json(const ProbeMapRecord& map) {
    return {{"file", map.file}, {"sha256", map.sha256}, {"encoding", map.encoding}, {"size", map.size}};
}

Json grid_json(const std::optional<ProbeGrid>& grid) {
    if (!grid) return nullptr;
    return {{"origin", vector_json(grid->origin)},
            {"spacing", vector_json(grid->spacing)},
            {"counts", Json::array({grid->nx, grid->ny, grid->nz})}};
}

Json specular_json(const ProbeSetRecord& r) {
    Json json = map_json(r.specular), levels = Json::array();
    json["quantity"] = "radiance";
    json["lobe"] = "ggx";
    for (std::size_t l = 0; l < r.roughness.size(); ++l)
        levels.push_back({{"level", l},
                          {"size", std::max(1, r.specular.size >> l)},
                          {"roughness", number_json(r.roughness[l])},
                          {"alpha", number_json(r.roughness[l] * r.roughness[l])}});
    json["levels"] = std::move(levels);
    return json;
}

// --- reading ---

Vec3f vector_of(JsonFields& fields, const char* key) {
    const auto v = fields.require(key).numbers(key, 3);
    return v.size() == 3 ? Vec3f{v[0], v[1], v[2]} : Vec3f{};
}

ProbeBox box_of(JsonFields& fields) {
    const ProbeBox box{vector_of(fields, "low"), vector_of(fields, "high")};
    if (!(box.low.x <= box.high.x && box.low.y <= box.high.y && box.low.z <= box.high.z))
        fields.fail("high", "is below `low`");
    return box;
}

ProbeInfluence influence_of(JsonFields fields) {
    ProbeInfluence influence;
    const std::string shape = fields.text("shape", "everywhere");
    influence.fade = fields.number("fade", 0);
    if (influence.fade < 0) fields.fail("fade", "is below 0");
    if (shape == "box") {
        influence.shape = ProbeInfluence::Shape::box;
        influence.box = box_of(fields);
    } else if (shape == "sphere") {
        influence.shape = ProbeInfluence::Shape::sphere;
        influence.radius = fields.require("radius").number("radius", 1);
        if (!(influence.radius > 0)) fields.fail("radius", "is not above 0");
    } else if (shape != "everywhere") {
        fields.fail("shape", fmt::format("\"{}\" is none of everywhere, box, sphere", shape));
    }
    return influence;
}

Probe probe_of(JsonFields& fields, std::size_t count) {
    Probe probe{.place = vector_of(fields, "place"), .position = vector_of(fields, "position")};
    probe.valid = fields.flag("valid", true);
    probe.moved = fields.flag("moved", false);
    probe.filled_from = fields.index("filled_from", count);
    probe.influence = influence_of(fields.object("influence"));
    if (JsonFields proxy = fields.object("proxy")) probe.proxy = box_of(proxy);
    return probe;
}

std::array<Vec3d, 9> harmonics_of(JsonFields& fields, const Json& probe) {
    std::array<Vec3d, 9> harmonics{};
    const Json& rows = probe["harmonics"];
    const auto is_triple = [](const Json& row) {
        return row.size() == 3 && std::ranges::all_of(row.elements(), &Json::is_number);
    };
    if (rows.size() != 9 || !std::ranges::all_of(rows.elements(), is_triple)) {
        fields.fail("harmonics", "are not nine coefficients of three numbers");
        return harmonics;
    }
    for (std::size_t i = 0; i < 9; ++i)
        harmonics[i] = {rows[i][0].get<double>(), rows[i][1].get<double>(), rows[i][2].get<double>()};
    return harmonics;
}

std::optional<ProbeGrid> grid_of(JsonFields fields) {
    if (!fields) return std::nullopt;
    ProbeGrid grid{.origin = vector_of(fields, "origin"), .spacing = vector_of(fields, "spacing")};
    const auto counts = fields.require("counts").numbers("counts", 3);
    for (const float n : counts)
        if (!(n >= 1 && n <= float(k_most_probes) && n == std::floor(n)))
            fields.fail("counts", fmt::format("{} is not a number of places", n));
    if (counts.size() == 3) grid.nx = int(counts[0]), grid.ny = int(counts[1]), grid.nz = int(counts[2]);
    return grid;
}

ProbeSource source_of(JsonFields fields) {
    // An unknown hash is null.
    return {fields.text("file"), fields.has("sha256") ? fields.text("sha256") : ""};
}

ProbeMapRecord map_of(JsonFields fields) {
    fields.require("file").require("size");
    return {fields.text("file"), fields.text("sha256"), fields.text("encoding"), int(fields.size("size", 0))};
}

std::vector<float> roughness_of(JsonFields specular) {
    std::vector<float> roughness;
    for (JsonFields& level : specular.array("levels"))
        roughness.push_back(level.require("roughness").number("roughness", 0));
    return roughness;
}

std::vector<std::array<int, 4>> tetrahedra_of(JsonFields& root, const Json& json, std::size_t probes) {
    std::vector<std::array<int, 4>> tetrahedra;
    for (const Json& row : json["tetrahedra"].elements()) {
        std::array<int, 4> corners{};
        bool fits = row.size() == 4;
        for (std::size_t i = 0; fits && i < 4; ++i) {
            fits = row[i].is_number_unsigned() && row[i].get<std::uint64_t>() < probes;
            if (fits) corners[i] = row[i].get<int>();
        }
        if (!fits) {
            root.fail("tetrahedra", "its elements are not four numbers of probes each");
            break;
        }
        tetrahedra.push_back(corners);
    }
    return tetrahedra;
}

/// A null is as good as a member that is missing.
Json without_nulls(const Json& json) {
    if (!json.is_object()) return json;
    Json out = Json::object();
    for (const auto& [key, value] : json.items())
        if (!value.is_null()) out[key] = without_nulls(value);
    return out;
}

Result<ProbeSetRecord> record_of(const Json& json) {
    std::optional<Error> error;
    JsonFields root(json, "", error);
    ProbeSetRecord r;
    root.require("format").require("probes").require("specular").require("irradiance");
    if (const auto format = root.size("format", k_format); format != k_format)
        root.fail("format", fmt::format("{} is not {}, the only one known here", format, k_format));
    r.version = root.text("version");
    r.scene = source_of(root.object("scene"));
    r.environment = source_of(root.object("environment"));
    if (const Json* options = json.find("options")) r.options = *options;
    r.grid = grid_of(root.object("grid"));
    r.specular = map_of(root.object("specular"));
    r.roughness = roughness_of(root.object("specular"));
    r.irradiance = map_of(root.object("irradiance"));
    if (root.has("distance")) {
        r.distance = map_of(root.object("distance"));
        r.farthest = root.object("distance").number("farthest", 0);
    }
    auto probes = root.array("probes");
    if (probes.empty() || probes.size() > k_most_probes)
        root.fail("probes", fmt::format("{} are not from 1 to {}", probes.size(), k_most_probes));
    for (std::size_t i = 0; i < probes.size() && !error; ++i) {
        r.probes.push_back(probe_of(probes[i], probes.size()));
        r.harmonics.push_back(harmonics_of(probes[i], json["probes"][i]));
    }
    r.tetrahedra = tetrahedra_of(root, json, probes.size());
    if (error) return *error;
    return r;
}

}  // namespace

std::string probe_record_text(const ProbeSetRecord& r) {
    Json irradiance = map_json(r.irradiance);
    irradiance["quantity"] = "irradiance_over_pi";
    Json json{{"format", k_format},
              {"version", r.version},
              {"scene", source_json(r.scene)},
              {"environment", source_json(r.environment)},
              {"options", r.options},
              {"grid", grid_json(r.grid)},
              {"specular", specular_json(r)},
              {"irradiance", std::move(irradiance)}};
    if (r.distance) {
        Json distance = map_json(*r.distance);
        distance["quantity"] = "distance, and its square";
        distance["farthest"] = number_json(r.farthest);
        json["distance"] = std::move(distance);
    }
    // A line for each probe. The whole as one value would take ten kilobytes of memory a probe.
    std::string text = json.dump(1);
    text.resize(text.rfind('\n'));
    const auto append = [&](const char* member, std::size_t count, const auto& element) {
        text += fmt::format(",\n \"{}\": [", member);
        for (std::size_t i = 0; i < count; ++i) text += (i > 0 ? ",\n  " : "\n  ") + element(i).dump();
        text += "\n ]";
    };
    append("probes", r.probes.size(), [&](std::size_t i) { return probe_json(r.probes[i], r.harmonics[i]); });
    if (!r.tetrahedra.empty())
        append("tetrahedra", r.tetrahedra.size(), [&](std::size_t i) { return Json(r.tetrahedra[i]); });
    return text + "\n}\n";
}

Result<ProbeSetRecord> read_probe_record(const std::filesystem::path& folder) {
    const std::filesystem::path file = folder / k_probes_json;
    const auto json = Json::read(file);
    if (!json) return Error{json.error().what, file.string(), "The folder must be one that `domelight probes` wrote."};
    auto record = record_of(without_nulls(*json));
    if (!record) return Error{record.error().format(), file.string(), ""};
    return record;
}

}  // namespace domelight
