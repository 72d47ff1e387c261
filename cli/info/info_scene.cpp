#include "cli/info/info_scene.h"

#include "domelight/base/version.h"
#include "domelight/io/file/file_extension.h"
#include "domelight/render/render.h"

#include "cli/console/print.h"
#include "cli/console/vector_json.h"
#include "io/file/json.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>

namespace domelight::cli {
namespace {

const char* kind_of(const PunctualLight& light) {
    switch (light.kind) {
        case PunctualLight::Kind::directional:
            return "directional";
        case PunctualLight::Kind::point:
            return "point";
        case PunctualLight::Kind::spot:
            return "spot";
    }
    return "";
}

/// "2", or "2: lamp (point), sun (directional)" where they have names.
std::string list_of(std::size_t count, const std::vector<std::string>& words) {
    return count == 0 ? "none" : fmt::format("{}: {}", count, join(words, ", "));
}

std::string named(const std::string& name, std::size_t number) {
    return name.empty() ? std::to_string(number) : printable(name, 60);
}

std::string camera_words(const Camera& camera, std::size_t number) {
    const std::string shape =
        camera.orthographic ? "parallel" : fmt::format("{:.3g} degrees", camera.fov_y * 180 / k_pi);
    return fmt::format("{} ({})", named(camera.name, number), shape);
}

std::ptrdiff_t emitting_materials(const Scene& scene) {
    return std::ranges::count_if(scene.materials, [](const Material& m) {
        return m.unlit || std::max({m.emission.x, m.emission.y, m.emission.z}) > 0;
    });
}

Json document(const std::string& name, const Scene& scene, const std::vector<std::string>& left_out) {
    const Scene::Box box = scene.bounds();
    Json cameras = Json::array(), lights = Json::array();
    for (const Camera& c : scene.cameras)
        cameras.push_back({{"name", c.name}, {"orthographic", c.orthographic}, {"fov_y_deg", c.fov_y * 180 / k_pi}});
    for (const PunctualLight& l : scene.lights) lights.push_back({{"name", l.name}, {"kind", kind_of(l)}});
    return {{"version", version()},
            {"kind", "scene"},
            {"file", name},
            {"triangles", scene.triangle_count()},
            {"objects", scene.instances.size()},
            {"materials", scene.materials.size()},
            {"emitting_materials", emitting_materials(scene)},
            {"images", scene.images.size()},
            {"box", {{"low", vector_json(box.low)}, {"high", vector_json(box.high)}}},
            {"cameras", cameras},
            {"lights", lights},
            {"left_out", left_out},
            {"warnings", scene.warnings}};
}

void print_text(const std::string& name, const Scene& scene, const std::vector<std::string>& left_out) {
    const auto [low, high] = scene.bounds();
    const Vec3f size = high - low;
    std::vector<std::string> cameras, lights;
    for (const Camera& c : scene.cameras) cameras.push_back(camera_words(c, cameras.size() + 1));
    for (const PunctualLight& l : scene.lights)
        lights.push_back(fmt::format("{} ({})", named(l.name, lights.size() + 1), kind_of(l)));
    print("{}: a scene of {} triangles in {} object{}\n", name, scene.triangle_count(), scene.instances.size(),
          scene.instances.size() == 1 ? "" : "s");
    print("  materials        {}, of which {} emit{} light\n", scene.materials.size(), emitting_materials(scene),
          emitting_materials(scene) == 1 ? "s" : "");
    print("  images           {}\n", scene.images.size());
    print("  size             {:.4g} x {:.4g} x {:.4g} metres\n", size.x, size.y, size.z);
    print(
        "  box              {:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}   (low and high corner, as probes --region takes "
        "it)\n",
        low.x, low.y, low.z, high.x, high.y, high.z);
    print("  cameras          {}\n", list_of(cameras.size(), cameras));
    print("  lights           {}\n", list_of(lights.size(), lights));
    for (const std::string& line : left_out) print("  not rendered     {}\n", line);
}

}  // namespace

bool may_be_scene(const std::string& name) {
    constexpr std::array<std::string_view, 4> endings{".glb", ".gltf", ".obj", ".ply"};
    if (std::ranges::count(endings, lower_case_extension(name)) > 0) return true;
    const std::vector<std::string> built_in = built_in_scene_names();
    std::error_code failure;
    return std::ranges::count(built_in, name) > 0 && !std::filesystem::exists(name, failure);
}

int info_scene(const std::string& name, const Scene& scene, const CommonOptions& options) {
    const std::vector<std::string> left_out = not_rendered(scene);
    print_warnings(scene.warnings, options, name);
    if (options.json)
        print_document(document(name, scene, left_out));
    else
        print_text(name, scene, left_out);
    return exit_done;
}

}  // namespace domelight::cli
