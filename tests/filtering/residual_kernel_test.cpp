#include "filtering/kernel/residual_kernel.h"

#include "domelight/base/vec.h"

#include "filtering/lights/light_groups.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

using namespace domelight;

namespace {

struct Case {
    ZonalKernel kernel;
    int band_limit;
};

const Case k_cases[] = {
    {ZonalKernel::cosine(), 256},      {ZonalKernel::ggx(0.32), 256},     {ZonalKernel::ggx(0.6), 256},
    {ZonalKernel::charlie(0.1), 1024}, {ZonalKernel::charlie(0.25), 768}, {ZonalKernel::charlie(0.75), 768},
    {ZonalKernel::charlie(1), 768},    {{Lobe::phong_brdf, 1}, 256},      {{Lobe::phong_plain, 1}, 256}};

double legendre_series(const std::vector<double>& k, double c) {
    double p = 1, before = 0, sum = 0;
    for (int l = 0; l < int(k.size()); ++l) {
        sum += (2 * l + 1) / (4 * k_pi) * k[l] * p;
        const double next = ((2 * l + 1) * c * p - l * before) / (l + 1);
        before = p;
        p = next;
    }
    return sum;
}

std::vector<double> added(std::vector<double> a, const std::vector<double>& b) {
    for (std::size_t i = 0; i < a.size(); ++i) a[i] += b[i];
    return a;
}

/// The residual as the tables have it.
double table_value(const simd::ResidualTable& table, double theta) {
    const auto at = [](const float* values, double where) {
        const int i = int(where);
        return values[i] + (where - i) * (values[i + 1] - double(values[i]));
    };
    double sum = 0;
    const double c = std::cos(theta), chord = 2 * std::sin(theta / 2);
    if (std::abs(c) < table.half_width) sum += at(table.ring, (c / table.half_width + 1) * 0.5 * table.ring_steps);
    if (chord < table.extent) sum += at(table.axis, chord / table.extent * table.axis_steps);
    return sum;
}

Vec3d direction(std::mt19937& random) {
    std::uniform_real_distribution<double> uniform(-1, 1);
    const double z = uniform(random), phi = k_pi * uniform(random), s = std::sqrt(1 - z * z);
    return {s * std::cos(phi), s * std::sin(phi), z};
}

}  // namespace

TEST_CASE("residual kernel: with the tapered expansion it is the kernel, at every angle") {
    for (const Case& test : k_cases) {
        CAPTURE(int(test.kernel.lobe));
        CAPTURE(test.kernel.width);
        const std::vector<double> factors = test.kernel.coefficients(test.band_limit);
        const ResidualKernel residual(test.kernel, factors);
        const std::vector<double> tapered = added(factors, residual.removed());
        double largest = 0, of_residual = 0;
        for (int i = 1; i < 4000; ++i) {
            const double theta = k_pi * i / 4000, density = test.kernel.density(theta);
            const double rest = density - legendre_series(tapered, std::cos(theta));
            of_residual = std::max(of_residual, std::abs(rest) - ResidualKernel::k_allowed * density);
            largest = std::max(
                largest, std::abs(table_value(residual.table(), theta) - rest) - ResidualKernel::k_allowed * density);
        }
        CHECK(largest < 3e-3 * of_residual);
    }
}

TEST_CASE("residual kernel: beyond its limits it is as small as asked for") {
    for (const Case& test : k_cases) {
        CAPTURE(int(test.kernel.lobe));
        CAPTURE(test.kernel.width);
        const std::vector<double> factors = test.kernel.coefficients(test.band_limit);
        const ResidualKernel residual(test.kernel, factors);
        const std::vector<double> tapered = added(factors, residual.removed());
        for (const double error : {1e-4, 1e-5, 1e-6}) {
            const double ring = residual.ring_limit(error), axis = residual.axis_limit(error);
            for (int i = 1; i < 1000; ++i) {
                const double theta = k_pi * i / 1000, density = test.kernel.density(theta);
                if (std::abs(std::cos(theta)) < ring || 2 * std::sin(theta / 2) < axis) continue;
                const double rest = density - legendre_series(tapered, std::cos(theta));
                CHECK(std::abs(rest) < 1.05 * error + 1.05 * ResidualKernel::k_allowed * density + 1e-6);
            }
        }
        CHECK(residual.ring_limit(1e-7) < 0.25);
    }
}

TEST_CASE("residual sums: the groups that are skipped are those that do not matter") {
    std::mt19937 random(7);
    PointLights points;
    for (int cluster = 0; cluster < 9; ++cluster) {
        const Vec3d centre = direction(random);
        for (int i = 0; i < 23; ++i) {
            const Vec3d d = normalize(centre + direction(random) * 0.02);
            const float rgb[3] = {1.f + float(i), 2.f, 0.5f};
            points.add(d, 0.01, rgb);
        }
    }
    const LightGroups groups(points);
    CHECK(groups.used == points.count());
    CHECK(groups.count() % LightGroups::k_padding == 0);

    const ZonalKernel kernel = ZonalKernel::charlie(1);  // a ring and an axis
    const ResidualKernel residual(kernel, kernel.coefficients(256));
    const double error = 1e-6;
    std::vector<float> ring, axis;
    for (int g = 0; g < groups.count(); ++g) {
        ring.push_back(float(residual.ring_limit(error)) + groups.radius[g]);
        const double chord = residual.axis_limit(error) + groups.radius[g];
        axis.push_back(float(1 - 0.5 * chord * chord));
    }
    const simd::ResidualGroups view{groups.x.data(), groups.y.data(), groups.z.data(),     ring.data(),
                                    axis.data(),     groups.count(),  groups.lights.view()};
    std::vector<float> x, y, z;
    std::vector<Vec3d> directions;
    for (int i = 0; i < 1000; ++i) {
        directions.push_back(i % 10 == 0 ? normalize(points.place(i % points.count()) + direction(random) * 0.01)
                                         : direction(random));
        x.push_back(float(directions[i].x)), y.push_back(float(directions[i].y)), z.push_back(float(directions[i].z));
    }
    std::vector<float> rgb(3000, 1.f);
    simd::add_residual_sums(view, residual.table(), x.data(), y.data(), z.data(), 1000, rgb.data());
    double largest = 0;
    for (int i = 0; i < 1000; ++i) {
        Vec3d sum;
        for (int p = 0; p < points.count(); ++p)
            sum += Vec3d{points.r[p], points.g[p], points.b[p]} *
                   table_value(residual.table(),
                               2 * std::asin(std::min(1.0, 0.5 * length(directions[i] - points.place(p)))));
        largest = std::max({largest, std::abs(rgb[3 * i] - 1 - sum.x), std::abs(rgb[3 * i + 2] - 1 - sum.z)});
    }
    // 207 lights of at most 0.23 each, each left out where it is below 1e-6; and a fine table read in float.
    CHECK(largest < 5e-5);
}
