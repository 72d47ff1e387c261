#pragma once
// A scene as a real-time engine draws it, lit by the maps that `bake` writes or by probes. Each model follows its shader.

#include "domelight/base/names.h"
#include "domelight/filtering/harmonic/spherical_harmonics.h"
#include "domelight/filtering/kernel/zonal_kernel.h"
#include "domelight/probe/probe_blend.h"
#include "domelight/render/render.h"

#include <memory>
#include <optional>

namespace domelight {

/// The light that a shader looks up at a point. Lookups take world directions.
class LightAt {
  public:
    virtual ~LightAt() = default;

    /// The prefiltered radiance from a direction.
    virtual Vec3f specular(const Vec3f& direction, float roughness) const = 0;
    /// The same for a Phong lobe, by exponent.
    virtual Vec3f phong(const Vec3f& direction, float exponent) const = 0;
    /// E / pi by an irradiance cube, or by the nine spherical-harmonic coefficients.
    virtual Vec3f irradiance_over_pi(const Vec3f& normal) const = 0;
    virtual Vec3f irradiance_over_pi_sh(const Vec3f& normal) const = 0;
    /// Scale and bias from the BRDF table, by bilinear lookup.
    struct ScaleBias {
        float scale, bias;
    };
    virtual ScaleBias brdf(float NdotV, float roughness) const = 0;

  protected:
    LightAt() = default;
    LightAt(const LightAt&) = default;
    LightAt& operator=(const LightAt&) = default;
};

/// The maps of a bake: the same light at every point.
class LightMaps final : public LightAt {
  public:
    /// Reads a bake for the generic engine (`domelight bake -o DIR`) with the lobe ggx or one of Phong's:
    /// specular.ktx2, irradiance.ktx2, sh.json and brdf.ktx2, and the roughness or exponent of each level from
    /// manifest.json. Errors name the file.
    static Result<LightMaps> load(const std::filesystem::path& folder);
    /// Bakes the maps of the generic engine in memory. lobe: ggx, or phong_brdf with its default exponents.
    static Result<LightMaps> bake(ImageView<const float> latlong, const Mat3& world_to_source, int threads = 0,
                                  Lobe lobe = Lobe::ggx);
    ~LightMaps() override;
    LightMaps(LightMaps&&) noexcept;
    LightMaps& operator=(LightMaps&&) noexcept;

    /// The lobe of the specular chain: ggx, or one of Phong's.
    Lobe lobe() const;
    /// The prefiltered environment, interpolated between the two levels nearest in roughness, without seams at the
    /// edges of faces.
    Vec3f specular(const Vec3f& direction, float roughness) const override;
    /// The same for a Phong chain, by exponent. Below the exponent of the last level it is interpolated towards the
    /// irradiance (exponent 0).
    Vec3f phong(const Vec3f& direction, float exponent) const override;
    Vec3f irradiance_over_pi(const Vec3f& normal) const override;
    Vec3f irradiance_over_pi_sh(const Vec3f& normal) const override;
    ScaleBias brdf(float NdotV, float roughness) const override;

  private:
    struct Impl;
    LightMaps();
    std::unique_ptr<Impl> impl_;
};

/// How a shader turns the maps into reflected light.
enum class ShadingModel {
    split_sum,  ///< Karis 2013: prefiltered environment times BRDF table, plus diffuse light from the irradiance
    stretched,  ///< the same with nine lookups instead of one, so that reflections stretch at grazing angles
    phong,      ///< two maps prefiltered with the modified Phong BRDF (n = v = r for the specular one)
    mirror,     ///< reflection mapping: the sharp environment in the mirror direction
    refract,    ///< refraction mapping: Snell's law at the front surface, mixed with the reflection by the Fresnel term
};
template <>
struct EnumNames<ShadingModel> {
    static constexpr const char* kind = "a model of shading";
    static constexpr NamedValue<ShadingModel> table[] = {
        {ShadingModel::split_sum, "split-sum"}, {ShadingModel::stretched, "stretched"}, {ShadingModel::phong, "phong"},
        {ShadingModel::mirror, "mirror"},       {ShadingModel::refract, "refract"},
    };
};

/// The texture that reflection and refraction mapping look up.
enum class MapLookup {
    environment,      ///< no texture: the environment as it was read
    cube,             ///< size: of a face
    latlong,          ///< size: its height
    sphere_map,       ///< OpenGL's, centre +Z: size of the square; -Z covers the whole rim
    dual_paraboloid,  ///< Heidrich and Seidel 1998, about +Z and -Z: size of each square
};
template <>
struct EnumNames<MapLookup> {
    static constexpr const char* kind = "a lookup";
    static constexpr NamedValue<MapLookup> table[] = {
        {MapLookup::environment, "environment"},
        {MapLookup::cube, "cube"},
        {MapLookup::latlong, "latlong"},
        {MapLookup::sphere_map, "sphere-map"},
        {MapLookup::dual_paraboloid, "dual-paraboloid"},
    };
};

/// The factor, for each channel, by which the diffuse layer of a metallic-roughness surface is multiplied; the layer's
/// albedo already holds the factor 1 - metalness. F0 is the mix of 0.04 (or of the F0 of the index of refraction) and
/// the base colour.
enum class DiffuseWeight {
    /// 1 - (F0 scale + F90 bias), minus the multiple scattering if that is on: the energy that the specular layer does
    /// not reflect. A white surface then reflects uniform light unchanged.
    energy,
    /// 1 - F(NdotV), the simpler form of many shaders. A white plastic under uniform light of radiance 1 then reflects
    /// only 0.28 at roughness 1 and NdotV = 0.05.
    fresnel,
};
template <>
struct EnumNames<DiffuseWeight> {
    static constexpr const char* kind = "a weight";
    static constexpr NamedValue<DiffuseWeight> table[] = {
        {DiffuseWeight::energy, "energy"},
        {DiffuseWeight::fresnel, "fresnel"},
    };
};

struct ShadingOptions {
    ShadingModel model = ShadingModel::split_sum;
    MapLookup lookup = MapLookup::environment;  ///< mirror and refract: the texture they read
    int lookup_size = 512;                      ///< its size in texels, 1 .. 8192
    bool sh_irradiance = false;                 ///< nine harmonics instead of the irradiance cube
    bool bent_lookup =
        false;  ///< the lookup is moved from the mirror direction towards the normal (Lagarde and de Rousiers 2014,
                ///< 4.9.3)
    bool multiple_scattering = false;  ///< Fdez-Aguera 2019
    DiffuseWeight diffuse_weight = DiffuseWeight::energy;
    bool occlusion = true;  ///< occlusion textures, with specular occlusion (Lagarde and de Rousiers 2014, 4.10.2)
};

/// Features of the scene's materials that a model does not support, as warnings. Empty for mirror and refract, which
/// ignore most of a material.
std::vector<std::string> not_rendered(const Scene& scene, ShadingModel model);
/// The lobe of the specular chain that a model needs.
Lobe shading_lobe(ShadingModel model);

/// Draws the scene with a shading model: the same camera, samples and layers (radiance, opacity, diffuse, specular,
/// albedo, normal, depth, object) as render_reference. No shadows: compare with RenderOptions::occlusion = false.
/// `environment` is used for the background, and by mirror and refract. The scene's lights and
/// RenderOptions::environment_lights are added with the material's BRDF; mirror and refract show each as a narrow
/// highlight. Errors: maps of another lobe than the model's; "cancelled".
Result<RenderResult> render_shaded(const RayScene& scene, const LightMaps& maps, const EnvironmentSampler& environment,
                                   const ShadingOptions& shading, const RenderOptions& options);

/// The same, lit at each point by the probes around it, with split-sum, stretched or phong (by the lobe of GGX that
/// matches each exponent); `environment` is the background alone. What probes have captured, they light: windows, glowing
/// surfaces, light that is reflected between walls. The scene's lights and RenderOptions::environment_lights, which no
/// probe sees directly, cast shadows unless RenderOptions::occlusion is false. Errors: mirror or refract; "cancelled".
Result<RenderResult> render_shaded(const RayScene& scene, const ProbeBlender& probes,
                                   const EnvironmentSampler& environment, const ShadingOptions& shading,
                                   const RenderOptions& options);

}  // namespace domelight
