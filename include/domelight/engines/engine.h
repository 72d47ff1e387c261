#pragma once

#include "domelight/base/names.h"
#include "domelight/base/result.h"
#include "domelight/base/vec.h"
#include "domelight/filtering/prefilter.h"
#include "domelight/filtering/quantity.h"
#include "domelight/texture/texture.h"

#include <span>
#include <string>
#include <vector>

namespace domelight {

/// The file a map is written to. exr and hdr hold one image a level; the others hold the whole chain. dds9 is DDS with
/// the header from before DX10; exr_mip a tiled OpenEXR with its levels and the envmap attribute. The last three belong
/// to one engine each: Babylon's .env, a glTF file with EXT_lights_image_based, PlayCanvas' atlas (a PNG).
enum class Container { ktx2, ktx1, dds, dds9, exr, exr_mip, hdr, env, gltf, playcanvas_atlas };
template <>
struct EnumNames<Container> {
    static constexpr const char* kind = "a format";
    static constexpr NamedValue<Container> table[] = {
        {Container::ktx2, "ktx2"}, {Container::ktx1, "ktx1"},
        {Container::dds, "dds"},   {Container::dds9, "dds9"},
        {Container::exr, "exr"},   {Container::exr_mip, "exr-mip"},
        {Container::hdr, "hdr"},   {Container::env, "env"},
        {Container::gltf, "gltf"}, {Container::playcanvas_atlas, "playcanvas-atlas"},
    };
};

/// The containers that suit any engine: all but those that belong to one.
std::span<const Container> containers_for_any_engine();
std::string container_extension(Container container);  ///< ".ktx2", ".ktx", ...

/// How an engine looks up the light that arrives from world direction d = (x, y, z).
enum class CubeMirror {
    none,     ///< it reads texture(cube, d)
    x,        ///< it reads texture(cube, (-x, y, z))
    z,        ///< it reads texture(cube, (x, y, -z))
    swap_yz,  ///< it reads texture(cube, (x, z, y))
};
std::string cube_mirror_direction(CubeMirror mirror);  ///< "d", "(-x, y, z)", ...
Mat3 cube_mirror_matrix(CubeMirror mirror);            ///< M, where the engine reads texture(cube, M d)

/// What a BRDF table's channels hold; brdf_table.h has the integrals.
enum class BrdfForm { none, scale_bias, multiscatter, scale_bias_charlie };
template <>
struct EnumNames<BrdfForm> {
    static constexpr const char* kind = "a form of BRDF table";
    static constexpr NamedValue<BrdfForm> table[] = {
        {BrdfForm::none, "none"},
        {BrdfForm::scale_bias, "scale-bias"},
        {BrdfForm::multiscatter, "multiscatter"},
        {BrdfForm::scale_bias_charlie, "scale-bias-charlie"},
    };
};

/// The roughness that a shader reads at a level in a chain of `levels` levels whose first has `size`^2 texels a face.
/// The level is a number from 0 to levels - 1: a baked level, or a place between two. The roughness rises with it.
using RoughnessCurve = double (*)(double level, int levels, int size);

/// One engine: what it loads and in which convention. In file names, {stem} stands for the environment's name, and
/// the container's extension is appended. An empty name means that the map is not written.
struct Engine {
    std::string name;   ///< "filament"
    std::string loads;  ///< one line for lists: the engine, and what is baked for it
    std::string note;   ///< a remark for the user: what the engine does itself, for example; may be empty

    int size = 512;    ///< face size of level 0; 0 (only with `environment_only`): the image is as fine as the source
    int smallest = 8;  ///< by default levels go down to this face size
    int smallest_phong = 0;  ///< the same for Phong lobes, whose exponents are fixed for each level; 0: `smallest`
    int fewest_levels = 1;   ///< by default at least these, where the size allows, even if the last is then smaller
    RoughnessCurve roughness = nullptr;
    std::string level_text;  ///< for manifests: the level that a shader reads for a roughness r; M is the last level
    Layout layout = Layout::cube;  ///< the default layout of the maps
    CubeMirror mirror = CubeMirror::none;
    /// Convention of lat-long maps, by its name (docs/conventions.md). One that differs from the default by quarter
    /// turns about +Y only moves texels; for any other one the maps are reprojected.
    std::string latlong = "default";
    Encoding encoding = Encoding::rgba16f;
    Container container = Container::ktx2;
    bool zstd = false;
    /// The engine filters by itself: only the environment is written, as one image of the projection `panorama`. A
    /// lat-long image has 4 size x 2 size texels, a square image of another projection 2 size x 2 size; if `size` is 0,
    /// the image is as fine as the source.
    bool environment_only = false;
    std::string panorama = "latlong";  ///< name and convention, as projections.h takes them

    std::string specular_file = "specular";
    std::string sheen_file;     ///< a second chain with Charlie's lobe
    std::string skybox_file;    ///< level 0 alone
    std::string panorama_file;  ///< the environment as one .exr beside the maps
    std::string irradiance_file = "irradiance";
    int irradiance_size = 64;
    Quantity irradiance_quantity = Quantity::irradiance;
    Encoding irradiance_encoding = Encoding::rgba16f;
    std::string brdf_file = "brdf";
    BrdfForm brdf_form = BrdfForm::scale_bias;
    int brdf_size = 128;
    std::string sh_text_file;  ///< Filament's nine numbers as text
    bool sh_metadata = false;  ///< the same in the specular file's key "sh"
};

/// All engines, `generic` first.
std::span<const Engine> engines();
/// The engine of that name. The error lists the names.
Result<const Engine*> find_engine(const std::string& name);

/// roughness = level / (levels - 1); 0 for a single level.
double linear_roughness(double level, int levels, int size);

/// The level from 0 to levels - 1 that an engine's shader reads for a roughness in [0, 1]: the inverse of
/// Engine::roughness, which must not be null. The least level where several have the roughness.
double level_of_roughness(const Engine& engine, double roughness, int levels, int size);

/// The first engine whose curve gives these roughnesses, one a level, in a chain whose level 0 has `size`^2 texels a
/// face; null where there is none.
const Engine* engine_with_curve(std::span<const double> roughness, int size);

/// The number of levels of an engine's cube chain from `size`^2 texels a face down to its smallest.
int default_levels(const Engine& engine, int size, Lobe lobe = Lobe::ggx);

/// The default Phong exponent n_s of a level >= 0, a continuous function of `level`:
///
// clang-format off
///   0        infinity: the environment itself
///   0 .. 1   2050 / level^4 - 2, which makes the roughness of the matching GGX lobe proportional to the level
///   1 .. 6   2048 / 4^(level - 1): a quarter for each level, because its texels are twice as wide
///   6 .. 7   2^(7 - level)
///   7 ..     1
// clang-format on
double default_phong_exponent(double level);
/// The level with this default exponent, for exponents from 1 to infinity; 7 for exponent 1.
double default_phong_level(double exponent);
/// The exponents of the levels 0 .. levels - 1.
std::vector<double> default_phong_exponents(int levels);

}  // namespace domelight
