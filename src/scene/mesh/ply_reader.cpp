#include "image/srgb_curve.h"
#include "io/file/byte_budget.h"
#include "io/file/printable.h"
#include "io/file/text_fields.h"
#include "io/image_reader.h"
#include "scene/mesh/mesh_repair.h"
#include "scene/mesh/mtl_reader.h"
#include "scene/mesh/polygon.h"
#include "scene/scene_readers.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace domelight {

namespace {

enum class Type { i8, u8, i16, u16, i32, u32, f32, f64, none };

Type type_of(std::string_view name) {
    constexpr std::pair<const char*, Type> k_names[] = {
        {"char", Type::i8},   {"int8", Type::i8},     {"uchar", Type::u8},   {"uint8", Type::u8},
        {"short", Type::i16}, {"int16", Type::i16},   {"ushort", Type::u16}, {"uint16", Type::u16},
        {"int", Type::i32},   {"int32", Type::i32},   {"uint", Type::u32},   {"uint32", Type::u32},
        {"float", Type::f32}, {"float32", Type::f32}, {"double", Type::f64}, {"float64", Type::f64}};
    for (const auto& [known, type] : k_names)
        if (name == known) return type;
    return Type::none;
}

std::size_t bytes_of(Type type) {
    switch (type) {
        case Type::i8:
        case Type::u8:
            return 1;
        case Type::i16:
        case Type::u16:
            return 2;
        case Type::f64:
            return 8;
        default:
            return 4;
    }
}

struct Property {
    std::string name;
    Type type = Type::none, count_type = Type::none;  // count_type: of a list's length; none: no list
};

struct Element {
    std::string name;
    std::uint64_t count = 0;
    std::vector<Property> properties;
};

enum class Format { ascii, little, big };

/// The values after the header, one after the other, in any of the three formats.
class PlyValues {
  public:
    PlyValues(std::string_view rest, Format format) : rest_(rest), format_(format) {}

    /// Whether the file can contain so many entries of an element. Entries without properties take no bytes: a header
    /// could state any number of them.
    bool holds(const Element& element) const {
        std::size_t least = 0;
        for (const Property& p : element.properties)
            least += format_ == Format::ascii ? 2 : bytes_of(p.count_type == Type::none ? p.type : p.count_type);
        // The last value of a text file need not be followed by a blank.
        return least == 0 ? element.count == 0 : element.count <= (rest_.size() + 1) / least;
    }
    bool next(Type type, double& value) {
        if (format_ == Format::ascii) return parse_number(take_word(rest_), value);
        const std::size_t n = bytes_of(type);
        if (rest_.size() < n) return false;
        std::uint8_t bytes[8];
        std::memcpy(bytes, rest_.data(), n);
        rest_.remove_prefix(n);
        if ((format_ == Format::big) != (std::endian::native == std::endian::big)) std::reverse(bytes, bytes + n);
        value = decode(type, bytes);
        return true;
    }

  private:
    template <typename T>
    static double as(const std::uint8_t* bytes) {
        T value;
        std::memcpy(&value, bytes, sizeof value);
        return double(value);
    }
    static double decode(Type type, const std::uint8_t* bytes) {
        switch (type) {
            case Type::i8:
                return as<std::int8_t>(bytes);
            case Type::u8:
                return as<std::uint8_t>(bytes);
            case Type::i16:
                return as<std::int16_t>(bytes);
            case Type::u16:
                return as<std::uint16_t>(bytes);
            case Type::i32:
                return as<std::int32_t>(bytes);
            case Type::u32:
                return as<std::uint32_t>(bytes);
            case Type::f32:
                return as<float>(bytes);
            default:
                return as<double>(bytes);
        }
    }
    std::string_view rest_;
    Format format_;
};

Error too_early() {
    return {"file ends too early, or contains a word that is not a number", "", "The file is truncated or damaged."};
}

/// IEC 61966-2-1: colours of scans are made for a screen.
float linear_of_srgb(double c) {
    return float(srgb_to_linear(c));
}

class PlyReader {
  public:
    PlyReader(std::string_view text, const SceneOptions& options) : lines_(text), budget_(options.max_bytes) {}
    Result<Scene> read();

  private:
    Result<void> read_header();
    Result<void> header_line(std::string_view key, std::string_view rest);
    Result<void> read_vertices(const Element& element, PlyValues& values);
    Result<void> read_faces(const Element& element, PlyValues& values);
    Result<void> skip(const Element& element, PlyValues& values);
    void set_vertex(const Property& property, double value);

    TextLines lines_;
    ByteBudget budget_;
    Format format_ = Format::ascii;
    bool has_format_ = false;
    std::vector<Element> elements_;
    Mesh mesh_;
    std::vector<std::string> warnings_;
};

Result<void> PlyReader::header_line(std::string_view key, std::string_view rest) {
    if (key == "format") {
        const std::string_view name = take_word(rest);
        if (name == "ascii")
            format_ = Format::ascii;
        else if (name == "binary_little_endian")
            format_ = Format::little;
        else if (name == "binary_big_endian")
            format_ = Format::big;
        else
            return Error{fmt::format("there is no format '{}'", printable(name)), "", ""};
        has_format_ = true;
    } else if (key == "element") {
        Element element;
        element.name = take_word(rest);
        const std::string_view count = take_word(rest);
        const auto parsed = std::from_chars(count.data(), count.data() + count.size(), element.count);
        if (element.name.empty() || parsed.ec != std::errc() || parsed.ptr != count.data() + count.size())
            return Error{fmt::format("'{}' is not a number of elements", printable(count)), "", ""};
        elements_.push_back(std::move(element));
    } else if (key == "property") {
        Property property;
        std::string_view type = take_word(rest);
        if (type == "list") {
            property.count_type = type_of(take_word(rest));
            if (property.count_type == Type::none || property.count_type >= Type::f32)
                return Error{"list whose length is of no whole type", "", ""};
            type = take_word(rest);
        }
        property.type = type_of(type);
        property.name = take_word(rest);
        if (property.type == Type::none || elements_.empty())
            return Error{fmt::format("property of type '{}'", printable(type)), "", ""};
        elements_.back().properties.push_back(std::move(property));
    }
    return {};
}

Result<void> PlyReader::read_header() {
    std::string_view line;
    if (!lines_.next(line) || trimmed(line) != "ply") return Error{"not a PLY file", "", ""};
    while (lines_.next(line)) {
        const std::string_view key = take_word(line);
        if (key == "end_header") return has_format_ ? Result<void>() : Error{"its header names no format", "", ""};
        if (const auto done = header_line(key, line); !done)
            return Error{fmt::format("line {}: {}", lines_.number(), done.error().what), "", ""};
    }
    return Error{"its header has no end", "", "The file is truncated."};
}

void PlyReader::set_vertex(const Property& p, double value) {
    const float v = float_of(value);
    // Whole numbers are 0..255 (or 0..65535), others 0..1.
    const double scaled = p.type == Type::u8 ? value / 255 : p.type == Type::u16 ? value / 65535 : value;
    if (p.name == "x")
        mesh_.positions.back().x = v;
    else if (p.name == "y")
        mesh_.positions.back().y = v;
    else if (p.name == "z")
        mesh_.positions.back().z = v;
    else if (mesh_.normals.size() && p.name == "nx")
        mesh_.normals.back().x = v;
    else if (mesh_.normals.size() && p.name == "ny")
        mesh_.normals.back().y = v;
    else if (mesh_.normals.size() && p.name == "nz")
        mesh_.normals.back().z = v;
    else if (mesh_.texcoords[0].size() && (p.name == "u" || p.name == "s" || p.name == "texture_u"))
        mesh_.texcoords[0].back().u = v;
    else if (mesh_.texcoords[0].size() && (p.name == "v" || p.name == "t" || p.name == "texture_v"))
        mesh_.texcoords[0].back().v = 1 - v;
    else if (mesh_.colors.size() && p.name == "red")
        mesh_.colors.back().rgb.x = linear_of_srgb(scaled);
    else if (mesh_.colors.size() && p.name == "green")
        mesh_.colors.back().rgb.y = linear_of_srgb(scaled);
    else if (mesh_.colors.size() && p.name == "blue")
        mesh_.colors.back().rgb.z = linear_of_srgb(scaled);
    else if (mesh_.colors.size() && p.name == "alpha")
        mesh_.colors.back().a = float(scaled);
}

Result<void> PlyReader::read_vertices(const Element& element, PlyValues& values) {
    const auto has = [&](std::string_view name) {
        return std::any_of(element.properties.begin(), element.properties.end(),
                           [&](const Property& p) { return p.name == name; });
    };
    if (!has("x") || !has("y") || !has("z")) return Error{"its vertices have no x, y and z", "", ""};
    const bool normals = has("nx") && has("ny") && has("nz"), colors = has("red") && has("green") && has("blue");
    const bool texcoords = (has("u") && has("v")) || (has("s") && has("t")) || (has("texture_u") && has("texture_v"));
    if (const auto room = budget_.take(element.count, 12 + 12 * normals + 8 * texcoords + 16 * colors, "vertices");
        !room)
        return room;
    for (std::uint64_t i = 0; i < element.count; ++i) {
        mesh_.positions.emplace_back();
        if (normals) mesh_.normals.emplace_back();
        if (texcoords) mesh_.texcoords[0].emplace_back();
        if (colors) mesh_.colors.emplace_back();
        for (const Property& p : element.properties) {
            double value = 0, length = 1;
            if (p.count_type != Type::none && !(values.next(p.count_type, length) && length >= 0)) return too_early();
            for (double k = 0; k < length; ++k)
                if (!values.next(p.type, value)) return too_early();
            if (p.count_type == Type::none) set_vertex(p, value);
        }
    }
    return {};
}

Result<void> PlyReader::read_faces(const Element& element, PlyValues& values) {
    std::vector<std::uint32_t> corners;
    for (std::uint64_t i = 0; i < element.count; ++i)
        for (const Property& p : element.properties) {
            const bool face = p.count_type != Type::none && (p.name == "vertex_indices" || p.name == "vertex_index");
            double length = 1, value = 0;
            if (p.count_type != Type::none && !(values.next(p.count_type, length) && length >= 0)) return too_early();
            corners.clear();
            for (double k = 0; k < length; ++k) {
                if (!values.next(p.type, value)) return too_early();
                if (!face) continue;
                if (!(value >= 0 && value < double(mesh_.positions.size())))
                    return Error{fmt::format("face {}: there is no vertex {}, only {} of them", i, value,
                                             mesh_.positions.size()),
                                 "", ""};
                corners.push_back(std::uint32_t(value));
            }
            if (!face || corners.size() < 3) continue;
            if (const auto room = budget_.take(corners.size(), 12, "faces"); !room) return room;
            triangulate(corners, mesh_.positions, mesh_.indices);
        }
    return {};
}

Result<void> PlyReader::skip(const Element& element, PlyValues& values) {
    for (std::uint64_t i = 0; i < element.count; ++i)
        for (const Property& p : element.properties) {
            double length = 1, value = 0;
            if (p.count_type != Type::none && !(values.next(p.count_type, length) && length >= 0)) return too_early();
            for (double k = 0; k < length; ++k)
                if (!values.next(p.type, value)) return too_early();
        }
    if (element.count)
        warnings_.push_back(fmt::format("{} elements '{}' left out", element.count, printable(element.name)));
    return {};
}

Result<Scene> PlyReader::read() {
    if (const auto header = read_header(); !header) return header.error();
    PlyValues values(lines_.rest(), format_);
    bool vertices = false;
    for (const Element& element : elements_) {
        if (!values.holds(element))
            return Error{
                fmt::format("{} elements '{}' do not fit into the file", element.count, printable(element.name)), "",
                "The file is truncated, or its header is wrong."};
        const bool first_vertices = element.name == "vertex" && !vertices;
        vertices |= first_vertices;
        const auto done = first_vertices           ? read_vertices(element, values)
                          : element.name == "face" ? read_faces(element, values)
                                                   : skip(element, values);
        if (!done) return done.error();
    }
    Scene scene;
    MeshRepairs repairs;
    mesh_.name = "object";
    repairs.mend(mesh_);
    scene.materials.push_back(plain_material());
    if (!mesh_.indices.empty()) {
        scene.instances.push_back({0, {}, mesh_.name});
        scene.meshes.push_back(std::move(mesh_));
    }
    scene.warnings = std::move(warnings_);
    for (std::string& line : repairs.warnings()) scene.warnings.push_back(std::move(line));
    return scene;
}

}  // namespace

Result<Scene> read_ply(std::shared_ptr<const FileBytes> bytes, const SceneOptions& options) {
    const auto all = bytes->bytes();
    return PlyReader({reinterpret_cast<const char*>(all.data()), all.size()}, options).read();
}

}  // namespace domelight
