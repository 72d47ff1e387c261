#include "domelight/filtering/harmonic/spherical_harmonics.h"

#include "domelight/filtering/kernel/zonal_kernel.h"
#include "domelight/image/row_source.h"
#include "domelight/io/environment/open_environment.h"
#include "domelight/projection/projection.h"

#include "base/gauss_legendre.h"
#include "filtering/reference/source.h"
#include "test.h"

#include <cmath>

using namespace domelight;

namespace {

const Vec3d k_directions[] = {
    {1, 0, 0}, {0, 1, 0}, {0, 0, -1}, normalize(Vec3d{1, 2, -3}), normalize(Vec3d{-0.2, 0.01, 0.9})};

}  // namespace

TEST_CASE("spherical_harmonics: the first nine are Ramamoorthi and Hanrahan's polynomials") {
    // Eq. 3 of Ramamoorthi and Hanrahan, with the constants as printed (6 digits).
    for (const Vec3d& d : k_directions) {
        double y[9];
        sh_basis(d, 3, y);
        const double expected[9] = {0.282095,
                                    0.488603 * d.y,
                                    0.488603 * d.z,
                                    0.488603 * d.x,
                                    1.092548 * d.x * d.y,
                                    1.092548 * d.y * d.z,
                                    0.315392 * (3 * d.z * d.z - 1),
                                    1.092548 * d.x * d.z,
                                    0.546274 * (d.x * d.x - d.y * d.y)};
        for (int i = 0; i < 9; ++i) CHECK(std::abs(y[i] - expected[i]) < 1e-6);
    }
}

TEST_CASE("spherical_harmonics: orthonormal over the sphere, and the addition theorem holds to band 60") {
    constexpr int k_bands = 12, k_count = k_bands * k_bands;
    std::vector<double> gram(k_count * k_count, 0.0), y(k_count);
    const GaussLegendre& rule = gauss_legendre(k_bands);
    for (int i = 0; i < k_bands; ++i)
        for (int j = 0; j < 2 * k_bands; ++j) {
            const double z = rule.x[i], s = std::sqrt(1 - z * z), phi = 2 * k_pi * j / (2 * k_bands);
            sh_basis({s * std::cos(phi), s * std::sin(phi), z}, k_bands, y);
            for (int a = 0; a < k_count; ++a)
                for (int b = 0; b < k_count; ++b)
                    gram[a * k_count + b] += rule.w[i] * 2 * k_pi / (2 * k_bands) * y[a] * y[b];
        }
    double worst = 0;
    for (int a = 0; a < k_count; ++a)
        for (int b = 0; b < k_count; ++b) worst = std::max(worst, std::abs(gram[a * k_count + b] - (a == b)));
    CHECK(worst < 1e-13);

    // sum_m Y_lm(a) Y_lm(b) = (2l + 1) / 4π P_l(a . b)
    std::vector<double> ya(60 * 60), yb(60 * 60);
    const Vec3d a = k_directions[3], b = k_directions[4];
    sh_basis(a, 60, ya);
    sh_basis(b, 60, yb);
    for (int l = 0; l < 60; ++l) {
        double sum = 0;
        for (int i = l * l; i < (l + 1) * (l + 1); ++i) sum += ya[i] * yb[i];
        CHECK(std::abs(sum - (2 * l + 1) / (4 * k_pi) * std::legendre(l, dot(a, b))) < 1e-12);
    }
}

TEST_CASE("spherical_harmonics: irradiance of a cosine sky in closed form, a constant stays constant") {
    // Radiance 1 + d.x: E / π = 1 + 2/3 n.x.
    std::vector<Vec3d> radiance(9);
    const double y00 = 1 / std::sqrt(4 * k_pi), y11 = std::sqrt(3 / (4 * k_pi));
    radiance[0] = Vec3d{1, 2, 4} / y00;
    radiance[3] = Vec3d{1, 2, 4} / y11;
    const std::vector<Vec3d> irradiance = sh_irradiance_over_pi(radiance);
    for (const Vec3d& n : k_directions) {
        CHECK(sh_evaluate(radiance, n).y == doctest::Approx(2 * (1 + n.x)).epsilon(1e-14));
        CHECK(sh_evaluate(irradiance, n).y == doctest::Approx(2 * (1 + 2.0 / 3 * n.x)).epsilon(1e-14));
    }
    const std::vector<Vec3d> filament = sh_filament(radiance);
    REQUIRE(filament.size() == 9);
    CHECK(filament[0].z == doctest::Approx(4).epsilon(1e-14));
    CHECK(filament[3].z == doctest::Approx(4 * 2.0 / 3).epsilon(1e-14));
    CHECK(filament[6].z == 0);
    CHECK(sh_filament(std::span(radiance).first(1))[0].x == doctest::Approx(1).epsilon(1e-14));
}

TEST_CASE("spherical_harmonics: Filament's polynomials with its nine numbers give the same irradiance") {
    std::vector<Vec3d> radiance(16);
    for (int i = 0; i < 16; ++i) radiance[i] = Vec3d{std::sin(i + 1.0), std::cos(3.0 * i), 1.0 / (i + 1)};
    const std::vector<Vec3d> f = sh_filament(radiance);
    const std::vector<Vec3d> irradiance = sh_irradiance_over_pi(std::span(radiance).first(9));
    for (const Vec3d& n : k_directions) {
        const Vec3d value = f[0] + f[1] * n.y + f[2] * n.z + f[3] * n.x + f[4] * (n.x * n.y) + f[5] * (n.y * n.z) +
                            f[6] * (3 * n.z * n.z - 1) + f[7] * (n.z * n.x) + f[8] * (n.x * n.x - n.y * n.y);
        CHECK(length(value - sh_evaluate(irradiance, n)) < 1e-14);
    }
}

TEST_CASE("spherical_harmonics: windows leave the mean and damp the highest band most") {
    for (ShWindow window : {ShWindow::hann, ShWindow::lanczos}) {
        std::vector<Vec3d> c(16, Vec3d{1, 1, 1});
        sh_window(c, window);
        CHECK(c[0].x == 1);
        for (int i = 1; i < 16; ++i) CHECK(c[i].x <= c[i - 1].x);
        CHECK(c[15].x == doctest::Approx(window == ShWindow::hann ? (1 + std::cos(0.75 * k_pi)) / 2
                                                                  : std::sin(0.75 * k_pi) / (0.75 * k_pi)));
        CHECK(c[9].x == c[15].x);  // one weight a band
    }
    std::vector<Vec3d> same(4, Vec3d{1, 2, 3});
    sh_window(same, ShWindow::none);
    CHECK(same[3].z == 3);
}

TEST_CASE("spherical_harmonics: Filament's nine numbers of a real environment are those that its own tool wrote") {
    DOMELIGHT_DATA_FILE(file, "reference/symmetrical_garden/symmetrical_garden_1k.hdr");
    auto environment = open_environment({file});
    REQUIRE(environment);
    const auto image = read_latlong(**environment->rows());
    REQUIRE(image);
    // Key "sh" of symmetrical_garden_ibl.ktx.
    const Vec3d theirs[9] = {
        {0.744558, 0.773899, 0.911555},    {0.949531, 0.990914, 1.25601},     {-0.211972, -0.20181, -0.24574},
        {0.558717, 0.573824, 0.681412},    {0.810173, 0.821786, 0.932482},    {-0.262837, -0.281018, -0.315964},
        {-0.145663, -0.145209, -0.162459}, {-0.154947, -0.161729, -0.184412}, {-0.236724, -0.236824, -0.268643}};
    // Their world looks along +Z at the picture's centre and has -X to its right.
    const Mat3 world_to_source{{Vec3d{0, 0, 1}, Vec3d{0, 1, 0}, Vec3d{-1, 0, 0}}};
    const std::vector<Vec3d> ours = sh_filament(ReferenceSource(*image).spherical_harmonics(3, world_to_source, 0));
    // The tool damps the higher bands with a window function, and the mean of its source is 1.2 % brighter than that of
    // ours.
    const double damped[3] = {1.012, 0.975, 0.862};
    for (int i = 0; i < 9; ++i) {
        const Vec3d expected = ours[i] * damped[i == 0 ? 0 : i < 4 ? 1 : 2];
        CHECK_MESSAGE(length(expected - theirs[i]) < 0.02, i, ": ", expected.x, " for ", theirs[i].x);
    }
}

TEST_CASE("sh_polynomial: the expansion's own values, for any number of coefficients") {
    for (const int count : {1, 4, 9, 16}) {
        std::vector<Vec3d> a;
        for (int i = 0; i < count; ++i) a.push_back({std::sin(1.0 + i), std::cos(2.0 * i), 0.1 * i - 0.4});
        const QuadraticPolynomial p = sh_polynomial(a);
        a.resize(std::min<std::size_t>(a.size(), 9));
        for (const Vec3d& d : k_directions) CHECK(length(p(d) - sh_evaluate(a, d)) < 1e-12);
    }
    const QuadraticPolynomial one = sh_polynomial(std::vector<Vec3d>{{1, 2, 3}});
    CHECK(one.xx.z == doctest::Approx(3 * 0.282095).epsilon(1e-5));  // a constant is spread over the squares
    CHECK(one.yy == one.xx);
    CHECK(one.zz == one.xx);
}
