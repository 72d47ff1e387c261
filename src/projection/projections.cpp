#include "domelight/projection/projections.h"

#include "base/read_number.h"
#include "projection/latlong_convention.h"
#include "projection/shapes.h"

#include <algorithm>
#include <array>
#include <vector>

namespace domelight {

namespace {

constexpr std::array<ProjectionInfo, 11> k_projections{{
    {"latlong", "the whole sphere by longitude and latitude (equirectangular)", "+X", "+Z", "+Y",
     [](double) { return make_latlong_shape(); }},
    {"cube", "six faces +X -X +Y -Y +Z -Z in OpenGL's orientation", "+Z", "+X", "+Y",
     [](double) { return make_cube_shape(); }},
    {"sphere-map", "OpenGL's sphere map: a mirror ball seen from far away", "+Z", "+X", "+Y",
     [](double) { return make_sphere_map_shape(); }},
    {"mirror-ball", "a mirror ball in a photograph that it spans fov degrees of", "+Z", "+X", "+Y",
     [](double fov_deg) { return make_mirror_ball_shape(fov_deg * k_pi / 180); }},
    {"angular", "Debevec's light probe: the distance from the middle is the angle", "-Z", "+X", "+Y",
     [](double) { return make_angular_shape(); }},
    {"hemisphere", "normalize(p).xy: the half around the centre alone", "+Z", "+X", "+Y",
     [](double) { return make_hemisphere_shape(); }},
    {"paraboloid", "the front half of a dual paraboloid alone", "+Z", "+X", "+Y",
     [](double) { return make_paraboloid_shape(); }},
    {"paraboloid-opposite", "the back half read at xy / (z - 1), turned by half", "+Z", "+X", "+Y",
     [](double) { return make_paraboloid_opposite_shape(); }},
    {"dual-paraboloid", "front xy / (1 + z) and back xy / (1 - z), side by side or two files", "+Z", "+X", "+Y",
     [](double) { return make_dual_paraboloid_shape(); }},
    {"octahedral", "an octahedron unfolded to a square", "+Y", "+X", "+Z",
     [](double) { return make_octahedral_shape(); }},
    {"equal-area-octahedral", "the same with texels of equal solid angle (pbrt-v4)", "+Y", "+X", "+Z",
     [](double) { return make_equal_area_octahedral_shape(); }},
}};

std::string names() {
    std::string text;
    for (const ProjectionInfo& info : k_projections) text += (text.empty() ? "" : ", ") + std::string(info.name);
    return text;
}

/// The orientation of the picture, and the other settings after the slash.
struct Convention {
    Vec3d centre, right, up;
    SampleGrid grid = SampleGrid::centres;
    double fov_deg = 0;
    Mat3 world_to_picture() const { return {{right, up, centre}}; }
};

Result<void> read_key(const std::string& key, const std::string& value, bool has_fov, Convention& c) {
    if (key == "fov" && has_fov) {
        const char* end = value.data() + value.size();
        if (read_number(value.data(), end, c.fov_deg) != end)
            return Error{"a mirror ball's fov: \"" + value + "\" is not a number", "", ""};
        if (!(c.fov_deg >= 0 && c.fov_deg < 175))
            return Error{"a mirror ball's fov must lie between 0 and 175 degrees", "", ""};
        return {};
    }
    Vec3d* axis = key == "centre" || key == "center" ? &c.centre
                  : key == "right"                   ? &c.right
                  : key == "up"                      ? &c.up
                                                     : nullptr;
    if (!axis)
        return Error{"unknown word \"" + key + "\" in a convention", "",
                     "Accepted: centre, right, up" + std::string(has_fov ? ", fov." : ".")};
    const Result<Vec3d> direction = signed_axis(value);
    if (!direction) return direction.error();
    *axis = *direction;
    return {};
}

Result<Convention> read_convention(const std::string& name, const std::string& words, Convention c) {
    if (words.empty()) return c;
    if (words.find('=') == std::string::npos) {
        if (name == "latlong") {
            const auto named = latlong_convention(words);
            if (!named) return named.error();
            c = {named->centre, named->right, named->up, named->grid, 0};
            return c;
        }
        if (name == "cube" && words == "openexr") {
            c.grid = SampleGrid::both_on_edges;
            return c;
        }
        return Error{"unknown convention \"" + words + "\" of " + name, "",
                     name == "cube" ? "Accepted: openexr, or centre=+Z,right=+X[,up=+Y]."
                                    : "Accepted: centre=+Z,right=+X[,up=+Y]."};
    }
    for (std::size_t at = 0; at <= words.size();) {
        const std::size_t end = std::min(words.find_first_of(",/", at), words.size());
        const std::string item = words.substr(at, end - at);
        at = end + 1;
        const std::size_t equals = std::min(item.find('='), item.size());
        const std::string value = equals < item.size() ? item.substr(equals + 1) : "";
        if (const auto read = read_key(item.substr(0, equals), value, name == "mirror-ball", c); !read)
            return read.error();
    }
    if (dot(c.centre, c.right) != 0 || dot(c.centre, c.up) != 0 || dot(c.right, c.up) != 0)
        return Error{"centre, right and up of \"" + words + "\" must be three different axes", "",
                     "What is left out is as in the projection's default."};
    return c;
}

}  // namespace

std::span<const ProjectionInfo> projections() {
    return k_projections;
}

UVBox Projection::texel_box(int x, int y, int width, int height) const {
    const auto edge = [](int i, int n, bool on_edges) {
        return on_edges && n > 1 ? std::clamp((i - 0.5) / (n - 1), 0.0, 1.0) : double(i) / n;
    };
    const bool columns = grid_ == SampleGrid::both_on_edges, rows = grid_ != SampleGrid::centres;
    return {edge(x, width, columns), edge(y, height, rows), edge(x + 1, width, columns), edge(y + 1, height, rows)};
}

void Projection::texel_solid_angles(int y, int width, int height, std::span<double> out) const {
    const int half = (width + 1) / 2;
    std::vector<double> edges(std::size_t(half) + 1);
    for (int x = 0; x <= half; ++x) edges[std::size_t(x)] = x < width ? texel_box(x, y, width, height).u0 : 1.0;
    const UVBox row = texel_box(0, y, width, height);
    shape_->solid_angles(row.v0, row.v1, edges, out.first(std::size_t(half)));
    for (int x = half; x < width; ++x) out[std::size_t(x)] = out[std::size_t(width - 1 - x)];
}

Result<Projection> projection_from_name(const std::string& text) {
    const std::size_t slash = std::min(text.find('/'), text.size());
    std::string name = text.substr(0, slash);
    if (name == "equirectangular") name = "latlong";
    if (name == "pbrt") name = "equal-area-octahedral";
    const auto found =
        std::find_if(k_projections.begin(), k_projections.end(), [&](const auto& info) { return name == info.name; });
    if (found == k_projections.end())
        return Error{"unknown projection \"" + name + "\"", "", "Accepted: " + names() + "."};
    const Convention usual{*signed_axis(found->centre), *signed_axis(found->right), *signed_axis(found->up)};
    const auto convention = read_convention(name, slash < text.size() ? text.substr(slash + 1) : "", usual);
    if (!convention) return convention.error();
    return Projection(name, found->make_shape(convention->fov_deg), convention->world_to_picture(), convention->grid);
}

}  // namespace domelight
