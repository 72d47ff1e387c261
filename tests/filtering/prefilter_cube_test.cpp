#include "domelight/filtering/prefilter.h"
#include "domelight/io/environment/open_environment.h"
#include "domelight/projection/projection.h"

#include "base/gauss_legendre.h"
#include "projection/bordered_cube.h"
#include "test.h"

#include <random>

using namespace domelight;

namespace {

/// The kernel summed in double over the nodes of a dense quadrature rule on every patch of the cube's reconstruction.
struct CubeTruth {
    std::vector<Vec3d> direction, light;

    explicit CubeTruth(const Cubemap& source) {
        const BorderedCube cube(source);
        const int n = cube.size();
        const auto& rule = gauss_legendre(6);
        for (int f = 0; f < 6; ++f)
            for (int j = -1; j < n; ++j)
                for (int i = -1; i < n; ++i)
                    for (std::size_t q = 0; q < 36; ++q) {
                        const auto place = [&](int cell, std::size_t k, double& fraction, double& weight) {
                            const double low = cell < 0 ? 0.5 : 0, high = cell == n - 1 ? 0.5 : 1;
                            fraction = low + (high - low) * 0.5 * (1 + rule.x[k]);
                            weight = rule.w[k] * (high - low) / n;
                            return (cell + 0.5 + fraction) / n;
                        };
                        double fu, fv, wu, wv;
                        const double u = place(i, q % 6, fu, wu), v = place(j, q / 6, fv, wv);
                        const Vec3d d = cube_direction(f, {u, v});
                        const double weight = wu * wv / std::pow(dot(d, d), 1.5);
                        double g[3];
                        for (int c = 0; c < 3; ++c)
                            g[c] = (cube.texel(f, i, j)[c] * (1 - fu) + cube.texel(f, i + 1, j)[c] * fu) * (1 - fv) +
                                   (cube.texel(f, i, j + 1)[c] * (1 - fu) + cube.texel(f, i + 1, j + 1)[c] * fu) * fv;
                        direction.push_back(normalize(d));
                        light.push_back(Vec3d{g[0], g[1], g[2]} * weight);
                    }
    }
    Vec3d convolve(const ZonalKernel& kernel, const Vec3d& axis) const {
        Vec3d sum;
        for (std::size_t i = 0; i < direction.size(); ++i)
            sum =
                sum + light[i] * kernel.density(std::atan2(length(cross(axis, direction[i])), dot(axis, direction[i])));
        return sum;
    }
};

}  // namespace

TEST_CASE("prefilter: a cube is filtered as the integral over its own reconstruction, a sun on an edge included") {
    const int n = 24;
    Cubemap source(n);
    std::mt19937 random(7);
    for (float& p : source.pixels()) p = float(random() % 1000) / 1000;
    for (int c = 0; c < 3; ++c) source.face(2).at(0, 11)[c] = 20000;  // on the edge between +Y and -X
    const CubeTruth truth(source);

    FilterOptions options;
    options.world_to_source = rotation_y(0.3);
    options.irradiance_size = 8;
    for (double roughness : {0.5, 0.7, 1.0}) options.specular.push_back({8, false, ZonalKernel::ggx(roughness)});
    const auto result = prefilter(source, options);
    REQUIRE(result);
    options.threads = 1;
    const auto again = prefilter(source, options);
    REQUIRE(again);

    Vec3d mean;
    for (const Vec3d& l : truth.light) mean += l / (4 * k_pi);
    CHECK(std::abs(result->mean.x / mean.x - 1) < 1e-6);
    for (std::size_t l = 0; l <= options.specular.size(); ++l) {
        const bool irradiance = l == options.specular.size();
        const FilteredMap& map = irradiance ? result->irradiance_over_pi : result->specular[l];
        const FilteredMap& map1 = irradiance ? again->irradiance_over_pi : again->specular[l];
        CHECK(std::equal(map.pixels().begin(), map.pixels().end(), map1.pixels().begin()));
        double error2 = 0, truth2 = 0, worst = 0;
        for (int f = 0; f < 6; ++f)
            for (int i = 0; i < 8; ++i) {
                const int x = i, y = (3 * i + f) % 8;
                const Vec3d d = options.world_to_source * normalize(cube_direction(f, {(x + 0.5) / 8, (y + 0.5) / 8}));
                const Vec3d t = truth.convolve(irradiance ? ZonalKernel::cosine() : options.specular[l].kernel, d);
                const double e = map.face(f).at(x, y)[0] - t.x;
                error2 += e * e;
                truth2 += t.x * t.x;
                worst = std::max(worst, std::abs(e) / std::max(t.x, 0.01 * mean.x));
            }
        MESSAGE("level " << l << ": RMSE " << std::sqrt(error2 / truth2) << ", max " << worst);
        CHECK(std::sqrt(error2 / truth2) < 1e-4);
        CHECK(worst < 2e-3);
    }
}

TEST_CASE("prefilter: small cubes of a photograph with a sun, as a scene's own light is baked many times a second") {
    DOMELIGHT_DATA_FILE(file, "env_latlong/noon_grass_1k.hdr");
    const auto photograph = open_environment({file});
    REQUIRE(photograph);
    FilterOptions face;
    face.sh_bands = 0;
    face.specular = {{64, true, {}}, {32, true, {}}};
    const auto cubes = prefilter(*photograph, face);
    REQUIRE(cubes);
    for (const FilteredMap& captured : cubes->specular) {
        const Cubemap source = captured.cube();
        const CubeTruth truth(source);
        FilterOptions options;
        options.sh_bands = 0;
        for (const double roughness : {0.25, 0.5, 1.0})
            options.specular.push_back({8, false, ZonalKernel::ggx(roughness)});
        const auto result = prefilter(source, options);
        REQUIRE(result);
        for (std::size_t l = 0; l < options.specular.size(); ++l) {
            double error2 = 0, truth2 = 0;
            for (int f = 0; f < 6; ++f)
                for (const auto& [x, y] : {std::pair{1, 2}, {6, 4}}) {
                    const Vec3d d = normalize(cube_direction(f, {(x + 0.5) / 8, (y + 0.5) / 8}));
                    const double t = truth.convolve(options.specular[l].kernel, d).y,
                                 e = result->specular[l].face(f).at(x, y)[1] - t;
                    error2 += e * e, truth2 += t * t;
                }
            INFO("faces of " << source.size() << "^2, level " << l);
            CHECK(std::sqrt(error2 / truth2) < 2e-4);
        }
    }
}
