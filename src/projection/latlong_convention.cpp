#include "projection/latlong_convention.h"

#include "domelight/base/names.h"

#include <cctype>

namespace domelight {

namespace {

using Grid = LatlongConvention::Grid;

// All of them look from inside: right = centre x up.
const NamedValue<LatlongConvention> k_named[] = {
    {{{1, 0, 0}, {0, 0, 1}, {0, 1, 0}, Grid::centres}, "default"},
    {{{0, 0, 1}, {-1, 0, 0}, {0, 1, 0}, Grid::centres}, "usd"},
    {{{0, 0, 1}, {-1, 0, 0}, {0, 1, 0}, Grid::rows_on_poles}, "mitsuba"},
    {{{0, 0, 1}, {-1, 0, 0}, {0, 1, 0}, Grid::both_on_edges}, "openexr"},  // ImfEnvmap.h
    {{{0, 0, -1}, {1, 0, 0}, {0, 1, 0}, Grid::centres}, "materialx"},
    {{{-1, 0, 0}, {0, 0, -1}, {0, 1, 0}, Grid::centres}, "mod"},
};

Error unknown(const std::string& name) {
    std::string accepted;
    for (const std::string& convention : latlong_convention_names()) accepted += convention + ", ";
    return {"unknown lat-long convention \"" + name + "\"", "",
            "Accepted: " + accepted + "or centre=+X,right=+Z[,up=+Y]."};
}

/// "centre=+X,right=+Z[,up=+Y]".
Result<LatlongConvention> convention_from_axes(const std::string& text) {
    LatlongConvention c;
    bool has_centre = false, has_right = false;
    for (std::size_t at = 0; at <= text.size();) {
        const std::size_t comma = std::min(text.find(',', at), text.size());
        const std::string item = text.substr(at, comma - at);
        at = comma + 1;
        const std::size_t equals = item.find('=');
        if (equals == std::string::npos) return unknown(text);
        const std::string key = item.substr(0, equals);
        const Result<Vec3d> axis = signed_axis(item.substr(equals + 1));
        if (!axis) return axis.error();
        if (key == "centre" || key == "center") {
            c.centre = *axis, has_centre = true;
        } else if (key == "right") {
            c.right = *axis, has_right = true;
        } else if (key == "up") {
            c.up = *axis;
        } else {
            return unknown(text);
        }
    }
    if (!has_centre || !has_right)
        return Error{"lat-long convention \"" + text + "\" needs both centre and right", "", ""};
    if (dot(c.centre, c.right) != 0 || dot(c.centre, c.up) != 0 || dot(c.right, c.up) != 0)
        return Error{"centre, right and up of \"" + text + "\" must be three different axes", "",
                     "up is +Y unless it is given."};
    return c;
}

}  // namespace

Result<Vec3d> signed_axis(const std::string& name) {
    const bool has_sign = !name.empty() && (name[0] == '+' || name[0] == '-');
    const double sign = has_sign && name[0] == '-' ? -1 : 1;
    if (name.size() == (has_sign ? 2u : 1u)) {
        switch (std::toupper(static_cast<unsigned char>(name.back()))) {
            case 'X':
                return Vec3d{sign, 0, 0};
            case 'Y':
                return Vec3d{0, sign, 0};
            case 'Z':
                return Vec3d{0, 0, sign};
            default:
                break;
        }
    }
    return Error{"unknown axis \"" + name + "\"", "", "Accepted: +X, -X, +Y, -Y, +Z, -Z."};
}

std::vector<std::string> latlong_convention_names() {
    std::vector<std::string> names;
    for (const auto& named : k_named) names.emplace_back(named.name);
    return names;
}

Result<LatlongConvention> latlong_convention(const std::string& name) {
    for (const auto& named : k_named)
        if (named.name == name) return named.value;
    if (name.find('=') != std::string::npos) return convention_from_axes(name);
    return unknown(name);
}

}  // namespace domelight
