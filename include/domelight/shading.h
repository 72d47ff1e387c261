#pragma once
// What a real-time engine draws: a scene lit by the maps that `bake` writes, each model as its shader has it.

#include "domelight/render.h"
#include "domelight/spherical_harmonics.h"

#include <memory>
#include <optional>

namespace domelight {

/// The maps of a bake, as a shader binds them. Lookups are in world directions.
class LightMaps {
  public:
    /// Reads what `domelight bake -o DIR` wrote for the generic target: specular.ktx2, irradiance.ktx2, sh.json,
    /// brdf.ktx2, roughness by level from manifest.json. Errors name the file.
    static Result<LightMaps> load(const std::filesystem::path& folder);
    /// Bakes them in memory with the generic target's sizes.
    static Result<LightMaps> bake(ImageView<const float> latlong, const Mat3& world_to_source, int threads = 0);
    ~LightMaps();
    LightMaps(LightMaps&&) noexcept;
    LightMaps& operator=(LightMaps&&) noexcept;

    /// The prefiltered environment, between the two levels nearest in roughness; seamless across edges.
    Vec3f specular(const Vec3f& direction, float roughness) const;
    /// E / pi by the irradiance cube, or by the nine spherical-harmonic coefficients.
    Vec3f irradiance_over_pi(const Vec3f& normal) const;
    Vec3f irradiance_over_pi_sh(const Vec3f& normal) const;
    /// Scale and bias of the BRDF table, bilinear.
    struct ScaleBias {
        float scale, bias;
    };
    ScaleBias brdf(float NdotV, float roughness) const;

  private:
    struct Impl;
    LightMaps();
    std::unique_ptr<Impl> impl_;
};

enum class ShadingModel {
    split_sum,  ///< Karis 2013: prefiltered environment times BRDF table, and irradiance below
    phong,      ///< Blinn and Newell's prefiltered maps with the modified Phong BRDF (n = v = r for the specular one)
    mirror,     ///< reflection mapping: the sharp environment in the mirror direction
    refract,    ///< and refraction mapping: Snell's law at the front surface, mixed with the reflection by Fresnel
};
/// "split-sum", "phong", "mirror", "refract".
std::string shading_model_name(ShadingModel model);

struct ShadingOptions {
    ShadingModel model = ShadingModel::split_sum;
    bool sh_irradiance = false;  ///< nine coefficients instead of the irradiance cube
    bool bent_lookup =
        false;  ///< the lookup leans from the mirror direction to the normal (Lagarde and de Rousiers 2014, 4.9.3)
    bool multiple_scattering = false;  ///< Fdez-Aguera 2019
    bool occlusion = true;  ///< occlusion textures, with specular occlusion (Lagarde and de Rousiers 2014, 4.10.2)
};

/// What of a scene's materials a model does not know, for a warning; of mirror and refract, which know next to nothing
/// of materials, not said.
std::vector<std::string> not_rendered(const Scene& scene, ShadingModel model);

/// Draws with one of them: the same camera, samples and layers (radiance, opacity, diffuse, specular, albedo, normal,
/// depth, object) as render_reference. No shadows: compare with RenderOptions::occlusion = false. `environment` is the
/// background and what mirror and refract read.
Result<RenderResult> render_shaded(const RayScene& scene, const LightMaps& maps, const EnvironmentSampler& environment,
                                   const ShadingOptions& shading, const RenderOptions& options);

}  // namespace domelight
