#include "domelight/sampling/reflection_estimate.h"

#include "domelight/environment/sky/sky.h"
#include "domelight/filtering/prefilter.h"
#include "domelight/filtering/reference.h"
#include "domelight/image/row_source.h"
#include "domelight/io/environment/open_environment.h"
#include "domelight/projection/projection.h"
#include "domelight/sampling/product_sampling.h"

#include "test.h"

#include <algorithm>

using namespace domelight;
using namespace domelight::test;

namespace {

/// A small sky with a hard sun between texel centres and a lamp on the seam.
ImageF small_environment() {
    SkyOptions options;
    options.height = 32;
    options.sun_elevation_deg = 40;
    ImageF image(64, 32, 3);
    REQUIRE(make_sky(options)->read(image.view()));
    image.at(63, 13)[0] += 40;
    image.at(0, 13)[2] += 25;
    return image;
}

/// The prefilter's lobe as a surface: n = v, f NdotL = K, drawn by GGX half vectors.
Surface prefilter_lobe(const Vec3d& axis, const ZonalKernel& kernel) {
    Surface surface =
        make_surface(axis, axis, BasicGgxBrdf<GgxNormals::half_vectors>{float(kernel.width), {1, 1, 1}, {1, 1, 1}});
    surface.evaluate = [kernel](const Vec3f&, const Vec3f& L) {
        if (!(L.z > 0)) return Vec3f{};
        const float f = float(kernel.density(std::atan2(std::hypot(double(L.x), L.y), double(L.z))) / L.z);
        return Vec3f{f, f, f};
    };
    return surface;
}

double largest_deviation(const Estimate& e, const Vec3d& truth) {
    const auto in_errors = [](double got, double want, double error) {
        return std::abs(got - want) / (error + 1e-6 * want);
    };
    return std::max({in_errors(e.radiance.x, truth.x, e.standard_error.x),
                     in_errors(e.radiance.y, truth.y, e.standard_error.y),
                     in_errors(e.radiance.z, truth.z, e.standard_error.z)});
}

}  // namespace

TEST_CASE("estimate_reflection: every strategy agrees with the exact irradiance within its confidence interval") {
    const ImageF image = small_environment();
    auto sampler = EnvironmentSampler::build(image);
    EnvironmentSamplerOptions compensate;
    compensate.compensate = true;
    auto compensated = EnvironmentSampler::build(image, compensate);
    REQUIRE(sampler);
    REQUIRE(compensated);
    for (const Vec3d& normal : {Vec3d{0, 1, 0}, normalize(Vec3d{0.6, 0.3, -0.5}), normalize(Vec3d{-1, 0.1, 0})}) {
        const Surface surface = make_surface(normal, normal, LambertBrdf{});
        const Vec3d truth = convolve_exactly(image, ZonalKernel::cosine(), std::span(&normal, 1))[0];
        const auto check = [&](Strategy strategy, const EnvironmentSampler& s, double most_error) {
            EstimateOptions o;
            o.samples = 100000;
            const Estimate e = estimate_reflection(surface, s, strategy, o);
            INFO(name_of(strategy) << " at " << normal.x << " " << normal.y << " " << normal.z << ": " << e.radiance.y
                                   << " +- " << e.standard_error.y << ", exact " << truth.y);
            CHECK(largest_deviation(e, truth) < 4.5);  // 7e-6 for one, two-sided; 60 numbers
            // The check is meaningful, because the interval is narrow.
            CHECK(e.standard_error.y / truth.y < most_error);
        };
        check(Strategy::uniform, *sampler, 0.08);
        check(Strategy::cosine, *sampler, 0.08);
        check(Strategy::brdf, *sampler, 0.08);
        check(Strategy::environment, *sampler, 0.01);
        check(Strategy::mis_balance, *sampler, 0.01);
        check(Strategy::mis_power, *sampler, 0.01);
        check(Strategy::mis_balance, *compensated, 0.01);
        check(Strategy::mis_power, *compensated, 0.01);
        check(Strategy::product, *sampler, 0.01);
        EstimateOptions many;
        many.samples = 4'000'000;
        const Estimate sum = estimate_reflection(surface, *sampler, Strategy::riemann, many);
        CHECK(sum.radiance.y == doctest::Approx(truth.y).epsilon(2e-3));
    }
}

TEST_CASE("estimate_reflection: the lobe of the prefilter gives the exact prefilter") {
    const ImageF image = small_environment();
    auto sampler = EnvironmentSampler::build(image);
    REQUIRE(sampler);
    for (const double roughness : {0.2, 0.5, 1.0}) {
        const ZonalKernel kernel = ZonalKernel::ggx(roughness);
        const Vec3d axis = normalize(Vec3d{-0.8, 0.7, 0.2});
        const Vec3d truth = convolve_exactly(image, kernel, std::span(&axis, 1))[0];
        for (const Strategy strategy :
             {Strategy::brdf, Strategy::environment, Strategy::mis_balance, Strategy::mis_power, Strategy::product}) {
            EstimateOptions o;
            o.samples = 60000;
            o.seed = 5;
            const Estimate e = estimate_reflection(prefilter_lobe(axis, kernel), *sampler, strategy, o);
            INFO(name_of(strategy) << ", roughness " << roughness << ": " << e.radiance.y << " +- "
                                   << e.standard_error.y << ", exact " << truth.y);
            CHECK(largest_deviation(e, truth) < 4.5);
        }
    }
}

TEST_CASE("estimate_reflection: on a photograph the estimate is the bake's irradiance") {
    DOMELIGHT_DATA_FILE(file, "env_highres/spruit_sunrise_1k.hdr");
    auto environment = open_environment({file});
    REQUIRE(environment);
    auto image = read_latlong(**environment->rows());
    REQUIRE(image);
    auto sampler = EnvironmentSampler::build(*image);
    REQUIRE(sampler);
    FilterOptions options;
    options.irradiance_size = 4;
    ImageRowSource rows(*image);
    auto baked = prefilter(rows, options);
    REQUIRE(baked);
    for (const auto& [face, x, y] : {std::tuple{0, 1, 1}, {2, 2, 0}, {5, 3, 2}}) {
        const Vec3d normal = normalize(cube_direction(face, {(x + 0.5) / 4, (y + 0.5) / 4}));
        const float* p = baked->irradiance_over_pi.face(face).at(x, y);
        EstimateOptions o;
        o.samples = 200000;
        const Estimate e =
            estimate_reflection(make_surface(normal, normal, LambertBrdf{}), *sampler, Strategy::mis_balance, o);
        INFO(e.radiance.y << " +- " << e.standard_error.y << ", baked " << p[1]);
        CHECK(largest_deviation(e, {p[0], p[1], p[2]}) < 4.5);
        CHECK(e.standard_error.y < 0.01 * p[1]);
    }
}

TEST_CASE("estimate_reflection: low-discrepancy points beat random ones") {
    const ImageF image = small_environment();
    auto sampler = EnvironmentSampler::build(image);
    REQUIRE(sampler);
    const Vec3d normal{0, 1, 0};
    const Vec3d truth = convolve_exactly(image, ZonalKernel::cosine(), std::span(&normal, 1))[0];
    const auto rmse = [&](Sequence sequence) {
        double sum = 0;
        for (int seed = 1; seed <= 16; ++seed) {
            EstimateOptions o;
            o.samples = 1024;
            o.sequence = sequence;
            o.seed = seed;
            const double e =
                estimate_reflection(make_surface(normal, normal, LambertBrdf{}), *sampler, Strategy::environment, o)
                    .radiance.y -
                truth.y;
            sum += e * e;
        }
        return std::sqrt(sum / 16);
    };
    const double random = rmse(Sequence::random);
    for (const Sequence s : {Sequence::stratified, Sequence::hammersley, Sequence::halton, Sequence::sobol})
        CHECK(rmse(s) < 0.25 * random);
}

TEST_CASE("sample_product: draws in proportion to the product, and nothing where there is none") {
    const ImageF image = small_environment();
    auto sampler = EnvironmentSampler::build(image);
    REQUIRE(sampler);
    std::vector<UnitPoint> candidates(16);
    for (int i = 0; i < 16; ++i) candidates[i] = random_point(1, i);
    CHECK(sample_product(*sampler, [](const LightSample&) { return 0.f; }, candidates, {5, 0}).pdf_solid_angle == 0);
    // If the target equals the density, resampling changes nothing: the result has the density of the sampler.
    const LightSample s =
        sample_product(*sampler, [](const LightSample& l) { return l.pdf_solid_angle; }, candidates, {7u << 20, 0});
    CHECK(s.pdf_solid_angle == doctest::Approx(sampler->pdf_solid_angle(s.direction)).epsilon(1e-4));
}
