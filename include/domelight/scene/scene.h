#pragma once
// A scene: surfaces with materials and textures, lights and cameras, in the world of glTF 2.0: metres, right-handed, +Y
// up.

#include "domelight/base/result.h"
#include "domelight/base/vec.h"
#include "domelight/image/rgba8_image.h"

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

namespace domelight {

/// World from local: the columns x, y, z and a translation.
struct Affine {
    Vec3f x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1}, translation;

    Vec3f vector(const Vec3f& v) const { return x * v.x + y * v.y + z * v.z; }
    Vec3f point(const Vec3f& p) const { return vector(p) + translation; }
    /// a * b: b first.
    Affine operator*(const Affine& b) const { return {vector(b.x), vector(b.y), vector(b.z), point(b.translation)}; }
    /// Transforms a normal (as a plane, not as a vector); the result is not of unit length. Uses the cofactors, so that
    /// it stays finite when one axis is scaled to 0.
    Vec3f normal(const Vec3f& n) const { return cross(y, z) * n.x + cross(z, x) * n.y + cross(x, y) * n.z; }
    float determinant() const { return dot(cross(x, y), z); }
};

/// How a material looks up an image.
struct SceneTexture {
    enum class Wrap : std::uint8_t { repeat, clamp, mirror };
    int image = -1;    ///< of Scene::images; -1: none, every channel 1
    int texcoord = 0;  ///< which set of texture coordinates, 0 or 1
    Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
    bool nearest = false;
    /// KHR_texture_transform: uv' = translation * rotation * scale * uv. A positive rotation (radians) is
    /// counter-clockwise as seen with v running down. (The GLSL in the extension's text turns the other way, but its
    /// sample model and other readers do not.)
    float offset_u = 0, offset_v = 0, rotation = 0, scale_u = 1, scale_v = 1;
    explicit operator bool() const { return image >= 0; }
};

/// F0 of a dielectric from the `reflectance` that engines' materials have, [0, 1]: 0.5 is 4 %, 1 is 16 %. Lagarde and
/// de Rousiers 2014, 3.2.1.
inline float f0_of_reflectance(float reflectance) {
    return 0.16f * reflectance * reflectance;
}
/// The index of refraction whose F0 = ((ior - 1) / (ior + 1))^2 is f0_of_reflectance(reflectance): a reflectance of 0.5
/// gives 1.5, glTF's default. A glTF material without KHR_materials_ior may state its reflectance as
/// extras.reflectance.
inline float ior_of_reflectance(float reflectance) {
    return (1 + 0.4f * reflectance) / (1 - 0.4f * reflectance);
}

/// A surface: glTF's metallic-roughness model and its extensions. Factors are linear; colour textures are decoded from
/// sRGB.
struct Material {
    enum class AlphaMode : std::uint8_t { opaque, mask, blend };

    std::string name;
    bool unlit = false;    ///< KHR_materials_unlit: the base colour, and nothing else
    bool lambert = false;  ///< extras.lambert: a pure Lambert surface of the base colour, without specular reflection
    /// A modified Phong surface: diffuse albedo = base colour (1 - metalness), specular albedo = F0, exponent derived
    /// from the roughness.
    bool phong = false;
    /// extras.separableMasking: Smith's masking as G1(l) G1(v) instead of the height-correlated G2, for comparison with
    /// older renderers.
    bool separable_masking = false;
    bool double_sided = false;
    AlphaMode alpha_mode = AlphaMode::opaque;
    float alpha_cutoff = 0.5f;

    Vec3f base_color{1, 1, 1};
    float opacity = 1;
    float metalness = 1, roughness = 1;
    Vec3f emission;  ///< radiance, KHR_materials_emissive_strength included
    float ior = 1.5f;
    float specular = 1;  ///< KHR_materials_specular
    Vec3f specular_color{1, 1, 1};
    float normal_scale = 1, occlusion_strength = 1;

    float clearcoat = 0, clearcoat_roughness = 0, clearcoat_normal_scale = 1;
    Vec3f sheen_color;
    float sheen_roughness = 0;
    float transmission = 0, thickness = 0;
    Vec3f attenuation_color{1, 1, 1};
    float attenuation_distance = std::numeric_limits<float>::infinity();
    float anisotropy = 0, anisotropy_rotation = 0;  ///< anisotropy_rotation: radians

    SceneTexture base_color_texture;          ///< sRGB, A: opacity
    SceneTexture metallic_roughness_texture;  ///< G: roughness, B: metalness
    SceneTexture normal_texture, occlusion_texture /* R */, emission_texture /* sRGB */;
    SceneTexture specular_texture /* A */, specular_color_texture /* sRGB */;
    SceneTexture clearcoat_texture /* R */, clearcoat_roughness_texture /* G */, clearcoat_normal_texture;
    SceneTexture sheen_color_texture /* sRGB */, sheen_roughness_texture /* A */;
    SceneTexture transmission_texture /* R */, thickness_texture /* G */,
        anisotropy_texture /* RG direction, B strength */;
};

/// Triangles of one material. Arrays other than `positions` and `indices` are empty or as long as `positions`.
struct Mesh {
    std::string name;
    std::vector<Vec3f> positions;
    std::vector<Vec3f> normals;  ///< of unit length; empty: flat
    struct Tangent {
        Vec3f t;
        float sign = 1;  ///< bitangent = sign cross(normal, t)
    };
    std::vector<Tangent> tangents;
    struct TexCoord {
        float u = 0, v = 0;
    };
    std::vector<TexCoord> texcoords[2];
    struct Color {
        Vec3f rgb{1, 1, 1};
        float a = 1;
    };
    std::vector<Color> colors;  ///< linear, multiplied with the base colour
    std::vector<std::uint32_t>
        indices;       ///< three a triangle, each < positions.size(); counter-clockwise from the front
    int material = 0;  ///< of Scene::materials
    int triangle_count() const { return int(indices.size() / 3); }
};

/// A mesh placed in the world.
struct Instance {
    int mesh = 0;
    Affine to_world;
    std::string name;  ///< of the node, otherwise of the mesh: the object's name in tables
};

/// KHR_lights_punctual.
struct PunctualLight {
    enum class Kind : std::uint8_t { directional, point, spot };
    Kind kind = Kind::directional;
    Vec3f position, direction{0, 0, -1};  ///< in the world; `direction`: the way the light travels, unit length
    Vec3f intensity;                      ///< directional: irradiance perpendicular to it; else radiant intensity
    float range = std::numeric_limits<float>::infinity();
    float cos_inner = 1, cos_outer = 0.70710678f;  ///< spot
    std::string name;
};

/// A pinhole camera (or a parallel one) looking along -z of its frame, +y up; or one that sees in every direction.
struct Camera {
    /// What a camera that sees in every direction draws: an environment around its position, in its frame's axes.
    enum class Panorama : std::uint8_t {
        none,
        cube,    ///< the six faces of a Cubemap, one below the other: the picture is six times as high as wide
        latlong  ///< a lat-long map in the default convention: the picture is twice as wide as high
    };

    Affine to_world;
    float fov_y = 0.6f;  ///< radians
    bool orthographic = false;
    float half_height = 1;  ///< orthographic: metres
    Panorama panorama = Panorama::none;  ///< not `none`: fov_y, orthographic and half_height are not used
    float aspect = 0;       ///< width / height of the picture that it was made for; 0: not stated
    std::string name;
};

struct Scene {
    std::vector<Rgba8Image> images;
    std::vector<Material> materials;
    std::vector<Mesh> meshes;
    std::vector<Instance> instances;
    std::vector<PunctualLight> lights;
    std::vector<Camera> cameras;
    std::vector<std::string> warnings;  ///< what was repaired, and what was left out

    /// The bounding box of everything, in the world; [0, 0] for an empty scene.
    struct Box {
        Vec3f low, high;
    };
    Box bounds() const;
    std::int64_t triangle_count() const;  ///< over all instances
};

/// How a scene is read. A scene beyond one of the limits is refused with an error that states the limit, before the
/// memory is allocated; no part of it is returned.
struct SceneOptions {
    /// The largest number of bytes, >= 0, for the file and everything decoded from it: buffers, meshes, images, and
    /// each instance with what the renderer makes of it.
    std::int64_t max_bytes = std::int64_t(4) << 30;
    /// glTF: the largest number of instances of mesh primitives, >= 0, counted over nodes and EXT_mesh_gpu_instancing.
    /// A second instance of a primitive with exactly the same transform is left out with a warning and does not count.
    std::int64_t max_instances = std::int64_t(1) << 20;
    /// The illuminance in lux that an irradiance of 1 in the environment's unit stands for, > 0. Intensities in
    /// KHR_lights_punctual are in lux and candela and are divided by it, unless the file states a value of its own
    /// (extras.lux_per_unit of the light or of the asset, as `domelight lights` writes it).
    float lux_per_unit = 683;
    int threads = 0;  ///< for decoding textures; 0: all
};

/// Reads glTF 2.0 (.gltf, .glb), .obj or .ply. Errors name the file and what is wrong in it: broken JSON, missing
/// buffers and textures, paths out of the file's folder, cyclic nodes, indices and accessors out of range, extensions
/// that are required and unknown, JSON nested more than 256 deep, no triangles, more memory than
/// SceneOptions::max_bytes or more instances than SceneOptions::max_instances. Repaired with a warning: NaN vertices
/// and degenerate triangles (left out), normals of length 0 (recomputed).
Result<Scene> load_scene(const std::filesystem::path& file, const SceneOptions& options = {});

/// Lights that were taken out of an environment: what `domelight lights` writes as lights.gltf.
struct EnvironmentLights {
    /// In the environment's unit. Directions are in the world as it was when the lights were extracted.
    std::vector<PunctualLight> lights;
    double rotate_y_deg = 0;  ///< by how many degrees the environment was turned about +Y then
    std::vector<std::string> warnings;
};
/// Reads the lights of a glTF 2.0 file, with or without triangles. Errors: as load_scene, and a file that is not glTF.
Result<EnvironmentLights> load_environment_lights(const std::filesystem::path& file, const SceneOptions& options = {});

/// Built-in scenes: "spheres" (roughness from left to right, metal above dielectric), "ball" (a material ball on a
/// plinth), "furnace" (one white sphere). Errors: another name.
Result<Scene> built_in_scene(const std::string& name);
/// The names that built_in_scene accepts.
std::vector<std::string> built_in_scene_names();
/// The built-in scene of that name, or else the file, by load_scene().
Result<Scene> open_scene(const std::string& name_or_file, const SceneOptions& options = {});

}  // namespace domelight
