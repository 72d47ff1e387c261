#include "domelight/probe/scene_hash.h"

#include "io/file/sha256.h"

#include <cstring>
#include <span>
#include <type_traits>

namespace domelight {
namespace {

/// Numbers and arrays of numbers, one after the other, each array after its length.
class SceneHash {
  public:
    template <typename T>
    void number(const T& value) {
        static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>);
        std::uint8_t bytes[sizeof(T)];
        std::memcpy(bytes, &value, sizeof value);
        hash_.add(bytes);
    }
    template <typename... T>
    void numbers(const T&... values) {
        (number(values), ...);
    }
    void vector(const Vec3f& v) { numbers(v.x, v.y, v.z); }
    void affine(const Affine& a) { vector(a.x), vector(a.y), vector(a.z), vector(a.translation); }
    /// Elements that are numbers, or made of numbers of one size, so that there are no gaps.
    template <typename T>
    void array(const std::vector<T>& values) {
        static_assert(std::is_trivially_copyable_v<T>);
        number(std::uint64_t(values.size()));
        hash_.add({reinterpret_cast<const std::uint8_t*>(values.data()), values.size() * sizeof(T)});
    }
    void texture(const SceneTexture& t) {
        numbers(t.image, t.texcoord, t.wrap_u, t.wrap_v, t.nearest, t.offset_u, t.offset_v, t.rotation, t.scale_u,
                t.scale_v);
    }
    void material(const Material& m) {
        numbers(m.unlit, m.lambert, m.phong, m.separable_masking, m.double_sided, m.alpha_mode, m.alpha_cutoff);
        vector(m.base_color), vector(m.emission), vector(m.specular_color), vector(m.sheen_color);
        vector(m.attenuation_color);
        numbers(m.opacity, m.metalness, m.roughness, m.ior, m.specular, m.normal_scale, m.occlusion_strength,
                m.clearcoat, m.clearcoat_roughness, m.clearcoat_normal_scale, m.sheen_roughness, m.transmission,
                m.thickness, m.attenuation_distance, m.anisotropy, m.anisotropy_rotation);
        for (const SceneTexture* t :
             {&m.base_color_texture, &m.metallic_roughness_texture, &m.normal_texture, &m.occlusion_texture,
              &m.emission_texture, &m.specular_texture, &m.specular_color_texture, &m.clearcoat_texture,
              &m.clearcoat_roughness_texture, &m.clearcoat_normal_texture, &m.sheen_color_texture,
              &m.sheen_roughness_texture, &m.transmission_texture, &m.thickness_texture, &m.anisotropy_texture})
            texture(*t);
    }
    void mesh(const Mesh& m) {
        array(m.positions), array(m.normals), array(m.tangents), array(m.texcoords[0]), array(m.texcoords[1]);
        array(m.colors), array(m.indices);
        number(m.material);
    }
    void light(const PunctualLight& l) {
        number(l.kind);
        vector(l.position), vector(l.direction), vector(l.intensity);
        numbers(l.range, l.cos_inner, l.cos_outer);
    }
    std::string finish() { return hash_.finish(); }

  private:
    Sha256 hash_;
};

}  // namespace

std::string scene_sha256(const Scene& scene) {
    SceneHash hash;
    hash.numbers(scene.images.size(), scene.materials.size(), scene.meshes.size(), scene.instances.size(),
                 scene.lights.size());
    for (const Rgba8Image& image : scene.images) hash.numbers(image.width, image.height), hash.array(image.rgba);
    for (const Material& m : scene.materials) hash.material(m);
    for (const Mesh& m : scene.meshes) hash.mesh(m);
    for (const Instance& i : scene.instances) hash.number(i.mesh), hash.affine(i.to_world);
    for (const PunctualLight& l : scene.lights) hash.light(l);
    return hash.finish();
}

}  // namespace domelight
