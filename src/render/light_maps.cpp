#include "domelight/brdf_table.h"
#include "domelight/prefilter.h"
#include "domelight/projection.h"
#include "domelight/shading.h"
#include "domelight/texture.h"

#include "image/bordered_cube.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

namespace domelight {

struct LightMaps::Impl {
    std::vector<BorderedCube> specular;
    std::vector<float> roughness;  ///< of each level, rising
    std::vector<BorderedCube> irradiance_over_pi;
    std::vector<Vec3d> sh_irradiance;
    ImageF brdf;
};

LightMaps::LightMaps() : impl_(std::make_unique<Impl>()) {}
LightMaps::~LightMaps() = default;
LightMaps::LightMaps(LightMaps&&) noexcept = default;
LightMaps& LightMaps::operator=(LightMaps&&) noexcept = default;

namespace {

/// Bilinear, on across the edges.
Vec3f look_up(const BorderedCube& cube, const Vec3f& direction) {
    const CubePoint p = cube_point(Vec3d(direction));
    const int n = cube.size();
    const float x = float(p.uv.u * n) - 0.5f, y = float(p.uv.v * n) - 0.5f;
    const int i = std::clamp(int(std::floor(x)), -1, n - 1), j = std::clamp(int(std::floor(y)), -1, n - 1);
    const float s = x - float(i), t = y - float(j);
    const float *a = cube.texel(p.face, i, j), *b = cube.texel(p.face, i + 1, j), *c = cube.texel(p.face, i, j + 1),
                *d = cube.texel(p.face, i + 1, j + 1);
    const auto mix = [&](int k) {
        const float upper = a[k] + s * (b[k] - a[k]), lower = c[k] + s * (d[k] - c[k]);
        return upper + t * (lower - upper);
    };
    return {mix(0), mix(1), mix(2)};
}

Result<nlohmann::json> read_json(const std::filesystem::path& file) {
    std::ifstream in(file);
    if (!in)
        return Error{"cannot be read", file.string(),
                     "The folder must be one that `domelight bake` wrote for the generic target."};
    auto json = nlohmann::json::parse(in, nullptr, false);
    if (json.is_discarded()) return Error{"is no JSON", file.string(), ""};
    return json;
}

Result<std::vector<Cubemap>> read_cubes(const std::filesystem::path& file) {
    auto texture = read_texture(file);
    if (!texture) return texture.error();
    auto levels = decode_cubes(*texture);
    if (!levels) return levels.error().at(file.string());
    return levels;
}

}  // namespace

Result<LightMaps> LightMaps::load(const std::filesystem::path& folder) {
    LightMaps maps;
    Impl& impl = *maps.impl_;
    const auto manifest = read_json(folder / "manifest.json");
    if (!manifest) return manifest.error();
    const auto specular = read_cubes(folder / "specular.ktx2");
    if (!specular) return specular.error();
    const auto irradiance = read_cubes(folder / "irradiance.ktx2");
    if (!irradiance) return irradiance.error();
    auto brdf = read_texture(folder / "brdf.ktx2");
    if (!brdf) return brdf.error();

    const std::string name = (folder / "manifest.json").string();
    const auto levels = manifest->value("specular", nlohmann::json::object()).value("levels", nlohmann::json::array());
    if (levels.size() != specular->size())
        return Error{fmt::format("tells of {} specular levels, specular.ktx2 has {}", levels.size(), specular->size()),
                     name, ""};
    for (const auto& level : levels) impl.roughness.push_back(level.is_object() ? level.value("roughness", 0.f) : 0);
    if (!std::ranges::is_sorted(impl.roughness))
        return Error{"has roughness values that do not rise from level to level", name, ""};
    for (const Cubemap& c : *specular) impl.specular.emplace_back(c);

    // The generic target stores irradiance E, others E / pi.
    const bool over_pi =
        manifest->value("irradiance", nlohmann::json::object()).value("quantity", "irradiance") == "irradiance_over_pi";
    Cubemap e = irradiance->front();
    if (!over_pi)
        for (float& p : e.pixels()) p /= float(k_pi);
    impl.irradiance_over_pi.emplace_back(e);
    impl.brdf = decode_texture(*brdf, 0, 0);

    const auto sh = read_json(folder / "sh.json");
    if (!sh) return sh.error();
    const auto coefficients = sh->value("radiance", nlohmann::json::array());
    std::vector<Vec3d> radiance;
    for (const auto& c : coefficients)
        if (c.is_array() && c.size() == 3 && c[0].is_number())
            radiance.push_back({c[0].get<double>(), c[1].get<double>(), c[2].get<double>()});
    if (radiance.empty()) return Error{"has no coefficients", (folder / "sh.json").string(), ""};
    if (radiance.size() > 9) radiance.resize(9);
    impl.sh_irradiance = sh_irradiance_over_pi(radiance);
    return maps;
}

Result<LightMaps> LightMaps::bake(ImageView<const float> latlong, const Mat3& world_to_source, int threads) {
    FilterOptions options;
    constexpr int levels = 7, size = 512;
    for (int l = 0; l < levels; ++l)
        options.specular.push_back({size >> l, l == 0, ZonalKernel::ggx(double(l) / (levels - 1))});
    options.irradiance_size = 64;
    options.sh_bands = 3;
    options.world_to_source = world_to_source;
    options.threads = threads;
    ImageRowSource rows(latlong);
    auto filtered = prefilter(rows, options);
    if (!filtered) return filtered.error();
    LightMaps maps;
    for (int l = 0; l < levels; ++l) {
        maps.impl_->specular.emplace_back(filtered->specular[l].cube);
        maps.impl_->roughness.push_back(float(l) / (levels - 1));
    }
    maps.impl_->irradiance_over_pi.emplace_back(filtered->irradiance_over_pi.cube);
    maps.impl_->sh_irradiance = sh_irradiance_over_pi(filtered->sh);
    maps.impl_->brdf = brdf_table_default();
    return maps;
}

Vec3f LightMaps::specular(const Vec3f& direction, float roughness) const {
    const auto& r = impl_->roughness;
    const auto above = std::upper_bound(r.begin(), r.end(), roughness);
    if (above == r.begin()) return look_up(impl_->specular.front(), direction);
    if (above == r.end()) return look_up(impl_->specular.back(), direction);
    const std::size_t i = std::size_t(above - r.begin());
    const float t = (roughness - r[i - 1]) / (r[i] - r[i - 1]);
    const Vec3f low = look_up(impl_->specular[i - 1], direction);
    return t > 0 ? low + (look_up(impl_->specular[i], direction) - low) * t : low;
}

Vec3f LightMaps::irradiance_over_pi(const Vec3f& normal) const {
    return look_up(impl_->irradiance_over_pi.front(), normal);
}

Vec3f LightMaps::irradiance_over_pi_sh(const Vec3f& normal) const {
    const Vec3d e = sh_evaluate(impl_->sh_irradiance, normalize(Vec3d(normal)));
    return Vec3f(Vec3d{std::max(0.0, e.x), std::max(0.0, e.y), std::max(0.0, e.z)});
}

LightMaps::ScaleBias LightMaps::brdf(float NdotV, float roughness) const {
    const ImageF& t = impl_->brdf;
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

}  // namespace domelight
