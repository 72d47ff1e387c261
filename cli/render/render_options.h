#pragma once

#include "domelight/io/environment/open_environment.h"
#include "domelight/render/render.h"
#include "domelight/render/shading/shading.h"

#include "cli/console/arguments.h"
#include "cli/console/console.h"
#include "preview/tonemap.h"

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace domelight::cli {

/// The word of --shading for path tracing.
inline constexpr const char* k_reference = "reference";

/// The command line of `render`.
struct RenderWords {
    CommonOptions common;
    std::vector<std::string> scenes, environment_files, light_files, outputs;
    EnvironmentOptions environment;
    std::optional<ShadingModel> shading;  ///< nothing: the reference
    LightStrategy strategy = LightStrategy::mis;
    MapLookup lookup = MapLookup::environment;
    DiffuseWeight diffuse_weight = DiffuseWeight::energy;
    Tonemap tonemap = Tonemap::agx;
    std::optional<Background> background;
    bool occlusion = true, sh_irradiance = false;
    std::string maps, probes, brdf = "scene";
    bool parallax = true, probe_visibility = true;
    std::optional<int> probe_blend;
    double probe_offset = 0;
    std::optional<int> width, height, spp, bounces, seed, lookup_size;
    std::vector<double> camera_position, camera_target;
    std::string camera;
    double fov_deg = 35, noise = 0, time = 0, save_every = 0, lux_per_unit = 683;
    double ev = std::numeric_limits<double>::quiet_NaN();
    bool multiple_scattering = false, bent_lookup = false;

    std::string background_color;
    double background_roughness = 0.35;
    bool shadow_catcher = false;

    std::optional<int> frames;
    double fps = 30;
    std::string turn = "camera";
    bool resume = false;

    bool study = false;

    // Set by check_words().
    Background backdrop = Background::environment;
    Vec3f backdrop_colour;  ///< linear

    int threads() const { return common.threads.value_or(0); }
    bool reference() const { return !shading; }
    std::string shading_name() const { return shading ? name_of(*shading) : k_reference; }
    std::string scene_name() const { return scenes.empty() ? "" : scenes.front(); }
    /// Whether --camera asks for a picture of every direction.
    Camera::Panorama panorama() const {
        return camera == "cube"      ? Camera::Panorama::cube
               : camera == "latlong" ? Camera::Panorama::latlong
                                     : Camera::Panorama::none;
    }
};

/// Checks the options and their combinations, splits the outputs at commas, and sets the background.
Result<void> check_words(RenderWords& words, const Arguments& arguments);

/// The camera that was asked for, and the size in pixels: a camera of the scene determines the height for a given
/// width. Errors: the scene has no such camera.
Result<RenderOptions> render_options(const RenderWords& words, const Scene& scene);

/// "1 \"front\", 2" for a message.
std::string camera_list(const Scene& scene);

/// "#rrggbb" (sRGB) or "R,G,B" (linear) as linear radiance.
Result<Vec3f> parse_colour(const std::string& text);

}  // namespace domelight::cli
