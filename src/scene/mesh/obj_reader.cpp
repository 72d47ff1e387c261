#include "domelight/base/parallel.h"

#include "io/file/path_inside.h"
#include "io/file/printable.h"
#include "io/file/text_fields.h"
#include "io/image_reader.h"
#include "scene/mesh/mesh_repair.h"
#include "scene/mesh/mtl_reader.h"
#include "scene/mesh/polygon.h"
#include "scene/scene_readers.h"

#include <fmt/format.h>

#include <map>
#include <unordered_map>

namespace domelight {

namespace {

/// One corner of a face: places in the lists of positions, texture coordinates and normals; -1: not given.
struct Corner {
    std::int64_t v = -1, vt = -1, vn = -1;
    bool operator==(const Corner&) const = default;
};

struct CornerHash {
    std::size_t operator()(const Corner& c) const {
        std::uint64_t h = std::uint64_t(c.v) * 0x9e3779b97f4a7c15u;
        h = (h ^ std::uint64_t(c.vt)) * 0xbf58476d1ce4e5b9u;
        return std::size_t((h ^ (h >> 31) ^ std::uint64_t(c.vn)) * 0x94d049bb133111ebu);
    }
};

/// The faces of one object and material.
struct Group {
    Mesh mesh;
    bool normals = true, texcoords = true, smooth = false;  // whether every corner has them
    std::unordered_map<Corner, std::uint32_t, CornerHash> vertices;
};

/// A Wavefront .obj: polygons, with materials of .mtl files beside it. Free-form surfaces, lines and points are left
/// out.
class ObjReader {
  public:
    ObjReader(std::string_view text, const std::filesystem::path& folder, const SceneOptions& options)
        : text_(text), folder_(folder), budget_(options.max_bytes), options_(options) {}
    Result<Scene> read();

  private:
    Result<void> statement(std::string_view key, std::string_view rest);
    Result<void> face(std::string_view rest);
    bool corner(std::string_view word, Corner& out) const;
    Result<void> library(std::string_view name);
    bool numbers(std::string_view& rest, int count, float* out) const;
    Group& group();
    std::uint32_t vertex(Group& group, const Corner& corner);
    void finish(Group& group);

    std::string_view text_;
    std::filesystem::path folder_;
    ByteBudget budget_;
    SceneOptions options_;
    Scene scene_;
    std::vector<Vec3f> positions_, normals_;
    std::vector<Mesh::TexCoord> texcoords_;
    std::map<std::string, int, std::less<>> materials_;
    std::map<std::pair<std::string, int>, std::size_t> group_numbers_;
    std::vector<Group> groups_;
    std::string object_ = "object";
    int material_ = -1;  // -1: none stated yet
    bool smooth_ = false;
    std::size_t current_ = std::size_t(-1);
    std::vector<SceneImageSource> sources_;
    std::int64_t left_out_ = 0;
};

bool ObjReader::numbers(std::string_view& rest, int count, float* out) const {
    for (int i = 0; i < count; ++i) {
        double value = 0;
        if (!parse_number(take_word(rest), value)) return false;
        out[i] = float_of(value);
    }
    return true;
}

/// "v", "v/vt", "v//vn" or "v/vt/vn", counted from 1, or from the end if negative.
bool ObjReader::corner(std::string_view word, Corner& out) const {
    std::int64_t* const places[3] = {&out.v, &out.vt, &out.vn};
    const std::int64_t counts[3] = {std::int64_t(positions_.size()), std::int64_t(texcoords_.size()),
                                    std::int64_t(normals_.size())};
    for (int k = 0; k < 3; ++k) {
        const std::size_t slash = word.find('/');
        const std::string_view part = word.substr(0, slash);
        if (!part.empty()) {
            std::int64_t n = 0;
            const auto parsed = std::from_chars(part.data(), part.data() + part.size(), n);
            if (parsed.ec != std::errc() || parsed.ptr != part.data() + part.size()) return false;
            *places[k] = n < 0 ? counts[k] + n : n - 1;
            if (n == 0 || *places[k] < 0 || *places[k] >= counts[k]) return false;
        }
        if (slash == word.npos) return out.v >= 0;
        word.remove_prefix(slash + 1);
    }
    return false;
}

Group& ObjReader::group() {
    if (current_ < groups_.size()) return groups_[current_];
    if (material_ < 0) {
        material_ = int(scene_.materials.size());
        scene_.materials.push_back(plain_material());
    }
    const auto [at, fresh] = group_numbers_.try_emplace({object_, material_}, groups_.size());
    if (fresh) {
        groups_.emplace_back();
        groups_.back().mesh.name = object_;
        groups_.back().mesh.material = material_;
    }
    current_ = at->second;
    return groups_[current_];
}

std::uint32_t ObjReader::vertex(Group& group, const Corner& corner) {
    const auto [at, fresh] = group.vertices.try_emplace(corner, std::uint32_t(group.mesh.positions.size()));
    if (fresh) {
        group.mesh.positions.push_back(positions_[std::size_t(corner.v)]);
        group.mesh.normals.push_back(corner.vn < 0 ? Vec3f{} : normals_[std::size_t(corner.vn)]);
        // v runs upwards in .obj files, and downwards in ours.
        const Mesh::TexCoord uv = corner.vt < 0 ? Mesh::TexCoord{} : texcoords_[std::size_t(corner.vt)];
        group.mesh.texcoords[0].push_back({uv.u, 1 - uv.v});
        group.normals &= corner.vn >= 0;
        group.texcoords &= corner.vt >= 0;
    }
    return at->second;
}

Result<void> ObjReader::face(std::string_view rest) {
    Group& in = group();
    in.smooth |= smooth_;
    std::vector<std::uint32_t> corners;
    for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest)) {
        Corner at;
        if (!corner(word, at))
            return Error{fmt::format("face with a corner '{}' that is not there", printable(word)), "", ""};
        corners.push_back(vertex(in, at));
    }
    if (corners.size() < 3) return Error{"face with fewer than three corners", "", ""};
    triangulate(corners, in.mesh.positions, in.mesh.indices);
    return {};
}

Result<void> ObjReader::library(std::string_view name) {
    const std::string file(name);
    const auto path = path_inside(folder_ / file, folder_, file);
    if (!path) return path.error();
    auto bytes = FileBytes::open(*path, options_.max_bytes, FileKinds::regular);
    if (!bytes) {
        scene_.warnings.push_back(
            fmt::format("{}: {}: its materials are left out", printable(name, 80), bytes.error().what));
        return {};
    }
    const auto text = (*bytes)->bytes();
    read_mtl({reinterpret_cast<const char*>(text.data()), text.size()}, path->parent_path(), folder_, scene_,
             materials_, sources_);
    return {};
}

Result<void> ObjReader::statement(std::string_view key, std::string_view rest) {
    float n[3];
    if (key == "v") {
        if (!numbers(rest, 3, n)) return Error{"vertex without three numbers", "", ""};
        positions_.push_back({n[0], n[1], n[2]});
    } else if (key == "vn") {
        if (!numbers(rest, 3, n)) return Error{"normal without three numbers", "", ""};
        normals_.push_back({n[0], n[1], n[2]});
    } else if (key == "vt") {
        if (!numbers(rest, 1, n)) return Error{"texture coordinate without a number", "", ""};
        if (!numbers(rest, 1, n + 1)) n[1] = 0;
        texcoords_.push_back({n[0], n[1]});
    } else if (key == "f") {
        return face(rest);
    } else if (key == "o" || key == "g") {
        if (const std::string_view name = trimmed(rest); !name.empty()) object_ = name;
        current_ = std::size_t(-1);
    } else if (key == "usemtl") {
        const auto known = materials_.find(trimmed(rest));
        if (known == materials_.end()) {
            scene_.materials.push_back(plain_material());
            scene_.materials.back().name = std::string(trimmed(rest));
            scene_.warnings.push_back(
                fmt::format("material '{}' is not defined: light grey is used", printable(trimmed(rest))));
            material_ = materials_[scene_.materials.back().name] = int(scene_.materials.size()) - 1;
        } else {
            material_ = known->second;
        }
        current_ = std::size_t(-1);
    } else if (key == "mtllib") {
        return library(trimmed(rest));
    } else if (key == "s") {
        const std::string_view value = take_word(rest);
        smooth_ = value != "off" && value != "0";
    } else if (key == "l" || key == "p" || key == "curv" || key == "surf") {
        ++left_out_;
    }
    return {};
}

void ObjReader::finish(Group& group) {
    if (!group.texcoords) group.mesh.texcoords[0].clear();
    if (!group.normals) group.mesh.normals.clear();
}

Result<Scene> ObjReader::read() {
    // A statement of n bytes adds at most this much memory.
    if (const auto room = budget_.take(text_.size(), 40, "its text"); !room) return room.error();
    TextLines lines(text_);
    std::string joined;
    for (std::string_view line; lines.next(line);) {
        // A backslash at the end continues the line.
        if (line.ends_with('\\')) {
            joined.assign(line.substr(0, line.size() - 1));
            for (bool more = true; more && lines.next(line);) {
                more = line.ends_with('\\');
                joined.append(" ").append(line.substr(0, line.size() - more));
            }
            line = joined;
        }
        const std::string_view key = take_word(line);
        if (const auto done = statement(key, line); !done)
            return Error{fmt::format("line {}: {}", lines.number(), done.error().what), "", done.error().hint};
    }
    MeshRepairs repairs;
    for (Group& group : groups_) {
        const bool smooth = !group.normals && group.smooth;
        finish(group);
        if (smooth) smooth_normals(group.mesh);
        repairs.mend(group.mesh);
        if (group.mesh.indices.empty()) continue;
        scene_.instances.push_back({int(scene_.meshes.size()), {}, group.mesh.name});
        scene_.meshes.push_back(std::move(group.mesh));
    }
    if (const auto loaded = load_scene_images(sources_, scene_, budget_, options_.threads); !loaded)
        return loaded.error();
    // A map of light without a factor is the light itself.
    for (Material& m : scene_.materials)
        if (m.emission_texture && m.emission == Vec3f{}) m.emission = {1, 1, 1};
    if (!materials_.empty()) scene_.warnings.push_back("Phong materials are approximated by roughness and reflectance");
    if (left_out_)
        scene_.warnings.push_back(fmt::format("{} lines, points or curves left out: only faces are drawn", left_out_));
    for (std::string& line : repairs.warnings()) scene_.warnings.push_back(std::move(line));
    return std::move(scene_);
}

}  // namespace

Result<Scene> read_obj(std::shared_ptr<const FileBytes> bytes, const std::filesystem::path& folder,
                       const SceneOptions& options) {
    const auto all = bytes->bytes();
    return ObjReader({reinterpret_cast<const char*>(all.data()), all.size()}, folder, options).read();
}

}  // namespace domelight
