#pragma once

#include "domelight/base/result.h"
#include "domelight/image/image.h"
#include "domelight/image/row_source.h"

#include <array>
#include <optional>

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

/// Reads a picture of a cube into OpenGL's faces, holding a few of its rows at a time. Preconditions: `rows` has the
/// layout's shape; the layout is not openexr_strip, which is read as a vertical strip for cube_from_openexr().
Result<Cubemap> read_cube_picture(RowSource& rows, CubeLayout layout);

/// Faces as OpenEXR has them, turned into OpenGL's orientation, with their samples moved from the edges to texel
/// centres.
Cubemap cube_from_openexr(Cubemap cube);

/// The cube whose face order[i] is the i-th face of `cube`.
Cubemap cube_with_faces(const Cubemap& cube, const std::array<int, 6>& order);

/// Whether faces that nothing is known of lie as OpenEXR has them: the samples on an edge are then in both faces that
/// meet there, and are equal, and in OpenGL's orientation the faces do not meet. False for a cube of one colour.
bool meets_as_openexr(const Cubemap& cube);

}  // namespace domelight
