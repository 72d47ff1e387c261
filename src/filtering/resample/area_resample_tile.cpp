#include "filtering/resample/area_resample_tile.h"

#include "domelight/base/vec.h"
#include "domelight/projection/projection.h"

#include <algorithm>
#include <cmath>

namespace domelight::area {

namespace {
/// The vector kernel's last, half-empty step may reach this far.
constexpr std::size_t k_slack = 8;
constexpr double k_infinity = std::numeric_limits<double>::infinity();
}  // namespace

SourceGrid::SourceGrid(int width_, int height_)
    : width(width_), height(height_), column_angle(2 * k_pi / width_), row_angle(k_pi / height_) {
    const double h = row_angle;
    for (int j = -1; j < height; ++j) {
        const double top = j < 0 ? 0 : (j + 0.5) * h, middle = (j + 1) * h, s = std::sin(top), c = std::cos(top);
        row_cos.push_back(c);
        row_sin.push_back(s);
        row_tan2.push_back(2 * j + 1 >= height ? k_infinity : (s / c) * (s / c));
        // ∫ v sin theta by the sum rule about the cell's middle: half the whole, and the odd part cos(middle) (...).
        const bool polar = j < 0 || j + 1 == height;
        const double whole = polar ? 2 * std::pow(std::sin(0.25 * h), 2) : 2 * std::sin(middle) * std::sin(0.5 * h);
        // ∫_{-h/2}^{h/2} (x/h) sin(m + x) dx = cos m (2 sin(h/2) - h cos(h/2)) / h
        const double x = 0.5 * h, x2 = x * x;
        const double odd = x2 * x * 2 * (1.0 / 3 - x2 * (1.0 / 30 - x2 * (1.0 / 840 - x2 / 45360))) / h;
        whole_lower.push_back(0.5 * whole + (polar ? 0 : std::cos(middle) * odd));
        whole_upper.push_back(whole - whole_lower.back());
    }
}

LineFrame::LineFrame(const SourceGrid& grid, double phase_, int origin_, int direction_)
    : phase(phase_), origin(origin_), direction(direction_) {
    for (int n = 0;; ++n) {
        const double psi = (n - phase) * grid.column_angle;
        const bool beyond = psi >= 0.5 * k_pi - 1e-12;
        tan.push_back(beyond ? k_infinity : std::tan(psi));
        cos.push_back(beyond ? 0 : std::cos(psi));
        if (beyond) return;
    }
}

ColumnPhase::ColumnPhase(const SourceGrid& grid, double phase_) : phase(phase_) {
    const double quarter = 0.25 * grid.width;
    forward = LineFrame(grid, phase, 0, 1);
    // psi' = -psi: n' - phase' = -(n - phase).
    const double back_phase = phase > 0 ? 1 - phase : 0;
    backward = LineFrame(grid, back_phase, int(std::lround(phase + back_phase)), -1);
    // psi' = 90 degrees - psi: n' - phase' = quarter - (n - phase).
    const double z_origin = std::ceil(quarter + phase - 1e-9);
    from_z = LineFrame(grid, z_origin - quarter - phase, int(z_origin), -1);
    // psi' = 90 degrees + psi: n' - phase' = quarter + (n - phase).
    const double minus_origin = std::floor(phase - quarter + 1e-9);
    from_minus_z = LineFrame(grid, phase - quarter - minus_origin, int(minus_origin), 1);
}

void TileBuilder::clear(int texels) {
    count_ = 0;
    runs_.clear();
    boxes_.assign(texels, Box());
}

void TileBuilder::grow() {
    const std::size_t size = std::max<std::size_t>(4096, 2 * from_.size());
    for (auto* a : {&from_, &to_, &column_tan_, &column_cos_, &row_cos_, &row_sin_}) a->resize(size);
    for (auto* a : {&upper_, &lower_, &width_}) a->resize(2 * size);
    column_.resize(size);
    row_.resize(size);
}

/// Widens a texel's box to cells between the two ends of one of its border lines.
void TileBuilder::include(int texel, int column_a, int column_b, int row_a, int row_b) {
    if (texel < 0) return;
    Box& b = boxes_[texel];
    b.column0 = std::min({b.column0, column_a, column_b});
    b.column1 = std::max({b.column1, column_a, column_b});
    b.row0 = std::min(b.row0, row_a);
    b.row1 = std::max(b.row1, row_b);
}

/// The pieces of a line from its texel `first` outwards to before `end`, all on the side of psi = 0 that `frame` looks
/// to.
void TileBuilder::add_part(const Line& line, const LineFrame& frame, int first, int end, int step) {
    const auto boundary = [&](int k) { return std::max(0, step * (2 * k - size_)) * line.scale; };
    const double kappa2 = line.kappa * line.kappa;
    const auto row_crossing = [&](int j) {
        const double tan2 = grid_.row_tan2[j + 1];
        return tan2 == k_infinity ? k_infinity : std::sqrt(std::max(0.0, kappa2 * tan2 - 1));
    };
    const std::size_t start = count_;
    double t = boundary(step > 0 ? first : first + 1);
    // The cell where the part starts: first estimated by the angles, then corrected by the same numbers as the
    // crossings.
    int column = std::max(0, int(std::floor(std::atan(t) / grid_.column_angle + frame.phase)));
    while (column > 0 && frame.tan[column] > t) --column;
    while (frame.tan[column + 1] <= t) ++column;
    int row = std::clamp(int(std::floor(std::atan2(std::sqrt(1 + t * t), line.kappa) / grid_.row_angle - 0.5)), -1,
                         grid_.height - 1);
    while (row >= 0 && row_crossing(row) > t) --row;
    // Where kappa^2 tan^2 - 1 <= 0 the row lies above the whole line.
    while (grid_.row_tan2[row + 2] < k_infinity && kappa2 * grid_.row_tan2[row + 2] - 1 <= t * t) ++row;
    double next_column = frame.tan[column + 1], next_row = row_crossing(row + 1);

    for (int k = first; k != end; k += step) {
        const double edge = boundary(step > 0 ? k + 1 : k);
        const int offset = (k - line.along0) * line.stride;
        Run run{int(count_), 0, line.plus == k_nobody ? -1 : line.plus + offset,
                line.minus == k_nobody ? -1 : line.minus + offset};
        const int column_a = column, row_a = row;
        while (t < edge) {
            if (count_ + k_slack >= from_.size()) grow();
            const std::size_t p = count_++;
            const double to = std::min(edge, std::min(next_column, next_row));
            from_[p] = t;
            to_[p] = to;
            column_tan_[p] = frame.tan[column];
            column_cos_[p] = frame.cos[column];
            row_cos_[p] = grid_.row_cos[row + 1];
            row_sin_[p] = grid_.row_sin[row + 1];
            column_[p] = frame.direction > 0 ? frame.origin + column : frame.origin - 1 - column;
            row_[p] = row;
            t = to;
            if (to == edge) break;
            if (to == next_column) next_column = frame.tan[++column + 1];
            if (to == next_row) next_row = row_crossing(++row + 1);
        }
        run.last = int(count_);
        const auto cell = [&](int c) { return frame.direction > 0 ? frame.origin + c : frame.origin - 1 - c; };
        include(run.plus, cell(column_a), cell(column), row_a, row);
        include(run.minus, cell(column_a), cell(column), row_a, row);
        runs_.push_back(run);
        // A crossing exactly on the texel grid is passed now.
        while (next_column <= t) next_column = frame.tan[++column + 1];
        while (next_row <= t) next_row = row_crossing(++row + 1);
    }
    // Two nodes are exact to 1e-9 if pieces are short compared with their distance from the singular points T = +-i.
    const double longest =
        std::max({grid_.column_angle, grid_.row_angle, std::sqrt(grid_.column_angle * 2 * line.scale)});
    const auto at = [&](std::vector<double>& a) { return a.data() + start; };
    simd::integrate_arc_pieces({at(from_), at(to_), at(column_tan_), at(column_cos_), at(row_cos_), at(row_sin_),
                                upper_.data() + 2 * start, lower_.data() + 2 * start, width_.data() + 2 * start},
                               count_ - start, line.kappa, 1 / grid_.column_angle, 1 / grid_.row_angle,
                               longest < 0.02 ? 2 : 3, frame.direction < 0);
}

/// Texels [begin, end) along a line, split where psi = 0.
void TileBuilder::add_line(const Line& line, const LineFrame& outward, const LineFrame* inward, int begin, int end) {
    const int first_outward = size_ / 2;  // the first texel that reaches beyond psi = 0
    const int end_inward = (size_ + 1) / 2;
    if (end > first_outward) add_part(line, outward, std::max(begin, first_outward), end, 1);
    if (begin < end_inward && inward) add_part(line, *inward, std::min(end, end_inward) - 1, begin - 1, -1);
}

void TileBuilder::add_side_lines(const TileShape& shape, const ColumnPhase& columns) {
    const int across = shape.i1 - shape.i0;
    for (int j = shape.j0; j <= shape.j1; ++j) {
        const int above = j > shape.j0 ? (j - 1 - shape.j0) * across : k_nobody,
                  below = j < shape.j1 ? (j - shape.j0) * across : k_nobody;
        // The middle row of an odd size: its upper half, down to the equator.
        const double t = std::max(0, size_ - 2 * j) / double(size_);
        add_line({t, 1.0 / size_, above, below, 1, shape.i0}, columns.forward, &columns.backward, shape.i0, shape.i1);
    }
}

void TileBuilder::add_polar_lines(const TileShape& shape, const ColumnPhase& columns) {
    const int across = shape.i1 - shape.i0;
    // x = const: above it (nearer the pole) the texel of smaller x.
    for (int i = shape.i0; i <= shape.i1; ++i) {
        const int x = 2 * i - size_;
        if (x == 0) continue;  // a meridian
        add_line({double(size_) / x, 1.0 / x, i > shape.i0 ? i - 1 - shape.i0 : k_nobody,
                  i < shape.i1 ? i - shape.i0 : k_nobody, across, shape.j0},
                 columns.forward, &columns.backward, shape.j0, shape.j1);
    }
    for (int j = shape.j0; j <= shape.j1; ++j) {
        const int z = 2 * j - size_;
        if (z == 0) continue;
        const int before = j > shape.j0 ? (j - 1 - shape.j0) * across : k_nobody,
                  after = j < shape.j1 ? (j - shape.j0) * across : k_nobody;
        const double scale = 1.0 / std::abs(z);
        if (z > 0)
            add_line({double(size_) / z, scale, before, after, 1, shape.i0}, columns.from_z, nullptr, shape.i0,
                     shape.i1);
        else  // the far side of a texel that straddles z = 0
            add_line({double(size_) / -z, scale, after, k_nobody, 1, shape.i0}, columns.from_minus_z, nullptr, shape.i0,
                     shape.i1);
    }
}

/// Adds a run's pieces to one of its texels.
void TileBuilder::add_run(const Run& run, int texel, double sign) {
    const Box& box = boxes_[texel];
    const int cells = box.columns(), columns = box.node_columns();
    double* nodes = nodes_.data() + box.nodes;
    double* widths = widths_.data() + box.widths;
    for (int p = run.first; p < run.last; ++p) {
        const int c = column_[p] - box.column0, j = row_[p] - box.row0;
        double *above = nodes + j * columns + c, *below = above + columns, *width = widths + 2 * (j * cells + c);
        for (int side = 0; side < 2; ++side) above[side] += sign * upper_[2 * p + side];
        for (int side = 0; side < 2; ++side) below[side] += sign * lower_[2 * p + side];
        for (int side = 0; side < 2; ++side) width[side] += sign * width_[2 * p + side];
    }
}

void TileBuilder::scatter() {
    std::size_t nodes = 0, widths = 0;
    for (Box& b : boxes_) {
        b.nodes = nodes;
        b.widths = widths;
        if (b.empty()) continue;
        nodes += std::size_t(b.node_columns()) * (b.rows() + 1);
        widths += std::size_t(b.columns()) * b.rows() * 2;
    }
    nodes_.assign(nodes, 0.0);
    widths_.assign(widths, 0.0);
    for (const Run& run : runs_) {
        if (run.plus >= 0) add_run(run, run.plus, 1);
        if (run.minus >= 0) add_run(run, run.minus, -1);
    }
}

/// The source rows and columns of a texel's weights. `mirrored`: the texel is this and its mirror image in the equator.
simd::Stencil TileBuilder::shape_of(const Box& box, bool mirrored) const {
    // Rows -1 and H are rows 0 and H - 1 again: v clamps.
    const int last_row = grid_.height - 1;
    int first = std::max(box.row0, 0), last = std::min(box.row1 + 1, last_row);
    if (mirrored) {
        first = std::min(first, last_row - last);
        last = last_row - first;
    }
    return {first, box.column0, last - first + 1, box.node_columns(), 0};
}

/// Adds to every cell the part of it that lies above the pieces in lower cells.
void TileBuilder::sum_cells(const Box& box) {
    const int cells = box.columns(), columns = box.node_columns();
    double* nodes = nodes_.data() + box.nodes;
    const double* widths = widths_.data() + box.widths;
    for (int c = 0; c < cells; ++c) {
        double left = 0, right = 0;
        for (int j = box.rows() - 2; j >= 0; --j) {
            left += widths[2 * ((j + 1) * cells + c)];
            right += widths[2 * ((j + 1) * cells + c) + 1];
            const double upper = grid_.whole_upper[box.row0 + j + 1], lower = grid_.whole_lower[box.row0 + j + 1];
            double* node = nodes + j * columns + c;
            node[0] += upper * left;
            node[1] += upper * right;
            node[columns] += lower * left;
            node[columns + 1] += lower * right;
        }
    }
}

/// The weights of a texel, scaled by 1 / `total`, or (0) to the sum 1.
void TileBuilder::store_weights(const Box& box, const simd::Stencil& s, bool mirrored, double total, float* to) {
    const int columns = s.columns, count = s.rows * columns, last_row = grid_.height - 1;
    const double* from = nodes_.data() + box.nodes;
    if (mirrored || s.rows != box.rows() + 1) {
        folded_.assign(count, 0.0);
        for (int j = 0; j <= box.rows(); ++j)
            for (int c = 0; c < columns; ++c) {
                const int row = std::clamp(box.row0 + j, 0, last_row);
                folded_[(row - s.row) * columns + c] += from[j * columns + c];
                if (mirrored) folded_[(last_row - row - s.row) * columns + c] += from[j * columns + c];
            }
        from = folded_.data();
    }
    // Below zero only by rounding.
    const auto weight = [&](int k) { return from[k] > 0 ? from[k] : 0; };
    double even = 0, odd = 0;
    for (int k = 0; k < count; k += 2) {
        even += weight(k);
        odd += weight(k + 1);
    }
    const double scale = 1 / (total > 0 ? total : even + odd);
    for (int k = 0; k < count; ++k) to[k] = float(weight(k) * scale);
}

/// The tile from the collected pieces; texels from `first_mirrored` on are one half of what the equator divides.
Tile TileBuilder::finish(int first_mirrored, double total) {
    scatter();
    std::size_t weights = 0;
    for (std::size_t k = 0; k < boxes_.size(); ++k) {
        const simd::Stencil s = shape_of(boxes_[k], int(k) >= first_mirrored);
        weights += std::size_t(s.rows) * s.columns;
    }
    const std::size_t header = boxes_.size() * sizeof(simd::Stencil);
    std::byte* memory = arena_.allocate(header + weights * sizeof(float));
    constexpr int least = std::numeric_limits<int>::min(), greatest = std::numeric_limits<int>::max();
    Tile tile{{reinterpret_cast<simd::Stencil*>(memory), boxes_.size()},
              reinterpret_cast<float*>(memory + header),
              greatest,
              least,
              greatest,
              least};
    float* to = reinterpret_cast<float*>(memory + header);
    std::uint32_t first = 0;
    for (std::size_t k = 0; k < boxes_.size(); ++k) {
        const Box& box = boxes_[k];
        const bool mirrored = int(k) >= first_mirrored;
        simd::Stencil& s = tile.stencils[k] = shape_of(box, mirrored);
        s.first = first;
        sum_cells(box);
        store_weights(box, s, mirrored, total, to + first);
        first += s.rows * s.columns;
        tile.first_row = std::min(tile.first_row, s.row);
        tile.last_row = std::max(tile.last_row, s.row + s.rows - 1);
        tile.first_column = std::min(tile.first_column, s.column);
        tile.last_column = std::max(tile.last_column, s.column + s.columns - 1);
    }
    return tile;
}

std::byte* StencilArena::allocate(std::size_t bytes) {
    bytes = (bytes + 63) / 64 * 64;
    const Lock lock(mutex_);
    if (blocks_.empty() || used_ + bytes > blocks_.back().size()) {
        blocks_.emplace_back(std::max(k_block, bytes), false);
        used_ = 0;
    }
    std::byte* place = blocks_.back().data() + used_;
    used_ += bytes;
    return place;
}

Tile TileBuilder::build(const TileShape& shape, const ColumnPhase& columns) {
    const int across = shape.i1 - shape.i0, down = shape.j1 - shape.j0, texels = across * down;
    clear(texels);
    if (shape.polar) {
        add_polar_lines(shape, columns);
        // Even size: the texel that touches the pole reaches up to it.
        if (2 * shape.i0 == size_ && 2 * shape.j0 == size_) boxes_[0].row0 = -1;
        return finish(texels, 0);
    }
    add_side_lines(shape, columns);
    return finish(size_ % 2 && shape.j1 == (size_ + 1) / 2 ? texels - across : texels, 0);
}

Tile TileBuilder::build_pole_quarter(const ColumnPhase& columns) {
    clear(1);
    const int middle = size_ / 2;
    // The outer border x = 1 / size: texel `middle` along z.
    add_line({double(size_), 1, 0, k_nobody, 1, middle}, columns.forward, &columns.backward, middle, middle + 1);
    boxes_[0].row0 = -1;
    return finish(1, 0.25 * cube_solid_angle(middle, middle, size_));
}

}  // namespace domelight::area
