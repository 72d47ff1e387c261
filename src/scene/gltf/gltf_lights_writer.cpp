#include "scene/gltf/gltf_lights_writer.h"

#include "io/file/json.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace domelight {
namespace {

Json array(const Vec3d& v) {
    return Json::array({v.x, v.y, v.z});
}

Json light_json(const ExtractedLight& light, int number, double lux_per_unit) {
    const double largest = std::max({light.irradiance.x, light.irradiance.y, light.irradiance.z});
    return {{"name", fmt::format("light {}", number)},
            {"type", "directional"},
            {"color", array(light.colour)},
            {"intensity", lux_per_unit * largest},
            {"extras",
             {{"irradiance", array(light.irradiance)},
              {"lux_per_unit", lux_per_unit},
              {"angular_diameter_deg", light.angular_diameter_deg},
              {"resolved", light.resolved},
              {"share", light.share}}}};
}

}  // namespace

std::array<double, 4> turn_from_minus_z(const Vec3d& d) {
    // From a to b: (a x b, 1 + a . b), normalised; for a = -Z that is (d.y, -d.x, 0, 1 - d.z). For the opposite
    // direction there is no shortest turn: the turn is about Y.
    const double w = 1 - d.z;
    if (w < 1e-12) return {0, 1, 0, 0};
    const double scale = 1 / std::sqrt(d.x * d.x + d.y * d.y + w * w);
    return {d.y * scale, -d.x * scale, 0, w * scale};
}

std::string gltf_lights(std::span<const ExtractedLight> lights, double lux_per_unit, double rotate_y_deg,
                        const std::string& generator) {
    Json json{{"asset",
               {{"version", "2.0"},
                {"generator", generator},
                {"extras", {{"lux_per_unit", lux_per_unit}, {"rotate_y_deg", rotate_y_deg}}}}}};
    Json scene{{"name", "lights"}}, nodes = Json::array(), definitions = Json::array(), children = Json::array();
    for (std::size_t i = 0; i < lights.size(); ++i) {
        definitions.push_back(light_json(lights[i], int(i) + 1, lux_per_unit));
        nodes.push_back({{"name", fmt::format("light {}", i + 1)},
                         {"rotation", turn_from_minus_z(-lights[i].direction)},
                         {"extensions", {{"KHR_lights_punctual", {{"light", i}}}}}});
        children.push_back(i);
    }
    // The format allows no empty arrays.
    if (!lights.empty()) {
        json["extensionsUsed"] = {"KHR_lights_punctual"};
        json["extensions"] = {{"KHR_lights_punctual", {{"lights", definitions}}}};
        json["nodes"] = nodes;
        scene["nodes"] = children;
    }
    json["scenes"] = Json::array({scene});
    json["scene"] = 0;
    return json.dump(2) + "\n";
}

}  // namespace domelight
