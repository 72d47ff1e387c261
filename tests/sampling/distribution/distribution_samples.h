#pragma once
// Weights that are difficult for samplers, and points to draw with.

#include "domelight/environment/sky/sky.h"
#include "domelight/projection/projection.h"
#include "domelight/sampling/distribution/distribution.h"

#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace domelight::test {

struct NamedWeights {
    std::string name;
    ImageF image;  ///< one channel
    Weights weights() const { return Weights::of(image.view()); }
    double sum() const {
        double s = 0;
        for (float w : image.pixels()) s += w;
        return s;
    }
};

inline NamedWeights constant_weights(std::string name, int width, int height, float value) {
    return {std::move(name), ImageF(width, height, 1, value)};
}

/// `hot` in one texel, `background` in all others.
inline NamedWeights hot_texel(int width, int height, int x, int y, float hot = 1, float background = 0) {
    NamedWeights w{"hot " + std::to_string(x) + "," + std::to_string(y) + " of " + std::to_string(width) + "x" +
                       std::to_string(height) + (background > 0 ? " over background" : ""),
                   ImageF(width, height, 1, background)};
    *w.image.at(x, y) = hot;
    return w;
}

/// Luminance times sin θ of an environment, averaged down to `height` rows at most.
inline NamedWeights light_weights(std::string name, const ImageF& rgb, int height) {
    const int step = std::max(1, rgb.height() / height), w = rgb.width() / step, h = rgb.height() / step;
    NamedWeights weights{std::move(name), ImageF(w, h, 1)};
    for (int y = 0; y < h * step; ++y)
        for (int x = 0; x < w * step; ++x) {
            const float* p = rgb.at(x, y);
            *weights.image.at(x / step, y / step) += float((0.2126 * p[0] + 0.7152 * p[1] + 0.0722 * p[2]) *
                                                           std::sin((y + 0.5) / rgb.height() * k_pi) / (step * step));
        }
    return weights;
}

inline NamedWeights sky_weights(int height) {
    SkyOptions options;
    options.height = height;
    auto sky = make_sky(options);
    ImageF image(sky->width(), sky->height(), 3);
    (void)sky->read(image.view());
    return light_weights("built-in sky", image, height);
}

inline NamedWeights random_weights(int width, int height, unsigned seed) {
    NamedWeights w{"random " + std::to_string(width) + "x" + std::to_string(height), ImageF(width, height, 1)};
    std::mt19937 random(seed);
    std::exponential_distribution<float> value(1);
    for (float& p : w.image.pixels()) p = value(random);
    return w;
}

/// Random, with black patches: rows, columns and single texels.
inline NamedWeights patched_weights(int width, int height, unsigned seed) {
    NamedWeights w = random_weights(width, height, seed);
    w.name = "zero patches " + std::to_string(width) + "x" + std::to_string(height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            if (y < 2 || y == height / 2 || y == height - 1 || x < 3 || x >= width - 2 || (x / 4 + y / 3) % 3 == 0)
                *w.image.at(x, y) = 0;
    return w;
}

/// Independent rows: in each a few random spikes over a little noise.
inline NamedWeights spiky_weights(int width, int height, unsigned seed) {
    NamedWeights w = random_weights(width, height, seed);
    w.name = "spikes " + std::to_string(width) + "x" + std::to_string(height);
    std::mt19937 random(seed);
    for (int y = 0; y < height; ++y)
        for (int k = 0; k < 4; ++k) *w.image.at(int(random() % unsigned(width)), y) = 200;
    return w;
}

/// A background that is lost in tables of floats: 0.01 beside six texels of 1e5, in 3996 texels.
inline NamedWeights sun_and_background() {
    NamedWeights w{"six of 1e5 over .01", ImageF(74, 54, 1, 0.01f)};
    for (int k = 0; k < 6; ++k) *w.image.at(30 + k % 3, 20 + k / 3) = 1e5f;
    return w;
}

inline std::vector<NamedWeights> hard_weights() {
    std::vector<NamedWeights> all;
    for (auto [x, y] : {std::pair{9, 7}, {0, 0}, {31, 0}, {0, 15}, {31, 15}, {0, 6}, {31, 6}, {13, 0}, {13, 15}}) {
        all.push_back(hot_texel(32, 16, x, y));
        all.push_back(hot_texel(32, 16, x, y, 300, 0.5f));
    }
    all.push_back(constant_weights("constant 32x16", 32, 16, 0.7f));
    all.push_back(random_weights(3, 2, 1));
    all.push_back(constant_weights("1x1", 1, 1, 3));
    all.push_back(random_weights(5, 1, 2));
    all.push_back(random_weights(1, 7, 3));
    all.push_back(random_weights(47, 19, 4));
    all.push_back(patched_weights(40, 20, 5));
    all.push_back(patched_weights(33, 17, 6));
    all.push_back(spiky_weights(300, 5, 7));
    all.push_back(constant_weights("all black", 16, 8, 0));
    all.push_back(sky_weights(64));
    return all;
}

/// Points at random, with the corners of the square among them.
inline std::vector<UnitPoint> random_points(int count, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::vector<UnitPoint> points(count);
    for (UnitPoint& p : points) {
        const std::uint64_t bits = random();
        p = {std::uint32_t(bits), std::uint32_t(bits >> 32)};
    }
    const std::uint32_t ends[] = {0, 0xffffffffu, 1, 0x80000000u, 0x7fffffffu};
    int k = 0;
    for (std::uint32_t x : ends)
        for (std::uint32_t y : ends)
            if (k < count) points[k++] = {x, y};
    return points;
}

inline const DistributionMethod k_all_methods[] = {DistributionMethod::linear,   DistributionMethod::walk,
                                                   DistributionMethod::binary,   DistributionMethod::guided,
                                                   DistributionMethod::alias,    DistributionMethod::hierarchical,
                                                   DistributionMethod::bilinear, DistributionMethod::bilinear_plain};

inline std::unique_ptr<Distribution2D> made(const NamedWeights& weights, DistributionMethod method) {
    auto distribution = make_distribution(weights.weights(), method);
    return distribution ? std::move(*distribution) : nullptr;
}

}  // namespace domelight::test
