#pragma once

#include "domelight/image/image.h"
#include "domelight/base/result.h"
#include "domelight/image/row_source.h"

#include <array>
#include <filesystem>
#include <optional>
#include <vector>

namespace domelight {

/// How the six faces of a cube lie in one picture. Every face is in OpenGL's orientation (docs/conventions.md) except
/// where said:
///
///   horizontal_cross   . +Y .  .      vertical_cross   . +Y .      horizontal_strip  +X -X +Y -Y +Z -Z
///                     -X +Z +X -Z                     -X +Z +X     vertical_strip    the same from the top down
///                      . -Y .  .                       . -Y .      openexr_strip     the same, with +-X and +-Z
///                      mirrored left to right and
///                                                      . -Z .                        +-Y top to bottom, as ImfEnvmap.h
///                                                      draws them, and
///                                                                                    samples on the faces' edges (i /
///                                                                                    (n - 1))
///
/// In a vertical cross -Z hangs below -Y, turned by 180 degrees. Where faces touch in a cross, the picture continues.
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
