#include "preview/sample_picture.h"

#include "test.h"

#include <algorithm>
#include <cmath>
#include <set>

using namespace domelight;

namespace {

EnvironmentSampler sampler_of(const ImageF& image, EnvironmentSamplerOptions options = {}) {
    options.threads = 1;
    auto sampler = EnvironmentSampler::build(image.view(), options);
    REQUIRE(bool(sampler));
    return std::move(*sampler);
}

std::array<int, 3> rgb(const Image<std::uint8_t>& image, int x, int y) {
    return {image.at(x, y)[0], image.at(x, y)[1], image.at(x, y)[2]};
}

// The environment begins at (16, 66) in every picture.
constexpr int k_left = 16, k_top = 66;

}  // namespace

TEST_CASE("sample_picture: a dot lies where its sample fell, the rest is the environment") {
    const ImageF image(64, 32, 3, 0.5f);
    const EnvironmentSampler sampler = sampler_of(image);
    SamplePictureOptions options;
    options.width = 400;
    LightSample sample;
    sample.u = 0.25f;
    sample.v = 0.75f;
    const auto with = sample_picture(sampler, std::span(&sample, 1), options),
               without = sample_picture(sampler, {}, options);
    CHECK(with.width() == 400 + 2 * k_left);
    double x = 0, y = 0, count = 0;
    for (int j = 0; j < with.height(); ++j)
        for (int i = 0; i < with.width(); ++i)
            if (rgb(with, i, j) != rgb(without, i, j)) x += i + 0.5, y += j + 0.5, ++count;
    REQUIRE(count > 10);
    CHECK(count < 100);
    CHECK(x / count == doctest::Approx(k_left + 100).epsilon(0.005));
    CHECK(y / count == doctest::Approx(k_top + 150).epsilon(0.005));
}

TEST_CASE("density_picture: a constant environment has one density per steradian, and over the image the sine's") {
    const ImageF image(64, 32, 3, 0.5f);
    SamplePictureOptions options;
    options.width = 256;
    for (const DistributionMethod method : {DistributionMethod::guided, DistributionMethod::bilinear}) {
        EnvironmentSamplerOptions how;
        how.method = method;
        const EnvironmentSampler sampler = sampler_of(image, how);
        const auto even = density_picture(sampler, DensityMeasure::solid_angle, options);
        // Near the poles the sine varies within a row of texels, which a density that is constant within the row does
        // not follow.
        std::set<std::array<int, 3>> colours;
        for (int y = 40; y < 88; ++y) colours.insert(rgb(even, k_left + 100, k_top + y));
        int least = 255, largest = 0;
        for (const auto& c : colours) least = std::min(least, c[0]), largest = std::max(largest, c[0]);
        CHECK(largest - least < 25);
        const auto sine = density_picture(sampler, DensityMeasure::uv, options);
        CHECK(rgb(sine, k_left + 100, k_top + 64)[0] > rgb(sine, k_left + 100, k_top + 4)[0] + 50);
        CHECK(rgb(sine, k_left + 3, k_top + 20) == rgb(sine, k_left + 250, k_top + 20));
    }
}

TEST_CASE("density_picture: what is never drawn is hatched, what is drawn is not") {
    ImageF image(16, 8, 3);
    for (int c = 0; c < 3; ++c) image.at(4, 3)[c] = 1e4f;
    EnvironmentSamplerOptions how;
    how.method = DistributionMethod::guided;
    const EnvironmentSampler sampler = sampler_of(image, how);
    SamplePictureOptions options;
    options.width = 256;
    const auto picture = density_picture(sampler, DensityMeasure::solid_angle, options);
    const std::set<std::array<int, 3>> hatching{{60, 62, 68}, {36, 38, 42}};
    int outside = 0, inside = 0;
    for (int y = 0; y < 128; ++y)
        for (int x = 0; x < 256; ++x) {
            const bool hatched = hatching.contains(rgb(picture, k_left + x, k_top + y));
            const bool hot = x / 16 == 4 && y / 16 == 3;
            (hot ? inside : outside) += hatched == hot;
        }
    CHECK(inside == 0);
    CHECK(outside == 0);
}

TEST_CASE("sample pictures: the same bytes on any number of threads, a black environment too") {
    ImageF image(33, 17, 3);
    SamplePictureOptions options;
    options.width = 256;
    const auto check = [&] {
        const EnvironmentSampler sampler = sampler_of(image);
        std::vector<LightSample> samples;
        for (std::uint32_t i = 0; i < 50; ++i) samples.push_back(sampler.sample({i * 0x9e3779b9u, i * 0x7f4a7c15u}));
        options.threads = 1;
        const auto a = sample_picture(sampler, samples, options),
                   c = density_picture(sampler, DensityMeasure::uv, options);
        options.threads = 3;
        const auto b = sample_picture(sampler, samples, options),
                   d = density_picture(sampler, DensityMeasure::uv, options);
        CHECK(std::equal(a.pixels().begin(), a.pixels().end(), b.pixels().begin()));
        CHECK(std::equal(c.pixels().begin(), c.pixels().end(), d.pixels().begin()));
    };
    check();
    for (int i = 0; i < 33 * 17 * 3; ++i) image.pixels()[i] = float(i % 7);
    check();
}
