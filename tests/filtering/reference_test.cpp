#include "domelight/filtering/reference.h"

#include "domelight/filtering/harmonic/spherical_harmonics.h"
#include "domelight/projection/projection.h"

#include "filtering/reference/sampling.h"
#include "filtering/reference/source.h"
#include "test.h"

#include <cmath>
#include <cstring>
#include <random>

using namespace domelight;

namespace {

ImageF constant(int width, int height, float value) {
    return ImageF(width, height, 3, value);
}

ImageF noise(int width, int height, unsigned seed) {
    std::mt19937 generator(seed);
    ImageF image(width, height, 3);
    for (float& v : image.pixels()) v = float(generator() % 1000) / 500;
    return image;
}

/// One bright texel on black.
ImageF one_texel(int width, int height, int x, int y) {
    ImageF image(width, height, 3);
    for (int c = 0; c < 3; ++c) image.at(x, y)[c] = float(1000 * (c + 1));
    return image;
}

/// ∫ K g dω over the tent of that texel, by 400 x 400 midpoints: the definition itself.
double tent_by_midpoints(int width, int height, int x, int y, const ZonalKernel& kernel, const Vec3d& axis) {
    constexpr int k_points = 400;
    double sum = 0;
    for (int i = 0; i < k_points; ++i)
        for (int j = 0; j < k_points; ++j) {
            const double s = 2 * (j + 0.5) / k_points - 1,
                         t = 2 * (i + 0.5) / k_points - 1;  // -1..1 from the texel's centre
            const double theta = (y + 0.5 + t) * k_pi / height;
            const Vec3d d = latlong_direction({(x + 0.5 + s) / width, (y + 0.5 + t) / height});
            const double angle = 2 * std::asin(std::min(1.0, length(d - axis) / 2));
            sum += kernel.density(angle) * (1 - std::abs(s)) * (1 - std::abs(t)) * std::sin(theta);
        }
    return sum * (2 * k_pi / width) * (k_pi / height) * 4 / (double(k_points) * k_points);
}

std::vector<Vec3d> directions() {
    std::mt19937 generator(7);
    std::normal_distribution<double> normal;
    std::vector<Vec3d> d = {{1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, -1}, {-1, 0, 0}, normalize(Vec3d{1e-4, 1, -1e-5})};
    for (int i = 0; i < 6; ++i) d.push_back(normalize(Vec3d{normal(generator), normal(generator), normal(generator)}));
    return d;
}

const ZonalKernel k_kernels[] = {{Lobe::ggx, 1},          {Lobe::ggx, 0.6},         {Lobe::ggx, 0.1},
                                 {Lobe::ggx, 0.01},       {Lobe::ggx, 0.0026},      {Lobe::charlie, 1},
                                 {Lobe::charlie, 0.25},   {Lobe::charlie, 0.01},    {Lobe::phong_brdf, 1},
                                 {Lobe::phong_brdf, 20},  {Lobe::phong_brdf, 2048}, {Lobe::phong_plain, 1},
                                 {Lobe::phong_plain, 100}};

}  // namespace

TEST_CASE("convolve_exactly: a constant environment stays constant, at every size and lobe") {
    for (auto [width, height] : {std::pair{1, 1}, {1, 2}, {2, 1}, {7, 3}, {64, 32}, {220, 110}}) {
        const ImageF image = constant(width, height, 0.75f);
        for (const ZonalKernel& kernel : k_kernels)
            for (const Vec3d& value : convolve_exactly(image, kernel, directions()))
                // The error of the quadrature is 1e-9 to 5e-8 at 1k, and a little more if a patch spans radians.
                CHECK_MESSAGE(std::abs(value.y / 0.75 - 1) < 1e-6, width, " x ", height, " ", name_of(kernel.lobe), " ",
                              kernel.width);
    }
}

TEST_CASE(
    "convolve_exactly: one bright texel, against midpoints over its tent: at it, opposite, on the ring 90 degrees "
    "away") {
    for (auto [width, height, x, y] :
         {std::array{128, 64, 97, 20}, {128, 64, 0, 1}, {32, 64, 31, 40}, {128, 64, 64, 31}}) {
        const ImageF image = one_texel(width, height, x, y);
        const Vec3d sun = latlong_direction({(x + 0.5) / width, (y + 0.5) / height});
        const Vec3d side = normalize(cross(sun, Vec3d{0.3, 0.5, -0.2})), other = cross(sun, side);
        std::vector<Vec3d> axes = {sun, -sun, side, other, normalize(sun + side * 0.02), normalize(sun + other * 0.3)};
        for (double offset : {-0.05, -0.01, 0.003, 0.02}) axes.push_back(normalize(side + sun * offset));
        for (const ZonalKernel& kernel : k_kernels) {
            if (kernel.width < 0.01) continue;  // too narrow for 400 midpoints
            const std::vector<Vec3d> values = convolve_exactly(image, kernel, axes);
            double peak = 0, worst = 0;
            for (std::size_t i = 0; i < axes.size(); ++i) {
                const double expected = 2000 * tent_by_midpoints(width, height, x, y, kernel, axes[i]);
                peak = std::max(peak, expected);
                worst = std::max(worst, std::abs(values[i].y - expected));
                CHECK(values[i].z == doctest::Approx(1.5 * values[i].y));
            }
            // The error of midpoints is (1/200)² / 24 times the second derivative, in units of the half width of the
            // tent, or of the lobe if that is narrower.
            CHECK_MESSAGE(worst < 3e-5 * peak, name_of(kernel.lobe), " ", kernel.width, " at ", x, ",", y, " of ",
                          width);
        }
    }
}

TEST_CASE("convolve_exactly: agrees with multiplying spherical harmonics by the kernel's coefficients") {
    const ImageF image = noise(24, 12, 3);
    constexpr int k_bands = 40;
    const std::vector<Vec3d> a = ReferenceSource(image).spherical_harmonics(k_bands, Mat3{}, 0);
    for (const ZonalKernel& kernel :
         {ZonalKernel{Lobe::ggx, 1}, {Lobe::ggx, 0.4}, {Lobe::ggx, 0.15}, {Lobe::charlie, 1}, {Lobe::phong_brdf, 30}}) {
        const std::vector<double> k = kernel.coefficients(k_bands - 1);
        std::vector<Vec3d> b = a;
        for (int l = 0; l < k_bands; ++l)
            for (int i = l * l; i < (l + 1) * (l + 1); ++i) b[i] *= k[l];
        const std::vector<Vec3d> axes = directions(), values = convolve_exactly(image, kernel, axes);
        for (std::size_t i = 0; i < axes.size(); ++i)
            // The tolerance is what bands from 40 on would add: l^-2 of the source times l^-2.5 of the lobe (l^-1.5 for
            // Charlie).
            CHECK(length(values[i] - sh_evaluate(b, axes[i])) < (kernel.lobe == Lobe::charlie ? 5e-3 : 3e-4));
    }
}

TEST_CASE("convolve_exactly: the narrowest lobe is the bilinear reconstruction itself") {
    const ImageF image = noise(40, 20, 5);
    const ReferenceSource source(image);
    const std::vector<Vec3d> axes = directions(), values = convolve_exactly(image, {Lobe::ggx, 1e-5}, axes);
    for (std::size_t i = 6; i < axes.size(); ++i)  // not the axes themselves: at the poles u has no value
        CHECK(length(values[i] - source.lookup(axes[i])) < 1e-3);  // α over a texel
}

TEST_CASE("convolve_exactly: the same bits on any number of threads and in any company") {
    const ImageF image = noise(50, 25, 9);
    const std::vector<Vec3d> axes = directions();
    for (const ZonalKernel& kernel : {ZonalKernel{Lobe::ggx, 0.05}, {Lobe::charlie, 0.5}}) {
        const std::vector<Vec3d> once = convolve_exactly(image, kernel, axes, 1);
        for (int threads : {2, 3, 8}) CHECK(convolve_exactly(image, kernel, axes, threads) == once);
        CHECK(convolve_exactly(image, kernel, std::span(axes).subspan(3, 1), 1)[0] == once[3]);
    }
}

TEST_CASE(
    "reference source: mean and harmonics of a known environment, lookups at texel centres and beyond the poles' "
    "rows") {
    const ImageF image = noise(31, 17, 2);
    const ReferenceSource source(image);
    CHECK(length(source.lookup(latlong_direction({4.5 / 31, 9.5 / 17})) - source.texel(4, 9)) < 1e-12);
    CHECK(length(source.lookup(latlong_direction({4.5 / 31, 0.2 / 17})) - source.texel(4, 0)) < 1e-12);
    CHECK(length(source.lookup(latlong_direction({0, 3.5 / 17})) - (source.texel(0, 3) + source.texel(30, 3)) / 2.0) <
          1e-12);
    const std::vector<Vec3d> a = source.spherical_harmonics(3, Mat3{}, 1);
    CHECK(length(a[0] / std::sqrt(4 * k_pi) - source.mean()) < 1e-12);
    CHECK(length(ReferenceSource(constant(5, 3, 2)).mean() - Vec3d{2, 2, 2}) < 1e-15);

    // Turning the basis turns the world: if world to source is a quarter turn about Y, world x is source z.
    const Mat3 turn = rotation_y(k_pi / 2);
    const std::vector<Vec3d> b = source.spherical_harmonics(3, turn, 1);
    for (const Vec3d& d : directions()) CHECK(length(sh_evaluate(b, d) - sh_evaluate(a, turn * d)) < 1e-12);
}

TEST_CASE("prefilter_reference: a constant environment stays constant by every method, in both layouts") {
    const ImageF image = constant(16, 8, 3);
    for (ReferenceMethod method : {ReferenceMethod::bruteforce, ReferenceMethod::riemann, ReferenceMethod::montecarlo})
        for (Layout layout : {Layout::cube, Layout::latlong}) {
            FilterOptions options;
            options.layout = layout;
            options.specular = {{4, true, {}},
                                {2, false, ZonalKernel::ggx(0.3)},
                                {1, false, ZonalKernel::charlie(0.7)},
                                {1, false, {Lobe::phong_brdf, 9}}};
            options.irradiance_size = 2;
            const auto result = prefilter_reference(image, options, {method, {16, 16}, {.count = 64}});
            REQUIRE(result);
            REQUIRE(result->specular.size() == 4);
            CHECK(result->specular[0].pixels().size() == std::size_t(3 * 16 * (layout == Layout::cube ? 6 : 2)));
            CHECK(result->specular[0].layout == layout);
            for (const FilteredMap& level : result->specular)
                for (float v : level.pixels()) CHECK(v == doctest::Approx(3).epsilon(1e-6));
            for (float v : result->irradiance_over_pi.pixels()) CHECK(v == doctest::Approx(3).epsilon(1e-6));
            CHECK(result->sh.size() == 9);
            CHECK(result->sh[0].x == doctest::Approx(3 * std::sqrt(4 * k_pi)).epsilon(1e-9));
            for (int i = 1; i < 9; ++i) CHECK(length(result->sh[i]) < 1e-7);
            CHECK(result->mean.x == doctest::Approx(3).epsilon(1e-12));
        }
}

TEST_CASE("prefilter_reference: the Riemann sum and Monte Carlo come nearer to brute force with more work") {
    const ImageF image = noise(32, 16, 11);
    for (const ZonalKernel& kernel : {ZonalKernel{Lobe::ggx, 1},
                                      {Lobe::ggx, 0.3},
                                      {Lobe::charlie, 0.5},
                                      {Lobe::phong_brdf, 20},
                                      {Lobe::phong_plain, 20}}) {
        FilterOptions options;
        options.specular = {{2, false, kernel}};
        const auto truth = prefilter_reference(image, options);
        const auto error = [&](const ReferenceOptions& reference) {
            const auto result = prefilter_reference(image, options, reference);
            double sum = 0;
            for (std::size_t i = 0; i < 72; ++i) {
                const double e = result->specular[0].pixels()[i] - truth->specular[0].pixels()[i];
                sum += e * e;
            }
            return std::sqrt(sum / 72);
        };
        CHECK(error({ReferenceMethod::riemann, {400, 200}}) < 1e-4);  // (π / 400)^2
        CHECK(error({ReferenceMethod::riemann, {20, 10}}) > error({ReferenceMethod::riemann, {80, 40}}));
        const auto montecarlo = [&](Sequence sequence, std::uint64_t seed, int count) {
            return error({ReferenceMethod::montecarlo, {}, {sequence, seed, count}});
        };
        // Noise of a unit-contrast source, low-discrepancy points.
        CHECK(montecarlo(Sequence::hammersley, 0, 16384) < 1e-3);
        CHECK(montecarlo(Sequence::hammersley, 0, 64) > montecarlo(Sequence::hammersley, 0, 4096));
        // Each sequence, plain and randomised. The error of independent points would be the deviation divided by √4096.
        for (const Sequence sequence :
             {Sequence::stratified, Sequence::hammersley, Sequence::halton, Sequence::sobol, Sequence::r2})
            for (const std::uint64_t seed : {0, 1}) {
                INFO(name_of(sequence) << ", seed " << seed);
                CHECK(montecarlo(sequence, seed, 4096) < 8e-3);  // 0.0045 to 0.0063 were measured
            }
        CHECK(montecarlo(Sequence::random, 1, 4096) < 2e-2);
        CHECK(montecarlo(Sequence::random, 1, 4096) > 2 * montecarlo(Sequence::sobol, 1, 4096));
    }
}

TEST_CASE("prefilter_reference: the plain Riemann sum of constant light is the lecture's, and depends on J alone") {
    FilterOptions options;
    options.irradiance_size = 1;
    options.sh_bands = 0;
    const auto irradiance = [&](int K, int J, bool normalised) {
        const auto result =
            prefilter_reference(constant(8, 4, 1), options, {ReferenceMethod::riemann, {K, J, normalised}});
        return result->irradiance_over_pi.pixels()[0] * k_pi;
    };
    // π^2 / J sum_j cos θ_j sin θ_j = (π^2 / 2J) / sin(π / 2J): π^2 / (8 sin(π / 8)) for J = 4.
    for (const int K : {1, 4, 16}) CHECK(irradiance(K, 4, false) == doctest::Approx(3.2238).epsilon(1e-4));
    CHECK(irradiance(4, 16, false) == doctest::Approx(3.1466).epsilon(1e-4));
    CHECK(irradiance(4, 4, true) == doctest::Approx(k_pi).epsilon(1e-6));
}

TEST_CASE("prefilter_reference: K steps turn about the direction, J steps tilt away from it") {
    // Light that depends on the azimuth about +Y only: J changes only the sum of the weights, and K samples the
    // azimuth.
    ImageF image(64, 32, 3);
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 64; ++x)
            for (int c = 0; c < 3; ++c) image.at(x, y)[c] = (x + 8) / 16 % 2 == 0 ? 1.f : 0.f;
    const ReferenceSource source(image);
    const auto sum = [&](int K, int J) {
        return riemann_sum(source, ZonalKernel::cosine(), {0, 1, 0}, {.phi_steps = K, .theta_steps = J}).x;
    };
    CHECK(sum(64, 1) == doctest::Approx(0.5).epsilon(1e-9));
    CHECK(sum(64, 9) == doctest::Approx(0.5).epsilon(1e-9));
    CHECK(std::abs(sum(1, 64) - 0.5) > 0.4);
}

TEST_CASE("prefilter_reference: the mirror level is the environment, turned as asked") {
    const ImageF image = noise(64, 32, 4);
    FilterOptions options;
    options.layout = Layout::latlong;
    options.specular = {{32, true, {}}};
    const auto same = prefilter_reference(image, options);
    options.world_to_source = rotation_y(2 * k_pi * 5 / 64);  // five texels
    const auto turned = prefilter_reference(image, options);
    double mean = 0, worst = 0;
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 64; ++x) {
            mean += same->specular[0].image.at(x, y)[1] * latlong_solid_angle(y, 64, 32) / (4 * k_pi);
            worst = std::max(worst, double(std::abs(turned->specular[0].image.at(x, y)[1] -
                                                    same->specular[0].image.at((x + 5) % 64, y)[1])));
        }
    CHECK(worst < 1e-6);
    CHECK(mean == doctest::Approx(same->mean.y).epsilon(1e-3));  // 8 x 8 midpoints
}

TEST_CASE(
    "prefilter_reference: the same bytes on any number of threads, progress rises, cancelling works, nonsense is "
    "refused") {
    const ImageF image = noise(20, 10, 8);
    FilterOptions options;
    options.specular = {{8, true, {}}, {4, false, ZonalKernel::ggx(0.5)}};
    options.irradiance_size = 2;
    double last = 0;
    options.progress = [&](std::string_view, double done) {
        CHECK(done >= last);
        last = done;
        return true;
    };
    options.threads = 1;
    const auto one = prefilter_reference(image, options);
    CHECK(last == 1);
    options.progress = nullptr;
    options.threads = 3;
    const auto three = prefilter_reference(image, options);
    for (int i = 0; i < 2; ++i)
        CHECK(std::memcmp(one->specular[i].pixels().data(), three->specular[i].pixels().data(),
                          one->specular[i].pixels().size_bytes()) == 0);
    CHECK(one->sh == three->sh);

    options.progress = [](std::string_view, double) { return false; };
    const auto cancelled = prefilter_reference(image, options);
    REQUIRE(!cancelled);
    CHECK(cancelled.error().what == "cancelled");
    options.progress = nullptr;
    CHECK(!prefilter_reference(ImageF(), options));
    options.specular = {{4, false, {Lobe::ggx, 1.5}}};
    CHECK(!prefilter_reference(image, options));
    options.specular = {{0, true, {}}};
    CHECK(!prefilter_reference(image, options));
    options.specular.clear();
    CHECK(!prefilter_reference(image, options, {ReferenceMethod::montecarlo, {}, {.count = 0}}));
}
