#include "domelight/capture/engine_files.h"

#include "domelight/filtering/harmonic/spherical_harmonics.h"

#include "probe/cube_of.h"
#include "test.h"
#include "texture/texel/half.h"
#include "texture/texel/rgb9e5.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <random>

namespace domelight {
namespace {

using test::cube_of;
using test::TemporaryFolder;

/// The nine coefficients of the radiance at a place: different at each, and E above 0 everywhere.
std::array<Vec3d, 9> harmonics_at(int place) {
    std::mt19937 random(unsigned(place) + 1);
    std::uniform_real_distribution<double> value(-0.2, 0.2);
    std::array<Vec3d, 9> harmonics;
    for (Vec3d& h : harmonics) h = {value(random), value(random), value(random)};
    harmonics[0] += Vec3d{2, 1.5, 1};
    return harmonics;
}

/// A grid whose probes have light of nine harmonics.
ProbeSet grid_set(const ProbeGrid& grid) {
    std::vector<Probe> probes;
    std::vector<ProbeMaps> maps;
    for (int i = 0; i < grid.count(); ++i) {
        probes.push_back({.place = grid.place(i), .position = grid.place(i)});
        ProbeMaps& m = maps.emplace_back();
        m.harmonics = harmonics_at(i);
        const auto e = sh_irradiance_over_pi(m.harmonics);
        const auto fill = [](int size, std::span<const Vec3d> coefficients) {
            return cube_of(size, 3, [&](const Vec3d& d, float* texel) {
                const Vec3f v(sh_evaluate(coefficients, d));
                texel[0] = v.x, texel[1] = v.y, texel[2] = v.z;
            });
        };
        m.irradiance_over_pi = fill(16, e);
        m.specular = {fill(16, m.harmonics), fill(8, e)};
    }
    auto set = ProbeSet::from_maps(std::move(probes), grid, {0, 1}, maps);
    REQUIRE(set);
    return *std::move(set);
}

/// A KTX2 file of one three-dimensional level, looked up as GPUs do: linear, clamped to the edge.
class Volume {
  public:
    explicit Volume(const std::filesystem::path& file) {
        std::ifstream in(file, std::ios::binary);
        bytes_.assign(std::istreambuf_iterator<char>(in), {});
        REQUIRE(bytes_.size() > 104);
        format = word(12);
        for (int i = 0; i < 3; ++i) size[std::size_t(i)] = int(word(20 + 4 * i));
        texels_ = bytes_.data() + word(80);
        REQUIRE(bytes_.size() >= word(80) + word(88));
        REQUIRE(word(88) == std::size_t(size[0]) * std::size_t(size[1]) * std::size_t(size[2]) * texel_bytes());
    }

    std::array<double, 4> linear(double u, double v, double w) const {
        const double at[3] = {u * size[0] - 0.5, v * size[1] - 0.5, w * size[2] - 0.5};
        std::array<double, 4> sum{};
        for (int corner = 0; corner < 8; ++corner) {
            double weight = 1;
            int i[3];
            for (int a = 0; a < 3; ++a) {
                const double low = std::floor(at[a]), t = at[a] - low;
                const bool high = corner >> a & 1;
                weight *= high ? t : 1 - t;
                i[a] = std::clamp(int(low) + high, 0, size[std::size_t(a)] - 1);
            }
            const auto texel = at_texel(i[0], i[1], i[2]);
            for (std::size_t c = 0; c < 4; ++c) sum[c] += weight * texel[c];
        }
        return sum;
    }

    std::array<int, 3> size{};
    std::uint32_t format = 0;

  private:
    std::uint32_t word(std::size_t at) const {
        std::uint32_t value;
        std::memcpy(&value, bytes_.data() + at, 4);
        return value;
    }
    std::size_t texel_bytes() const { return format == 97 ? 8 : 4; }
    std::array<double, 4> at_texel(int x, int y, int z) const {
        const char* p = texels_ + texel_bytes() * std::size_t(x + size[0] * (y + size[1] * z));
        if (format == 97) {
            std::uint16_t h[4];
            std::memcpy(h, p, 8);
            return {float_from_half(h[0]), float_from_half(h[1]), float_from_half(h[2]), float_from_half(h[3])};
        }
        std::uint32_t bits;
        std::memcpy(&bits, p, 4);
        const Vec3f v = rgb_from_rgb9e5(bits);
        return {v.x, v.y, v.z, 1};
    }

    std::vector<char> bytes_;
    const char* texels_ = nullptr;
};

nlohmann::json json_file(const std::filesystem::path& file) {
    std::ifstream in(file);
    return nlohmann::json::parse(in);
}

Vec3d vector_of(const nlohmann::json& json) {
    return {json[0].get<double>(), json[1].get<double>(), json[2].get<double>()};
}

/// E / pi of the place whose number is given, trilinear between the places around the point.
Vec3d interpolated(const ProbeGrid& grid, const Vec3f& point, const std::function<Vec3d(int place)>& at) {
    const GridCell cell = cell_at(grid, point);
    Vec3d sum;
    for (std::size_t k = 0; k < 8; ++k) sum += at(cell.place[k]) * double(cell.weight[k]);
    return sum;
}

Vec3f some_normal(std::mt19937& random) {
    std::normal_distribution<float> value;
    return normalize(Vec3f{value(random), value(random), value(random)});
}

const ProbeGrid k_grid{.origin = {-1, 0.5f, 2}, .spacing = {0.5f, 1, 2}, .nx = 4, .ny = 2, .nz = 3};

TEST_CASE("engine files: three.js' shader finds in its atlas the light between the places of the grid") {
    const TemporaryFolder folder;
    const auto set = grid_set(k_grid);
    const auto report = write_engine_files(set, "three", folder.path());
    REQUIRE(report);
    CHECK(report->files == std::vector<std::string>{"light-probe-grid.ktx2", "light-probe-grid.json"});
    CHECK(report->clipped_texels == 0);
    const Volume atlas(folder / "light-probe-grid.ktx2");
    CHECK(atlas.format == 97);
    CHECK(atlas.size == std::array{4, 2, 7 * 5});
    const auto json = json_file(folder / "light-probe-grid.json");
    const Vec3d size = vector_of(json["size"]), low = vector_of(json["position"]) - size * 0.5;
    std::mt19937 random(1);
    std::uniform_real_distribution<float> fraction(0, 1);
    for (int i = 0; i < 300; ++i) {
        const Vec3f point = Vec3f(low) + Vec3f{fraction(random) * float(size.x), fraction(random) * float(size.y),
                                               fraction(random) * float(size.z)};
        const Vec3d n(some_normal(random));
        // getLightProbeGridIrradiance() of r187, without the half spacing along the normal.
        const auto inside = [](double t, int count) { return std::clamp(t, 0.5 / count, 1 - 0.5 / count); };
        const double u = inside((point.x - low.x) / size.x, 4), v = inside((point.y - low.y) / size.y, 2),
                     w = inside((point.z - low.z) / size.z, 3);
        double c[28];
        for (int t = 0; t < 7; ++t) {
            const auto texel = atlas.linear(u, v, (w * 3 + 1 + t * 5) / (7 * 5));
            std::ranges::copy(texel, c + 4 * t);
        }
        const Vec3d light = interpolated(k_grid, point, [&](int place) {
            return sh_evaluate(sh_irradiance_over_pi(harmonics_at(place)), n) * k_pi;
        });
        const double expected[3] = {light.x, light.y, light.z};
        for (int channel = 0; channel < 3; ++channel) {
            const auto h = [&](int k) { return c[3 * k + channel]; };
            const double irradiance = h(0) * 0.886227 + 2 * 0.511664 * (h(1) * n.y + h(2) * n.z + h(3) * n.x) +
                                      2 * 0.429043 * (h(4) * n.x * n.y + h(5) * n.y * n.z + h(7) * n.x * n.z) +
                                      h(6) * (0.743125 * n.z * n.z - 0.247708) +
                                      h(8) * 0.429043 * (n.x * n.x - n.y * n.y);
            CHECK(irradiance == doctest::Approx(expected[channel]).epsilon(1e-3));
        }
    }
}

TEST_CASE("engine files: Bevy's shader finds in its volume the light between the places of the grid") {
    const TemporaryFolder folder;
    const auto set = grid_set(k_grid);
    REQUIRE(write_engine_files(set, "bevy", folder.path()));
    const Volume volume(folder / "irradiance-volume.ktx2");
    CHECK(volume.format == 123);
    CHECK(volume.size == std::array{4, 4, 9});
    const auto json = json_file(folder / "irradiance-volume.json");
    const Vec3d centre = vector_of(json["translation"]), size = vector_of(json["scale"]);
    std::mt19937 random(2);
    std::uniform_real_distribution<float> fraction(-0.5f, 0.5f);
    double worst = 0, sum = 0;
    for (int i = 0; i < 300; ++i) {
        const Vec3d unit{fraction(random), fraction(random), fraction(random)};  // in the volume's own space
        const Vec3d n(some_normal(random));
        const Vec3f point(centre + Vec3d{unit.x * size.x, unit.y * size.y, unit.z * size.z});
        // irradiance_volume_light() of Bevy.
        const double stp[3] = {std::clamp((unit.x + 0.5) * 4, 0.5, 3.5), std::clamp((unit.y + 0.5) * 2, 0.5, 1.5),
                               std::clamp((unit.z + 0.5) * 3, 0.5, 2.5)};
        const double normal[3] = {n.x, n.y, n.z};
        std::array<double, 3> light{};
        for (int axis = 0; axis < 3; ++axis) {
            const auto texel =
                volume.linear(stp[0] / 4, stp[1] / 4 + (normal[axis] < 0 ? 0.5 : 0), stp[2] / 9 + axis / 3.0);
            for (std::size_t c = 0; c < 3; ++c) light[c] += texel[c] * normal[axis] * normal[axis];
        }
        const Vec3d expected = interpolated(
            k_grid, point, [&](int place) { return Vec3d(ambient_cube_at(fit_ambient_cube(set, place), Vec3f(n))); });
        CHECK(light[0] == doctest::Approx(expected.x).epsilon(5e-3));
        CHECK(light[2] == doctest::Approx(expected.z).epsilon(5e-3));
        const Vec3d exact = interpolated(
            k_grid, point, [&](int place) { return sh_evaluate(sh_irradiance_over_pi(harmonics_at(place)), n); });
        worst = std::max(worst, std::abs(light[1] / exact.y - 1)), sum += light[1] / exact.y - 1;
    }
    // An ambient cube holds half of a band of nine harmonics: close, and neither darker nor brighter on the whole.
    CHECK(worst < 0.1);
    CHECK(std::abs(sum / 300) < 5e-3);
}

TEST_CASE("engine files: an ambient cube of uniform light is uniform, and it is the best there is") {
    const ProbeGrid one{};
    auto set = grid_set(one);
    const AmbientCube best = fit_ambient_cube(set, 0);
    const auto error_of = [&](const AmbientCube& cube) {
        std::mt19937 random(3);
        double sum = 0;
        for (int i = 0; i < 4000; ++i) {
            const Vec3f n = some_normal(random);
            const Vec3d d = Vec3d(ambient_cube_at(cube, n)) - Vec3d(set.irradiance_over_pi(0, n));
            sum += dot(d, d);
        }
        return sum;
    };
    const double least = error_of(best);
    for (std::size_t i = 0; i < 6; ++i)
        for (const float change : {-0.05f, 0.05f}) {
            AmbientCube other = best;
            other[i] += Vec3f{change, change, change};
            CHECK(error_of(other) > least);
        }
    for (int axis = 0; axis < 6; ++axis) {
        AmbientCube flat{};
        flat.fill({2, 3, 4});
        CHECK(length(Vec3d(ambient_cube_at(flat, normalize(Vec3f{1, float(axis), -2}))) - Vec3d{2, 3, 4}) < 1e-5);
    }
}

TEST_CASE("engine files: for other engines, each valid probe is a bake of its own, with its place in a list") {
    const TemporaryFolder folder;
    const ProbeGrid two{.origin = {0, 1, 0}, .spacing = {2, 1, 1}, .nx = 2};
    const auto set = grid_set(two);
    const auto report = write_engine_files(set, "babylon", folder.path());
    REQUIRE(report);
    const auto json = json_file(folder / "probes.json");
    CHECK(json["engine"] == "babylon");
    REQUIRE(json["probes"].size() == 2);
    CHECK(json["probes"][1]["position"] == nlohmann::json{2.0, 1.0, 0.0});
    for (const auto& probe : json["probes"])
        for (const auto& file : probe["files"]) CHECK(std::filesystem::exists(folder / file.get<std::string>()));
    CHECK(report->files.back() == "probes.json");
}

TEST_CASE("engine files: errors name what is wrong") {
    const TemporaryFolder folder;
    std::vector<ProbeMaps> maps(1);
    maps[0].irradiance_over_pi = Cubemap(4, 3);
    maps[0].specular = {Cubemap(4, 3)};
    const auto set = ProbeSet::from_maps({Probe{}}, {}, {0}, maps);
    REQUIRE(set);
    const auto no_grid = write_engine_files(*set, "three", folder.path());
    REQUIRE(!no_grid);
    CHECK(no_grid.error().what.find("not in one") != std::string::npos);
    const auto unknown = write_engine_files(*set, "treee", folder.path());
    REQUIRE(!unknown);
    CHECK(unknown.error().what.find("treee") != std::string::npos);
    CHECK(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace domelight
