#pragma once

#include "domelight/base/names.h"

namespace domelight {

/// How the six faces of a cube lie in their pictures (docs/conventions.md).
enum class FaceOrientation {
    opengl,   ///< OpenGL's table of cube maps in our right-handed world: front is +Z, seen from inside mirrored
    directx,  ///< the same table in a left-handed world, so that front is -Z here and right is +X: as a viewer sees it
    openexr,  ///< ImfEnvmap.h: seen along its axis each face is the mirror image of OpenGL's, samples on the edges
};
template <>
struct EnumNames<FaceOrientation> {
    static constexpr const char* kind = "an orientation of a cube's faces";
    static constexpr NamedValue<FaceOrientation> table[] = {
        {FaceOrientation::opengl, "opengl"},
        {FaceOrientation::directx, "directx"},
        {FaceOrientation::openexr, "openexr"},
    };
};

}  // namespace domelight
