#include "gltf_samples.h"

#include <cmath>

using namespace domelight;
using namespace domelight::test;

namespace {

// A PNG of one opaque red texel.
const char* const k_red_png =
    "data:image/"
    "png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mP8z8DwHwAFBQIAX8jx0gAAAABJRU5ErkJggg==";

/// A scene of one triangle with one material.
GltfSample with_material(Json material) {
    GltfSample sample;
    sample.json["images"] = Json::array({{{"uri", k_red_png}}});
    sample.json["samplers"] = Json::array({{{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}}});
    sample.json["textures"] = Json::array({{{"source", 0}}, {{"source", 0}, {"sampler", 0}}});
    sample.json["materials"] = Json::array({std::move(material)});
    Json primitive = sample.triangle();
    primitive["material"] = 0;
    sample.show(std::move(primitive));
    return sample;
}

Material material_of(Json material) {
    const auto scene = with_material(std::move(material)).load();
    REQUIRE_MESSAGE(scene, error_of(scene));
    return scene->materials[0];
}

}  // namespace

TEST_CASE("gltf material: the defaults are glTF's") {
    const Material m = material_of(Json::object());
    CHECK(m.base_color == Vec3f{1, 1, 1});
    CHECK((m.metalness == 1 && m.roughness == 1 && m.opacity == 1 && m.ior == 1.5f && m.specular == 1));
    CHECK(!(m.unlit || m.lambert || m.double_sided));
    CHECK(m.alpha_mode == Material::AlphaMode::opaque);
    CHECK(!m.base_color_texture);
    CHECK(std::isinf(m.attenuation_distance));
}

TEST_CASE("gltf material: metallic-roughness with its textures") {
    const Material m = material_of({{"name", "paint"},
                                    {"doubleSided", true},
                                    {"alphaMode", "MASK"},
                                    {"alphaCutoff", 0.25},
                                    {"emissiveFactor", {0.5, 0.25, 1}},
                                    {"emissiveTexture", {{"index", 0}}},
                                    {"normalTexture", {{"index", 0}, {"scale", 0.5}, {"texCoord", 1}}},
                                    {"occlusionTexture", {{"index", 0}, {"strength", 0.75}}},
                                    {"pbrMetallicRoughness",
                                     {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}},
                                      {"metallicFactor", 0.25},
                                      {"roughnessFactor", 0.5},
                                      {"baseColorTexture", {{"index", 1}}},
                                      {"metallicRoughnessTexture", {{"index", 0}}}}},
                                    {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 8}}}}},
                                    {"extras", {{"lambert", true}}}});
    CHECK(m.name == "paint");
    CHECK(m.lambert);
    CHECK(m.double_sided);
    CHECK(m.alpha_mode == Material::AlphaMode::mask);
    CHECK(m.alpha_cutoff == 0.25f);
    CHECK(m.base_color == Vec3f{0.1f, 0.2f, 0.3f});
    CHECK(m.opacity == 0.4f);
    CHECK((m.metalness == 0.25f && m.roughness == 0.5f));
    CHECK(m.emission == Vec3f{4, 2, 8});
    CHECK((m.normal_scale == 0.5f && m.normal_texture.texcoord == 1 && m.occlusion_strength == 0.75f));
    CHECK((m.base_color_texture && m.metallic_roughness_texture && m.normal_texture && m.occlusion_texture &&
           m.emission_texture));
    CHECK(m.base_color_texture.wrap_u == SceneTexture::Wrap::clamp);
    CHECK(m.base_color_texture.wrap_v == SceneTexture::Wrap::mirror);
    CHECK(m.base_color_texture.nearest);
    CHECK(m.normal_texture.wrap_u == SceneTexture::Wrap::repeat);
}

TEST_CASE("gltf material: every extension that Material has fields for") {
    const Json texture = {{"index", 0}};
    const Material m =
        material_of({{"extensions",
                      {{"KHR_materials_ior", {{"ior", 1.33}}},
                       {"KHR_materials_specular",
                        {{"specularFactor", 0.5},
                         {"specularColorFactor", {1, 2, 3}},
                         {"specularTexture", texture},
                         {"specularColorTexture", texture}}},
                       {"KHR_materials_clearcoat",
                        {{"clearcoatFactor", 0.6},
                         {"clearcoatRoughnessFactor", 0.2},
                         {"clearcoatTexture", texture},
                         {"clearcoatRoughnessTexture", texture},
                         {"clearcoatNormalTexture", {{"index", 0}, {"scale", 2}}}}},
                       {"KHR_materials_sheen",
                        {{"sheenColorFactor", {0.1, 0.2, 0.3}},
                         {"sheenRoughnessFactor", 0.4},
                         {"sheenColorTexture", texture},
                         {"sheenRoughnessTexture", texture}}},
                       {"KHR_materials_transmission", {{"transmissionFactor", 0.9}, {"transmissionTexture", texture}}},
                       {"KHR_materials_volume",
                        {{"thicknessFactor", 2},
                         {"attenuationDistance", 3},
                         {"attenuationColor", {0.5, 0.6, 0.7}},
                         {"thicknessTexture", texture}}},
                       {"KHR_materials_anisotropy",
                        {{"anisotropyStrength", 0.7}, {"anisotropyRotation", 0.3}, {"anisotropyTexture", texture}}},
                       {"KHR_materials_unlit", Json::object()}}}});
    CHECK(m.ior == 1.33f);
    CHECK((m.specular == 0.5f && m.specular_color == Vec3f{1, 2, 3} && m.specular_texture && m.specular_color_texture));
    CHECK((m.clearcoat == 0.6f && m.clearcoat_roughness == 0.2f && m.clearcoat_normal_scale == 2));
    CHECK((m.clearcoat_texture && m.clearcoat_roughness_texture && m.clearcoat_normal_texture));
    CHECK((m.sheen_color == Vec3f{0.1f, 0.2f, 0.3f} && m.sheen_roughness == 0.4f && m.sheen_color_texture &&
           m.sheen_roughness_texture));
    CHECK((m.transmission == 0.9f && m.transmission_texture));
    CHECK((m.thickness == 2 && m.attenuation_distance == 3 && m.attenuation_color == Vec3f{0.5f, 0.6f, 0.7f} &&
           m.thickness_texture));
    CHECK((m.anisotropy == 0.7f && m.anisotropy_rotation == 0.3f && m.anisotropy_texture));
    CHECK(m.unlit);
}

TEST_CASE("gltf material: texture transforms, and the set of coordinates they may name") {
    const Json transform = {{"offset", {0.5, 0.25}}, {"rotation", 1.5}, {"scale", {2, 3}}, {"texCoord", 1}};
    const Material m =
        material_of({{"pbrMetallicRoughness",
                      {{"baseColorTexture",
                        {{"index", 0}, {"texCoord", 0}, {"extensions", {{"KHR_texture_transform", transform}}}}}}}});
    const SceneTexture& t = m.base_color_texture;
    CHECK((t.offset_u == 0.5f && t.offset_v == 0.25f && t.rotation == 1.5f && t.scale_u == 2 && t.scale_v == 3 &&
           t.texcoord == 1));
}

TEST_CASE("gltf material: values out of range are moved into it, wrong ones are errors") {
    const Material m = material_of({{"pbrMetallicRoughness", {{"roughnessFactor", 7}, {"metallicFactor", -1}}},
                                    {"extensions", {{"KHR_materials_ior", {{"ior", 0.5}}}}}});
    CHECK((m.roughness == 1 && m.metalness == 0 && m.ior == 1));
    CHECK(contains(error_of(with_material({{"alphaMode", "CUTOUT"}}).load()), "materials[0].alphaMode"));
    CHECK(contains(error_of(with_material({{"emissiveFactor", {1, 2}}}).load()),
                   "materials[0].emissiveFactor: is not 3 numbers"));
    CHECK(contains(error_of(with_material({{"doubleSided", 1}}).load()), "materials[0].doubleSided"));
    CHECK(contains(error_of(with_material({{"normalTexture", {{"index", 2}}}}).load()),
                   "materials[0].normalTexture.index: there is no 2"));
    CHECK(contains(error_of(with_material({{"normalTexture", {{"scale", 2}}}}).load()), "index: is missing"));
}

TEST_CASE("gltf material: images by uri, by buffer view and by WebP, and those that are broken") {
    GltfSample sample = with_material({{"emissiveTexture", {{"index", 0}}}});
    auto scene = sample.load();
    REQUIRE_MESSAGE(scene, error_of(scene));
    CHECK((scene->images[0].width == 1 && scene->images[0].height == 1));
    CHECK(scene->images[0].rgba[0] == 255);

    GltfSample unused = sample;
    unused.json["images"].push_back({{"uri", "missing.png"}});
    CHECK(error_of(unused.load()) == "loaded");
    GltfSample missing = sample;
    missing.json["images"][0]["uri"] = "missing.png";
    scene = missing.load();
    REQUIRE_MESSAGE(scene, error_of(scene));
    CHECK(warns(*scene, "images[0]: missing.png: no such file: left out"));
    CHECK(!scene->materials[0].emission_texture);
    missing.json["images"][0]["uri"] = "../missing.png";
    scene = missing.load();
    REQUIRE_MESSAGE(scene, error_of(scene));
    CHECK(warns(*scene, "leaves the folder of the file that names it"));
    GltfSample broken = sample;
    broken.json["images"][0]["uri"] = "data:image/png;base64,AAAA";
    scene = broken.load();
    REQUIRE_MESSAGE(scene, error_of(scene));
    CHECK(warns(*scene, "neither PNG nor JPEG nor WebP"));
    GltfSample outside = sample;
    outside.json["images"][0] = {
        {"bufferView", outside.add("bufferViews", {{"buffer", 0}, {"byteOffset", 1000}, {"byteLength", 5}})},
        {"mimeType", "image/png"}};
    CHECK(warns(*outside.load(), "do not exist"));
    GltfSample nothing = sample;
    nothing.json["images"][0] = Json::object();
    CHECK(contains(error_of(nothing.load()), "images[0]: names neither or both"));
    // An image that starts as a PNG and ends too early.
    GltfSample cut = sample;
    cut.json["images"][0]["uri"] = "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR4nGP4";
    scene = cut.load();
    REQUIRE_MESSAGE(scene, error_of(scene));
    CHECK(warns(*scene, "left out, its materials have their factors alone"));
    // A texture whose image exists only in a format that is not read.
    GltfSample basis = sample;
    basis.json["textures"][0] = {{"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}};
    scene = basis.load();
    REQUIRE_MESSAGE(scene, error_of(scene));
    CHECK(!scene->materials[0].emission_texture);
    CHECK(warns(*scene, "textures[0]"));
}
