#include "domelight/filtering/prefilter_transpose.h"

#include "filtering/prefilter_checks.h"
#include "test.h"

#include <random>

namespace domelight {
namespace {

/// Numbers from -1 to 1.
ImageF signed_noise(int width, int height, unsigned seed) {
    ImageF image(width, height, 3);
    std::mt19937 engine(seed);
    for (float& p : image.pixels()) p = float(engine() % 2048) / 1024 - 1;
    return image;
}

double dot(std::span<const float> a, std::span<const float> b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += double(a[i]) * b[i];
    return sum;
}

/// |⟨A x, y⟩ - ⟨x, Aᵀ y⟩| / (|A x| |y|) for noise x and y.
double transpose_error(const FilterOptions& options, int width, int height) {
    const ImageF x = test::noise_image(width, height, 5);
    ImageRowSource rows(x);
    const auto filtered = prefilter(rows, options);
    REQUIRE(filtered);
    FilterResult y;
    double left = 0, squares = 0, y_squares = 0;
    const auto add = [&](const FilteredMap& map, unsigned seed) {
        FilteredMap noise(map.layout, signed_noise(map.image.width(), map.image.height(), seed));
        left += dot(map.pixels(), noise.pixels());
        squares += dot(map.pixels(), map.pixels());
        y_squares += dot(noise.pixels(), noise.pixels());
        return noise;
    };
    for (std::size_t l = 0; l < filtered->specular.size(); ++l)
        y.specular.push_back(add(filtered->specular[l], 10 + unsigned(l)));
    if (options.irradiance_size > 0) y.irradiance_over_pi = add(filtered->irradiance_over_pi, 9);
    const ImageF noise = signed_noise(std::max(1, int(filtered->sh.size())), 1, 8);
    for (std::size_t i = 0; i < filtered->sh.size(); ++i) {
        const float* rgb = noise.at(int(i), 0);
        y.sh.push_back({rgb[0], rgb[1], rgb[2]});
        left += domelight::dot(filtered->sh[i], y.sh[i]);
        squares += domelight::dot(filtered->sh[i], filtered->sh[i]);
        y_squares += domelight::dot(y.sh[i], y.sh[i]);
    }
    const auto back = prefilter_transpose(width, height, y, options);
    REQUIRE(back);
    return std::abs(left - dot(x.pixels(), back->pixels())) / std::sqrt(squares * y_squares);
}

FilterOptions levels(std::initializer_list<ZonalKernel> kernels, int size) {
    FilterOptions options;
    options.sh_bands = 0;
    for (const ZonalKernel& kernel : kernels) options.specular.push_back({size, false, kernel});
    return options;
}

}  // namespace

TEST_CASE("prefilter_transpose: <A x, y> = <x, A' y> to 1e-6, for every lobe, layout and map") {
    FilterOptions options = levels({ZonalKernel::ggx(0.3), ZonalKernel::ggx(0.6), ZonalKernel::ggx(1)}, 16);
    CHECK(transpose_error(options, 64, 32) < 1e-6);
    options.layout = Layout::latlong;
    options.world_to_source = Mat3{{Vec3d{0, 0, 1}, Vec3d{0, 1, 0}, Vec3d{-1, 0, 0}}} * rotation_y(0.3);
    CHECK(transpose_error(options, 60, 31) < 1e-6);
    CHECK(transpose_error(levels({ZonalKernel::ggx(0.1)}, 24), 128, 64) < 1e-6);
    CHECK(transpose_error(levels({ZonalKernel::charlie(0.5), {Lobe::phong_brdf, 40}}, 16), 64, 32) < 1e-6);
    FilterOptions rest = levels({}, 0);
    rest.irradiance_size = 8;
    rest.sh_bands = 4;
    CHECK(transpose_error(rest, 64, 32) < 1e-6);
}

TEST_CASE("prefilter_transpose: single directions") {
    FilterOptions options = levels({ZonalKernel::ggx(0.5)}, 1);
    options.directions = {{0, 1, 0}, {3, 0, 0.1}, {0, -1e-3, 0}, {1, 1, 1}};
    CHECK(transpose_error(options, 32, 16) < 1e-6);
}

TEST_CASE("prefilter_transpose: a constant gradient is spread as the texels' solid angles") {
    // The mean over all directions of a filtered map is the mean of the environment, so the transpose of that mean is the
    // texels' share of the sphere.
    FilterOptions options = levels({ZonalKernel::ggx(0.7)}, 16);
    FilterResult mean;
    mean.specular.emplace_back(Cubemap(16));
    for (int y = 0; y < 96; ++y)
        for (int x = 0; x < 16; ++x)
            for (int c = 0; c < 3; ++c)
                mean.specular[0].image.at(x, y)[c] = float(cube_solid_angle(x, y % 16, 16) / (4 * k_pi));
    const auto back = prefilter_transpose(16, 8, mean, options);
    REQUIRE(back);
    double sum = 0;
    for (const float v : back->pixels()) sum += v;
    CHECK(sum == doctest::Approx(3).epsilon(1e-5));
    CHECK(back->at(0, 3)[0] == doctest::Approx(latlong_solid_angle(3, 16, 8) / (4 * k_pi)).epsilon(0.03));
}

TEST_CASE("prefilter_transpose: what has no transpose is an error that names the field") {
    FilterOptions options = levels({ZonalKernel::ggx(0.5)}, 8);
    FilterResult values;
    values.specular.emplace_back(Cubemap(4));
    CHECK(prefilter_transpose(16, 8, values, options).error().where == "`values`");
    options.specular[0].size = 4;
    options.texels = Texels::read;
    CHECK(prefilter_transpose(16, 8, values, options).error().where == "`texels`");
    options.texels = Texels::centre;
    options.specular[0].mirror = true;
    CHECK(prefilter_transpose(16, 8, values, options).error().where == "`specular`");
    CHECK(prefilter_transpose(0, 8, values, options).error().where == "`width`");
}

}  // namespace domelight
