#include "domelight/engines/engine.h"

#include "engines/all.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

namespace domelight {

std::span<const Container> containers_for_any_engine() {
    static constexpr Container all[] = {Container::ktx2, Container::ktx1,    Container::dds, Container::dds9,
                                        Container::exr,  Container::exr_mip, Container::hdr};
    return all;
}

std::string container_extension(Container container) {
    switch (container) {
        case Container::ktx1:
            return ".ktx";
        case Container::dds9:
            return ".dds";
        case Container::exr_mip:
            return ".exr";
        case Container::playcanvas_atlas:
            return ".png";
        default:
            return "." + name_of(container);
    }
}

std::string cube_mirror_direction(CubeMirror mirror) {
    switch (mirror) {
        case CubeMirror::none:
            return "d";
        case CubeMirror::x:
            return "(-x, y, z)";
        case CubeMirror::z:
            return "(x, y, -z)";
        case CubeMirror::swap_yz:
            return "(x, z, y)";
    }
    return {};
}

Mat3 cube_mirror_matrix(CubeMirror mirror) {
    switch (mirror) {
        case CubeMirror::none:
            return {};
        case CubeMirror::x:
            return {{Vec3d{-1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}}};
        case CubeMirror::z:
            return {{Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, -1}}};
        case CubeMirror::swap_yz:
            return {{Vec3d{1, 0, 0}, Vec3d{0, 0, 1}, Vec3d{0, 1, 0}}};
    }
    return {};
}

double linear_roughness(double level, int levels, int) {
    return levels > 1 ? level / (levels - 1) : 0;
}

double level_of_roughness(const Engine& engine, double roughness, int levels, int size) {
    double below = 0, above = levels - 1;
    if (engine.roughness(below, levels, size) >= roughness) return below;
    if (engine.roughness(above, levels, size) < roughness) return above;
    for (int halving = 0; halving < 60; ++halving) {
        const double middle = (below + above) / 2;
        (engine.roughness(middle, levels, size) < roughness ? below : above) = middle;
    }
    return above;
}

const Engine* engine_with_curve(std::span<const double> roughness, int size) {
    const auto gives = [&](const Engine& engine) {
        if (engine.environment_only || !engine.roughness) return false;
        for (int l = 0; l < int(roughness.size()); ++l)
            if (std::abs(engine.roughness(l, int(roughness.size()), size) - roughness[std::size_t(l)]) > 1e-6)
                return false;
        return true;
    };
    for (const Engine& engine : engines())
        if (gives(engine)) return &engine;
    return nullptr;
}

int default_levels(const Engine& engine, int size, Lobe lobe) {
    const int smallest = is_phong(lobe) && engine.smallest_phong ? engine.smallest_phong : engine.smallest;
    int levels = 1;
    while ((size >> levels) >= std::max(1, levels < engine.fewest_levels ? 1 : smallest)) ++levels;
    return levels;
}

double default_phong_exponent(double level) {
    if (level < 1) return 2050 / std::pow(level, 4) - 2;
    return std::max({1.0, 2048 * std::pow(0.25, level - 1), std::exp2(7 - level)});
}

double default_phong_level(double exponent) {
    if (exponent > 2048) return std::pow(2050 / (exponent + 2), 0.25);
    const double power = std::log2(exponent);
    return std::max((13 - power) / 2, 7 - power);
}

std::vector<double> default_phong_exponents(int levels) {
    std::vector<double> exponents{INFINITY};
    for (int l = 1; l < levels; ++l) exponents.push_back(default_phong_exponent(l));
    return exponents;
}

double quadratic_roughness(double level, int levels, int) {
    return levels > 1 ? 1 - std::sqrt(1 - level / (levels - 1)) : 0;
}

std::span<const Engine> engines() {
    static const std::array all{generic_engine(),  khronos_engine(), filament_engine(),      babylon_engine(),
                                bevy_engine(),     three_engine(),   three_latlong_engine(), playcanvas_engine(),
                                gltf_engine(),     godot_engine(),   unity_engine(),         unreal_engine(),
                                blender_engine(),  mitsuba_engine(), pbrt_engine(),          usd_engine(),
                                materialx_engine()};
    return all;
}

Result<const Engine*> find_engine(const std::string& name) {
    std::string names;
    for (const Engine& engine : engines()) {
        if (engine.name == name) return &engine;
        if (!names.empty()) names += ", ";
        names += engine.name;
    }
    return Error{fmt::format("\"{}\" is not an engine; accepted are {}", name, names), "", ""};
}

}  // namespace domelight
