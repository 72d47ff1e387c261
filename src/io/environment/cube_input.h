#pragma once

#include "domelight/base/result.h"
#include "domelight/image/image.h"
#include "domelight/image/row_source.h"

#include <array>
#include <filesystem>
#include <optional>
#include <vector>

namespace domelight {

// clang-format off
/// How the six faces of a cube lie in one picture. Every face is in OpenGL's orientation (docs/conventions.md) except
/// where it is said otherwise. Where faces touch in a cross, the picture continues.
///
///     horizontal_cross      vertical_cross
///
///        .  +Y  .  .           .  +Y  .
///       -X  +Z +X -Z          -X  +Z +X
///        .  -Y  .  .           .  -Y  .
///                              .  -Z  .       here -Z is turned by 180 degrees
///
/// horizontal_strip   +X -X +Y -Y +Z -Z from left to right
/// vertical_strip     the same from top to bottom
/// openexr_strip      the same from top to bottom, as ImfEnvmap.h draws it: +X, -X, +Z and -Z are mirrored from left to
///                    right, +Y and -Y from top to bottom, and the samples lie on the faces' edges, at i / (n - 1)
// clang-format on
enum class CubeLayout { horizontal_cross, vertical_cross, horizontal_strip, vertical_strip, openexr_strip };

/// The layout whose shape a picture has, if any: 4:3, 3:4, 6:1 or 1:6 exactly.
std::optional<CubeLayout> cube_layout_of_shape(int width, int height);

/// Reads a picture of a cube into OpenGL's faces, holding a few of its rows at a time. Precondition: `rows` has the
/// layout's shape.
Result<Cubemap> read_cube_picture(RowSource& rows, CubeLayout layout);

/// The face (0..5: +X -X +Y -Y +Z -Z) that a file's name speaks of: px nx py ny pz nz, mx my mz for nx ny nz, posx negx
/// ..., +x -x ..., right left top bottom front back (right is +X, top is +Y, front is +Z), or up down for top bottom.
/// The name is in any case, and stands alone or is set off from the rest by something other than a letter or digit.
std::optional<int> cube_face_of_name(const std::filesystem::path& file);

/// Sorts six files into faces +X -X +Y -Y +Z -Z by their names.
Result<std::array<std::filesystem::path, 6>> cube_faces_by_name(const std::vector<std::filesystem::path>& files);

/// The files of a folder that are named as faces.
std::vector<std::filesystem::path> cube_faces_in_folder(const std::filesystem::path& folder);

}  // namespace domelight
