#include "render/camera.h"

#include "domelight/projection/projection.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace domelight {

CameraRays::CameraRays(const Camera& camera, int width, int height) : camera_(camera), width_(width), height_(height) {
    half_height_ = camera.orthographic ? camera.half_height : std::tan(0.5f * camera.fov_y);
    half_width_ = half_height_ * float(width) / float(height);
    step_u_ = 2 * half_width_ / float(width);
    step_v_ = 2 * half_height_ / float(height);
}

Vec3f CameraRays::panorama_direction(float x, float y) const {
    if (camera_.panorama == Camera::Panorama::latlong)
        return Vec3f(latlong_direction({double(x) / width_, double(y) / height_}));
    const int face = std::min(int(y) / width_, 5);
    return Vec3f(cube_direction(face, {double(x) / width_, double(y) / width_ - face}));
}

Ray CameraRays::through(int x, int y, UnitPoint within) const {
    if (camera_.panorama != Camera::Panorama::none) {
        const Vec3f d = panorama_direction(float(x) + unit_float(within.x), float(y) + unit_float(within.y));
        return {camera_.to_world.translation, normalize(camera_.to_world.vector(d)), 0};
    }
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

Camera camera_for(Camera camera, float aspect) {
    // A wider picture has the same height, and shows more at the sides.
    const float taller = camera.aspect / aspect;
    if (!(taller > 1)) return camera;
    camera.fov_y = 2 * std::atan(std::tan(0.5f * camera.fov_y) * taller);
    camera.half_height *= taller;
    camera.aspect = aspect;
    return camera;
}

namespace {

constexpr int k_slices = 64;

/// What a scene sweeps when it is turned about the vertical axis through its middle, in slices of equal height: how far
/// from the axis each slice reaches.
struct Sweep {
    float low = 0, height = 0;  ///< above the middle
    std::array<float, k_slices> radius{};
};

Sweep sweep_of(const Scene& scene, const Scene::Box& box, const Vec3f& middle) {
    Sweep sweep{box.low.y - middle.y, box.high.y - box.low.y};
    for (const Instance& instance : scene.instances)
        for (const Vec3f& position : scene.meshes[std::size_t(instance.mesh)].positions) {
            const Vec3f p = instance.to_world.point(position) - middle;
            const float part = sweep.height > 0 ? (p.y - sweep.low) / sweep.height : 0;
            float& radius = sweep.radius[std::size_t(std::clamp(int(part * k_slices), 0, k_slices - 1))];
            radius = std::max(radius, std::hypot(p.x, p.z));
        }
    return sweep;
}

/// How far from a scene's middle a camera with these axes must stand to see all of its sweep, and so the whole scene in
/// every frame of a turntable.
///
/// tan_x, tan_y  half the width and height of the picture at distance 1
float framing_distance(const Affine& frame, const Sweep& sweep, float tan_x, float tan_y) {
    constexpr int k_angles = 64;
    float distance = 0;
    for (int slice = 0; slice < k_slices; ++slice)
        for (int edge = slice; edge <= slice + 1; ++edge)
            for (int i = 0; i < k_angles; ++i) {
                const float angle = float(2 * k_pi * i / k_angles), radius = sweep.radius[std::size_t(slice)];
                const Vec3f p{radius * std::cos(angle), sweep.low + sweep.height * float(edge) / k_slices,
                              radius * std::sin(angle)};
                const float across = std::abs(dot(p, frame.x)) / tan_x, up = std::abs(dot(p, frame.y)) / tan_y;
                distance = std::max(distance, dot(p, frame.z) + std::max(across, up));
            }
    return distance;
}

}  // namespace

Camera default_camera(const Scene& scene, float aspect) {
    if (!scene.cameras.empty()) return camera_for(scene.cameras.front(), aspect);
    constexpr float margin = 1.05f;  // of the picture around the scene
    const Scene::Box box = scene.bounds();
    const Vec3f middle = (box.low + box.high) * 0.5f;
    const float fov_y = float(35 * k_pi / 180), tan_y = std::tan(0.5f * fov_y) / margin;
    const Vec3f back = normalize(Vec3f{0.25f, 0.2f, 1});
    const float distance = framing_distance(look_at(middle + back, middle, fov_y).to_world,
                                            sweep_of(scene, box, middle), tan_y * aspect, tan_y);
    return look_at(middle + back * std::max(1e-6f, distance), middle, fov_y);
}

void set_view(RenderOptions& o, const Scene& scene, const SceneView& view) {
    const Camera* camera = view.eye ? nullptr : view.camera;
    const float aspect = camera && camera->aspect > 0 ? camera->aspect : 1;
    const auto other_side = [](float length) { return std::clamp(int(std::lround(length)), 1, 16384); };
    if (view.width || !view.height) {
        o.width = view.width.value_or(512);
        o.height = view.height ? *view.height : other_side(float(o.width) / aspect);
    } else {
        o.height = *view.height;
        o.width = other_side(float(o.height) * aspect);
    }
    const float shape = float(o.width) / float(o.height);
    o.camera = camera     ? camera_for(*camera, shape)
               : view.eye ? look_at(*view.eye, view.target, view.fov_y)
                          : default_camera(scene, shape);
}

}  // namespace domelight
