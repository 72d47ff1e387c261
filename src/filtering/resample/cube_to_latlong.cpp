#include "filtering/resample/cube_to_latlong.h"

#include "domelight/base/parallel.h"
#include "domelight/projection/projection.h"

#include "base/sort.h"
#include "filtering/resample/area_resample_arc.h"
#include "filtering/resample/resize_latlong.h"
#include "projection/bordered_cube.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

// The frame: azimuth phi from +x towards +z, theta from +y. Side face q looks to the azimuth q * 90 degrees; the sector
// within 45 degrees of it, from pole to pole, belongs to it, so that by turns of 90 degrees every sector is that of +x.
// There, with phi from -45 to 45 degrees, the side face has s = tan phi along growing azimuth and height
// h = cot theta / cos phi, and the polar face has x = tan theta cos phi and z = tan theta sin phi. The lines of texel
// centres, s and z = c, h = c, x = c, and the edge between the two faces, h = x = 1, divide a sector into cells, and g
// is bilinear on a cell.
//
// ∫ g dω over a lat-long texel = ∫ dphi ∫ g sin theta dtheta. The texel's columns are cut wherever the inner integral
// starts or ceases to cross a cell; between the cuts it is smooth, and few Gauss-Legendre nodes are exact to rounding.

namespace domelight::area {

namespace {

constexpr double k_quarter_turn = 0.5 * k_pi;

/// Texels (i, j) = -1 .. size of a bordered face, in the order of the frame above.
struct FaceTexels {
    const float* origin = nullptr;
    std::ptrdiff_t step_i = 0, step_j = 0;
    const float* at(int i, int j) const { return origin + i * step_i + j * step_j; }
};

/// The two faces of a sector of one hemisphere: of the side face, i along growing azimuth and j from the pole towards
/// the equator; of the polar face, i along x and j along z.
struct Sector {
    FaceTexels side, polar;
};

/// The texels of the face whose point (a, b), -1 to 1 each along i and j, lies in the direction `direction(a, b)`.
template <typename Direction>
FaceTexels face_texels(const BorderedCube& cube, const Direction& direction) {
    const auto point = [&](double a, double b) { return cube_point(direction(a, b)); };
    const CubePoint middle = point(0, 0), along_i = point(0.5, 0), along_j = point(0, 0.5);
    // Texels of the face's own columns and rows to one step of i or j: 1, 0 or -1.
    const auto step = [&](const CubePoint& p) {
        const auto column = std::lround(4 * (p.uv.u - middle.uv.u)), row = std::lround(4 * (p.uv.v - middle.uv.v));
        return (cube.texel(0, int(column), int(row)) - cube.texel(0, 0, 0));
    };
    FaceTexels texels{nullptr, step(along_i), step(along_j)};
    const auto first = [&](double i, double j) { return 0.5 * (1 - i - j) * (cube.size() - 1); };
    const double iu = 4 * (along_i.uv.u - middle.uv.u), ju = 4 * (along_j.uv.u - middle.uv.u);
    const double iv = 4 * (along_i.uv.v - middle.uv.v), jv = 4 * (along_j.uv.v - middle.uv.v);
    texels.origin = cube.texel(middle.face, int(std::lround(first(iu, ju))), int(std::lround(first(iv, jv))));
    return texels;
}

/// A symmetry of the frame's grid of cells: south, or mirrored in the plane z = 0, or both.
struct Image {
    bool south = false, mirrored = false;
};

/// The image of the sector about the azimuth `quarter` * 90 degrees; `axes` takes the frame's directions to the cube's.
Sector sector_of(const BorderedCube& cube, const Mat3& axes, int quarter, Image image) {
    const auto turned = [&](Vec3d d) {
        for (int q = 0; q < quarter; ++q) d = {-d.z, d.y, d.x};  // +x to +z
        return axes * Vec3d{d.x, d.y, image.mirrored ? -d.z : d.z};
    };
    const double up = image.south ? -1 : 1;
    return {face_texels(cube,
                        [&](double a, double b) {
                            return turned({1, -b * up, a});
                        }),
            face_texels(cube, [&](double a, double b) {
                return turned({a, up, b});
            })};
}

/// The weights of the four texels (i, j), (i + 1, j), (i, j + 1), (i + 1, j + 1) of a cell, in sector `quarter`.
struct CellWeights {
    int quarter = 0, i = 0, j = 0;
    bool polar = false;
    std::array<double, 4> weights{};

    bool same_cell(const CellWeights& c) const {
        return i == c.i && j == c.j && polar == c.polar && quarter == c.quarter;
    }
};

/// Where a meridian leaves a cell.
enum class Exit { x, z, edge, height, texel };

/// A cell that a meridian crosses, and the line by which it leaves it.
struct Crossing {
    bool polar = false;
    int i = 0, j = 0;
    Exit exit = Exit::texel;
    double line = 0;  ///< where the line x, z or h = line is
};

/// The rows [theta0, theta1] of the output, on the northern hemisphere.
struct RowLimits {
    double tan0 = 0, tan1 = 0;  ///< tan theta
    double cot0 = 0, cot1 = 0;
};

/// The integrals along a meridian.
class Meridians {
  public:
    explicit Meridians(int size) : size_(size) {}

    double centre(int index) const { return (2 * index + 1.0) / size_ - 1; }
    /// The cell of a coordinate from -1 to 1.
    int cell(double place) const {
        return std::clamp(int(std::floor((0.5 * place + 0.5) * size_ - 0.5)), -1, size_ - 1);
    }

    /// Finds the cells that the meridian `phi` crosses between two parallels, from the pole down.
    void find_crossings(double phi, const RowLimits& row, std::vector<Crossing>& out) const {
        out.clear();
        const double c = std::cos(phi), s = std::sin(phi);
        if (row.tan0 * c < 1) polar_crossings(c, s, row, out);
        if (row.tan1 * c > 1) side_crossings(c, s / c, row, out);
    }

    /// Adds `dphi` times the integrals along the meridian `phi`, which crosses the same cells, to their weights.
    void add(double phi, double dphi, const RowLimits& row, const std::vector<Crossing>& crossings,
             std::vector<CellWeights>& cells) const {
        const double c = std::cos(phi), s = std::sin(phi);
        double place = row.tan0;  // tan theta on the polar face
        Height height = height_at(std::min(row.cot0, c));
        for (std::size_t k = 0; k < crossings.size(); ++k) {
            const Crossing& crossing = crossings[k];
            if (crossing.polar) {
                const double end = std::clamp(polar_end(crossing, c, s, row), place, std::max(place, row.tan1));
                add_polar(crossing, c, s, place, end, dphi, cells[k].weights);
                place = end;
            } else {
                const double end = crossing.exit == Exit::height ? crossing.line * c : row.cot1;
                const Height lower = height_at(std::clamp(end, std::min(row.cot1, height.cot), height.cot));
                add_side(crossing, c, s / c, height, lower, dphi, cells[k].weights);
                height = lower;
            }
        }
    }

  private:
    struct Height {
        double cot, cos, sin;  ///< of theta
    };
    static Height height_at(double cot) {
        const double sin = 1 / std::sqrt(1 + cot * cot);
        return {cot, cot * sin, sin};
    }

    void polar_crossings(double c, double s, const RowLimits& row, std::vector<Crossing>& out) const {
        int i = cell(row.tan0 * c), j = cell(row.tan0 * s);
        const int step_j = s < 0 ? -1 : 1;
        const double never = 1e300, end = std::min(row.tan1, 1 / c);
        while (true) {
            const double x = centre(i + 1), z = centre(s < 0 ? j : j + 1);
            const double at_x = i + 1 < size_ ? x / c : never;
            const double at_z = s != 0 && j + step_j >= -1 && j + step_j < size_ ? z / s : never;
            const double next = std::min(at_x, at_z);
            if (next >= end) break;
            out.push_back({true, i, j, at_x <= at_z ? Exit::x : Exit::z, at_x <= at_z ? x : z});
            if (at_x <= at_z)
                ++i;
            else
                j += step_j;
        }
        out.push_back({true, i, j, row.tan1 * c > 1 ? Exit::edge : Exit::texel, 0});
    }

    void side_crossings(double c, double s, const RowLimits& row, std::vector<Crossing>& out) const {
        const int i = cell(s);
        int j = cell(-std::min(1.0, row.cot0 / c));
        for (; j + 1 < size_ && -centre(j + 1) * c > row.cot1; ++j)
            out.push_back({false, i, j, Exit::height, -centre(j + 1)});
        out.push_back({false, i, j, Exit::texel, 0});
    }

    static double polar_end(const Crossing& crossing, double c, double s, const RowLimits& row) {
        switch (crossing.exit) {
            case Exit::x:
                return crossing.line / c;
            case Exit::z:
                return crossing.line / s;
            case Exit::edge:
                return 1 / c;
            default:
                return row.tan1;
        }
    }

    /// ∫ g sin theta dtheta in a cell of the polar face, with t = tan theta: sin theta dtheta = t (1 + t^2)^(-3/2) dt.
    void add_polar(const Crossing& cell, double c, double s, double from, double to, double dphi,
                   std::array<double, 4>& weights) const {
        if (!(to > from)) return;
        if (to - from > 0.1) {
            add_polar(cell, c, s, from, 0.5 * (from + to), dphi, weights);
            add_polar(cell, c, s, 0.5 * (from + to), to, dphi, weights);
            return;
        }
        const GaussRule& rule = to - from < 0.02 ? k_gauss3 : k_gauss5;
        const double half = 0.5 * (to - from), middle = 0.5 * (from + to);
        for (int k = 0; k < rule.count; ++k) {
            const double t = middle + half * rule.node[k], q = 1 + t * t;
            const double w = dphi * half * rule.weight[k] * t / (q * std::sqrt(q));
            const double u = (t * c - centre(cell.i)) * 0.5 * size_, v = (t * s - centre(cell.j)) * 0.5 * size_;
            const double lower = w * v, upper = w - lower, lower_right = lower * u, upper_right = upper * u;
            weights[0] += upper - upper_right;
            weights[1] += upper_right;
            weights[2] += lower - lower_right;
            weights[3] += lower_right;
        }
    }

    /// The same in a cell of the side face, where h sin theta = cos theta / cos phi and g is linear in h.
    void add_side(const Crossing& cell, double c, double s, const Height& from, const Height& to, double dphi,
                  std::array<double, 4>& weights) const {
        const double whole = dphi * (from.cos - to.cos), first = dphi * (to.sin - from.sin) / c;
        const double lower = (-first - centre(cell.j) * whole) * 0.5 * size_, upper = whole - lower;
        const double u = (s - centre(cell.i)) * 0.5 * size_;
        weights[0] += upper * (1 - u);
        weights[1] += upper * u;
        weights[2] += lower * (1 - u);
        weights[3] += lower * u;
    }

    int size_;
};

/// The azimuths, -45 to 45 degrees, at which a sector's columns are cut.
class Cuts {
  public:
    Cuts(const Meridians& meridians, int size) : meridians_(meridians), size_(size) {}

    /// Appends those of a row: where it meets lines of texel centres, their crossings, and the edge.
    void append(const RowLimits& row, std::vector<double>& out) const {
        const double least_cos = std::sqrt(0.5);
        if (row.tan1 > 1)  // it reaches beyond the edge
            for (int i = 0; i < size_; ++i) out.push_back(std::atan(meridians_.centre(i)));
        for (const double cot : {row.cot0, row.cot1}) {
            if (cot < 1) append_both(std::acos(cot), out);
            // h = c: cos phi = cot theta / c
            for (int j = size_ - 1; j >= 0 && meridians_.centre(j) > cot; --j)
                append_both(std::acos(cot / meridians_.centre(j)), out);
        }
        if (row.tan0 * least_cos >= 1) return;
        for (const double tan : {row.tan0, row.tan1}) append_circle(tan, out);
        append_vertices(row, out);
    }

  private:
    static void append_both(double phi, std::vector<double>& out) {
        if (phi > 0.25 * k_pi) return;
        out.push_back(phi);
        out.push_back(-phi);
    }

    /// Where the parallel of this tan theta crosses x = c and z = c on the polar face.
    void append_circle(double tan, std::vector<double>& out) const {
        for (int i = size_ - 1; i >= 0 && meridians_.centre(i) > 0; --i) {
            const double c = meridians_.centre(i);
            if (c > tan) continue;
            append_both(std::acos(c / tan), out);
            append_both(std::asin(c / tan), out);
        }
        if (size_ % 2) out.push_back(0);
    }

    /// Where lines x = c and z = c cross each other between the two parallels.
    void append_vertices(const RowLimits& row, std::vector<double>& out) const {
        const double far = std::min(row.tan1, 2.0);
        for (int i = size_ - 1; i >= 0 && meridians_.centre(i) > 0; --i) {
            const double x = meridians_.centre(i);
            if (x > far) continue;
            const double least = std::sqrt(std::max(0.0, row.tan0 * row.tan0 - x * x)),
                         most = std::min(x, std::sqrt(far * far - x * x));
            for (int j = std::max(size_ / 2, meridians_.cell(least)); j < size_ && meridians_.centre(j) <= most; ++j)
                append_both(std::atan2(meridians_.centre(j), x), out);
        }
    }

    const Meridians& meridians_;
    int size_;
};

/// Averages into the rows of a lat-long image.
class LatlongAverager {
  public:
    LatlongAverager(const Cubemap& source, int out_height, const AlignedOrientation& orientation)
        : size_(source.size()),
          height_(out_height),
          width_(2 * out_height),
          turns_(width_ % 4 ? 2 : 4),
          mirrors_(orientation.angle == 0 && width_ / turns_ % 2 == 0),
          columns_(width_ / turns_ / (mirrors_ ? 2 : 1)),
          start_(-orientation.angle - k_pi),
          cube_(source),
          meridians_(size_),
          out_(width_, height_, 3) {
        const Mat3 axes = orientation.axes.transposed();
        for (int q = 0; q < 4; ++q)
            for (const bool south : {false, true})
                for (const bool mirrored : {false, true})
                    sectors_[south][mirrored][q] = sector_of(cube_, axes, q, {south, mirrored});
        const auto [least, greatest] = std::minmax_element(source.pixels().begin(), source.pixels().end());
        least_ = *least, greatest_ = *greatest;
    }

    /// Row y of the upper half (the middle one of an odd height included) and its mirror image in the equator.
    void make_row(int y);

    ImageF finish() { return std::move(out_); }

  private:
    struct Work {
        std::vector<double> cuts;
        std::vector<Crossing> crossings;
        std::vector<CellWeights> piece, texel;
    };

    void add_piece(double a, double b, int quarter, const RowLimits& row, Work& work) const;
    void integrate(double a, double b, const RowLimits& row, Work& work) const;
    void merge(Work& work) const;
    void store(int x, int y, std::vector<CellWeights>& texel);
    void store_images(int x, int y, const std::vector<CellWeights>& texel, bool mirrored, int turn);
    Vec3d mean(const std::vector<CellWeights>& texel, Image image, int turn) const;
    void put(int x, int y, const Vec3d& g);

    int size_, height_, width_;
    int turns_;     ///< the number of turns about the axis that take columns to columns and sectors to sectors
    bool mirrors_;  ///< whether a column's mirror image in the plane z = 0 is a column too
    int columns_;   ///< the first ones, of which all others are turned or mirrored images
    double start_;  ///< azimuth of the left edge of column 0
    BorderedCube cube_;
    Meridians meridians_;
    std::array<std::array<std::array<Sector, 4>, 2>, 2> sectors_;  ///< by Image::south, Image::mirrored and quarter
    double least_ = 0, greatest_ = 0;
    ImageF out_;
};

void LatlongAverager::make_row(int y) {
    const double theta0 = k_pi * y / height_, theta1 = std::min(0.5 * k_pi, k_pi * (y + 1) / height_);
    const bool to_equator = 2 * (y + 1) >= height_;
    RowLimits row{std::tan(theta0), to_equator ? 1e300 : std::tan(theta1), 0, 0};
    row.cot0 = y > 0 ? 1 / row.tan0 : 1e300;
    row.cot1 = to_equator ? 0 : 1 / row.tan1;

    const double column_angle = 2 * k_pi / width_, end = start_ + columns_ * column_angle;
    Work work;
    std::vector<double> row_cuts, cuts;
    Cuts(meridians_, size_).append(row, row_cuts);
    int column = 0;
    for (int q = int(std::floor(start_ / k_quarter_turn + 0.5)); (q - 0.5) * k_quarter_turn < end; ++q) {
        const double middle = q * k_quarter_turn, from = std::max(start_ - middle, -0.25 * k_pi),
                     to = std::min(end - middle, 0.25 * k_pi);
        if (!(to > from)) continue;
        cuts.assign({from, to});
        for (const double cut : row_cuts)
            if (cut > from && cut < to) cuts.push_back(cut);
        for (int x = column; x <= columns_; ++x)
            if (const double cut = start_ + x * column_angle - middle; cut > from && cut < to) cuts.push_back(cut);
        sort_items(cuts);
        for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
            const double at = 0.5 * (cuts[k] + cuts[k + 1]) + middle - start_;
            const int x = std::clamp(int(at / column_angle), column, columns_ - 1);
            if (x > column) store(column, y, work.texel);
            column = x;
            add_piece(cuts[k], cuts[k + 1], q, row, work);
        }
    }
    store(column, y, work.texel);
}

/// Adds the part of a texel between two cuts.
void LatlongAverager::add_piece(double a, double b, int quarter, const RowLimits& row, Work& work) const {
    if (!(b > a)) return;
    meridians_.find_crossings(0.5 * (a + b), row, work.crossings);
    work.piece.clear();
    for (const Crossing& c : work.crossings) work.piece.push_back({quarter & 3, c.i, c.j, c.polar, {}});
    integrate(a, b, row, work);
    merge(work);
}

void LatlongAverager::integrate(double a, double b, const RowLimits& row, Work& work) const {
    const double size = b - a, middle = 0.5 * (a + b);
    // The line z = c crosses a meridian at tan theta = c / sin phi: pieces must be short against the distance from 0.
    const bool crosses_z = std::ranges::any_of(work.crossings, [](const Crossing& c) { return c.exit == Exit::z; });
    const double near = crosses_z ? std::min(0.2, std::abs(middle) - 0.5 * size) : 0.2;
    if (size > 0.5 * near && size > 1e-10) {
        integrate(a, middle, row, work);
        integrate(middle, b, row, work);
        return;
    }
    const GaussRule& rule = size < 0.03 * near ? k_gauss3 : k_gauss5;
    for (int k = 0; k < rule.count; ++k)
        meridians_.add(middle + 0.5 * size * rule.node[k], 0.5 * size * rule.weight[k], row, work.crossings,
                       work.piece);
}

/// Adds a piece's cells to its texel's.
void LatlongAverager::merge(Work& work) const {
    constexpr std::size_t k_looked_at = 12;  // of the latest cells; one that was added before may stand twice
    for (const CellWeights& cell : work.piece) {
        std::size_t k = work.texel.size();
        const std::size_t least = k > k_looked_at ? k - k_looked_at : 0;
        while (k > least && !work.texel[k - 1].same_cell(cell)) --k;
        if (k == least) {
            work.texel.push_back(cell);
            continue;
        }
        for (std::size_t c = 0; c < 4; ++c) work.texel[k - 1].weights[c] += cell.weights[c];
    }
}

/// Writes the texel's mean wherever its weights apply, and clears them.
void LatlongAverager::store(int x, int y, std::vector<CellWeights>& texel) {
    double total = 0;
    for (const CellWeights& cell : texel)
        for (const double w : cell.weights) total += w;
    for (CellWeights& cell : texel)
        for (double& w : cell.weights) w /= total;
    for (int t = 0; t < turns_; ++t) {
        const int turned = t * (width_ / turns_), quarters = t * (4 / turns_);
        store_images(x + turned, y, texel, false, quarters);
        // The left edge of column 0 is at the azimuth -180 degrees, in the plane of the mirror.
        if (mirrors_) store_images((width_ - 1 - x + turned) % width_, y, texel, true, quarters);
    }
    texel.clear();
}

void LatlongAverager::store_images(int x, int y, const std::vector<CellWeights>& texel, bool mirrored, int turn) {
    const Vec3d north = mean(texel, {false, mirrored}, turn), south = mean(texel, {true, mirrored}, turn);
    const bool middle = 2 * y + 1 == height_;
    put(x, y, middle ? (north + south) * 0.5 : north);
    if (!middle) put(x, height_ - 1 - y, south);
}

/// The mean of a texel's image, turned by `turn` * 90 degrees (after the mirror).
Vec3d LatlongAverager::mean(const std::vector<CellWeights>& texel, Image image, int turn) const {
    const auto& sectors = sectors_[image.south][image.mirrored];
    double sum[3] = {};
    for (const CellWeights& cell : texel) {
        const Sector& sector = sectors[(cell.quarter + (image.mirrored ? -turn : turn)) & 3];
        const FaceTexels& face = cell.polar ? sector.polar : sector.side;
        const float *a = face.at(cell.i, cell.j), *b = a + face.step_i, *c = a + face.step_j, *d = c + face.step_i;
        const auto& w = cell.weights;
        for (int k = 0; k < 3; ++k) sum[k] += w[0] * a[k] + w[1] * b[k] + w[2] * c[k] + w[3] * d[k];
    }
    return {sum[0], sum[1], sum[2]};
}

/// An average lies between the least and the greatest texel; rounding must not move it outside (below zero, for example).
void LatlongAverager::put(int x, int y, const Vec3d& g) {
    float* to = out_.at(x, y);
    to[0] = float(std::clamp(g.x, least_, greatest_));
    to[1] = float(std::clamp(g.y, least_, greatest_));
    to[2] = float(std::clamp(g.z, least_, greatest_));
}

}  // namespace

ImageF aligned_cube_to_latlong(const Cubemap& source, int out_height, const AlignedOrientation& source_to_world,
                               int threads) {
    assert(source.channels() == 3);
    // A texel that covers many of the cube's is the mean of smaller ones: the work grows with the number of cells times
    // that of the columns' cuts in a texel.
    if (2 * out_height < source.size()) {
        const int factor = (source.size() + 2 * out_height - 1) / (2 * out_height);
        const ImageF fine = aligned_cube_to_latlong(source, factor * out_height, source_to_world, threads);
        return resize_latlong(fine, 2 * out_height, out_height);
    }
    LatlongAverager averager(source, out_height, source_to_world);
    parallel_for((out_height + 1) / 2, threads, [&](int y) { averager.make_row(y); });
    return averager.finish();
}

}  // namespace domelight::area
