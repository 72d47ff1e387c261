#include "render/camera.h"

#include <algorithm>
#include <cmath>

namespace domelight {

CameraRays::CameraRays(const Camera& camera, int width, int height) : camera_(camera) {
    half_height_ = camera.orthographic ? camera.half_height : std::tan(0.5f * camera.fov_y);
    half_width_ = half_height_ * float(width) / float(height);
    step_u_ = 2 * half_width_ / float(width);
    step_v_ = 2 * half_height_ / float(height);
}

Ray CameraRays::through(int x, int y, UnitPoint within) const {
    const float u = (float(x) + unit_float(within.x)) * step_u_ - half_width_,
                v = half_height_ - (float(y) + unit_float(within.y)) * step_v_;
    const Affine& m = camera_.to_world;
    if (camera_.orthographic) return {m.point({u, v, 0}), normalize(m.vector({0, 0, -1})), 0};
    return {m.translation, normalize(m.vector({u, v, -1})), 0};
}

Camera look_at(const Vec3f& eye, const Vec3f& target, float fov_y) {
    Vec3f back = eye - target;
    back = dot(back, back) > 0 ? normalize(back) : Vec3f{0, 0, 1};
    Vec3f right = cross(Vec3f{0, 1, 0}, back);
    right = dot(right, right) > 1e-12f ? normalize(right) : Vec3f{1, 0, 0};
    Camera camera;
    camera.to_world = {right, cross(back, right), back, eye};
    camera.fov_y = fov_y;
    return camera;
}

Camera default_camera(const Scene& scene, float aspect) {
    if (!scene.cameras.empty()) return scene.cameras.front();
    const auto [low, high] = scene.bounds();
    const Vec3f middle = (low + high) * 0.5f;
    const float radius = 0.5f * std::max(1e-6f, length(high - low)), fov_y = float(35 * k_pi / 180);
    const float half = std::min(0.5f * fov_y, std::atan(std::tan(0.5f * fov_y) * aspect));
    return look_at(middle + normalize(Vec3f{0.25f, 0.2f, 1}) * (radius / std::sin(half)), middle, fov_y);
}

}  // namespace domelight
