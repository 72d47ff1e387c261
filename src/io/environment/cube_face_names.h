#pragma once

#include "domelight/base/result.h"

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace domelight {

/// Six files in the order of a cube's faces, +X -X +Y -Y +Z -Z.
struct CubeFaceFiles {
    std::array<std::filesystem::path, 6> files;
    /// The names state the axes (px, +x, posx); false: words, letters or numbers, which say no convention.
    bool axes_named = true;
};

/// The face (0..5: +X -X +Y -Y +Z -Z) that a word names, in any case:
///
///     px posx +x, nx mx negx -x, and so on      the axes
///     right left top bottom front back          front is +Z, right +X, top +Y; also up and down
///     rt lf up dn ft bk                         the same in games
///     r l u d f b                               the same
///     0 1 2 3 4 5                               the order of the faces
std::optional<int> cube_face_of_word(const std::string& word);

/// The face that a file's name speaks of by the axes, or by a word of more than one letter. The word is set off from
/// the rest by something other than a letter or digit; the last one counts.
std::optional<int> cube_face_of_name(const std::filesystem::path& file);

/// Sorts six files into faces by their names. What all six have in common, before or after the word, may be anything;
/// before it there need be nothing that sets it off (desertrt, desertlf). Where names could be read in several ways,
/// that counts which makes them six different faces.
/// Errors: names that are not those of six faces.
Result<CubeFaceFiles> cube_faces_by_name(const std::vector<std::filesystem::path>& files);

/// The same for files whose order is stated: `order` is six words for faces, separated by spaces or commas.
Result<CubeFaceFiles> cube_faces_in_order(const std::vector<std::filesystem::path>& files, const std::string& order);

/// Whether these are the faces of one cube rather than as many environments: named as faces, and, where the names do
/// not name axes, square as far as the first can be read.
bool are_cube_faces(const std::vector<std::filesystem::path>& files);

/// The faces that six words name, each once, separated by spaces or commas.
Result<std::array<int, 6>> cube_face_order(const std::string& order);

/// The files of a folder that are named as faces: six, or as many as there are.
std::vector<std::filesystem::path> cube_faces_in_folder(const std::filesystem::path& folder);

}  // namespace domelight
