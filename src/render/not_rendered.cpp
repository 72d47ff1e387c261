#include "domelight/render/render.h"
#include "domelight/render/shading/shading.h"

#include <fmt/core.h>

#include <algorithm>

namespace domelight {
namespace {

/// The layers for which `asked` is true, each with the number of materials that have it.
template <typename Asked>
std::vector<std::string> layers_left_out(const Scene& scene, const Asked& asked) {
    std::vector<std::string> left_out;
    const auto ask = [&](const char* what, const auto& has) {
        const auto count =
            std::ranges::count_if(scene.materials, [&](const Material& m) { return asked(m) && has(m); });
        if (count > 0)
            left_out.push_back(fmt::format("{} of {} material{} is left out", what, count, count > 1 ? "s" : ""));
    };
    ask("sheen", [](const Material& m) { return std::max({m.sheen_color.x, m.sheen_color.y, m.sheen_color.z}) > 0; });
    ask("clearcoat", [](const Material& m) { return m.clearcoat > 0; });
    ask("transmission", [](const Material& m) { return m.transmission > 0; });
    ask("anisotropy", [](const Material& m) { return m.anisotropy > 0; });
    return left_out;
}

}  // namespace

std::vector<std::string> not_rendered(const Scene& scene) {
    // The two material models that are not part of glTF have no layers.
    return layers_left_out(scene, [](const Material& m) { return (m.lambert || m.phong) && !m.unlit; });
}

std::vector<std::string> not_rendered(const Scene& scene, ShadingModel model) {
    if (model == ShadingModel::mirror || model == ShadingModel::refract) return {};
    return layers_left_out(scene, [](const Material& m) { return !m.unlit; });
}

}  // namespace domelight
