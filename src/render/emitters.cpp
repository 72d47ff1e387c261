#include "render/emitters.h"

#include "domelight/base/parallel.h"
#include "domelight/image/colour.h"
#include "domelight/sampling/sequences.h"

#include "render/surface/surface.h"

#include <algorithm>
#include <cmath>

namespace domelight {
namespace {

/// A triangle in the world.
struct WorldTriangle {
    Vec3f a, b, c;
    Vec3f normal;  ///< towards the front; its length is twice the area
    WorldTriangle(const Scene& scene, int instance, int triangle) {
        const Instance& placed = scene.instances[instance];
        const Mesh& mesh = scene.meshes[placed.mesh];
        const auto corner = [&](int k) {
            return placed.to_world.point(mesh.positions[mesh.indices[3 * std::size_t(triangle) + std::size_t(k)]]);
        };
        a = corner(0), b = corner(1), c = corner(2);
        normal = cross(b - a, c - a) * (placed.to_world.determinant() < 0 ? -1.f : 1.f);
    }
    double area() const { return 0.5 * std::sqrt(dot(Vec3d(normal), Vec3d(normal))); }
};

/// A point with constant density on a triangle, as the weights of its second and third corner (Turk 1990).
struct Barycentric {
    float u, v;
};
Barycentric point_of_triangle(UnitPoint point) {
    const float root = std::sqrt(unit_float(point.x)), y = unit_float(point.y);
    return {root * (1 - y), root * y};
}

bool emits(const Material& m) {
    const Vec3f& e = m.emission;
    return m.unlit || (std::max({e.x, e.y, e.z}) > 0 && std::isfinite(e.x) && std::isfinite(e.y) && std::isfinite(e.z));
}

/// The mean luminance of a triangle's emission.
double mean_emission(const Scene& scene, int instance, int triangle) {
    const Material& m = scene.materials[scene.meshes[scene.instances[instance].mesh].material];
    const int points = m.emission_texture || m.unlit || m.alpha_mode != Material::AlphaMode::opaque ? 16 : 1;
    double sum = 0;
    for (int i = 0; i < points; ++i) {
        const auto [u, v] =
            point_of_triangle(unit_point(Sequence::hammersley, 0, std::uint32_t(i), std::uint32_t(points)));
        const Hit hit{0, instance, triangle, u, v, {}};
        sum += luminance(Vec3d(emission_before_layers(scene, hit))) * double(opacity_at(scene, hit));
    }
    return sum / points;
}

}  // namespace

Emitters::Emitters(const Scene& scene) : first_(scene.instances.size(), -1) {
    for (int i = 0; i < int(scene.instances.size()); ++i) {
        const Mesh& mesh = scene.meshes[scene.instances[i].mesh];
        if (!emits(scene.materials[mesh.material])) continue;
        first_[i] = int(triangles_.size());
        for (int t = 0; t < mesh.triangle_count(); ++t) triangles_.push_back({i, t, 0});
    }
    std::vector<double> area(triangles_.size()), emission(triangles_.size());
    parallel_ranges(int(triangles_.size()), 1024, 0, [&](int begin, int end) {
        for (int k = begin; k < end; ++k) {
            const auto& [instance, triangle, unused] = triangles_[k];
            area[k] = WorldTriangle(scene, instance, triangle).area();
            emission[k] = mean_emission(scene, instance, triangle);
            if (!std::isfinite(area[k]) || !std::isfinite(emission[k])) area[k] = emission[k] = 0;
        }
    });
    double power = 0, all_area = 0;
    for (std::size_t k = 0; k < area.size(); ++k) power += area[k] * emission[k], all_area += area[k];
    if (!(power > 0)) {
        *this = {};
        return;
    }
    const double least = 0.05 * power / all_area, total = 1.05 * power;
    double sum = 0;
    for (std::size_t k = 0; k < area.size(); ++k) {
        const double per_area = (emission[k] + least) / total;
        triangles_[k].pdf_area = float(per_area);
        cumulative_.push_back(sum += per_area * area[k]);
    }
    cumulative_.back() = 1;
}

EmitterSample Emitters::sample(const Scene& scene, const Vec3f& place, UnitPoint u) const {
    const double x = unit_double(u.x);
    const auto found = std::ranges::upper_bound(cumulative_, x);
    if (found == cumulative_.end()) return {};
    // Where the number lies within the triangle's share is as random as the number was.
    const double before = found == cumulative_.begin() ? 0 : *(found - 1), part = (x - before) / (*found - before);
    const UnitPoint rest{unit_fixed(part), u.y};
    const Triangle& t = triangles_[std::size_t(found - cumulative_.begin())];
    const WorldTriangle world(scene, t.instance, t.triangle);
    const auto [b, c] = point_of_triangle(rest);
    const Vec3f to = world.a * (1 - b - c) + world.b * b + world.c * c - place;
    const float distance = std::sqrt(dot(to, to));
    EmitterSample out;
    if (!(distance > 0)) return out;
    out.direction = to / distance;
    out.hit = {distance, t.instance, t.triangle, b, c, world.normal};
    out.pdf_solid_angle = pdf_solid_angle(out.hit, out.direction);
    if (!(out.pdf_solid_angle > 0) || !std::isfinite(out.pdf_solid_angle)) out.hit.instance = -1;
    return out;
}

float Emitters::pdf_solid_angle(const Hit& hit, const Vec3f& direction) const {
    if (empty() || first_[std::size_t(hit.instance)] < 0) return 0;
    const float pdf_area = triangles_[std::size_t(first_[std::size_t(hit.instance)] + hit.triangle)].pdf_area,
                size = std::sqrt(dot(hit.geometric_normal, hit.geometric_normal)),
                cosine = std::abs(dot(hit.geometric_normal, direction));
    return cosine > 0 ? pdf_area * hit.distance * hit.distance * size / cosine : 0;
}

}  // namespace domelight
