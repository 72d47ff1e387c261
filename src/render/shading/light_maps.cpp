#include "domelight/engines/engine.h"
#include "domelight/filtering/brdf/brdf_table.h"
#include "domelight/filtering/prefilter.h"
#include "domelight/projection/projection.h"
#include "domelight/render/shading/shading.h"
#include "domelight/texture/texture.h"

#include "engines/chain.h"
#include "io/file/json.h"
#include "projection/bilinear.h"
#include "render/shading/shading_models.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace domelight {

struct LightMaps::Impl {
    Lobe lobe = Lobe::ggx;
    std::vector<BorderedCube> specular;
    std::vector<float> roughness;  ///< of each level, rising; for a Phong chain the roughness that corresponds to the
                                   ///< exponent
    bool geometric = false;        ///< between levels with roughness above 0: linear in its logarithm, as generic's
                                   ///< shader reads; otherwise linear in the roughness
    std::vector<BorderedCube> irradiance_over_pi;
    std::vector<Vec3d> sh_irradiance;
    ImageF brdf;
};

LightMaps::LightMaps() : impl_(std::make_unique<Impl>()) {}
LightMaps::~LightMaps() = default;
LightMaps::LightMaps(LightMaps&&) noexcept = default;
LightMaps& LightMaps::operator=(LightMaps&&) noexcept = default;

namespace {

Result<Lobe> lobe_of(const std::string& name) {
    if (const auto lobe = from_name<Lobe>(name); lobe && *lobe != Lobe::charlie) return *lobe;
    return Error{fmt::format("describes a chain of lobe \"{}\"", name), "", "Bake with `lobe` ggx or phong."};
}

float level_roughness(const Json& level, Lobe lobe) {
    const char* key = lobe == Lobe::ggx ? "roughness" : "exponent";
    if (!level.is_object() || !level.contains(key) || !level[key].is_number()) return 0;  // "inf": the environment
    const double value = level[key].get<double>();
    return lobe == Lobe::ggx ? float(value) : matching_roughness(std::max(0.0, value));
}

Result<Json> read_json(const std::filesystem::path& file) {
    auto json = Json::read(file);
    if (!json)
        return Error{json.error().what, file.string(),
                     "The folder must be one that `domelight bake` wrote for the generic engine."};
    return json;
}

Result<std::vector<Cubemap>> read_cubes(const std::filesystem::path& file) {
    auto texture = read_texture(file);
    if (!texture) return texture.error();
    auto levels = decode_cubes(*texture);
    if (!levels) return levels.error().at(file.string());
    return levels;
}

/// The files of other engines have other names, and some are mirrored.
Result<void> check_generic(const Json& manifest, const std::filesystem::path& folder) {
    const Json& file = manifest["specular"]["file"];
    if (file == Json("specular.ktx2")) return {};
    const Json& engine = manifest["engine"]["name"];
    return Error{fmt::format("is a bake for {}{}, and only the KTX2 files for generic are read here",
                             engine.is_string() ? engine.get<std::string>() : "another engine",
                             file.is_string() ? fmt::format(" with the map {}", file.get<std::string>()) : ""),
                 folder.string(), "Bake for generic, which is what `domelight bake` does unless told otherwise."};
}

}  // namespace

float matching_roughness(double exponent) {
    return float(std::pow(2 / (exponent + 2), 0.25));
}

LightAt::ScaleBias look_up_brdf(const ImageF& t, float NdotV, float roughness) {
    const float x = std::clamp(NdotV * float(t.width()) - 0.5f, 0.f, float(t.width() - 1)),
                y = std::clamp(roughness * float(t.height()) - 0.5f, 0.f, float(t.height() - 1));
    const int i = int(x), j = int(y), i1 = std::min(i + 1, t.width() - 1), j1 = std::min(j + 1, t.height() - 1);
    const float a = x - float(i), b = y - float(j);
    const auto channel = [&](int c) {
        const float upper = t.at(i, j)[c] + a * (t.at(i1, j)[c] - t.at(i, j)[c]),
                    lower = t.at(i, j1)[c] + a * (t.at(i1, j1)[c] - t.at(i, j1)[c]);
        return upper + b * (lower - upper);
    };
    return {channel(0), channel(1)};
}

Result<LightMaps> LightMaps::load(const std::filesystem::path& folder) {
    LightMaps maps;
    Impl& impl = *maps.impl_;
    const auto manifest = read_json(folder / "manifest.json");
    if (!manifest) return manifest.error();
    if (auto ok = check_generic(*manifest, folder); !ok) return ok.error();
    const auto specular = read_cubes(folder / "specular.ktx2");
    if (!specular) return specular.error();
    const auto irradiance = read_cubes(folder / "irradiance.ktx2");
    if (!irradiance) return irradiance.error();
    auto brdf = read_texture(folder / "brdf.ktx2");
    if (!brdf) return brdf.error();

    const std::string name = (folder / "manifest.json").string();
    const Json& chain = std::as_const(*manifest)["specular"];
    const Json& levels = chain["levels"];
    if (levels.size() != specular->size())
        return Error{
            fmt::format("describes {} specular levels, but specular.ktx2 has {}", levels.size(), specular->size()),
            name, ""};
    const auto lobe = lobe_of(chain["lobe"].is_string() ? chain["lobe"].get<std::string>() : name_of(Lobe::ggx));
    if (!lobe) return lobe.error().at(name);
    impl.lobe = *lobe;
    for (const Json& level : levels.elements()) impl.roughness.push_back(level_roughness(level, impl.lobe));
    if (!std::ranges::is_sorted(impl.roughness))
        return Error{fmt::format("has {} that do not {} from level to level",
                                 impl.lobe == Lobe::ggx ? "roughness values" : "exponents",
                                 impl.lobe == Lobe::ggx ? "rise" : "fall"),
                     name, ""};
    for (const Cubemap& c : *specular) impl.specular.emplace_back(c);
    const std::vector<double> roughness(impl.roughness.begin(), impl.roughness.end());
    impl.geometric =
        impl.lobe == Lobe::ggx && engine_with_curve(roughness, specular->front().size()) == &engines().front();

    // The generic engine stores irradiance E, others E / pi.
    const bool over_pi =
        std::as_const(*manifest)["irradiance"]["quantity"] == Json(name_of(Quantity::irradiance_over_pi));
    Cubemap e = irradiance->front();
    if (!over_pi)
        for (float& p : e.pixels()) p /= float(k_pi);
    impl.irradiance_over_pi.emplace_back(e);
    impl.brdf = decode_texture(*brdf, 0, 0);

    const auto sh = read_json(folder / "sh.json");
    if (!sh) return sh.error();
    const Json& coefficients = std::as_const(*sh)["radiance"];
    std::vector<Vec3d> radiance;
    for (const Json& c : coefficients.elements())
        if (c.size() == 3 && std::ranges::all_of(c.elements(), &Json::is_number))
            radiance.push_back(
                {c.elements()[0].get<double>(), c.elements()[1].get<double>(), c.elements()[2].get<double>()});
    if (radiance.empty()) return Error{"has no coefficients", (folder / "sh.json").string(), ""};
    if (radiance.size() > 9) radiance.resize(9);
    impl.sh_irradiance = sh_irradiance_over_pi(radiance);
    return maps;
}

Result<LightMaps> LightMaps::bake(ImageView<const float> latlong, const Mat3& world_to_source, int threads, Lobe lobe) {
    const Engine& engine = engines().front();  // generic
    LightMaps maps;
    maps.impl_->lobe = lobe;
    maps.impl_->geometric = !is_phong(lobe);
    FilterOptions options;
    for (const LevelPlan& level : default_chain(engine, lobe)) {
        options.specular.push_back(level.spec);
        maps.impl_->roughness.push_back(is_phong(lobe) ? matching_roughness(level.exponent) : float(level.roughness));
    }
    options.texels = Texels::read;
    options.irradiance_size = engine.irradiance_size;
    options.sh_bands = 3;
    options.world_to_source = world_to_source;
    options.threads = threads;
    ImageRowSource rows(latlong);
    auto filtered = prefilter(rows, options);
    if (!filtered) return filtered.error();
    for (FilteredMap& level : filtered->specular) maps.impl_->specular.emplace_back(std::move(level).cube());
    maps.impl_->irradiance_over_pi.emplace_back(filtered->irradiance_over_pi.cube());
    maps.impl_->sh_irradiance = sh_irradiance_over_pi(filtered->sh);
    maps.impl_->brdf = brdf_table_default();
    return maps;
}

Lobe LightMaps::lobe() const {
    return impl_->lobe;
}

Vec3f LightMaps::specular(const Vec3f& direction, float roughness) const {
    const auto& r = impl_->roughness;
    const auto above = std::upper_bound(r.begin(), r.end(), roughness);
    if (above == r.begin()) return look_up(impl_->specular.front(), direction);
    if (above == r.end()) return look_up(impl_->specular.back(), direction);
    const std::size_t i = std::size_t(above - r.begin());
    const float t = impl_->geometric && r[i - 1] > 0 ? std::log(roughness / r[i - 1]) / std::log(r[i] / r[i - 1])
                                                     : (roughness - r[i - 1]) / (r[i] - r[i - 1]);
    const Vec3f low = look_up(impl_->specular[i - 1], direction);
    return t > 0 ? low + (look_up(impl_->specular[i], direction) - low) * t : low;
}

Vec3f LightMaps::phong(const Vec3f& direction, float exponent) const {
    const float roughness = matching_roughness(exponent), last = impl_->roughness.back();
    const Vec3f light = specular(direction, roughness);
    // (n + 2) / 2 pi cos^(n + 1) at n = 0 is the cosine itself.
    if (roughness <= last || last >= 1) return light;
    return light + (irradiance_over_pi(direction) - light) * ((roughness - last) / (1 - last));
}

Vec3f LightMaps::irradiance_over_pi(const Vec3f& normal) const {
    return look_up(impl_->irradiance_over_pi.front(), normal);
}

Vec3f LightMaps::irradiance_over_pi_sh(const Vec3f& normal) const {
    const Vec3d e = sh_evaluate(impl_->sh_irradiance, normalize(Vec3d(normal)));
    return Vec3f(Vec3d{std::max(0.0, e.x), std::max(0.0, e.y), std::max(0.0, e.z)});
}

LightAt::ScaleBias LightMaps::brdf(float NdotV, float roughness) const {
    return look_up_brdf(impl_->brdf, NdotV, roughness);
}

}  // namespace domelight
