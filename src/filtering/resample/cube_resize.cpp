#include "filtering/resample/cube_resize.h"

#include "domelight/base/parallel.h"

#include "filtering/resample/area_resample_arc.h"
#include "projection/bordered_cube.h"

#include <algorithm>
#include <cmath>
#include <vector>

// On a face's plane, S to the right and T down from -1 to 1, dω = (1 + S^2 + T^2)^(-3/2) dS dT, and g is bilinear
// between the lines of texel centres (BorderedCube). So a texel's rectangle is cut at these lines, into parts that a
// product of two Gauss-Legendre rules integrates to rounding.

namespace domelight::area {

namespace {

/// A node of the rule along one axis, in the part of an output column (row) between two lines of texel centres.
struct Node {
    int cell;         ///< the lines at the centres of source texels `cell` and `cell` + 1, from -1 on
    double place;     ///< S or T
    double weight;    ///< dS or dT
    double fraction;  ///< from the one line to the other
};

/// The nodes in output column (or row) `index` of `size`, rising.
std::vector<Node> nodes_of(int index, int size, int source_size) {
    const auto centre = [&](int i) { return (2 * i + 1.0) / source_size - 1; };
    const double from = 2.0 * index / size - 1, to = 2.0 * (index + 1) / size - 1;
    std::vector<Node> nodes;
    const auto line = [&](double place) { return int(std::floor((0.5 * place + 0.5) * source_size - 0.5)); };
    for (int cell = std::max(-1, line(from)); cell < source_size && centre(cell) < to; ++cell) {
        const double a = std::max(from, centre(cell)), b = std::min(to, centre(cell + 1));
        if (!(b > a)) continue;
        const int parts = int(std::ceil((b - a) / 0.1));
        const GaussRule& rule = b - a < 0.02 ? k_gauss3 : k_gauss5;
        const double half = 0.5 * (b - a) / parts;
        for (int part = 0; part < parts; ++part)
            for (int k = 0; k < rule.count; ++k) {
                const double place = a + half * (2 * part + 1 + rule.node[k]);
                nodes.push_back({cell, place, half * rule.weight[k], (place - centre(cell)) * 0.5 * source_size});
            }
    }
    return nodes;
}

/// The weights of the source's texels (columns, rows) from (first_column, first_row) on, row by row; they sum to 1.
struct Stencil {
    int first_column = 0, first_row = 0, columns = 0, rows = 0;
    std::vector<double> weights, row;  ///< `row`: room for a sum along a row
};

void make_stencil(const std::vector<Node>& across, const std::vector<Node>& down, Stencil& s) {
    s.first_column = across.front().cell, s.first_row = down.front().cell;
    s.columns = across.back().cell - s.first_column + 2, s.rows = down.back().cell - s.first_row + 2;
    s.weights.assign(std::size_t(s.columns) * s.rows, 0.0);
    double total = 0;
    for (const Node& t : down) {
        s.row.assign(std::size_t(s.columns), 0.0);
        for (const Node& n : across) {
            const double q = 1 + n.place * n.place + t.place * t.place, w = n.weight / (q * std::sqrt(q));
            double* const at = &s.row[std::size_t(n.cell - s.first_column)];
            at[0] += w * (1 - n.fraction);
            at[1] += w * n.fraction;
        }
        double* const above = &s.weights[std::size_t(t.cell - s.first_row) * s.columns];
        for (int i = 0; i < s.columns; ++i) {
            const double w = t.weight * s.row[std::size_t(i)];
            above[i] += w * (1 - t.fraction);
            above[i + s.columns] += w * t.fraction;
            total += w;
        }
    }
    for (double& w : s.weights) w /= total;
}

Vec3d mean(const BorderedCube& source, int face, const Stencil& s) {
    double sum[3] = {};
    const double* w = s.weights.data();
    for (int j = 0; j < s.rows; ++j) {
        const float* p = source.texel(face, s.first_column, s.first_row + j);
        for (int i = 0; i < s.columns; ++i, ++w, p += 3)
            for (int c = 0; c < 3; ++c) sum[c] += *w * p[c];
    }
    return {sum[0], sum[1], sum[2]};
}

}  // namespace

Cubemap resize_cube(const Cubemap& source, int size, int threads) {
    assert(source.channels() == 3);
    const BorderedCube bordered(source);
    const auto [least, greatest] = std::minmax_element(source.pixels().begin(), source.pixels().end());
    const double low = *least, high = *greatest;
    std::vector<std::vector<Node>> nodes;
    for (int i = 0; i < size; ++i) nodes.push_back(nodes_of(i, size, source.size()));
    Cubemap out(size);
    parallel_for(size, threads, [&](int y) {
        Stencil stencil;
        for (int x = 0; x < size; ++x) {
            make_stencil(nodes[std::size_t(x)], nodes[std::size_t(y)], stencil);
            for (int face = 0; face < 6; ++face) {
                const Vec3d g = mean(bordered, face, stencil);
                float* to = out.face(face).at(x, y);
                // An average lies between the least and the greatest texel; rounding must not move it outside.
                to[0] = float(std::clamp(g.x, low, high));
                to[1] = float(std::clamp(g.y, low, high));
                to[2] = float(std::clamp(g.z, low, high));
            }
        }
    });
    return out;
}

}  // namespace domelight::area
