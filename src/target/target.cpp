#include "domelight/target.h"

#include "target/all.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace domelight {

std::string quantity_name(Quantity quantity) {
    switch (quantity) {
        case Quantity::radiance:
            return "radiance";
        case Quantity::irradiance:
            return "irradiance";
        case Quantity::irradiance_over_pi:
            return "irradiance_over_pi";
    }
    return {};
}

std::string container_name(Container container) {
    switch (container) {
        case Container::ktx2:
            return "ktx2";
        case Container::ktx1:
            return "ktx1";
        case Container::dds:
            return "dds";
        case Container::exr:
            return "exr";
        case Container::hdr:
            return "hdr";
    }
    return {};
}

std::string container_extension(Container container) {
    return container == Container::ktx1 ? ".ktx" : fmt::format(".{}", container_name(container));
}

Result<Container> container_from_name(const std::string& name) {
    for (const auto container : {Container::ktx2, Container::ktx1, Container::dds, Container::exr, Container::hdr})
        if (container_name(container) == name) return container;
    return Error{fmt::format("\"{}\" is not a format; accepted are ktx2, ktx1, dds, exr, hdr", name), "", ""};
}

std::string brdf_form_name(BrdfForm form) {
    switch (form) {
        case BrdfForm::none:
            return "none";
        case BrdfForm::scale_bias:
            return "scale-bias";
        case BrdfForm::multiscatter:
            return "multiscatter";
        case BrdfForm::scale_bias_charlie:
            return "scale-bias-charlie";
    }
    return {};
}

Result<BrdfForm> brdf_form_from_name(const std::string& name) {
    for (const auto form : {BrdfForm::none, BrdfForm::scale_bias, BrdfForm::multiscatter, BrdfForm::scale_bias_charlie})
        if (brdf_form_name(form) == name) return form;
    return Error{
        fmt::format(
            "\"{}\" is not a form of BRDF table; accepted are none, scale-bias, multiscatter, scale-bias-charlie",
            name),
        "", ""};
}

double linear_roughness(int level, int levels, int) {
    return levels > 1 ? double(level) / (levels - 1) : 0;
}

int default_levels(const Target& target, int size) {
    int levels = 1;
    while ((size >> levels) >= std::max(1, target.smallest)) ++levels;
    return levels;
}

std::vector<double> default_phong_exponents(int levels) {
    std::vector<double> exponents{INFINITY};
    for (int l = 1; l < levels; ++l) exponents.push_back(std::max(1.0, 2048 * std::pow(0.25, l - 1)));
    return exponents;
}

double quadratic_roughness(int level, int levels, int) {
    return levels > 1 ? 1 - std::sqrt(1 - double(level) / (levels - 1)) : 0;
}

std::span<const Target> targets() {
    static const std::array all{generic_target(), khronos_target(), filament_target(),     babylon_target(),
                                bevy_target(),    three_target(),   three_latlong_target()};
    return all;
}

Result<const Target*> find_target(const std::string& name) {
    std::string names;
    for (const Target& target : targets()) {
        if (target.name == name) return &target;
        if (!names.empty()) names += ", ";
        names += target.name;
    }
    return Error{fmt::format("\"{}\" is not a target; accepted are {}", name, names), "", ""};
}

}  // namespace domelight
