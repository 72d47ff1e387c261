#include "cli/console/environment_options.h"

#include "domelight/environment/sky/sky.h"
#include "domelight/io/environment/open_environment.h"
#include "domelight/projection/projections.h"

#include "cli/console/suggestion.h"
#include "io/environment/cube_face_names.h"
#include "io/environment/environment_files.h"
#include "projection/latlong_convention.h"

#include <algorithm>
#include <cmath>

namespace domelight::cli {
namespace {

/// Another source's rows times a factor: --exposure for the built-in sky.
class ScaledRows : public RowSource {
  public:
    ScaledRows(std::unique_ptr<RowSource> source, float factor) : source_(std::move(source)), factor_(factor) {}
    int width() const override { return source_->width(); }
    int height() const override { return source_->height(); }
    Result<void> read(ImageView<float> rows) override {
        auto ok = source_->read(rows);
        for (int y = 0; ok && y < rows.height; ++y)
            for (int i = 0; i < rows.width * rows.channels; ++i) rows.row(y)[i] *= factor_;
        return ok;
    }

  private:
    std::unique_ptr<RowSource> source_;
    float factor_;
};

Result<Environment> built_in_sky(const EnvironmentOptions& options) {
    const EnvironmentOptions none;
    const auto refuse = [](const char* option) {
        return Error{"says how to read a file, but no environment is given", option,
                     "Without one the built-in sky is used."};
    };
    if (options.projection != none.projection) return refuse("--projection");
    if (options.latlong != none.latlong) return refuse("--latlong");
    if (options.layer != none.layer) return refuse("--layer");
    if (options.faces != none.faces) return refuse("--faces");
    if (options.face_orientation) return refuse("--face-orientation");
    if (options.decode != none.decode) return refuse("--decode");
    if (options.up != none.up) return refuse("--up");
    if (options.negatives != none.negatives) return refuse("--negatives");
    if (!std::isfinite(options.rotate_y_deg)) return Error{"angle is not a number", "--rotate-y-deg", ""};
    if (!(std::abs(options.exposure) <= 64))
        return Error{"exposure must lie between -64 and 64 stops", "--exposure", ""};
    // A sun of true radiance, 1e7 W/(m^2 sr), is far beyond half floats: eight stops down it fits.
    constexpr double built_in_exposure = -8;
    const float scale = float(std::exp2(options.exposure + built_in_exposure));
    const auto open = [scale](std::shared_ptr<RepairReport>) -> Result<std::unique_ptr<RowSource>> {
        return std::unique_ptr<RowSource>(std::make_unique<ScaledRows>(make_sky(SkyOptions{}), scale));
    };
    const int height = SkyOptions{}.height;
    Environment sky = Environment::from_rows(2 * height, height, open);
    sky.format = "sky";
    sky.world_to_source = rotation_y(options.rotate_y_deg * k_pi / 180).transposed();
    return sky;
}

}  // namespace

std::string projection_list(const std::map<std::string, std::string>& remarks) {
    std::string list;
    for (const ProjectionInfo& info : projections()) {
        list += (list.empty() ? "" : ", ") + std::string(info.name);
        if (const auto remark = remarks.find(info.name); remark != remarks.end()) list += remark->second;
        if (std::string_view(info.name) == "mirror-ball") list += "/fov=DEGREES";
    }
    return list;
}

void add_environment_options(Arguments& arguments, EnvironmentOptions& options) {
    arguments.group("Reading the environment");
    arguments.text(
        "--projection", "NAME", options.projection,
        "the projection of the image: " +
            projection_list(
                {{"latlong", " (also latlong/usd ...)"}, {"cube", ", cube-cross, cube-strip, cube-faces"}}) +
            "; if the image does not show the default axes, append those at its centre, right and top, for example "
            "/centre=+Z,right=+X,up=+Y (auto: latlong or a cube, by the image's shape and attributes)");
    arguments.text(
        "--latlong", "NAME", options.latlong,
        "lat-long convention: " + join(latlong_convention_names(), ", ") + k_other_conventions +
            "; pbrt is the same as --projection equal-area-octahedral (the one that the file states, otherwise "
            "default)");
    arguments.text("--layer", "NAME", options.layer,
                   "OpenEXR: the layer, the channel, or the part (its name, or its number from 0) to read (the unnamed "
                   "layer; else rgba, beauty or Combined, after any prefix; else the only one with a colour)");
    arguments.text(
        "--faces", "ORDER", options.faces,
        "the faces that six files, or the pictures of a strip, show one after the other, where their names do "
        "not say it: px,nx,py,ny,pz,nz or right,left,up,down,front,back ... in any order");
    arguments.choice("--face-orientation", options.face_orientation,
                     "how the faces of a cube lie: opengl (right is +X, front +Z), directx (front is -Z: what a viewer "
                     "sees around him), openexr (what the files state or show, otherwise opengl)");
    arguments.choice(
        "--decode", options.decode,
        "how values of 8 bits are decoded in PNG and JPEG files and in textures; rgbm, rgbd and rgbp are for textures "
        "only (auto: as the file says, otherwise srgb)");
    arguments.choice("--negatives", options.negatives,
                     "what becomes of negative values, which lossy compression leaves beside bright lights: balance: 0, "
                     "and the light that this adds is taken from the texels round it; clamp: 0; keep: as they are, for "
                     "convert, info and bake (balance)");
    arguments.number("--rotate-y-deg", "DEGREES", options.rotate_y_deg,
                     "turn the light about +Y: +X moves towards +Z (0)");
    arguments.text("--up", "AXIS", options.up, "the axis at the top of the image: +Y, +Z, ... (+Y)");
    arguments.number("--exposure", "STOPS", options.exposure, "multiply radiance by 2^STOPS, -64 to 64 (0)");
}

bool is_one_environment(const std::vector<std::string>& arguments, const EnvironmentOptions& options) {
    return arguments.size() <= 1 || options.projection == "cube-faces" || !options.faces.empty() ||
           are_cube_faces({arguments.begin(), arguments.end()});
}

Result<void> check_one_environment(const std::vector<std::string>& arguments, const EnvironmentOptions& options) {
    if (is_one_environment(arguments, options)) return {};
    return Error{"the command takes one environment at a time, or the six faces of a cube", "",
                 "Name them one at a time. Six faces of other names: --faces says their order."};
}

std::vector<std::filesystem::path> environment_files(const std::vector<std::string>& arguments,
                                                     const EnvironmentOptions& options) {
    return domelight::environment_files({arguments.begin(), arguments.end()}, options);
}

Result<Environment> open_light_to_draw_from(const std::vector<std::string>& arguments,
                                            const EnvironmentOptions& options) {
    if (options.negatives == Negatives::keep)
        return Error{"light is drawn in proportion to radiance, which must not be negative", "--negatives",
                     "Accepted here: balance, clamp."};
    return open_environment_or_sky(arguments, options);
}

Result<Environment> open_environment_or_sky(const std::vector<std::string>& arguments,
                                            const EnvironmentOptions& options) {
    if (arguments.empty()) return built_in_sky(options);
    auto environment = open_environment({arguments.begin(), arguments.end()}, options);
    if (environment) return environment;
    Error error = environment.error();
    std::vector<std::string> names = latlong_convention_names();
    names.emplace_back("pbrt");
    if (error.where == "`latlong`" && !std::ranges::count(names, options.latlong))
        error.hint = did_you_mean(options.latlong, names) + error.hint;
    return error;
}

}  // namespace domelight::cli
