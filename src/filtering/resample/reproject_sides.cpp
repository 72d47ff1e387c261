#include "filtering/resample/reproject_sides.h"

#include <algorithm>
#include <cmath>

namespace domelight::reproject_detail {

bool SideIntegrator::prepare(const Source& source, const Block& block) {
    box_ = source_box(block);
    if (box_.too_large()) return false;
    find_ranges(block);
    const std::size_t cells = std::size_t(box_.width()) * box_.height() * simd::k_cell_doubles;
    if (cells_.size() < cells) cells_ = AlignedArray<double>(cells, false);
    density_slope_.resize(std::size_t(box_.height()));
    is_even_ = true;
    for (int y = 0; y < box_.height(); ++y) {
        const double slope = source.density_slope(std::clamp(box_.y0 + y, 0, source.height() - 1));
        density_slope_[std::size_t(y)] = slope;
        is_even_ = is_even_ && slope == 0;
        if (ranges_[std::size_t(y)].first < ranges_[std::size_t(y)].end)
            fill_row(source, block.first.chart, y, ranges_[std::size_t(y)]);
    }
    return true;
}

/// The columns between the block's outermost sides, and one more on either side. Sides of several parts are curved: they
/// may touch all of the box.
void SideIntegrator::find_ranges(const Block& block) {
    if (block.parts > 1) {
        ranges_.assign(std::size_t(box_.height()), {0, box_.width()});
        return;
    }
    ranges_.assign(std::size_t(box_.height()), {box_.width(), 0});
    const auto include = [&](std::size_t a, std::size_t b) {
        const auto [left, right] = std::minmax(block.x[a], block.x[b]);
        const auto [top, bottom] = std::minmax(block.y[a], block.y[b]);
        const int first = std::max(0, int(std::floor(left)) - 1 - box_.x0),
                  end = std::min(box_.width(), int(std::floor(right)) + 2 - box_.x0),
                  last_row = std::min(box_.height() - 1, int(std::floor(bottom)) + 1 - box_.y0);
        for (int y = std::max(0, int(std::floor(top)) - 1 - box_.y0); y <= last_row; ++y) {
            Range& r = ranges_[std::size_t(y)];
            r = {std::min(r.first, first), std::max(r.end, end)};
        }
    };
    for (int i = 0; i + 1 < block.nx; ++i)
        for (const int j : {0, block.ny - 1}) include(block.corner(i, j), block.corner(i + 1, j));
    for (int j = 0; j + 1 < block.ny; ++j)
        for (const int i : {0, block.nx - 1}) include(block.corner(i, j), block.corner(i, j + 1));
}

void SideIntegrator::fill_row(const Source& source, int chart, int y, Range range) {
    const int row = std::clamp(box_.y0 + y, 0, source.height() - 1), count = range.end - range.first;
    const std::size_t stride = 3 * std::size_t(count) + 2 * simd::k_cell_slack;
    value_.resize(5 * stride);
    cell_.resize(std::size_t(count));
    solid_angle_.resize(std::size_t(count));
    // The functions of the texels that the range names, each once: runs of consecutive columns.
    std::size_t filled = 0;
    int previous = -1, run_first = 0, run_length = 0;
    const auto fill_run = [&] {
        if (run_length == 0) return;
        simd::CellRow cells{{}, density_slope_[std::size_t(y)], {}};
        for (int k = 0; k < 5; ++k) {
            cells.rows[k] = source.texel(chart, run_first, row + k - 2);
            cells.value[k] = value_.data() + std::size_t(k) * stride + 3 * filled;
        }
        simd::fill_cell_row(cells, 3 * std::size_t(run_length));
        filled += std::size_t(run_length), run_length = 0;
    };
    for (int k = 0; k < count; ++k) {
        const int column = source.column(box_.x0 + range.first + k);
        if (column != previous) {
            if (run_length == 0 || column != previous + 1) fill_run(), run_first = column;
            ++run_length;
        }
        previous = column;
        cell_[std::size_t(k)] = int(filled) + run_length - 1;
        solid_angle_[std::size_t(k)] = source.solid_angle(column, row);
    }
    fill_run();
    const double* value[5];
    for (std::size_t k = 0; k < 5; ++k) value[k] = value_.data() + k * stride;
    simd::sum_cell_row(value, cell_, solid_angle_.data(),
                       cells_.data() + simd::k_cell_doubles * (std::size_t(y) * box_.width() + range.first));
}

void SideIntegrator::begin_lines(std::size_t count) {
    const std::size_t size = count + simd::k_cell_slack;
    for (auto* a : {&ax_, &ay_, &bx_, &by_})
        if (a->size() < size) a->resize(size);
    if (line_sums_.size() < 4 * size) line_sums_.resize(4 * size);
}

void SideIntegrator::run(std::size_t count) {
    // What the last vector holds beyond the lines must be finite: the last line's repetitions.
    for (std::size_t k = count; k < count + simd::k_cell_slack; ++k)
        ax_[k] = bx_[k] = ax_[count - 1], ay_[k] = by_[k] = ay_[count - 1];
    const simd::SideTile tile{cells_.data(), density_slope_.data(), double(box_.x0), double(box_.y0),
                              box_.width(),  box_.height(),         is_even_};
    simd::integrate_sides(tile, {ax_.data(), ay_.data(), bx_.data(), by_.data(), line_sums_.data()}, count);
}

void SideIntegrator::add_up(int parts, std::size_t first, std::vector<SideSum>& sums) const {
    const double* p = line_sums_.data() + 4 * first;
    for (SideSum& sum : sums) {
        sum = {};
        for (int k = 0; k < parts; ++k, p += 4)
            for (std::size_t c = 0; c < 4; ++c) sum[c] += p[c];
    }
}

void SideIntegrator::integrate(const Block& block, const PlaceOf& place, SideSums& sums) {
    const int nx = block.nx, ny = block.ny;
    const std::size_t across = std::size_t(nx - 1) * ny, down = std::size_t(nx) * (ny - 1),
                      count = (across + down) * std::size_t(block.parts);
    begin_lines(count);
    std::size_t n = 0;
    for (int j = 0; j < ny; ++j)
        for (int i = 0; i + 1 < nx; ++i) n = add_side(block, place, i, j, 1, 0, n);
    for (int j = 0; j + 1 < ny; ++j)
        for (int i = 0; i < nx; ++i) n = add_side(block, place, i, j, 0, 1, n);
    run(count);
    sums.across.resize(across), sums.down.resize(down);
    add_up(block.parts, 0, sums.across);
    add_up(block.parts, across * std::size_t(block.parts), sums.down);
}

std::size_t SideIntegrator::add_side(const Block& block, const PlaceOf& place, int i, int j, int di, int dj,
                                     std::size_t n) {
    const std::size_t a = block.corner(i, j), b = block.corner(i + di, j + dj);
    ax_[n] = block.x[a], ay_[n] = block.y[a];
    for (int k = 1; k < block.parts; ++k, ++n) {
        const double s = double(k) / block.parts;
        const SourcePoint p = place(block.x0 + i + s * di, block.y0 + j + s * dj);
        ax_[n + 1] = bx_[n] = p.x, ay_[n + 1] = by_[n] = p.y;
    }
    bx_[n] = block.x[b], by_[n] = block.y[b];
    return n + 1;
}

}  // namespace domelight::reproject_detail
