#include "domelight/environment/sky/sky.h"
#include "domelight/io/environment/open_environment.h"
#include "domelight/io/write_image.h"
#include "domelight/projection/projection.h"
#include "domelight/study/environment_survey.h"
#include "domelight/study/explanation_picture.h"
#include "domelight/study/render_study_pictures.h"
#include "domelight/study/sample_explanation.h"
#include "domelight/study/strategy_study.h"

#include "test.h"

#include <cmath>

using namespace domelight;
using namespace domelight::test;

namespace {

/// Light of one radiance with a lamp of 3 x 3 texels at (x, y).
ImageF light_with_lamp(int width, int height, int x, int y) {
    ImageF image(width, height, 3, 0.5F);
    for (int i = 0; i < 9; ++i) {
        float* p = image.at(x + i % 3 - 1, y + i / 3 - 1);
        p[0] = p[1] = p[2] = 500;
    }
    return image;
}

EnvironmentSampler sampler_of(const ImageF& image, DistributionMethod method = DistributionMethod::bilinear) {
    auto sampler = EnvironmentSampler::build(image.view(), {.method = method});
    REQUIRE(bool(sampler));
    return *std::move(sampler);
}

}  // namespace

TEST_SUITE("study") {
    TEST_CASE("survey_environment: mean, irradiance and lamp of a file") {
        const TemporaryFolder folder;
        constexpr int width = 128, height = 64, x = 40, y = 20;
        const ImageF image = light_with_lamp(width, height, x, y);
        REQUIRE(bool(write_exr(folder / "light.exr", image.view(), {.half = false})));
        auto environment = open_environment({folder / "light.exr"}, {});
        REQUIRE(bool(environment));
        const auto survey = survey_environment(*environment);
        REQUIRE(bool(survey));
        CHECK(survey->least == 0.5F);
        CHECK(survey->largest == 500);
        const Vec3d at = latlong_direction({(x + 0.5) / width, (y + 0.5) / height});
        double lamp = 0;
        for (int i = -1; i <= 1; ++i) lamp += 3 * 499.5 * latlong_solid_angle(y + i, width, height);
        // The mean is computed by the prefilter, which is exact to about 1e-4.
        CHECK(survey->mean_radiance.y == doctest::Approx(0.5 + lamp / (4 * k_pi)).epsilon(1e-4));
        // The even light gives π/2 on every side, the lamp its power times the cosine. The tolerance is for the lamp's
        // size: it is not a point.
        const double cosines[6] = {at.x, -at.x, at.y, -at.y, at.z, -at.z};
        for (int f = 0; f < 6; ++f)
            CHECK(survey->irradiance[std::size_t(f)].x ==
                  doctest::Approx(0.5 * k_pi + lamp * std::max(0.0, cosines[f])).epsilon(0.01));
        REQUIRE(survey->lights.size() == 1);
        CHECK(dot(survey->lights[0].direction, at) > std::cos(0.5 * k_pi / 180));
    }

    TEST_CASE("survey_environment: the lamp of a cube lies where it does, turned with the cube") {
        Cubemap cube(64);
        std::fill(cube.pixels().begin(), cube.pixels().end(), 0.5F);
        for (int y = 20; y < 23; ++y)
            for (int x = 40; x < 43; ++x) std::fill_n(cube.face(4).at(x, y), 3, 500.0F);
        const Vec3d lamp = normalize(cube_direction(4, {41.5 / 64, 21.5 / 64}));
        for (const Mat3& turn : {Mat3{}, rotation_y(0.7)}) {
            const auto survey = survey_environment(Environment::from_cube(cube, turn));
            REQUIRE(bool(survey));
            REQUIRE(survey->lights.size() == 1);
            // Where to look in the cube for the light from world direction d is turn * d.
            CHECK(dot(survey->lights[0].direction, turn.transposed() * lamp) > std::cos(0.5 * k_pi / 180));
            CHECK(survey->lights[0].radius_deg == doctest::Approx(1.8).epsilon(0.3));
        }
    }

    TEST_CASE("explain_sample: the explanation ends where the sampler does") {
        const ImageF image = light_with_lamp(64, 32, 20, 12);
        for (const DistributionMethod method : {DistributionMethod::binary, DistributionMethod::guided,
                                                DistributionMethod::bilinear, DistributionMethod::bilinear_plain}) {
            CAPTURE(name_of(method));
            const EnvironmentSampler sampler = sampler_of(image, method);
            for (const std::array<double, 2>& point : {std::array{0.1, 0.2}, {0.5, 0.5}, {0.93, 0.4}, {0.0, 0.99}}) {
                const SampleExplanation e = explain_sample(sampler, point);
                CHECK(e.row.position == doctest::Approx(e.sample.v).epsilon(1e-5));
                CHECK(e.column.position == doctest::Approx(e.sample.u).epsilon(1e-5));
                CHECK(e.pdf_uv / e.jacobian == doctest::Approx(e.sample.pdf_solid_angle).epsilon(1e-4));
            }
        }
    }

    TEST_CASE(
        "study_strategies: environment sampling wins under a lamp, and Lambert's reference is its albedo times E / "
        "pi") {
        const ImageF image = light_with_lamp(64, 32, 20, 8);
        const EnvironmentSampler sampler = sampler_of(image);
        StrategyStudyOptions options;
        options.samples = 256;
        options.strategies = {"cosine", "mis-balance"};
        const auto study = study_strategies(sampler, options);
        REQUIRE(bool(study));
        CHECK(study->strategies.size() == 3);  // the strategy "environment" is always run
        REQUIRE(study->find("cosine"));
        CHECK(study->find("cosine")->expected_error() > 3 * study->find("environment")->expected_error());
        CHECK(study->efficiency_ratio("environment", "environment") == 1);
        CHECK(std::isnan(study->efficiency_ratio("product", "environment")));
        CHECK(study->product_gain_per_ray() == 0);
        options.brdf = LambertBrdf{{0.5F, 0.25F, 1}};
        const auto coloured = study_strategies(sampler, options);
        REQUIRE(bool(coloured));
        CHECK(coloured->reference.x == doctest::Approx(0.5 * study->reference.x));
        CHECK(coloured->reference.y == doctest::Approx(0.25 * study->reference.y));
    }

    TEST_CASE("explanation_picture: the sample is marked where it lies in the image") {
        const ImageF image(64, 32, 3, 1.0F);
        const EnvironmentSampler sampler = sampler_of(image);
        const SampleExplanation explanation = explain_sample(sampler, {0.25, 0.5});
        const Image<std::uint8_t> picture = explanation_picture(sampler, explanation, "test");
        const std::uint8_t* p =
            picture.at(24 + int(explanation.column.position * 900), 70 + int(explanation.row.position * 450));
        CHECK(p[0] > 200);  // the mark is yellow
        CHECK(p[1] > 200);
        CHECK(p[2] < 100);
    }

    TEST_CASE("stacked: one picture below the other, as wide as the widest") {
        Image<std::uint8_t> small(2, 1, 3), large(3, 2, 3);
        small.at(1, 0)[0] = 7;
        large.at(2, 1)[2] = 9;
        const Image<std::uint8_t> both = stacked({small, large});
        CHECK(both.width() == 3);
        CHECK(both.height() == 3);
        CHECK(both.at(1, 0)[0] == 7);
        CHECK(both.at(2, 0)[0] == 255);
        CHECK(both.at(2, 2)[2] == 9);
    }

    TEST_CASE("study_strategies: errors name the option") {
        const ImageF image(8, 4, 3, 1.0F);
        const EnvironmentSampler sampler = sampler_of(image);
        const auto place = [&](const StrategyStudyOptions& options) {
            const auto study = study_strategies(sampler, options);
            REQUIRE_FALSE(bool(study));
            return study.error().where;
        };
        CHECK(place({.samples = 0}) == "samples");
        CHECK(place({.view = {0, -1, 0}}) == "view");
        CHECK(place({.strategies = {"best"}}) == "strategies");
    }
}
