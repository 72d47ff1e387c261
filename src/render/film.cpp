#include "render/film.h"

#include "domelight/image/colour.h"

#include <fmt/core.h>

#include <limits>

namespace domelight {
double PixelSums::noise() const {
    if (count < 2) return 1e9;
    const double mean = luminance(radiance) / count, error = std::sqrt(std::max(0.0, luminance(variance_of_mean())));
    return error / ((1 + mean) * (1 + mean));
}

Vec3d PixelSums::variance_of_mean() const {
    if (count < 2) return {};
    const double n = count;
    const auto of = [&](double square, double sum) { return std::max(0.0, (square - sum * sum / n) / (n * (n - 1))); };
    return {of(squares.x, radiance.x), of(squares.y, radiance.y), of(squares.z, radiance.z)};
}

RenderStatus StatusSums::after(int t, double seconds) {
    Tile now;
    for (const PixelSums& s : film_.tile(t)) {
        now.samples += s.count;
        ++now.pixels;
        if (s.count < 2) continue;
        const double noise = s.noise();
        now.squared_noise += noise * noise;
        ++now.with_noise;
    }
    Tile& old = tiles_[std::size_t(t)];
    sum_.samples += now.samples - old.samples;
    sum_.squared_noise += now.squared_noise - old.squared_noise;
    sum_.pixels += now.pixels - old.pixels;
    sum_.with_noise += now.with_noise - old.with_noise;
    old = now;
    return {sum_.samples / std::max(1, sum_.pixels),
            std::sqrt(std::max(0.0, sum_.squared_noise) / std::max(1, sum_.with_noise)), seconds};
}

Result<void> check_size(int width, int height) {
    if (width >= 1 && height >= 1 && width <= 16384 && height <= 16384) return {};
    return Error{fmt::format("{} x {} is not a valid picture size", width, height), "",
                 "Accepted: 1 x 1 to 16384 x 16384."};
}

RenderResult develop(const Film& film, int width, int height) {
    RenderResult out;
    for (ImageF* image : {&out.radiance, &out.direct, &out.indirect, &out.diffuse, &out.specular, &out.albedo,
                          &out.normal, &out.variance})
        *image = ImageF(width, height, 3);
    for (ImageF* image : {&out.opacity, &out.depth, &out.object, &out.samples}) *image = ImageF(width, height, 1);
    double noise = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const PixelSums& s = film.at(x, y);
            const double n = std::max(1, s.count);
            const auto put = [&](ImageF& image, const Vec3d& v) {
                float* p = image.at(x, y);
                p[0] = float(v.x), p[1] = float(v.y), p[2] = float(v.z);
            };
            put(out.radiance, s.radiance / n);
            put(out.variance, s.variance_of_mean());
            put(out.direct, Vec3d(s.direct) / n);
            put(out.indirect, Vec3d(s.indirect) / n);
            put(out.diffuse, Vec3d(s.diffuse) / n);
            put(out.specular, Vec3d(s.specular) / n);
            put(out.albedo, Vec3d(s.albedo) / n);
            put(out.normal, Vec3d(s.normal) / n);
            *out.opacity.at(x, y) = float(s.covered / n);
            *out.depth.at(x, y) = s.covered > 0 ? float(s.depth / s.covered) : std::numeric_limits<float>::infinity();
            *out.object.at(x, y) = s.object;
            *out.samples.at(x, y) = float(s.count);
            noise += s.count > 1 ? s.noise() * s.noise() : 0;
            out.sample_count = std::max(out.sample_count, s.count);
            out.non_finite_samples += s.non_finite;
        }
    out.noise = std::sqrt(noise / (double(width) * height));
    return out;
}

}  // namespace domelight
