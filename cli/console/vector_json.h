#pragma once

#include "domelight/base/vec.h"

#include "io/file/json.h"

namespace domelight::cli {

/// A Vec3f or Vec3d as an array of three numbers.
template <typename Vector>
Json vector_json(const Vector& v) {
    return Json::array({v.x, v.y, v.z});
}

}  // namespace domelight::cli
