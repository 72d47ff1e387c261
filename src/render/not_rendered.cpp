#include "domelight/render.h"

#include <fmt/core.h>

#include <algorithm>

namespace domelight {

std::vector<std::string> not_rendered(const Scene& scene) {
    std::vector<std::string> left_out;
    const auto ask = [&](const char* what, const auto& has) {
        const auto count = std::ranges::count_if(scene.materials, has);
        if (count > 0)
            left_out.push_back(fmt::format("{} of {} material{} left out", what, count, count > 1 ? "s are" : " is"));
    };
    ask("sheen", [](const Material& m) { return std::max({m.sheen_color.x, m.sheen_color.y, m.sheen_color.z}) > 0; });
    ask("clearcoat", [](const Material& m) { return m.clearcoat > 0; });
    ask("transmission", [](const Material& m) { return m.transmission > 0; });
    ask("anisotropy", [](const Material& m) { return m.anisotropy != 0; });
    return left_out;
}

}  // namespace domelight
