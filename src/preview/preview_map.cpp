#include "preview/preview_map.h"

#include "domelight/projection/projection.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace domelight {
namespace {

constexpr int k_most_samples = 4;

/// The texels of a row or column that represent one of `count` cells: up to 4, spread over it.
struct Cell {
    int samples = 0;
    int at[k_most_samples];
};

std::vector<Cell> cells_of(int size, int count) {
    std::vector<Cell> cells(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) {
        const int begin = int(std::int64_t(i) * size / count), end = int(std::int64_t(i + 1) * size / count);
        Cell& cell = cells[std::size_t(i)];
        cell.samples = std::min(end - begin, k_most_samples);
        for (int k = 0; k < cell.samples; ++k) cell.at[k] = begin + ((2 * k + 1) * (end - begin)) / (2 * cell.samples);
    }
    return cells;
}

/// Fills the inside of a bordered width x height block from an image by the means of boxes.
void shrink(ImageView<const float> image, int width, int height, Texel4* block) {
    const std::vector<Cell> columns = cells_of(image.width, width), rows = cells_of(image.height, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const Cell &column = columns[std::size_t(x)], &row = rows[std::size_t(y)];
            float sum[3] = {0, 0, 0};
            for (int j = 0; j < row.samples; ++j)
                for (int i = 0; i < column.samples; ++i) {
                    const float* p = image.at(column.at[i], row.at[j]);
                    for (int c = 0; c < 3; ++c) sum[c] += p[c];
                }
            const float scale = 1 / float(row.samples * column.samples);
            block[(y + 1) * (width + 2) + x + 1] = Texel4::of(sum[0] * scale, sum[1] * scale, sum[2] * scale);
        }
}

}  // namespace

std::string size_text(const FilteredMap& map) {
    return map.layout == Layout::cube ? fmt::format("{}²", map.width())
                                      : fmt::format("{} × {}", map.width(), map.height());
}

MapPlace latlong_place(const Vec3f& d) {
    const UV uv = latlong_uv(Vec3d(d));
    return {0, float(uv.u), float(uv.v)};
}

PreviewMap::PreviewMap(const FilteredMap& map, int most) {
    if (map.empty()) return;
    if (map.layout == Layout::cube)
        make_cube(map, most);
    else
        make_latlong(map.image.view(), most);
}

PreviewMap::PreviewMap(ImageView<const float> latlong, int most, const Mat3& world_to_source)
    : turned_(!(world_to_source == Mat3{})), turn_(world_to_source) {
    make_latlong(latlong, most);
}

void PreviewMap::make_cube(const FilteredMap& cube, int most) {
    cube_ = true;
    width_ = height_ = std::min(cube.width(), most);
    const int n = width_, stride = n + 2;
    block_ = stride * stride;
    texels_.resize(std::size_t(block_) * 6);
    for (int f = 0; f < 6; ++f) shrink(cube.face(f), n, n, &texels_[std::size_t(f) * std::size_t(block_)]);
    // A border texel is the neighbour's texel where the face's plane would continue.
    const auto copy = [&](int f, int x, int y) {
        const MapPlace p = cube_place(Vec3f(cube_direction(f, {(double(x) - 0.5) / n, (double(y) - 0.5) / n})));
        const int px = std::clamp(int(p.u * float(n)), 0, n - 1), py = std::clamp(int(p.v * float(n)), 0, n - 1);
        texels_[std::size_t(f) * std::size_t(block_) + std::size_t(y * stride + x)] =
            texels_[std::size_t(p.face) * std::size_t(block_) + std::size_t((py + 1) * stride + px + 1)];
    };
    for (int f = 0; f < 6; ++f)
        for (int i = 0; i < n + 2; ++i) {
            copy(f, i, 0);
            copy(f, i, n + 1);
            copy(f, 0, i);
            copy(f, n + 1, i);
        }
}

void PreviewMap::make_latlong(ImageView<const float> image, int most) {
    height_ = std::min(image.height, 2 * most);
    width_ = std::min(image.width, 4 * most);
    const int stride = width_ + 2;
    block_ = stride * (height_ + 2);
    texels_.resize(std::size_t(block_));
    shrink(image, width_, height_, texels_.data());
    for (int y = 1; y <= height_; ++y) {
        Texel4* row = &texels_[std::size_t(y) * std::size_t(stride)];
        row[0] = row[width_];
        row[width_ + 1] = row[1];
    }
    std::copy_n(texels_.begin() + stride, stride, texels_.begin());
    std::copy_n(texels_.begin() + std::ptrdiff_t(height_) * stride, stride,
                texels_.begin() + std::ptrdiff_t(height_ + 1) * stride);
}

}  // namespace domelight
