#include "cli/console/light_options.h"

#include "cli/console/print.h"

#include <cmath>

namespace domelight::cli {

PunctualLight turned_light(PunctualLight light, const Mat3& turn) {
    light.direction = Vec3f(turn * Vec3d(light.direction));
    light.position = Vec3f(turn * Vec3d(light.position));
    return light;
}

Result<std::vector<PunctualLight>> environment_lights(const std::vector<std::string>& files,
                                                      const EnvironmentOptions& environment,
                                                      const SceneOptions& options, const CommonOptions& common) {
    std::vector<PunctualLight> lights;
    for (const std::string& file : files) {
        const auto found = load_environment_lights(file, options);
        if (!found) return found.error().at(file);
        print_warnings(found->warnings, common, file);
        if (found->lights.empty()) print_warnings({"there is no light in it"}, common, file);
        const Mat3 turn = rotation_y((environment.rotate_y_deg - found->rotate_y_deg) * k_pi / 180);
        for (const PunctualLight& light : found->lights) {
            lights.push_back(turned_light(light, turn));
            lights.back().intensity = light.intensity * float(std::exp2(environment.exposure));
        }
    }
    return lights;
}

}  // namespace domelight::cli
