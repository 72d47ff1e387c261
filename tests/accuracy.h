#pragma once
// The error of a filtered map against the truth, which the tests check and `accuracy_bench` prints.

#include "domelight/filtering/prefilter.h"
#include "domelight/filtering/reference.h"
#include "domelight/projection/projection.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace domelight::test {

struct Accuracy {
    std::string name;
    int size = 0;
    double width = 0;    ///< α or exponent
    double rmse = 0;     ///< √(∑ ω |error|² / ∑ ω |truth|²), all channels
    double largest = 0;  ///< max |error| / max(truth, 0.01 mean), per channel
    Vec3d where;         ///< direction of the largest error
};

/// Direction of a lat-long image's brightest texel.
inline Vec3d brightest_direction(ImageView<const float> image) {
    int bx = 0, by = 0;
    double best = -1;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const float* p = image.at(x, y);
            if (const double sum = double(p[0]) + p[1] + p[2]; sum > best) best = sum, bx = x, by = y;
        }
    return latlong_direction({(bx + 0.5) / image.width, (by + 0.5) / image.height});
}

/// A texel of a cube map and its direction.
struct CubeTexel {
    int face, x, y;
    Vec3d direction;
};

/// Texels to compare: `random` of them anywhere, and as many near the strongest light, opposite it and on the ring 90
/// degrees from it, where errors are largest; then the poles, and texels along the faces' edges.
inline std::vector<CubeTexel> texels_to_test(int size, const Vec3d& light, int random, unsigned seed = 1) {
    std::mt19937 engine(seed);
    std::normal_distribution<double> normal;
    std::vector<CubeTexel> texels;
    const auto add_texel = [&](int face, int x, int y) {
        texels.push_back({face, x, y, normalize(cube_direction(face, {(x + 0.5) / size, (y + 0.5) / size}))});
    };
    const auto add = [&](const Vec3d& d) {
        const CubePoint p = cube_point(d);
        add_texel(p.face, std::min(size - 1, int(p.uv.u * size)), std::min(size - 1, int(p.uv.v * size)));
    };
    const auto anywhere = [&] { return normalize(Vec3d{normal(engine), normal(engine), normal(engine)}); };
    for (int i = 0; i < random; ++i) add(anywhere());
    for (int i = 0; i < random / 4; ++i) {
        const Vec3d off = anywhere() * std::pow(10, -3 + 3.0 * i / (random / 4));
        add(light + off);
        add(-light + off);
        const Vec3d q = anywhere();
        add(normalize(q - light * dot(q, light)) + off * 0.1);
    }
    add({1e-9, 1, 2e-9});
    add({1e-9, -1, 2e-9});
    for (int face = 0; face < 6; ++face)
        for (int i = 0; i < std::max(1, random / 32); ++i) {
            const int at = int(engine() % size), end = i % 2 ? size - 1 : 0;
            if (i % 4 < 2)
                add_texel(face, at, end);
            else
                add_texel(face, end, at);
        }
    return texels;
}

/// Compares one map (a cube, in the source's frame) with the kernel integrated over the image.
inline Accuracy measure(const std::string& name, const Cubemap& map, const ZonalKernel& kernel,
                        ImageView<const float> image, const Vec3d& mean, const std::vector<CubeTexel>& texels) {
    std::vector<Vec3d> directions;
    for (const CubeTexel& t : texels) directions.push_back(t.direction);
    const auto truth = convolve_exactly(image, kernel, directions);
    Accuracy result{name, map.size(), kernel.width, 0, 0, {}};
    double error2 = 0, truth2 = 0;
    for (std::size_t i = 0; i < texels.size(); ++i) {
        const CubeTexel& t = texels[i];
        const double omega = cube_solid_angle(t.x, t.y, map.size());
        const float* p = map.face(t.face).at(t.x, t.y);
        const double expected[3] = {truth[i].x, truth[i].y, truth[i].z}, means[3] = {mean.x, mean.y, mean.z};
        for (int c = 0; c < 3; ++c) {
            const double error = p[c] - expected[c];
            error2 += omega * error * error;
            truth2 += omega * expected[c] * expected[c];
            const double relative = std::abs(error) / std::max({expected[c], 0.01 * means[c], 1e-30});
            if (relative > result.largest) result.largest = relative, result.where = t.direction;
        }
    }
    result.rmse = std::sqrt(error2 / std::max(truth2, 1e-300));
    return result;
}

/// The exact filter's maps of an image, each compared with the truth at about 2 · `random` texels. Mirror levels are
/// left out.
inline std::vector<Accuracy> measure_levels(ImageView<const float> image, FilterOptions options, int random) {
    std::vector<Accuracy> rows;
    ImageRowSource source(image);
    const auto result = prefilter(source, options);
    if (!result) return rows;
    const Vec3d light = brightest_direction(image);
    const auto add = [&](const std::string& name, const Cubemap& map, const ZonalKernel& kernel) {
        rows.push_back(measure(name, map, kernel, image, result->mean, texels_to_test(map.size(), light, random)));
    };
    for (std::size_t l = 0; l < options.specular.size(); ++l)
        if (!options.specular[l].mirror)
            add(name_of(options.specular[l].kernel.lobe) + " level " + std::to_string(l), result->specular[l].cube(),
                options.specular[l].kernel);
    if (options.irradiance_size > 0) add("irradiance", result->irradiance_over_pi.cube(), ZonalKernel::cosine());
    return rows;
}

/// Levels 0..count-1 of a chain from `size` down, level 0 a mirror, with `roughness(level)`.
template <typename Roughness>
std::vector<LevelSpec> ggx_chain(int size, int count, const Roughness& roughness) {
    std::vector<LevelSpec> levels{{size, true, {}}};
    for (int l = 1; l < count; ++l) levels.push_back({std::max(1, size >> l), false, ZonalKernel::ggx(roughness(l))});
    return levels;
}

/// A black sky with a soft gradient and a half-degree sun of `contrast` times its mean.
inline ImageF sun_image(int height, double contrast, double elevation, double azimuth) {
    ImageF image(2 * height, height, 3);
    const double ce = std::cos(elevation), radius = 0.25 * k_pi / 180;
    const Vec3d sun{ce * std::cos(azimuth), std::sin(elevation), ce * std::sin(azimuth)};
    constexpr int sub = 8;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < 2 * height; ++x) {
            const Vec3d d = latlong_direction({(x + 0.5) / (2 * height), (y + 0.5) / height});
            double covered = 0;
            if (length(d - sun) < 4 * k_pi / height + radius)
                for (int s = 0; s < sub * sub; ++s) {
                    const Vec3d e = latlong_direction(
                        {(x + (s % sub + 0.5) / sub) / (2 * height), (y + (s / sub + 0.5) / sub) / height});
                    covered += length(e - sun) < radius;
                }
            const double sky = 0.6 + 0.4 * d.y, disc = contrast * covered / (sub * sub);
            float* p = image.at(x, y);
            p[0] = float(sky + disc), p[1] = float(0.9 * sky + disc), p[2] = float(sky * 1.1 + 0.8 * disc);
        }
    return image;
}

}  // namespace domelight::test
