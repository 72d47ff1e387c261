#include "io/environment/cube_face_names.h"

#include "domelight/io/file/file_extension.h"

#include "base/field_place.h"
#include "io/file/printable.h"
#include "io/image_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <iterator>
#include <set>
#include <string_view>

namespace domelight {

namespace {

enum class Naming { axis, word, short_word };

/// A kind of name, and its names of the faces +X -X +Y -Y +Z -Z.
struct Names {
    Naming naming;
    std::array<std::string_view, 6> faces;
};

// The one table of names. Those of the first row are used in messages.
constexpr Names k_names[] = {
    {Naming::axis, {"+x", "-x", "+y", "-y", "+z", "-z"}},
    {Naming::axis, {"px", "nx", "py", "ny", "pz", "nz"}},
    {Naming::axis, {"px", "mx", "py", "my", "pz", "mz"}},
    {Naming::axis, {"posx", "negx", "posy", "negy", "posz", "negz"}},
    {Naming::word, {"right", "left", "top", "bottom", "front", "back"}},
    {Naming::word, {"rt", "lf", "up", "dn", "ft", "bk"}},
    {Naming::word, {"right", "left", "up", "down", "front", "back"}},
    {Naming::short_word, {"r", "l", "u", "d", "f", "b"}},
    {Naming::short_word, {"0", "1", "2", "3", "4", "5"}},
};

constexpr const char* k_hint =
    "Accepted: px nx py ny pz nz, px mx ..., posx negx ..., +x -x ..., right left top bottom (or up down) front back, "
    "rt lf up dn ft bk, r l u d f b or 0 to 5, before or after anything else (sky_px.hdr). For other names: `faces`.";

struct NamedFace {
    int face;
    Naming naming;
};

std::optional<NamedFace> named_face(std::string_view word) {
    for (const Names& row : k_names)
        for (int f = 0; f < 6; ++f)
            if (row.faces[std::size_t(f)] == word) return NamedFace{f, row.naming};
    return std::nullopt;
}

std::string lower_stem(const std::filesystem::path& file) {
    return lower_case(file.stem().string());
}

/// The words of a name: runs of letters and digits, x, y and z with the sign before them.
std::vector<std::string> words_of(const std::string& stem) {
    const auto is_word = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0; };
    std::vector<std::string> words;
    for (std::size_t at = 0; at < stem.size();) {
        const auto end = std::find_if_not(stem.begin() + std::ptrdiff_t(at), stem.end(), is_word);
        const std::string word(stem.begin() + std::ptrdiff_t(at), end);
        const bool axis = word == "x" || word == "y" || word == "z";
        const bool sign = at > 0 && (stem[at - 1] == '+' || stem[at - 1] == '-');
        if (!word.empty()) words.push_back(axis && sign ? stem[at - 1] + word : word);
        at = std::size_t(end - stem.begin()) + 1;
    }
    return words;
}

/// A way to read a file's name.
using Rule = std::optional<NamedFace> (*)(const std::filesystem::path& file);

template <typename Words>
std::optional<NamedFace> first_face(const Words& words, bool short_words) {
    for (const auto& word : words)
        if (const auto named = named_face(word); named && (named->naming == Naming::short_word) == short_words)
            return named;
    return std::nullopt;
}

template <bool short_words, bool from_the_end>
std::optional<NamedFace> set_off(const std::filesystem::path& file) {
    auto words = words_of(lower_stem(file));
    if (from_the_end) std::reverse(words.begin(), words.end());
    return first_face(words, short_words);
}

// The end of a name says more than its start: "front_left.hdr" is a face of the cube "front". Letters and numbers say
// less than words.
constexpr Rule k_rules[] = {set_off<false, true>, set_off<false, false>, set_off<true, true>, set_off<true, false>};

/// The files as six different faces by one rule, if they are that.
std::optional<CubeFaceFiles> by_rule(const std::vector<std::filesystem::path>& files, Rule rule) {
    CubeFaceFiles faces;
    for (const std::filesystem::path& file : files) {
        const auto named = rule(file);
        if (!named || !faces.files[std::size_t(named->face)].empty()) return std::nullopt;
        faces.files[std::size_t(named->face)] = file;
        faces.axes_named = faces.axes_named && named->naming == Naming::axis;
    }
    return faces;
}

/// Files that are one text and then a name of a face, with nothing between: desertrt, desertlf, sky0, sky1.
std::optional<CubeFaceFiles> by_common_start(const std::vector<std::filesystem::path>& files) {
    const std::string first = lower_stem(files[0]);
    for (const Names& row : k_names)
        for (const std::string_view name : row.faces) {
            if (!first.ends_with(name)) continue;
            const std::string start = first.substr(0, first.size() - name.size());
            CubeFaceFiles faces;
            faces.axes_named = row.naming == Naming::axis;
            std::size_t found = 0;
            for (const std::filesystem::path& file : files)
                for (std::size_t f = 0; f < 6; ++f)
                    if (lower_stem(file) == start + std::string(row.faces[f]) && faces.files[f].empty()) {
                        faces.files[f] = file;
                        ++found;
                    }
            if (found == 6) return faces;
        }
    return std::nullopt;
}

std::optional<CubeFaceFiles> six_faces(const std::vector<std::filesystem::path>& files) {
    if (files.size() != 6) return std::nullopt;
    for (const Rule rule : k_rules)
        if (auto faces = by_rule(files, rule)) return faces;
    return by_common_start(files);
}

/// The longest name of a face that a file's name ends in, with or without anything that sets it off.
std::optional<NamedFace> glued(const std::filesystem::path& file) {
    const std::string stem = lower_stem(file);
    std::optional<NamedFace> found;
    std::size_t longest = 0;
    for (const Names& row : k_names)
        for (int f = 0; f < 6; ++f) {
            const std::string_view name = row.faces[std::size_t(f)];
            if (!stem.ends_with(name) || name.size() <= longest) continue;
            found = NamedFace{f, row.naming};
            longest = name.size();
        }
    return found;
}

/// The rule by which the most of the files are named as faces.
Rule most_telling_rule(const std::vector<std::filesystem::path>& files) {
    const auto named = [&](Rule rule) {
        return std::count_if(files.begin(), files.end(), [&](const auto& file) { return rule(file).has_value(); });
    };
    Rule best = k_rules[0];
    for (const Rule rule : {k_rules[2], k_rules[3], &glued})
        if (named(rule) > named(best)) best = rule;
    return best;
}

/// Why files are not six faces.
Error why_not_faces(const std::vector<std::filesystem::path>& files) {
    const Rule rule = most_telling_rule(files);
    std::array<std::filesystem::path, 6> faces;
    for (const std::filesystem::path& file : files) {
        const auto named = rule(file);
        if (!named) return {"the name does not say which face of a cube it is", file.string(), k_hint};
        std::filesystem::path& face = faces[std::size_t(named->face)];
        if (!face.empty()) return {"is the same face of the cube as " + face.string(), file.string(), k_hint};
        face = file;
    }
    for (std::size_t f = 0; f < 6; ++f)
        if (faces[f].empty())
            return {"face " + std::string(k_names[0].faces[f]) + " of the cube is missing",
                    files.empty() ? "" : files[0].string(), k_hint};
    return {"are not the six faces of a cube", files.empty() ? "" : files[0].string(), k_hint};
}

}  // namespace

std::optional<int> cube_face_of_word(const std::string& word) {
    const auto named = named_face(lower_case(word));
    return named ? std::optional(named->face) : std::nullopt;
}

std::optional<int> cube_face_of_name(const std::filesystem::path& file) {
    const auto named = k_rules[0](file);
    return named ? std::optional(named->face) : std::nullopt;
}

Result<CubeFaceFiles> cube_faces_by_name(const std::vector<std::filesystem::path>& files) {
    if (auto faces = six_faces(files)) return *faces;
    return why_not_faces(files);
}

bool are_cube_faces(const std::vector<std::filesystem::path>& files) {
    const auto faces = six_faces(files);
    if (!faces || faces->axes_named) return faces.has_value();
    auto bytes = FileBytes::open(files[0], std::int64_t(1) << 30, FileKinds::regular);
    if (!bytes) return true;
    const auto image = open_image_reader(*std::move(bytes), {});
    return !image || (*image)->facts().width == (*image)->facts().height;
}

Result<std::array<int, 6>> cube_face_order(const std::string& order) {
    std::vector<std::string> words(1);
    for (const char c : order) {
        if (c != ' ' && c != ',')
            words.back() += c;
        else if (!words.back().empty())
            words.emplace_back();
    }
    if (words.back().empty()) words.pop_back();
    std::array<int, 6> faces{};
    std::set<int> seen;
    for (std::size_t i = 0; i < words.size(); ++i) {
        const auto face = cube_face_of_word(words[i]);
        if (!face)
            return Error{fmt::format("\"{}\" names no face of a cube", printable(words[i])), field_place("faces"),
                         k_hint};
        if (i < 6) faces[i] = *face;
        seen.insert(*face);
    }
    if (words.size() != 6 || seen.size() != 6)
        return Error{
            fmt::format("{} words for {} faces, where each of six faces is named once", words.size(), seen.size()),
            field_place("faces"), "For example: px nx py ny pz nz."};
    return faces;
}

Result<CubeFaceFiles> cube_faces_in_order(const std::vector<std::filesystem::path>& files, const std::string& order) {
    const auto faces = cube_face_order(order);
    if (!faces) return faces.error();
    if (files.size() != 6)
        return Error{fmt::format("states the order of six files, not of {}", files.size()), field_place("faces"), ""};
    CubeFaceFiles sorted;
    for (std::size_t i = 0; i < 6; ++i) sorted.files[std::size_t((*faces)[i])] = files[i];
    return sorted;
}

std::vector<std::filesystem::path> cube_faces_in_folder(const std::filesystem::path& folder) {
    static const std::set<std::string> k_pictures{".hdr", ".exr", ".png", ".jpg", ".jpeg", ".pic", ".rgbe"};
    std::vector<std::filesystem::path> all, pictures;
    std::error_code error;
    for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error)) {
        if (!entry->is_regular_file(error)) continue;
        all.push_back(entry->path());
        if (k_pictures.contains(lower_case_extension(entry->path()))) pictures.push_back(entry->path());
    }
    std::sort(all.begin(), all.end());
    std::sort(pictures.begin(), pictures.end());
    for (const auto* files : {&all, &pictures})
        for (const Rule rule : k_rules) {
            std::vector<std::filesystem::path> named;
            std::copy_if(files->begin(), files->end(), std::back_inserter(named),
                         [&](const std::filesystem::path& file) { return rule(file).has_value(); });
            if (named.size() == 6 && by_rule(named, rule)) return named;
        }
    if (pictures.size() == 6 && by_common_start(pictures)) return pictures;
    std::vector<std::filesystem::path> named;
    std::copy_if(all.begin(), all.end(), std::back_inserter(named),
                 [](const std::filesystem::path& file) { return cube_face_of_name(file).has_value(); });
    return named;
}

}  // namespace domelight
