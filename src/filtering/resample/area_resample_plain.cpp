#include "filtering/resample/area_resample_plain.h"

#include "domelight/base/parallel.h"

#include "base/sort.h"

#include <algorithm>

namespace domelight::area {

SineMoments sine_moments(double a, double b) {
    const double d = b - a, s = std::sin(a), c = std::cos(a);
    const double zeroth = 2 * std::sin(0.5 * (a + b)) * std::sin(0.5 * d);
    if (d > 0.2) return {zeroth, std::sin(b) - s - d * std::cos(b)};
    // sin(a + x) = s cos x + c sin x; ∫ x cos x and ∫ x sin x by their series.
    const double d2 = d * d;
    const double with_cos = d2 * (1.0 / 2 - d2 * (1.0 / 8 - d2 * (1.0 / 144 - d2 / 5760)));
    const double with_sin = d2 * d * (1.0 / 3 - d2 * (1.0 / 30 - d2 * (1.0 / 840 - d2 / 45360)));
    return {zeroth, s * with_cos + c * with_sin};
}

LatlongIntegrator::LatlongIntegrator(ImageView<const float> image)
    : image_(image), row_angle_(k_pi / image.height), column_angle_(2 * k_pi / image.width) {
    for (int j = -1; j < image.height; ++j) {
        const SineMoments m = sine_moments(cell_top(j), cell_top(j + 1));
        lower_.push_back(m.first / row_angle_);
        upper_.push_back(m.zeroth - lower_.back());
    }
}

LatlongIntegrator::Cell LatlongIntegrator::cell_at(const Vec3d& p) const {
    const UV uv = latlong_uv(p);
    return {int(std::floor(uv.u * image_.width - 0.5)),
            std::clamp(int(std::floor(uv.v * image_.height - 0.5)), -1, image_.height - 1)};
}

/// g on row `row` (clamped) at the fraction `u` between the centres of `column` and the next (wrapping).
Vec3d LatlongIntegrator::texel(int row, int column, double u) const {
    const float* p = image_.row(std::clamp(row, 0, image_.height - 1));
    const int w = image_.width, left = ((column % w) + w) % w, right = left + 1 == w ? 0 : left + 1;
    const float *a = p + 3 * std::ptrdiff_t(left), *b = p + 3 * std::ptrdiff_t(right);
    return Vec3d(a[0], a[1], a[2]) * (1 - u) + Vec3d(b[0], b[1], b[2]) * u;
}

/// ∫ g sin t dt along a meridian from the top of cell row `reference` to `theta`, which lies in `cell`.
LatlongIntegrator::Flux LatlongIntegrator::meridian(double theta, double u, Cell cell, int reference) const {
    Flux sum;
    const auto whole_row = [&](int j) {
        const double upper = upper_[j + 1], lower = lower_[j + 1];
        sum.add(upper, texel(j, cell.column, u));
        sum.add(lower, texel(j + 1, cell.column, u));
        sum.solid_angle += upper + lower;
    };
    const auto part = [&](double a, double b) {
        const SineMoments m = sine_moments(a, b);
        // In the half rows at the poles both rows are the same, so the origin of s does not matter.
        const double s0 = (a - (cell.row + 0.5) * row_angle_) / row_angle_;
        const double lower = m.first / row_angle_ + s0 * m.zeroth;
        sum.add(m.zeroth - lower, texel(cell.row, cell.column, u));
        sum.add(lower, texel(cell.row + 1, cell.column, u));
        sum.solid_angle += m.zeroth;
    };
    const double top = cell_top(cell.row), bottom = cell_top(cell.row + 1);
    theta = std::clamp(theta, top, bottom);  // a node may be outside by a rounding error
    if (cell.row >= reference) {
        for (int j = reference; j < cell.row; ++j) whole_row(j);
        part(top, theta);
        return sum;
    }
    for (int j = cell.row + 1; j < reference; ++j) whole_row(j);
    part(theta, bottom);
    return {-sum.light, -sum.solid_angle};
}

/// All parameters at which the arc crosses a row or column of texel centres, sorted, with both ends.
void LatlongIntegrator::cuts(const Arc& arc, std::vector<double>& out) const {
    out.assign({arc.s0, arc.s1});
    const auto theta = [&](double s) {
        const Vec3d p = arc.at(s);
        return std::atan2(std::hypot(p.x, p.z), p.y);
    };
    // Rows: between the lowest and highest point of the arc.
    std::vector<double> places{arc.s0, arc.s1};
    solve_circle(arc, arc.e2.y, -arc.e1.y, 0, places);
    double lowest = k_pi, highest = 0;
    for (double s : places) {
        lowest = std::min(lowest, theta(s));
        highest = std::max(highest, theta(s));
    }
    const int first = std::max(0, int(std::floor(lowest / row_angle_ - 0.5)));
    const int last = std::min(image_.height - 1, int(std::ceil(highest / row_angle_ - 0.5)));
    for (int j = first; j <= last; ++j) cross_plane(arc, {0, 1, 0}, std::cos((j + 0.5) * row_angle_), out);

    // Columns: phi is monotone between the places where x dz - z dx = 0 (a great circle has none).
    places.assign({arc.s0, arc.s1});
    const auto turn = [](const Vec3d& a, const Vec3d& b) { return a.x * b.z - a.z * b.x; };
    turning_points(arc, {0, 0, 1}, {1, 0, 0}, places);
    sort_items(places);
    for (std::size_t k = 0; k + 1 < places.size(); ++k) {
        // Slightly inside, in case the end is a pole.
        const double inside = 1e-7 * (places[k + 1] - places[k]), middle = 0.5 * (places[k] + places[k + 1]);
        const Vec3d a = arc.at(places[k] + inside), b = arc.at(places[k + 1] - inside);
        const double sign = turn(arc.place(middle).point, arc.place(middle).derivative) < 0 ? -1 : 1;
        const double start = std::atan2(a.z, a.x);
        double sweep = sign * (std::atan2(b.z, b.x) - start);
        sweep -= 2 * k_pi * std::floor(sweep / (2 * k_pi));
        if (sweep > 2 * k_pi - 1e-6) continue;  // a rounding error in the other direction
        const double from = (std::min(start, start + sign * sweep) + k_pi) / column_angle_ - 0.5;
        for (double i = std::floor(from), end = std::ceil(from + sweep / column_angle_); i <= end; ++i) {
            const double phi = (i + 0.5) * column_angle_ - k_pi;
            cross_plane(arc, {-std::sin(phi), 0, std::cos(phi)}, 0, out);
        }
    }
    sort_items(out);
}

void LatlongIntegrator::add_piece(const Arc& arc, double a, double b, Cell cell, int reference, Flux& sum) const {
    // dphi/ds has poles at the distance of the source's poles: pieces must be short compared with it.
    const double half = 0.5 * (b - a), middle = 0.5 * (a + b), size = 2 * half * arc.radius();
    const Vec3d m = arc.at(middle);
    const double near = std::sqrt(m.x * m.x + m.z * m.z) - 0.5 * size;
    if (size > 0.25 * near && size > 1e-10) {
        add_piece(arc, a, middle, cell, reference, sum);
        add_piece(arc, middle, b, cell, reference, sum);
        return;
    }
    const GaussRule& rule = size < 0.02 * near ? k_gauss3 : k_gauss5;
    const double column_phi = (cell.column + 0.5) * column_angle_ - k_pi;
    for (int k = 0; k < rule.count; ++k) {
        const double s = middle + half * rule.node[k];
        const auto [p, d] = arc.place(s);
        const double rho2 = p.x * p.x + p.z * p.z;
        if (!(rho2 > 0)) continue;  // F is 0 at a pole
        const double dphi = half * rule.weight[k] * (p.x * d.z - p.z * d.x) / rho2;
        const double u = std::remainder(std::atan2(p.z, p.x) - column_phi, 2 * k_pi) / column_angle_;
        const Flux f = meridian(std::atan2(std::sqrt(rho2), p.y), std::clamp(u, 0.0, 1.0), cell, reference);
        sum.add(dphi, f.light);
        sum.solid_angle += dphi * f.solid_angle;
    }
}

Vec3d LatlongIntegrator::integrate(std::span<const Arc> border, Pole pole) const {
    const int reference = pole == Pole::north   ? -1
                          : pole == Pole::south ? image_.height
                                                : cell_at(border[0].at(border[0].s0)).row;
    Flux sum;
    std::vector<double> s;
    for (const Arc& arc : border) {
        const Vec3d turning = cross(arc.e1, arc.e2);
        if (arc.is_great() && std::abs(turning.y) < 1e-15) continue;  // a meridian: dphi = 0
        cuts(arc, s);
        for (std::size_t k = 0; k + 1 < s.size(); ++k)
            if (s[k + 1] > s[k])
                add_piece(arc, s[k], s[k + 1], cell_at(arc.at(0.5 * (s[k] + s[k + 1]))), reference, sum);
    }
    return sum.solid_angle < 0 ? -sum.light : sum.light;
}

namespace {

using Pole = LatlongIntegrator::Pole;

/// A point closer to a border than this is treated as lying on it. Either treatment is right there; the distance only
/// has to exceed rounding.
constexpr double k_border = 1e-9;

Pole pole_in_cube_texel(int face, int x, int y, int size, const Mat3& world_to_source) {
    const Mat3 source_to_world = world_to_source.transposed();
    for (const Pole pole : {Pole::north, Pole::south}) {
        const Vec3d d = source_to_world * Vec3d{0, pole == Pole::north ? 1.0 : -1.0, 0};
        // s and t of d on the plane of this face: the face's axes are the differences of its corner directions.
        const Vec3d n = cube_direction(face, {0.5, 0.5}), right = cube_direction(face, {1, 0.5}) - n,
                    down = cube_direction(face, {0.5, 1}) - n;
        const double depth = dot(d, n);
        if (depth < 0.5) continue;  // farther than any point of the face
        const double px = 0.5 * (dot(d, right) / depth + 1) * size - x,
                     py = 0.5 * (dot(d, down) / depth + 1) * size - y;
        const double slack = k_border * size;
        if (px > -slack && px < 1 + slack && py > -slack && py < 1 + slack) return pole;
    }
    return Pole::none;
}

Pole pole_in_latlong(double u0, double u1, double v0, double v1, const Mat3& world_to_source) {
    const Mat3 source_to_world = world_to_source.transposed();
    for (const Pole pole : {Pole::north, Pole::south}) {
        const UV at = latlong_uv(source_to_world * Vec3d{0, pole == Pole::north ? 1.0 : -1.0, 0});
        if (at.v < v0 - k_border || at.v > v1 + k_border) continue;
        if (at.v < k_border || at.v > 1 - k_border) return pole;
        // The tolerance at the border, in u, grows where the meridians meet.
        const double slack = k_border / std::sin(k_pi * at.v), off = at.u - u0 - std::floor(at.u - u0 + slack);
        if (off <= u1 - u0 + slack) return pole;
    }
    return Pole::none;
}

/// Stores the rows and does the work at the end.
class PlainResampler : public AreaResampler {
  public:
    PlainResampler(int width, int height, int out_width, int out_height, const Mat3& world_to_source, int threads,
                   bool cube)
        : source_(width, height, 3),
          out_(out_width, out_height, 3),
          world_to_source_(world_to_source),
          threads_(threads),
          cube_(cube) {}

    void add_rows(ImageView<const float> rows) override {
        assert(rows.width == source_.width() && rows.channels == 3 && filled_ + rows.height <= source_.height());
        for (int y = 0; y < rows.height; ++y) {
            const float* row = rows.row(y);
            std::copy(row, row + std::size_t(rows.width) * 3, source_.row(filled_++));
        }
    }

    ImageF finish() override {
        assert(filled_ == source_.height());
        const LatlongIntegrator integrator(source_);
        // The average lies between the least and the greatest texel; rounding must not move it outside (below zero, for
        // example).
        const auto [least, greatest] = std::minmax_element(source_.pixels().begin(), source_.pixels().end());
        const double low = *least, high = *greatest;
        parallel_for(out_.height(), threads_, [&](int y) {
            for (int x = 0; x < out_.width(); ++x) {
                const Vec3d g = cube_ ? cube_texel(integrator, x, y) : latlong_texel(integrator, x, y);
                float* p = out_.at(x, y);
                p[0] = float(std::clamp(g.x, low, high));
                p[1] = float(std::clamp(g.y, low, high));
                p[2] = float(std::clamp(g.z, low, high));
            }
        });
        return std::move(out_);
    }

  private:
    Vec3d cube_texel(const LatlongIntegrator& integrator, int x, int strip_y) const {
        const int size = out_.width(), face = strip_y / size, y = strip_y % size;
        return integrator.integrate(cube_texel_border(face, x, y, size, world_to_source_),
                                    pole_in_cube_texel(face, x, y, size, world_to_source_)) /
               cube_solid_angle(x, y, size);
    }
    Vec3d latlong_texel(const LatlongIntegrator& integrator, int x, int y) const {
        // In parts of at most an eighth of a turn in each direction, so that none contains two poles.
        const int across = (8 + out_.width() - 1) / out_.width(), down = (4 + out_.height() - 1) / out_.height();
        Vec3d sum;
        for (int j = 0; j < down; ++j)
            for (int i = 0; i < across; ++i) {
                const double u0 = (x + double(i) / across) / out_.width(),
                             u1 = (x + double(i + 1) / across) / out_.width();
                const double v0 = (y + double(j) / down) / out_.height(),
                             v1 = (y + double(j + 1) / down) / out_.height();
                sum += integrator.integrate(latlong_border(u0, u1, v0, v1, world_to_source_),
                                            pole_in_latlong(u0, u1, v0, v1, world_to_source_));
            }
        return sum / latlong_solid_angle(y, out_.width(), out_.height());
    }

    ImageF source_, out_;
    Mat3 world_to_source_;
    int threads_;
    bool cube_;
    int filled_ = 0;
};

}  // namespace

std::unique_ptr<AreaResampler> plain_to_cube(int width, int height, int size, const Mat3& world_to_source,
                                             int threads) {
    return std::make_unique<PlainResampler>(width, height, size, 6 * size, world_to_source, threads, true);
}

std::unique_ptr<AreaResampler> plain_to_latlong(int width, int height, int out_height, const Mat3& world_to_source,
                                                int threads) {
    return std::make_unique<PlainResampler>(width, height, 2 * out_height, out_height, world_to_source, threads, false);
}

}  // namespace domelight::area
