#include "io/environment/cube_input.h"

#include "domelight/projection/projection.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace domelight {

namespace {

/// Where a face lies in a picture of columns x rows faces, and what turns it into OpenGL's orientation.
struct Tile {
    int face, column, row;
    bool mirror_x = false, mirror_y = false;  ///< both: turned by 180 degrees
};

struct Sheet {
    int columns, rows;
    std::array<Tile, 6> tiles;
};

Sheet sheet_of(CubeLayout layout) {
    switch (layout) {
        case CubeLayout::horizontal_cross:
            return {4, 3, {{{0, 2, 1}, {1, 0, 1}, {2, 1, 0}, {3, 1, 2}, {4, 1, 1}, {5, 3, 1}}}};
        case CubeLayout::vertical_cross:
            return {3, 4, {{{0, 2, 1}, {1, 0, 1}, {2, 1, 0}, {3, 1, 2}, {4, 1, 1}, {5, 1, 3, true, true}}}};
        case CubeLayout::horizontal_strip:
            return {6, 1, {{{0, 0, 0}, {1, 1, 0}, {2, 2, 0}, {3, 3, 0}, {4, 4, 0}, {5, 5, 0}}}};
        case CubeLayout::vertical_strip:
            return {1, 6, {{{0, 0, 0}, {1, 0, 1}, {2, 0, 2}, {3, 0, 3}, {4, 0, 4}, {5, 0, 5}}}};
        case CubeLayout::openexr_strip:
            break;
    }
    return {1,
            6,
            {{{0, 0, 0, true, false},
              {1, 0, 1, true, false},
              {2, 0, 2, false, true},
              {3, 0, 3, false, true},
              {4, 0, 4, true, false},
              {5, 0, 5, true, false}}}};
}

/// Copies row `y` of a tile, whose texels start at `from`, to its place in the face.
void place_row(const Tile& tile, int y, const float* from, ImageView<float> face) {
    const int n = face.width;
    float* to = face.row(tile.mirror_y ? n - 1 - y : y);
    for (int x = 0; x < n; ++x) std::copy_n(from + 3 * (tile.mirror_x ? n - 1 - x : x), 3, to + 3 * x);
}

/// A face whose samples run from edge to edge, at texel centres: bilinear at (i + 1/2) (n - 1) / n.
void move_to_texel_centres(ImageView<float> face) {
    const int n = face.width;
    const auto mix = [](double a, double b, double s) { return a + s * (b - a); };
    ImageF source(n, n, 3);
    for (int y = 0; y < n; ++y) std::copy_n(face.row(y), 3 * n, source.row(y));
    for (int y = 0; y < n; ++y) {
        const double py = (y + 0.5) * (n - 1) / n;
        const int y0 = int(py), y1 = std::min(y0 + 1, n - 1);
        for (int x = 0; x < n; ++x) {
            const double px = (x + 0.5) * (n - 1) / n;
            const int x0 = int(px), x1 = std::min(x0 + 1, n - 1);
            for (int c = 0; c < 3; ++c)
                face.at(x, y)[c] = float(mix(mix(source.at(x0, y0)[c], source.at(x1, y0)[c], px - x0),
                                             mix(source.at(x0, y1)[c], source.at(x1, y1)[c], px - x0), py - y0));
        }
    }
}

}  // namespace

std::optional<CubeLayout> cube_layout_of_shape(int width, int height) {
    for (const CubeLayout layout : {CubeLayout::horizontal_cross, CubeLayout::vertical_cross,
                                    CubeLayout::horizontal_strip, CubeLayout::vertical_strip}) {
        const Sheet sheet = sheet_of(layout);
        if (width % sheet.columns == 0 && height % sheet.rows == 0 && width / sheet.columns == height / sheet.rows)
            return layout;
    }
    return std::nullopt;
}

Result<Cubemap> read_cube_picture(RowSource& source, CubeLayout layout) {
    const Sheet sheet = sheet_of(layout);
    const int n = source.width() / sheet.columns;
    assert(source.width() == n * sheet.columns && source.height() == n * sheet.rows);
    Cubemap cube(n);
    ImageF band(source.width(), std::min(64, n), 3);
    for (int top = 0; top < source.height();) {
        const int count = std::min(band.height(), source.height() - top);
        if (const auto read = source.read(band.view().rows(0, count)); !read) return read.error();
        for (int y = 0; y < count; ++y, ++top)
            for (const Tile& tile : sheet.tiles)
                if (tile.row == top / n) place_row(tile, top % n, band.at(tile.column * n, y), cube.face(tile.face));
    }
    return cube;
}

Cubemap cube_from_openexr(Cubemap cube) {
    const ImageF stored(std::move(cube).take_strip());
    const int n = stored.width();
    Cubemap turned(n);
    for (const Tile& tile : sheet_of(CubeLayout::openexr_strip).tiles)
        for (int y = 0; y < n; ++y) place_row(tile, y, stored.row(tile.row * n + y), turned.face(tile.face));
    for (int f = 0; f < 6; ++f) move_to_texel_centres(turned.face(f));
    return turned;
}

Cubemap cube_with_faces(const Cubemap& cube, const std::array<int, 6>& order) {
    Cubemap sorted(cube.size());
    for (int i = 0; i < 6; ++i)
        for (int y = 0; y < cube.size(); ++y)
            std::copy_n(cube.face(i).row(y), 3 * cube.size(), sorted.face(order[std::size_t(i)]).row(y));
    return sorted;
}

namespace {

/// Whether a cube's samples are mirrored as OpenEXR's are.
enum class Mirrored { no, as_openexr };

/// The mean difference, relative to their sum, between the texels on either side of the twelve edges.
double step_across_edges(const Cubemap& cube, Mirrored mirrored) {
    const Sheet openexr = sheet_of(CubeLayout::openexr_strip);
    const int n = cube.size();
    const auto texel = [&](int f, int x, int y) {
        const Tile& tile = openexr.tiles[std::size_t(f)];
        const bool turn = mirrored == Mirrored::as_openexr;
        return cube.face(f).at(turn && tile.mirror_x ? n - 1 - x : x, turn && tile.mirror_y ? n - 1 - y : y);
    };
    double sum = 0;
    for (int f = 0; f < 6; ++f)
        for (int side = 0; side < 4; ++side)
            for (int i = 0; i < n; ++i) {
                const int x = side == 0 ? 0 : side == 1 ? n - 1 : i, y = side == 2 ? 0 : side == 3 ? n - 1 : i;
                constexpr double k_beyond = 1e-6;
                const auto place = [&](int at, int low, int high) {
                    return side == low ? -k_beyond : side == high ? 1 + k_beyond : (at + 0.5) / n;
                };
                const CubePoint other = cube_point(cube_direction(f, {place(x, 0, 1), place(y, 2, 3)}));
                const auto index = [&](double u) { return std::clamp(int(u * n), 0, n - 1); };
                const float *a = texel(f, x, y), *b = texel(other.face, index(other.uv.u), index(other.uv.v));
                for (int c = 0; c < 3; ++c) {
                    const double larger = std::abs(a[c]) + std::abs(b[c]);
                    if (larger > 0) sum += std::abs(double(a[c]) - b[c]) / larger;
                }
            }
    return sum / (6.0 * 4 * 3 * n);
}

}  // namespace

bool meets_as_openexr(const Cubemap& cube) {
    // Samples on an edge are in both faces, so their difference is that of rounding, to half floats or to eight bits.
    constexpr double k_same = 2e-3, k_clearly = 8;
    const double as_openexr = step_across_edges(cube, Mirrored::as_openexr);
    return as_openexr < k_same && step_across_edges(cube, Mirrored::no) > k_clearly * std::max(as_openexr, k_same / 2);
}

}  // namespace domelight
