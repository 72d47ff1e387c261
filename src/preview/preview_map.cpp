#include "preview/preview_map.h"

#include "domelight/projection.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace domelight {
namespace {

/// Mean of up to 4 x 4 texels spread over the box [x0, x1) x [y0, y1).
void box_mean(ImageView<const float> image, int x0, int x1, int y0, int y1, float* out) {
    const int nx = std::min(x1 - x0, 4), ny = std::min(y1 - y0, 4);
    float sum[3] = {0, 0, 0};
    for (int j = 0; j < ny; ++j)
        for (int i = 0; i < nx; ++i) {
            const float* p =
                image.at(x0 + ((2 * i + 1) * (x1 - x0)) / (2 * nx), y0 + ((2 * j + 1) * (y1 - y0)) / (2 * ny));
            for (int c = 0; c < 3; ++c) sum[c] += p[c];
        }
    for (int c = 0; c < 3; ++c) out[c] = sum[c] / float(nx * ny);
}

/// Fills the inside of a bordered width x height block from an image.
void shrink(ImageView<const float> image, int width, int height, float* block) {
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            box_mean(image, int(std::int64_t(x) * image.width / width), int(std::int64_t(x + 1) * image.width / width),
                     int(std::int64_t(y) * image.height / height), int(std::int64_t(y + 1) * image.height / height),
                     block + 3 * ((y + 1) * (width + 2) + x + 1));
}

}  // namespace

PreviewMap::PreviewMap(const FilteredMap& map, int most) {
    if (!map.cube.empty())
        make_cube(map.cube, most);
    else if (!map.latlong.empty())
        make_latlong(map.latlong.view(), most);
}

PreviewMap::PreviewMap(ImageView<const float> latlong, int most, const Mat3& world_to_source)
    : turned_(!(world_to_source == Mat3{})), turn_(world_to_source) {
    make_latlong(latlong, most);
}

void PreviewMap::make_cube(const Cubemap& cube, int most) {
    cube_ = true;
    width_ = height_ = std::min(cube.size(), most);
    const int n = width_, stride = 3 * (n + 2), block = stride * (n + 2);
    texels_.assign(std::size_t(block) * 6, 0);
    for (int f = 0; f < 6; ++f) shrink(cube.face(f), n, n, &texels_[std::size_t(f) * block]);
    // A border texel is the neighbour's that lies where the face's plane would go on.
    for (int f = 0; f < 6; ++f)
        for (int y = 0; y < n + 2; ++y)
            for (int x = 0; x < n + 2; ++x) {
                if (x > 0 && y > 0 && x <= n && y <= n) continue;
                const CubePoint p = cube_point(cube_direction(f, {(x - 0.5) / n, (y - 0.5) / n}));
                const int px = std::clamp(int(p.uv.u * n), 0, n - 1), py = std::clamp(int(p.uv.v * n), 0, n - 1);
                std::copy_n(&texels_[std::size_t(p.face) * block + (py + 1) * stride + 3 * (px + 1)], 3,
                            &texels_[std::size_t(f) * block + y * stride + 3 * x]);
            }
}

void PreviewMap::make_latlong(ImageView<const float> image, int most) {
    height_ = std::min(image.height, 2 * most);
    width_ = std::min(image.width, 4 * most);
    const int stride = 3 * (width_ + 2);
    texels_.assign(std::size_t(stride) * (height_ + 2), 0);
    shrink(image, width_, height_, texels_.data());
    for (int y = 1; y <= height_; ++y) {
        float* row = &texels_[std::size_t(y) * stride];
        std::copy_n(row + 3 * width_, 3, row);
        std::copy_n(row + 3, 3, row + 3 * (width_ + 1));
    }
    std::copy_n(texels_.begin() + stride, stride, texels_.begin());
    std::copy_n(texels_.begin() + std::size_t(height_) * stride, stride,
                texels_.begin() + std::size_t(height_ + 1) * stride);
}

Vec3f PreviewMap::bilinear(const float* origin, int stride, float x, float y) const {
    const int i = std::clamp(int(x), 0, width_), j = std::clamp(int(y), 0, height_);
    const float fx = x - float(i), fy = y - float(j);
    const float *a = origin + j * stride + 3 * i, *b = a + stride;
    const auto mix = [&](int c) {
        return (a[c] * (1 - fx) + a[3 + c] * fx) * (1 - fy) + (b[c] * (1 - fx) + b[3 + c] * fx) * fy;
    };
    return {mix(0), mix(1), mix(2)};
}

Vec3f PreviewMap::sample_face(int face, float u, float v) const {
    const int stride = 3 * (width_ + 2);
    return bilinear(&texels_[std::size_t(face) * stride * (height_ + 2)], stride, u * float(width_) + 0.5f,
                    v * float(height_) + 0.5f);
}

Vec3f PreviewMap::sample_latlong(float u, float v) const {
    if (cube_ || turned_) return sample(Vec3f(latlong_direction({u, v})));
    return bilinear(texels_.data(), 3 * (width_ + 2), u * float(width_) + 0.5f, v * float(height_) + 0.5f);
}

Vec3f PreviewMap::sample(const Vec3f& d) const {
    if (cube_) {
        const CubePoint p = cube_point(Vec3d(d));
        return sample_face(p.face, float(p.uv.u), float(p.uv.v));
    }
    const UV uv = latlong_uv(turned_ ? turn_ * Vec3d(d) : Vec3d(d));
    return bilinear(texels_.data(), 3 * (width_ + 2), float(uv.u * width_) + 0.5f, float(uv.v * height_) + 0.5f);
}

}  // namespace domelight
