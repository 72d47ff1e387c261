#include "scene/gltf/gltf_materials.h"

#include <fmt/format.h>

#include <algorithm>

namespace domelight {

namespace {

constexpr float k_no_limit = std::numeric_limits<float>::max();

SceneTexture::Wrap wrap_of(std::uint64_t code) {
    return code == 33071   ? SceneTexture::Wrap::clamp
           : code == 33648 ? SceneTexture::Wrap::mirror
                           : SceneTexture::Wrap::repeat;
}

Vec3f colour(JsonFields& fields, const char* key, const Vec3f& fallback, float high) {
    const std::vector<float> v = fields.numbers(key, 3);
    if (v.empty()) return fallback;
    return {std::clamp(v[0], 0.0f, high), std::clamp(v[1], 0.0f, high), std::clamp(v[2], 0.0f, high)};
}

/// The textures of one material.
class TextureFields {
  public:
    TextureFields(const std::vector<SceneTexture>& textures, std::vector<std::string>& warnings)
        : textures_(textures), warnings_(warnings) {}

    /// The textureInfo `key` of `fields`, with KHR_texture_transform.
    SceneTexture read(JsonFields& fields, const char* key) {
        JsonFields info = fields.object(key);
        if (!info) return {};
        const int index = info.require("index").index("index", textures_.size());
        if (index < 0) return {};
        SceneTexture texture = textures_[std::size_t(index)];
        std::uint64_t set = info.size("texCoord", 0);
        if (JsonFields transform = info.extension("KHR_texture_transform")) {
            const std::vector<float> offset = transform.numbers("offset", 2), scale = transform.numbers("scale", 2);
            if (!offset.empty()) texture.offset_u = offset[0], texture.offset_v = offset[1];
            if (!scale.empty()) texture.scale_u = scale[0], texture.scale_v = scale[1];
            texture.rotation = transform.number("rotation", 0);
            set = transform.size("texCoord", set);
        }
        if (set > 1) {
            warnings_.push_back(
                fmt::format("{}.{}: texture coordinates {} are not read: set 0 is used", fields.place(), key, set));
            set = 0;
        }
        texture.texcoord = int(set);
        return texture;
    }

  private:
    const std::vector<SceneTexture>& textures_;
    std::vector<std::string>& warnings_;
};

void read_metallic_roughness(JsonFields fields, TextureFields& textures, Material& m) {
    if (const std::vector<float> v = fields.numbers("baseColorFactor", 4); !v.empty()) {
        m.base_color = {std::clamp(v[0], 0.0f, 1.0f), std::clamp(v[1], 0.0f, 1.0f), std::clamp(v[2], 0.0f, 1.0f)};
        m.opacity = std::clamp(v[3], 0.0f, 1.0f);
    }
    m.metalness = fields.number("metallicFactor", 1, 0, 1);
    m.roughness = fields.number("roughnessFactor", 1, 0, 1);
    m.base_color_texture = textures.read(fields, "baseColorTexture");
    m.metallic_roughness_texture = textures.read(fields, "metallicRoughnessTexture");
}

void read_specular(JsonFields fields, TextureFields& textures, Material& m) {
    m.specular = fields.number("specularFactor", 1, 0, 1);
    m.specular_color =
        colour(fields, "specularColorFactor", {1, 1, 1}, k_no_limit);  // may exceed 1: F0 is clamped, not this factor
    m.specular_texture = textures.read(fields, "specularTexture");
    m.specular_color_texture = textures.read(fields, "specularColorTexture");
}

void read_clearcoat(JsonFields fields, TextureFields& textures, Material& m) {
    m.clearcoat = fields.number("clearcoatFactor", 0, 0, 1);
    m.clearcoat_roughness = fields.number("clearcoatRoughnessFactor", 0, 0, 1);
    m.clearcoat_texture = textures.read(fields, "clearcoatTexture");
    m.clearcoat_roughness_texture = textures.read(fields, "clearcoatRoughnessTexture");
    m.clearcoat_normal_texture = textures.read(fields, "clearcoatNormalTexture");
    m.clearcoat_normal_scale = fields.object("clearcoatNormalTexture").number("scale", 1);
}

void read_sheen(JsonFields fields, TextureFields& textures, Material& m) {
    m.sheen_color = colour(fields, "sheenColorFactor", {}, 1);
    m.sheen_roughness = fields.number("sheenRoughnessFactor", 0, 0, 1);
    m.sheen_color_texture = textures.read(fields, "sheenColorTexture");
    m.sheen_roughness_texture = textures.read(fields, "sheenRoughnessTexture");
}

void read_volume(JsonFields transmission, JsonFields volume, TextureFields& textures, Material& m) {
    m.transmission = transmission.number("transmissionFactor", 0, 0, 1);
    m.transmission_texture = textures.read(transmission, "transmissionTexture");
    m.thickness = volume.number("thicknessFactor", 0, 0, k_no_limit);
    m.thickness_texture = textures.read(volume, "thicknessTexture");
    m.attenuation_color = colour(volume, "attenuationColor", {1, 1, 1}, 1);
    const float distance = volume.number("attenuationDistance", 0);
    if (distance > 0) m.attenuation_distance = distance;
}

void read_anisotropy(JsonFields fields, TextureFields& textures, Material& m) {
    m.anisotropy = fields.number("anisotropyStrength", 0, 0, 1);
    m.anisotropy_rotation = fields.number("anisotropyRotation", 0);
    m.anisotropy_texture = textures.read(fields, "anisotropyTexture");
}

}  // namespace

std::vector<SceneTexture> read_gltf_textures(JsonFields& root, std::size_t images, std::vector<std::string>& warnings) {
    std::vector<JsonFields> samplers = root.array("samplers");
    std::vector<SceneTexture> textures;
    for (JsonFields& fields : root.array("textures")) {
        SceneTexture texture;
        texture.image = fields.index("source", images);
        // WebP in its own member, so that a reader without it finds a PNG or JPEG in `source`.
        if (JsonFields webp = fields.extension("EXT_texture_webp"))
            texture.image = webp.require("source").index("source", images);
        if (const int sampler = fields.index("sampler", samplers.size()); sampler >= 0) {
            JsonFields& s = samplers[std::size_t(sampler)];
            texture.wrap_u = wrap_of(s.size("wrapS", 10497));
            texture.wrap_v = wrap_of(s.size("wrapT", 10497));
            texture.nearest = s.size("magFilter", 9729) == 9728;
        }
        if (texture.image < 0)
            warnings.push_back(fields.place() + ": its image is of a kind that is not read: left out");
        textures.push_back(texture);
    }
    return textures;
}

Material read_gltf_material(JsonFields fields, const std::vector<SceneTexture>& all,
                            std::vector<std::string>& warnings) {
    TextureFields textures(all, warnings);
    Material m;
    m.name = fields.text("name");
    m.double_sided = fields.flag("doubleSided", false);
    m.alpha_cutoff = fields.number("alphaCutoff", 0.5f, 0, k_no_limit);
    const std::string mode = fields.text("alphaMode", "OPAQUE");
    if (mode == "MASK")
        m.alpha_mode = Material::AlphaMode::mask;
    else if (mode == "BLEND")
        m.alpha_mode = Material::AlphaMode::blend;
    else if (mode != "OPAQUE")
        fields.fail("alphaMode", "is none of OPAQUE, MASK and BLEND");

    read_metallic_roughness(fields.object("pbrMetallicRoughness"), textures, m);
    m.normal_texture = textures.read(fields, "normalTexture");
    m.normal_scale = fields.object("normalTexture").number("scale", 1);
    m.occlusion_texture = textures.read(fields, "occlusionTexture");
    m.occlusion_strength = fields.object("occlusionTexture").number("strength", 1, 0, 1);
    m.emission_texture = textures.read(fields, "emissiveTexture");
    m.emission = colour(fields, "emissiveFactor", {}, 1e9f) *
                 fields.extension("KHR_materials_emissive_strength").number("emissiveStrength", 1, 0, 1e9f);

    m.unlit = bool(fields.extension("KHR_materials_unlit"));
    // 0 stands for a mirror in the dielectric part; between 0 and 1 there is nothing.
    m.ior = fields.extension("KHR_materials_ior").number("ior", 1.5f, 0, k_no_limit);
    if (m.ior > 0) m.ior = std::max(m.ior, 1.0f);
    read_specular(fields.extension("KHR_materials_specular"), textures, m);
    read_clearcoat(fields.extension("KHR_materials_clearcoat"), textures, m);
    read_sheen(fields.extension("KHR_materials_sheen"), textures, m);
    read_volume(fields.extension("KHR_materials_transmission"), fields.extension("KHR_materials_volume"), textures, m);
    read_anisotropy(fields.extension("KHR_materials_anisotropy"), textures, m);

    m.lambert = fields.flag_in("extras", "lambert");
    m.phong = fields.flag_in("extras", "phong");
    m.separable_masking = fields.flag_in("extras", "separableMasking");
    if (const auto reflectance = fields.number_in("extras", "reflectance"); reflectance && m.ior == 1.5f)
        m.ior = ior_of_reflectance(std::clamp(*reflectance, 0.f, 1.f));
    return m;
}

}  // namespace domelight
