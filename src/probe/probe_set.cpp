#include "domelight/filtering/harmonic/spherical_harmonics.h"

#include "base/field_place.h"
#include "probe/distance_lookup.h"
#include "probe/probe_set_builder.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace domelight {

ProbeSet::ProbeSet() : impl_(std::make_unique<Impl>()) {}
ProbeSet::~ProbeSet() = default;
ProbeSet::ProbeSet(ProbeSet&&) noexcept = default;
ProbeSet& ProbeSet::operator=(ProbeSet&&) noexcept = default;

namespace {

Result<void> check_grid(const ProbeGrid& grid, std::size_t probes) {
    if (grid.nx < 1 || grid.ny < 1 || grid.nz < 1 || std::int64_t(grid.nx) * grid.ny * grid.nz != std::int64_t(probes))
        return Error{fmt::format("of {} x {} x {} places, but there are {} probes", grid.nx, grid.ny, grid.nz, probes),
                     field_place("grid"), ""};
    for (const float s : {grid.spacing.x, grid.spacing.y, grid.spacing.z})
        if (!(s > 0) || !std::isfinite(s))
            return Error{fmt::format("has a spacing of {}, which is not above 0", s), field_place("grid"), ""};
    return {};
}

Result<void> check_roughness(std::span<const float> roughness) {
    const bool rises = std::ranges::adjacent_find(roughness, std::greater_equal<>()) == roughness.end();
    if (!roughness.empty() && roughness.front() == 0 && roughness.back() <= 1 && rises) return {};
    return Error{"does not rise from 0 to at most 1", field_place("roughness"), "One value for each specular level."};
}

/// Whether the maps have the sizes of the first probe's.
Result<void> check_sizes(const ProbeMaps& maps, const ProbeMaps& first, std::size_t levels, std::size_t probe) {
    const auto wrong = [&](const std::string& what) {
        return Error{fmt::format("{} of probe {}", what, probe), field_place("maps"), ""};
    };
    if (maps.specular.size() != levels)
        return wrong(fmt::format("{} specular levels, where `roughness` has {},", maps.specular.size(), levels));
    for (std::size_t l = 0; l < levels; ++l) {
        const int size = std::max(1, first.specular[0].size() >> l);
        const Cubemap& cube = maps.specular[l];
        if (cube.size() != size || cube.channels() != 3 || cube.empty())
            return wrong(fmt::format("level {} is {} texels wide and not {}, or not RGB,", l, cube.size(), size));
    }
    if (maps.irradiance_over_pi.size() != first.irradiance_over_pi.size() || maps.irradiance_over_pi.empty() ||
        maps.irradiance_over_pi.channels() != 3)
        return wrong("an irradiance that is missing, of another size, or not RGB,");
    if (maps.distance.size() != first.distance.size() || (!maps.distance.empty() && maps.distance.channels() != 2))
        return wrong("distances of another size, or without two channels,");
    return {};
}

}  // namespace

Result<void> check_set(const std::optional<ProbeGrid>& grid, std::size_t probes, std::span<const float> roughness) {
    if (grid)
        if (auto ok = check_grid(*grid, probes); !ok) return ok;
    return check_roughness(roughness);
}

Result<ProbeSet> ProbeSet::from_maps(std::vector<Probe> probes, std::optional<ProbeGrid> grid,
                                     std::vector<float> roughness, std::span<const ProbeMaps> maps) {
    if (probes.empty()) return Error{"is empty", field_place("probes"), ""};
    if (maps.size() != probes.size())
        return Error{fmt::format("holds {}, but there are {} probes", maps.size(), probes.size()), field_place("maps"),
                     ""};
    if (auto ok = check_set(grid, probes.size(), roughness); !ok) return ok.error();
    for (std::size_t i = 0; i < maps.size(); ++i)
        if (auto ok = check_sizes(maps[i], maps[0], roughness.size(), i); !ok) return ok.error();

    std::vector<int> sizes;
    for (const Cubemap& level : maps[0].specular) sizes.push_back(level.size());
    ProbeSetBuilder builder(std::move(probes), grid, std::move(roughness),
                            {sizes, maps[0].irradiance_over_pi.size(), maps[0].distance.size()});
    for (std::size_t i = 0; i < maps.size(); ++i) builder.set(int(i), maps[i]);
    return builder.take();
}

ProbeSetBuilder::ProbeSetBuilder(std::vector<Probe> probes, std::optional<ProbeGrid> grid, std::vector<float> roughness,
                                 const ProbeMapSizes& sizes) {
    ProbeSet::Impl& impl = *set_.impl_;
    const int count = int(probes.size());
    for (const int size : sizes.specular) impl.specular.emplace_back(size, count);
    impl.irradiance_over_pi = {sizes.irradiance, count};
    if (sizes.distance > 0) impl.distance = {sizes.distance, count};
    impl.harmonics.resize(probes.size());
    impl.harmonics_irradiance.resize(probes.size());
    impl.probes = std::move(probes);
    impl.grid = grid;
    impl.roughness = std::move(roughness);
}

void ProbeSetBuilder::set(int probe, const ProbeMaps& maps) {
    ProbeSet::Impl& impl = *set_.impl_;
    for (std::size_t l = 0; l < maps.specular.size(); ++l)
        impl.specular[l].set(probe, maps.specular[l].pixels().data());
    impl.irradiance_over_pi.set(probe, maps.irradiance_over_pi.pixels().data());
    if (!maps.distance.empty()) impl.distance.set(probe, maps.distance.pixels().data());
    impl.harmonics[std::size_t(probe)] = maps.harmonics;
    const auto irradiance = sh_irradiance_over_pi(maps.harmonics);
    std::ranges::copy(irradiance, impl.harmonics_irradiance[std::size_t(probe)].begin());
}

void ProbeSetBuilder::set_sources(ProbeSource scene, ProbeSource environment) {
    set_.impl_->scene = std::move(scene);
    set_.impl_->environment = std::move(environment);
}

const ProbeSource& ProbeSet::scene() const {
    return impl_->scene;
}
const ProbeSource& ProbeSet::environment() const {
    return impl_->environment;
}
std::span<const Probe> ProbeSet::probes() const {
    return impl_->probes;
}
const std::optional<ProbeGrid>& ProbeSet::grid() const {
    return impl_->grid;
}
std::span<const std::array<int, 4>> ProbeSet::tetrahedra() const {
    return impl_->tetrahedra;
}
void ProbeSet::set_tetrahedra(std::vector<std::array<int, 4>> tetrahedra) {
    impl_->tetrahedra = std::move(tetrahedra);
}
std::span<const float> ProbeSet::roughness() const {
    return impl_->roughness;
}
int ProbeSet::specular_size() const {
    return impl_->specular.front().size();
}
int ProbeSet::irradiance_size() const {
    return impl_->irradiance_over_pi.size();
}
int ProbeSet::distance_size() const {
    return impl_->distance.size();
}
std::size_t ProbeSet::memory_bytes() const {
    std::size_t bytes = impl_->irradiance_over_pi.bytes() + impl_->distance.bytes();
    for (const auto& level : impl_->specular) bytes += level.bytes();
    return bytes + impl_->probes.size() * (sizeof(Probe) + 2 * sizeof(impl_->harmonics[0]));
}

Vec3f ProbeSet::radiance(int probe, const Vec3f& direction, float roughness) const {
    const auto& r = impl_->roughness;
    const auto above = std::ranges::upper_bound(r, roughness);
    if (above == r.begin()) return impl_->specular.front().look_up(probe, direction);
    if (above == r.end()) return impl_->specular.back().look_up(probe, direction);
    const std::size_t i = std::size_t(above - r.begin());
    const float t = r[i - 1] > 0 ? std::log(roughness / r[i - 1]) / std::log(r[i] / r[i - 1]) : roughness / r[i];
    const Vec3f low = impl_->specular[i - 1].look_up(probe, direction);
    return t > 0 ? low + (impl_->specular[i].look_up(probe, direction) - low) * t : low;
}

Vec3f ProbeSet::irradiance_over_pi(int probe, const Vec3f& normal) const {
    return impl_->irradiance_over_pi.look_up(probe, normal);
}

Vec3f ProbeSet::irradiance_over_pi_sh(int probe, const Vec3f& normal) const {
    const Vec3d e = sh_evaluate(impl_->harmonics_irradiance[std::size_t(probe)], normalize(Vec3d(normal)));
    return Vec3f(Vec3d{std::max(0.0, e.x), std::max(0.0, e.y), std::max(0.0, e.z)});
}

Cubemap ProbeSet::specular(int probe, int level) const {
    return impl_->specular[std::size_t(level)].cube(probe);
}
std::span<const Vec3d, 9> ProbeSet::harmonics(int probe) const {
    return impl_->harmonics[std::size_t(probe)];
}

DistanceMoments ProbeSet::distance(int probe, const Vec3f& direction) const {
    if (impl_->distance.size() == 0) {
        const float far = std::numeric_limits<float>::infinity();
        return {far, far};
    }
    return distance_between_texels(impl_->distance, probe, direction);
}

}  // namespace domelight
