#include "batch/scene_input.h"

#include <algorithm>

namespace domelight {

void read_scene_option(OptionReader& reader, std::string& scene) {
    reader.read("scene", scene);
    const auto names = built_in_scene_names();
    if (!scene.empty() && std::ranges::find(names, scene) == names.end())
        reader.fail(unknown_name(scene, "a built-in scene", names).at(field_place("scene")));
}

Result<Scene> open_scene(const JobCall& call, const std::string& built_in, double lux_per_unit) {
    const auto file = call.inputs.find("scene");
    if ((file == call.inputs.end()) == built_in.empty())
        return Error{"needs one scene", field_place("scene"), "A file as the input \"scene\", or the option scene."};
    SceneOptions options;
    options.threads = call.threads;
    options.lux_per_unit = float(lux_per_unit);
    return built_in.empty() ? load_scene(file->second[0].string(), options) : built_in_scene(built_in);
}

}  // namespace domelight
