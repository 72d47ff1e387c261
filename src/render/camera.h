#pragma once

#include "domelight/base/unit_point.h"
#include "domelight/render/render.h"

#include "render/ray_scene.h"

namespace domelight {

/// The rays of a camera through the pixels of a picture.
class CameraRays {
  public:
    CameraRays(const Camera& camera, int width, int height);
    /// The ray through a point of pixel (x, y).
    Ray through(int x, int y, UnitPoint within) const;

  private:
    /// The direction of a panorama's ray, in the camera's frame, through a point of the picture in pixels.
    Vec3f panorama_direction(float x, float y) const;

    Camera camera_;
    int width_, height_;
    float half_width_, half_height_;
    float step_u_, step_v_;  ///< from pixel to pixel
};

}  // namespace domelight
