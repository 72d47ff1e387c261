#include "scene/mesh/mesh_repair.h"

#include "io/file/printable.h"
#include "io/image_reader.h"

#include <fmt/format.h>

#include <cmath>

namespace domelight {

namespace {

/// Twice the area times the direction. In double: neither tiny nor huge triangles leave its range, and what is
/// collinear in float comes out as 0.
Vec3d area_normal(const Mesh& mesh, std::size_t triangle) {
    const Vec3d a(mesh.positions[mesh.indices[triangle]]), b(mesh.positions[mesh.indices[triangle + 1]]),
        c(mesh.positions[mesh.indices[triangle + 2]]);
    return cross(b - a, c - a);
}

/// By vertex: the sum over the triangles around it.
std::vector<Vec3d> normal_sums(const Mesh& mesh) {
    std::vector<Vec3d> sums(mesh.positions.size());
    for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
        const Vec3d n = area_normal(mesh, t);
        for (std::size_t k = 0; k < 3; ++k) sums[mesh.indices[t + k]] = sums[mesh.indices[t + k]] + n;
    }
    return sums;
}

Vec3f direction(const Vec3d& sum) {
    const double l = length(sum);
    return l > 0 && std::isfinite(l) ? Vec3f(sum / l) : Vec3f{0, 1, 0};
}

bool unit(const Vec3f& n) {
    const float squared = dot(n, n);
    return std::abs(squared - 1) < 1e-6f;
}

}  // namespace

void MeshRepairs::note(Kind& kind, std::int64_t count, const std::string& name) {
    if (count && !kind.count) kind.first = name;
    kind.count += count;
}

void MeshRepairs::drop_triangles(Mesh& mesh) {
    std::int64_t broken = 0, flat = 0;
    std::vector<bool> bad;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        if (is_sound(mesh.positions[v])) continue;
        if (bad.empty()) bad.resize(mesh.positions.size());
        bad[v] = true;
    }
    std::size_t kept = 0;
    for (std::size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
        const std::uint32_t a = mesh.indices[t], b = mesh.indices[t + 1], c = mesh.indices[t + 2];
        if (!bad.empty() && (bad[a] || bad[b] || bad[c])) {
            ++broken;
        } else if (a == b || b == c || c == a || area_normal(mesh, t) == Vec3d{}) {
            ++flat;
        } else {
            mesh.indices[kept] = a, mesh.indices[kept + 1] = b, mesh.indices[kept + 2] = c;
            kept += 3;
        }
    }
    mesh.indices.resize(kept);
    // These vertices belong to no triangle any more, but must not change the bounding box.
    const Vec3f harmless = kept ? mesh.positions[mesh.indices[0]] : Vec3f{};
    for (std::size_t v = 0; v < bad.size(); ++v)
        if (bad[v]) mesh.positions[v] = harmless;
    note(broken_, broken, mesh.name);
    note(flat_, flat, mesh.name);
}

void MeshRepairs::mend_normals(Mesh& mesh) {
    std::vector<std::uint32_t> lost;
    for (std::size_t v = 0; v < mesh.normals.size(); ++v) {
        Vec3f& n = mesh.normals[v];
        if (unit(n)) continue;
        const double l = length(Vec3d(n));
        if (l > 1e-20 && l < 1e30)
            n = Vec3f(Vec3d(n) / l);
        else
            lost.push_back(std::uint32_t(v));
    }
    if (lost.empty()) return;
    const std::vector<Vec3d> sums = normal_sums(mesh);
    std::int64_t used = 0;
    for (const std::uint32_t v : lost) {
        mesh.normals[v] = direction(sums[v]);
        used += sums[v] != Vec3d{};
    }
    note(normals_, used, mesh.name);
}

void MeshRepairs::mend_attributes(Mesh& mesh) {
    std::int64_t tangents = 0, others = 0;
    for (Mesh::Tangent& tangent : mesh.tangents) {
        const double l = length(Vec3d(tangent.t));
        if (l > 1e-20 && l < 1e30)
            tangent.t = Vec3f(Vec3d(tangent.t) / l);
        else
            ++tangents;
        tangent.sign = tangent.sign < 0 ? -1.0f : 1.0f;
    }
    if (tangents) mesh.tangents.clear();
    const auto finite = [&](float& value) {
        if (std::isfinite(value)) return;
        value = 0;
        ++others;
    };
    for (auto& set : mesh.texcoords)
        for (Mesh::TexCoord& uv : set) finite(uv.u), finite(uv.v);
    for (Mesh::Color& colour : mesh.colors)
        finite(colour.rgb.x), finite(colour.rgb.y), finite(colour.rgb.z), finite(colour.a);
    note(tangents_, tangents, mesh.name);
    note(attributes_, others, mesh.name);
}

void MeshRepairs::mend(Mesh& mesh) {
    drop_triangles(mesh);
    mend_normals(mesh);
    mend_attributes(mesh);
}

std::vector<std::string> MeshRepairs::warnings() const {
    std::vector<std::string> lines;
    const auto say = [&](const Kind& kind, const char* what) {
        if (kind.count)
            lines.push_back(fmt::format("{} {} (the first in mesh '{}')", kind.count, what, printable(kind.first)));
    };
    say(broken_, "triangles left out: a vertex is not finite, or out of range");
    say(flat_, "triangles left out: they have no area");
    say(normals_, "normals of no length recomputed");
    say(tangents_, "tangents of no length: tangents left out, to be derived from texture coordinates");
    say(attributes_, "texture coordinates or colours that are not finite set to 0");
    return lines;
}

void smooth_normals(Mesh& mesh) {
    const std::vector<Vec3d> sums = normal_sums(mesh);
    mesh.normals.resize(sums.size());
    for (std::size_t v = 0; v < sums.size(); ++v) mesh.normals[v] = direction(sums[v]);
}

}  // namespace domelight
