#include "bake/plan.h"

#include "domelight/projection/projections.h"

#include "bake/panorama.h"
#include "bake/phong_gaps.h"
#include "base/field_place.h"
#include "texture/container/dds_formats.h"
#include "texture/container/scaled_bytes.h"

#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace domelight {
namespace {

constexpr int k_max_size = 16384;

/// The number of levels from `size` down to 1 by halving.
int most_levels(int size) {
    return std::bit_width(unsigned(size));
}

Error field_error(const char* field, std::string what, std::string hint = "") {
    return {std::move(what), field_place(field), std::move(hint)};
}

Result<void> check_values(const BakeOptions& o) {
    if (o.size && (*o.size < 1 || *o.size > k_max_size))
        return field_error("size", fmt::format("{} is not from 1 to {}", *o.size, k_max_size));
    for (const double r : o.roughness)
        if (!(r >= 0 && r <= 1)) return field_error("roughness", fmt::format("{} is not from 0 to 1", r));
    for (const double n : o.exponents)
        if (!(n >= 0))
            return field_error("exponents", fmt::format("{} is not 0 or more", n),
                               "inf stands for the environment itself.");
    if (!o.exponents.empty() && !(o.lobe && is_phong(*o.lobe)))
        return field_error("exponents", "belongs to `lobe` phong", "Roughness is given with `roughness`.");
    if (o.lobe && is_phong(*o.lobe) && !o.roughness.empty())
        return field_error("roughness", "does not apply to `lobe` phong",
                           "Give its exponents with `exponents` n0,n1,...");
    if (o.encoding && encoding_channels(*o.encoding) != 3)
        return field_error("encoding", name_of(*o.encoding) + " has no room for a colour",
                           "Accepted are rgba16f, rgba32f, rgb9e5, r11g11b10f, bc6h, uastc-hdr, astc4x4-hdr, "
                           "astc6x6-hdr, rgbm, rgbd, rgbp.");
    if (o.irradiance_size && (*o.irradiance_size < 1 || *o.irradiance_size > 4096))
        return field_error("irradiance_size", fmt::format("{} is not from 1 to 4096", *o.irradiance_size));
    if (o.brdf_size && (*o.brdf_size < 1 || *o.brdf_size > 4096))
        return field_error("brdf_size", fmt::format("{} is not from 1 to 4096", *o.brdf_size));
    if (o.sh_bands < 1 || o.sh_bands > 64)
        return field_error("sh_bands", fmt::format("{} is not from 1 to 64", o.sh_bands));
    if (o.points.count < 1 || o.points.count > (1 << 24))
        return field_error("points", fmt::format("{} is not from 1 to 2^24", o.points.count));
    for (const int steps : {o.riemann.phi_steps, o.riemann.theta_steps})
        if (steps < 1 || steps > 65536) return field_error("riemann", fmt::format("{} is not from 1 to 65536", steps));
    if (o.threads < 0 || o.threads > 1024)
        return field_error("threads", fmt::format("{} is not from 0 to 1024", o.threads));
    return {};
}

bool is_chain(Container container) {
    return container != Container::exr && container != Container::hdr;
}

bool is_openexr(Container container) {
    return container == Container::exr || container == Container::exr_mip;
}

/// The number of levels that a lat-long map of a height can have in one texture. The width is twice the height only
/// while the height can be halved: below 130 x 65 a texture has 65 x 32, which is not the shape of a lat-long map.
int most_texture_levels(int height) {
    int levels = 1;
    for (; height % 2 == 0; height /= 2) ++levels;
    return levels;
}

/// Containers that only one engine has, with fixed contents.
bool own_container(Container container) {
    return container == Container::env || container == Container::gltf || container == Container::playcanvas_atlas;
}

/// Number of levels from the options, or from the engine's smallest size. `chain`: they go into one texture.
Result<int> level_count(const Engine& engine, const BakeOptions& o, int size, Layout layout, bool chain) {
    const Lobe lobe = o.lobe.value_or(Lobe::ggx);
    const std::size_t listed = std::max(o.roughness.size(), o.exponents.size());
    const char* list = o.exponents.empty() ? "roughness" : "exponents";
    if (listed && o.levels && std::size_t(*o.levels) != listed)
        return field_error("levels", fmt::format("{} levels, but `{}` names {}", *o.levels, list, listed));
    const int most = layout == Layout::latlong && chain ? most_texture_levels(size) : most_levels(size);
    const int levels = listed ? int(listed) : o.levels ? *o.levels : std::min(most, default_levels(engine, size, lobe));
    if (levels < 1 || levels > most_levels(size))
        return field_error(listed ? list : "levels", fmt::format("{} levels, but a map of size {} has from 1 to {}",
                                                                 levels, size, most_levels(size)));
    if (levels > most)
        return field_error(
            "size",
            fmt::format("a lat-long map of height {} halves exactly {} times, not {}", size, most - 1, levels - 1),
            fmt::format("Use a multiple of {}, or `format` exr.", 1 << (levels - 1)));
    return levels;
}

Result<void> plan_encoding(EnginePlan& plan, const BakeOptions& o) {
    const Engine& engine = *plan.engine;
    plan.container = o.format.value_or(engine.container);
    // An engine's encoding belongs to its container: with another container the default is half floats.
    plan.encoding = o.encoding.value_or(plan.container == engine.container ? engine.encoding : Encoding::rgba16f);
    plan.zstd = o.zstd.value_or(plan.container == Container::ktx2 && engine.zstd);
    if (plan.zstd && plan.container != Container::ktx2)
        return field_error("zstd", name_of(plan.container) + " has no supercompression", "Use `format` ktx2.");
    if (is_openexr(plan.container) && plan.encoding != Encoding::rgba16f && plan.encoding != Encoding::rgba32f)
        return field_error("encoding", name_of(plan.encoding) + " cannot be stored as " + name_of(plan.container),
                           "It holds rgba16f (half) and rgba32f (float).");
    if (plan.container == Container::dds9 && plan.encoding != Encoding::rgba16f && plan.encoding != Encoding::rgba32f &&
        !is_scaled_bytes(plan.encoding))
        return field_error("encoding", name_of(plan.encoding) + " does not exist in DDS headers from before DX10",
                           "dds9 holds rgba16f, rgba32f, and as bytes rgbm, rgbd and rgbp.");
    if (own_container(plan.container) && plan.encoding != engine.encoding)
        return field_error("encoding",
                           fmt::format("{} holds {} only", name_of(plan.container), name_of(engine.encoding)),
                           "Leave `encoding` out, or choose a `format`.");
    if (plan.container == Container::dds && is_scaled_bytes(plan.encoding))
        return field_error("encoding", "dds cannot say that its bytes are " + name_of(plan.encoding),
                           "Use `format` ktx2 or ktx1, where a key says so.");
    if (plan.container == Container::dds && dxgi_number(plan.encoding) == 0)
        return field_error("encoding", name_of(plan.encoding) + " cannot be stored as dds",
                           "DDS holds rgba16f, rgba32f, rgb9e5, r11g11b10f and bc6h; for others use `format` ktx2.");
    if (plan.container == Container::hdr && o.encoding)
        return field_error("encoding", "hdr has only its own encoding (RGBE)", "Leave `encoding` out.");
    return {};
}

/// Height of a lat-long image where the source's own is not known yet. Nothing that a plan checks depends on it.
constexpr int k_unknown_height = 1024;

/// The projection that a lat-long convention names: "latlong/usd".
Result<std::string> latlong_projection(const std::string& convention) {
    const std::size_t slash = convention.find('/');
    const std::string before = convention.substr(0, slash);
    const bool prefixed = before == "latlong" || before == "equirectangular";
    std::string name = "latlong/" + (!prefixed                    ? convention
                                     : slash == std::string::npos ? std::string("default")
                                                                  : convention.substr(slash + 1));
    if (const auto projection = projection_from_name(name); !projection)
        return projection.error().at(field_place("latlong_out"));
    return name;
}

/// The projection of the environment as one image.
std::string panorama_projection(const Engine& engine, const BakeOptions& o) {
    return o.latlong_out ? *latlong_projection(*o.latlong_out) : engine.panorama;
}

/// The environment as one image: `height` texels high, or as large as the source where no height is given.
PanoramaSpec plan_panorama(const std::string& projection, std::optional<int> height, const Environment* environment) {
    if (height) return panorama_spec(projection, *height);
    if (!environment) return panorama_spec(projection, k_unknown_height);
    const PanoramaSpec own = panorama_like(*environment, projection);
    return panorama_spec(projection, std::min(own.height, k_max_size));
}

Result<void> plan_environment_only(EnginePlan& plan, const BakeOptions& o, const Environment* environment) {
    const std::string& name = plan.engine->name;
    const auto refuse = [&](const char* field, const std::string& value = "") {
        return field_error(field, value + "does not apply to `engines` " + name,
                           name + " loads one lat-long image and filters it itself.");
    };
    if (o.levels && *o.levels != 1) return refuse("levels");
    if (!o.roughness.empty()) return refuse("roughness");
    if (o.lobe) return refuse("lobe");
    if (o.layout && *o.layout == Layout::cube) return refuse("layout", "cube ");
    plan.layout = Layout::latlong;
    std::optional<int> height = o.size;
    if (!height && plan.engine->size) height = 2 * plan.engine->size;
    plan.panorama = plan_panorama(panorama_projection(*plan.engine, o), height, environment);
    plan.size_of_source = !height;
    plan.specular = {glossy_level(Lobe::ggx, plan.panorama->height, 0)};
    return {};
}

/// The requirements of a container that only one engine has.
Result<void> check_own_container(const EnginePlan& plan, const BakeOptions& o) {
    if (!own_container(plan.container)) return {};
    const std::string name = name_of(plan.container);
    if (o.layout && *o.layout != plan.engine->layout)
        return field_error(
            "layout", fmt::format("{} holds {} maps", name, plan.engine->layout == Layout::cube ? "cube" : "lat-long"));
    const int size = plan.specular.front().spec.size;
    const bool atlas = plan.container == Container::playcanvas_atlas;
    if (atlas ? size != 512 : !std::has_single_bit(unsigned(size)))
        return field_error("size",
                           atlas ? "the atlas has one size: 512 rows of level 0"
                                 : fmt::format("{} holds cubes whose size is a power of two, not {}", name, size));
    const int levels = int(plan.specular.size()), all = most_levels(size);
    if (plan.container == Container::env && levels != all)
        return field_error("levels", fmt::format("a .env file of this size has {} levels, not {}", all, levels));
    if (atlas && levels != 7) return field_error("levels", fmt::format("the atlas has 7 levels, not {}", levels));
    if (atlas && plan.irradiance_size != 64) return field_error("irradiance_size", "the atlas has one size of it, 32");
    return {};
}

/// E or E / pi: the engine's, or the one that the options ask for.
Result<void> plan_irradiance(EnginePlan& plan, const BakeOptions& o) {
    const Engine& engine = *plan.engine;
    plan.irradiance_quantity = o.irradiance_quantity.value_or(engine.irradiance_quantity);
    if (!o.irradiance_quantity) return {};
    if (*o.irradiance_quantity == Quantity::radiance)
        return field_error("irradiance_quantity", "radiance is not irradiance or irradiance_over_pi");
    if (engine.irradiance_file.empty())
        return field_error("irradiance_quantity", "does not apply to `engines` " + engine.name,
                           "No map of irradiance is written for " + engine.name + ".");
    return {};
}

/// Quarter turns about +Y from the default lat-long convention to this one; nothing where texels do not only change
/// their columns.
std::optional<int> quarter_turns(const Projection& projection) {
    const Mat3 to_world = projection.world_to_picture().transposed();
    const Vec3d centre = to_world * Vec3d{0, 0, 1}, right = to_world * Vec3d{1, 0, 0}, up = to_world * Vec3d{0, 1, 0};
    if (projection.grid() != SampleGrid::centres || !(up == Vec3d{0, 1, 0}) || !(right == cross(centre, up)))
        return std::nullopt;
    return int(std::lround(std::atan2(centre.z, centre.x) * 2 / k_pi)) & 3;
}

/// The levels of the specular chain, and of the sheen's.
Result<void> plan_chain(EnginePlan& plan, const BakeOptions& o) {
    const Engine& engine = *plan.engine;
    plan.layout = o.layout.value_or(engine.layout);
    const int scale = plan.layout == Layout::latlong ? 2 : 1;  // a lat-long map is as fine as a cube of half its height
    const int size = o.size.value_or(scale * engine.size);
    const auto levels = level_count(engine, o, size, plan.layout, is_chain(plan.container));
    if (!levels) return levels.error();
    if (o.roughness.empty())
        plan.level_of = [&engine, count = *levels, size = size / scale](double roughness) {
            return level_of_roughness(engine, roughness, count, size);
        };
    const auto exponents = o.exponents.empty() ? default_phong_exponents(*levels) : o.exponents;
    for (int l = 0; l < *levels; ++l) {
        const int level_size = size >> l;
        const double roughness = o.roughness.empty() ? engine.roughness(l, *levels, size / scale) : o.roughness[l];
        plan.specular.push_back(is_phong(plan.lobe) ? phong_level(plan.lobe, level_size, exponents[l])
                                                    : glossy_level(plan.lobe, level_size, roughness));
        if (!engine.sheen_file.empty() && !o.lobe)
            plan.sheen.push_back(glossy_level(Lobe::charlie, level_size, roughness));
    }
    if (!engine.panorama_file.empty())
        plan.panorama = panorama_spec(panorama_projection(engine, o), 4 * plan.specular.front().spec.size / scale);
    return {};
}

/// Whether lat-long images in the convention that was asked for can be written for the engine.
Result<void> check_latlong_out(const EnginePlan& plan, const BakeOptions& o) {
    if (!o.latlong_out) return {};
    const Engine& engine = *plan.engine;
    const bool has_maps = plan.layout == Layout::latlong && !engine.environment_only;
    const bool has_panorama = engine.environment_only || !engine.panorama_file.empty();
    if (has_maps && own_container(plan.container))
        return field_error("latlong_out",
                           fmt::format("does not apply to `engines` {}: its file has a fixed convention, {}",
                                       engine.name, engine.latlong));
    if (has_maps || (has_panorama && projection_from_name(engine.panorama)->name() == "latlong")) return {};
    if (has_panorama)
        return field_error("latlong_out", fmt::format("does not apply to `engines` {}: its image is a fixed one, {}",
                                                      engine.name, projection_from_name(engine.panorama)->name()));
    return field_error("latlong_out",
                       fmt::format("does not apply to `engines` {}: no lat-long image is written", engine.name),
                       "Use `layout` latlong.");
}

/// The projection of the chain's files, and how the maps get there.
Result<void> plan_projection(EnginePlan& plan, const BakeOptions& o) {
    const Engine& engine = *plan.engine;
    if (auto ok = check_latlong_out(plan, o); !ok) return ok.error();
    if (engine.environment_only) return {};
    // The envmap attribute of these files says that samples lie as OpenEXR has them.
    const bool envmap = plan.container == Container::exr_mip;
    if (plan.layout == Layout::cube) {
        plan.order = TexelOrder::of_cube(cube_mirror_matrix(engine.mirror));
        plan.reprojected = envmap && engine.mirror == CubeMirror::none;
        if (plan.reprojected) plan.projection = "cube/openexr";
        return {};
    }
    plan.projection = o.latlong_out ? *latlong_projection(*o.latlong_out) : "latlong/" + engine.latlong;
    if (envmap && !o.latlong_out && engine.latlong == "default") plan.projection = "latlong/openexr";
    const auto quarters = quarter_turns(*projection_from_name(plan.projection));
    plan.reprojected = !quarters;
    if (!quarters) return {};
    plan.order = TexelOrder::of_latlong(*quarters);
    if (*quarters % 2 == 0) return {};
    for (const LevelPlan& level : plan.specular)
        if (level.spec.size % 2)
            return field_error("size",
                               fmt::format("a lat-long map {} high cannot be turned by a quarter: its "
                                           "width is not a multiple of 4",
                                           level.spec.size),
                               "Use a size and a number of levels that keep every height even.");
    return {};
}

/// What the texels of the chain hold.
Result<void> plan_texels(EnginePlan& plan, const BakeOptions& o) {
    const auto refuse = [&]() -> Result<void> {
        if (o.method != BakeMethod::exact) return field_error("texels", "read needs `method` exact");
        if (plan.engine->environment_only)
            return field_error("texels", "does not apply to `engines` " + plan.engine->name);
        if (plan.layout != Layout::cube) return field_error("texels", "read needs `layout` cube");
        if (plan.reprojected)
            return field_error("texels", "read does not apply to `format` exr-mip, whose samples lie on edges");
        return {};
    };
    const auto possible = refuse();
    plan.texels = o.texels.value_or(possible ? Texels::read : Texels::centre);
    return plan.texels == Texels::read ? possible : Result<void>();
}

/// Plans the bake for one engine, whose options have passed check_values().
Result<EnginePlan> plan_engine(const Engine& engine, const BakeOptions& o, const Environment* environment) {
    EnginePlan plan;
    plan.engine = &engine;
    plan.lobe = o.lobe.value_or(Lobe::ggx);
    plan.brdf_form = o.brdf_form.value_or(engine.brdf_form);
    plan.brdf_size = o.brdf_size.value_or(engine.brdf_size);
    if (auto ok = plan_encoding(plan, o); !ok) return ok.error();
    if (auto ok = plan_irradiance(plan, o); !ok) return ok.error();
    if (o.latlong_out)
        if (auto ok = latlong_projection(*o.latlong_out); !ok) return ok.error();
    if (auto ok = engine.environment_only ? plan_environment_only(plan, o, environment) : plan_chain(plan, o); !ok)
        return ok.error();
    if (is_phong(plan.lobe) && o.method == BakeMethod::exact) plan.gap_probes = phong_gap_probes(plan.specular);
    plan.irradiance_size =
        o.irradiance_size.value_or(engine.irradiance_size) * (plan.layout == Layout::latlong ? 2 : 1);
    if (const auto ok = check_own_container(plan, o); !ok) return ok.error();
    if (const auto ok = plan_projection(plan, o); !ok) return ok.error();
    if (const auto ok = plan_texels(plan, o); !ok) return ok.error();
    return plan;
}

}  // namespace

Result<std::vector<EnginePlan>> plan_bake(const BakeOptions& options, const Environment* environment) {
    if (options.engines.empty()) return field_error("engines", "no engine");
    std::vector<EnginePlan> plans;
    for (const std::string& name : options.engines) {
        const auto engine = find_engine(name);
        if (!engine) return engine.error().at(field_place("engines"));
        if (std::count(options.engines.begin(), options.engines.end(), name) > 1)
            return field_error("engines", name + " is given twice");
        if (auto ok = check_values(options); !ok) return ok.error();
        auto plan = plan_engine(**engine, options, environment);
        if (!plan) return plan.error();
        plans.push_back(*std::move(plan));
    }
    return plans;
}

Result<void> check_bake_options(const BakeOptions& options) {
    if (auto plans = plan_bake(options, nullptr); !plans) return plans.error();
    return {};
}

}  // namespace domelight
