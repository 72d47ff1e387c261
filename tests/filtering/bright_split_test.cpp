#include "filtering/harmonic/bright_split.h"

#include "domelight/projection/projection.h"

#include "filtering/lights/tent_nodes.h"
#include "test.h"

#include <algorithm>
#include <random>

using namespace domelight;

namespace {

constexpr int k_height = 256, k_width = 512;

/// A dim sky with a sun of one texel, one at the pole, a lamp of 12 x 7 texels whose colour changes across it, and one
/// over the seam.
ImageF lamps() {
    ImageF image(k_width, k_height, 3, 0.5f);
    const auto set = [&](int x, int y, float r, float g, float b) {
        float* p = image.at((x + k_width) % k_width, y);
        p[0] = r, p[1] = g, p[2] = b;
    };
    set(400, 60, 1e5f, 9e4f, 7e4f);
    set(17, 0, 3e6f, 3e6f, 2e6f);
    for (int y = 100; y < 107; ++y)
        for (int x = 200; x < 212; ++x) set(x, y, 2000.f * (x - 195), 3000.f, 4000.f * (y - 97));
    for (int y = 180; y < 184; ++y)
        for (int x = -3; x < 3; ++x) set(x, y, 5e3f, 1e4f, 2e3f);
    return image;
}

void take(BrightSplit& split, ImageView<float> rows) {
    std::vector<simd::Summary> summaries;
    for (int y = 0; y < rows.height; ++y) summaries.push_back(simd::summarize(rows.row(y), 3 * rows.width));
    split.take_from(rows, summaries);
}

/// The texels that the split removed, as tents.
struct Taken {
    Taken() : image(lamps()), rest(lamps()), split(k_width, k_height) {
        take(split, rest.view());
        for (int y = 0; y < k_height; ++y)
            for (int x = 0; x < k_width; ++x)
                if (rest.at(x, y)[1] != image.at(x, y)[1]) texels.push_back({x, y});
    }
    Vec3d exactly(const ZonalKernel& kernel, const Vec3d& n) const {
        Vec3d sum;
        for (const auto& [x, y] : texels) {
            // A rule of 16 x 16 nodes in each patch, which is fine enough for the kernel.
            PointLights nodes;
            add_tent_nodes(nodes, k_width, k_height, x, y, image.at(x, y), 16);
            for (int i = 0; i < nodes.count(); ++i) {
                const Vec3d p = normalize(nodes.place(i));
                const double angle = 2 * std::asin(std::min(1.0, 0.5 * length(p - n)));
                sum += Vec3d{nodes.r[i], nodes.g[i], nodes.b[i]} * kernel.density(angle);
            }
        }
        return sum;
    }
    Vec3d mean() const {
        const Spectrum spectrum = split.spectrum(8, 1);
        const auto a = [&](int c) { return spectrum.coefficient(0, 0, c).real() / std::sqrt(4 * k_pi); };
        return {a(0), a(1), a(2)};
    }
    ImageF image, rest;
    BrightSplit split;
    std::vector<std::pair<int, int>> texels;
};

}  // namespace

TEST_CASE("bright_split: takes what outshines the rest, however the rows come") {
    const Taken whole;
    CHECK(whole.texels.size() == 1 + 1 + 12 * 7 + 4 * 6);
    ImageF rows = lamps();
    BrightSplit split(k_width, k_height);
    for (int y = 0; y < k_height; y += 7) take(split, rows.view().rows(y, std::min(7, k_height - y)));
    CHECK(std::ranges::equal(rows.pixels(), whole.rest.pixels()));
    const Spectrum a = split.spectrum(8, 1), b = whole.split.spectrum(8, 1);
    for (int l = 0; l <= 8; ++l)
        for (int m = 0; m <= l; ++m) CHECK(a.coefficient(l, m, 1) == b.coefficient(l, m, 1));
}

TEST_CASE("bright_split: the tree of lights gives each kernel over the tents themselves, at any distance") {
    const Taken taken;
    std::mt19937 random(5);
    std::normal_distribution<double> normal;
    for (const ZonalKernel& kernel : {ZonalKernel::ggx(0.1), ZonalKernel::ggx(0.2), ZonalKernel::ggx(0.5),
                                      ZonalKernel::ggx(1), ZonalKernel::cosine(), ZonalKernel::charlie(0.5)}) {
        const auto lights = taken.split.lights(kernel);
        const DirectKernelTable table(kernel);
        const Vec3d mean = taken.mean();
        double worst = 0;
        for (int k = 0; k < 60; ++k) {
            Vec3d n = normalize(Vec3d{normal(random), normal(random), normal(random)});
            // Half of them lie one to a few hundred texels from a lamp.
            if (k % 2) {
                const auto& [x, y] = taken.texels[random() % taken.texels.size()];
                n = normalize(latlong_direction({(x + 0.5) / k_width, (y + 0.5) / k_height}) +
                              n * (k_pi / k_height * std::pow(1.5, k % 15)));
            }
            const float x = float(n.x), y = float(n.y), z = float(n.z);
            float rgb[3] = {};
            simd::add_direct_lights(lights.nodes.data(), int(lights.nodes.size()), lights.points.view(), table.view(),
                                    &x, &y, &z, 1, rgb);
            const Vec3d truth = taken.exactly(kernel, n);
            // Relative to the sum; where the horizon hides nearly all of it, to a tenth of its mean over the sphere.

            for (const auto& [got, want, floor] :
                 {std::tuple{rgb[0], truth.x, mean.x}, {rgb[1], truth.y, mean.y}, {rgb[2], truth.z, mean.z}})
                worst = std::max(worst, std::abs(got - want) / std::max(want, 0.1 * floor));
        }
        CAPTURE(kernel.width);
        CHECK(worst < 6e-4);  // third order in width over distance: k_far
    }
}

TEST_CASE("bright_split: the spectrum of the texels is that of an image of them alone") {
    const Taken taken;
    ImageF alone(k_width, k_height, 3);
    for (const auto& [x, y] : taken.texels) std::copy_n(taken.image.at(x, y), 3, alone.at(x, y));
    ShAnalysis analysis(k_width, k_height, 60, 1);
    analysis.add_rows(alone.view());
    const Spectrum want = analysis.finish(), got = taken.split.spectrum(60, 1);
    double norm = 0, difference = 0;
    for (int l = 0; l <= 60; ++l)
        for (int m = 0; m <= l; ++m)
            for (int c = 0; c < 3; ++c) {
                norm += std::norm(want.coefficient(l, m, c));
                difference += std::norm(want.coefficient(l, m, c) - got.coefficient(l, m, c));
            }
    CHECK(std::sqrt(difference / norm) < 1e-6);
}
