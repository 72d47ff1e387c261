#include "domelight/filtering/resample/reproject.h"

#include "domelight/base/parallel.h"

#include "filtering/resample/reproject_source.h"
#include "filtering/resample/reproject_tile.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <mutex>

namespace domelight {

namespace reproject_detail {

namespace {

constexpr int k_tile = 16;
/// The largest distance (in source texels) between a straight line and the curve that it approximates.
constexpr double k_straight = 0.004;

class Reprojector {
  public:
    Reprojector(const Source& source, const Projection& target, int width, int height, ImageF& out)
        : source_(source), target_(target), width_(width), height_(height), out_(out) {}

    /// Texels [x0, x1) x [y0, y1) of a chart: all together if possible, otherwise in parts, down to a single texel.
    void block(int chart, int x0, int y0, int x1, int y1, TileIntegrator& integrator) const {
        if (together(chart, x0, y0, x1, y1, integrator)) return;
        const int w = x1 - x0, h = y1 - y0;
        if (w == 1 && h == 1) {
            supersample(chart, x0, y0);
        } else if (w >= h) {
            block(chart, x0, y0, x0 + w / 2, y1, integrator);
            block(chart, x0 + w / 2, y0, x1, y1, integrator);
        } else {
            block(chart, x0, y0, x1, y0 + h / 2, integrator);
            block(chart, x0, y0 + h / 2, x1, y1, integrator);
        }
    }

  private:
    /// The position in the source of the point (x, y), given in texels of the chart. Fractions lie within texel
    /// (column, row).
    Vec3d direction(int chart, double x, double y) const {
        if (target_.grid() == SampleGrid::centres) return target_.direction(chart, {x / width_, y / height_});
        const int column = std::min(int(x), width_ - 1), row = std::min(int(y), height_ - 1);
        const UVBox b = target_.texel_box(column, row, width_, height_);
        return target_.direction(chart, {b.u0 + (x - column) * (b.u1 - b.u0), b.v0 + (y - row) * (b.v1 - b.v0)});
    }
    UV corner(int x, int y) const {
        const UVBox b = target_.texel_box(std::min(x, width_ - 1), std::min(y, height_ - 1), width_, height_);
        return {x < width_ ? b.u0 : b.u1, y < height_ ? b.v0 : b.v1};
    }

    struct Point {
        double x = 0, y = 0;
    };
    /// The position of a target point in the chart and region of `near`, with x shifted by whole turns to be next to
    /// it.
    Point place(int chart, double x, double y, const Place& near) const {
        const Place p = source_.locate_near(direction(chart, x, y), near);
        return {unwrapped(p.x, near.x), p.y};
    }
    double unwrapped(double x, double near) const {
        const int w = source_.width();
        return source_.wraps() ? x + w * std::round((near - x) / w) : x;
    }

    /// Integrates a block of texels by their outlines. False where a seam, a pole or a rim lies within, or the block is
    /// too large.
    bool together(int chart, int x0, int y0, int x1, int y1, TileIntegrator& integrator) const {
        const int nx = x1 - x0 + 1, ny = y1 - y0 + 1;
        std::array<Point, (k_tile + 1) * (k_tile + 1)> points;
        Place first;
        Point least{1e30, 1e30}, most{-1e30, -1e30};
        for (int j = 0; j < ny; ++j)
            for (int i = 0; i < nx; ++i) {
                if (!target_.valid(corner(x0 + i, y0 + j))) return false;
                const Place p = source_.locate(target_.direction(chart, corner(x0 + i, y0 + j)));
                if (i == 0 && j == 0) first = p;
                if (!p.shown || p.chart != first.chart || p.region != first.region) return false;
                // A pole: the picture's rows end there.
                if (source_.wraps() && (p.y < 0.5 || p.y > source_.height() - 0.5)) return false;
                const Point q{unwrapped(p.x, first.x), p.y};
                points[std::size_t(j * nx + i)] = q;
                least = {std::min(least.x, q.x), std::min(least.y, q.y)};
                most = {std::max(most.x, q.x), std::max(most.y, q.y)};
            }
        if (most.x - least.x > 0.4 * source_.width() || most.y - least.y > 0.6 * source_.height()) return false;
        const int parts = segments(chart, x0, y0, nx, ny, points, first);
        if (parts > 64) return false;
        const double slack = 0.02 * std::max(most.x - least.x, most.y - least.y) + 1;
        if (!integrator.prepare(source_, first.chart, int(std::floor(least.x - slack)),
                                int(std::floor(least.y - slack)), int(std::ceil(most.x + slack)),
                                int(std::ceil(most.y + slack))))
            return false;
        integrate(chart, x0, y0, nx, ny, points, first, parts, integrator);
        return true;
    }

    /// Into how many straight parts a texel's side must be cut.
    int segments(int chart, int x0, int y0, int nx, int ny, const auto& points, const Place& near) const {
        double bend = 0;
        const auto test = [&](Point a, Point b, double x, double y) {
            const Point m = place(chart, x, y, near);
            bend = std::max({bend, std::abs(m.x - 0.5 * (a.x + b.x)), std::abs(m.y - 0.5 * (a.y + b.y))});
        };
        // Checked on the border and the middle lines of the block, where the curvature is largest; it varies slowly.
        for (const int j : {0, ny / 2, ny - 1})
            for (int i = 0; i + 1 < nx; i += 4)
                test(points[std::size_t(j * nx + i)], points[std::size_t(j * nx + i + 1)], x0 + i + 0.5, y0 + j);
        for (const int i : {0, nx / 2, nx - 1})
            for (int j = 0; j + 1 < ny; j += 4)
                test(points[std::size_t(j * nx + i)], points[std::size_t((j + 1) * nx + i)], x0 + i, y0 + j + 0.5);
        return bend <= k_straight ? 1 : int(std::min(1000.0, std::ceil(std::sqrt(bend / k_straight))));
    }

    void integrate(int chart, int x0, int y0, int nx, int ny, const auto& points, const Place& near, int parts,
                   const TileIntegrator& integrator) const {
        const auto side = [&](int i, int j, int di, int dj) {
            const Point a = points[std::size_t(j * nx + i)], b = points[std::size_t((j + dj) * nx + i + di)];
            Flux sum;
            Point from = a;
            for (int k = 1; k <= parts; ++k) {
                const double s = double(k) / parts;
                const Point to = k == parts ? b : place(chart, x0 + i + s * di, y0 + j + s * dj, near);
                sum.add(1, integrator.along(from.x, from.y, to.x, to.y));
                from = to;
            }
            return sum;
        };
        std::array<Flux, k_tile> above, below;
        for (int i = 0; i + 1 < nx; ++i) above[std::size_t(i)] = side(i, 0, 1, 0);
        for (int j = 0; j + 1 < ny; ++j) {
            Flux left = side(0, j, 0, 1);
            for (int i = 0; i + 1 < nx; ++i) {
                below[std::size_t(i)] = side(i, j + 1, 1, 0);
                const Flux right = side(i + 1, j, 0, 1);
                Flux whole = above[std::size_t(i)];
                whole.add(1, right);
                whole.add(-1, below[std::size_t(i)]);
                whole.add(-1, left);
                if (std::abs(whole.solid_angle) > 1e-12)
                    store(chart, x0 + i, y0 + j, whole.light / whole.solid_angle);
                else
                    supersample(chart, x0 + i, y0 + j);
                left = right;
            }
            above = below;
        }
    }

    /// The mean over the texel's own points, each weighted by its solid angle.
    void supersample(int chart, int x, int y) const {
        // At least two points for each source texel, so that none is missed; more where a small bright light would
        // matter.
        const double covered =
            target_.shape().solid_angle(target_.texel_box(x, y, width_, height_)) / source_.mean_solid_angle();
        const int least = std::clamp(int(std::ceil(2 * std::sqrt(std::max(0.0, covered)))), 8, 64);
        Mean mean = sampled(chart, x, y, least);
        if (mean.contrast() > 0.2 && least < 16) mean = sampled(chart, x, y, 16);
        if (mean.contrast() > 4 && least < 64) mean = sampled(chart, x, y, 64);
        if (mean.contrast() > 40) mean = sampled(chart, x, y, 256);
        store(chart, x, y, mean.mean);
    }
    struct Mean {
        Vec3d mean;
        double least = 1e300, most = -1e300;
        double contrast() const { return (most - least) / std::max(1e-300, mean.x + mean.y + mean.z); }
    };
    Mean sampled(int chart, int x, int y, int steps) const {
        Mean result;
        const UVBox b = target_.texel_box(x, y, width_, height_);
        double weight = 0;
        for (int j = 0; j < steps; ++j)
            for (int i = 0; i < steps; ++i) {
                const UV uv{b.u0 + (i + 0.5) / steps * (b.u1 - b.u0), b.v0 + (j + 0.5) / steps * (b.v1 - b.v0)};
                if (!target_.valid(uv)) continue;
                const double w = target_.jacobian(uv);
                const Place p = source_.locate(target_.direction(chart, uv));
                const Vec3d g = p.shown || !source_.black_beyond() ? source_.at(p) : Vec3d{};
                result.mean += g * w;
                weight += w;
                result.least = std::min(result.least, g.x + g.y + g.z);
                result.most = std::max(result.most, g.x + g.y + g.z);
            }
        if (weight > 0) result.mean = result.mean / weight;
        return result;
    }

    void store(int chart, int x, int y, const Vec3d& g) const {
        float* p = out_.at(x, chart * height_ + y);
        p[0] = float(std::max(0.0, g.x)), p[1] = float(std::max(0.0, g.y)), p[2] = float(std::max(0.0, g.z));
    }

    const Source& source_;
    const Projection& target_;
    int width_, height_;
    ImageF& out_;
};

}  // namespace

}  // namespace reproject_detail

Vec3d radiant_power(const ProjectedImage& image, int threads) {
    const int w = image.width(), h = image.height();
    std::vector<Vec3d> rows(std::size_t((h + 1) / 2));
    // Row y and its mirror image have the same solid angles.
    parallel_for((h + 1) / 2, threads, [&](int y) {
        std::vector<double> omega(static_cast<std::size_t>(w));
        image.projection.texel_solid_angles(y, w, h, omega);
        // Texels of the same solid angle are added first: at most twelve floats.
        std::vector<float> alike(3 * omega.size());
        for (int c = 0; c < image.projection.charts(); ++c)
            for (const int row : {y, h - 1 - y}) {
                const float* p = image.pixels.row(c * h + row);
                for (std::size_t i = 0; i < alike.size(); ++i) alike[i] += p[i];
            }
        double sum[3] = {};
        for (std::size_t x = 0; x < omega.size(); ++x)
            for (std::size_t c = 0; c < 3; ++c) sum[c] += omega[x] * alike[3 * x + c];
        const double share = 2 * y + 1 == h ? 0.5 : 1;  // the middle row was added twice
        rows[std::size_t(y)] = Vec3d{sum[0], sum[1], sum[2]} * share;
    });
    Vec3d sum;
    for (const Vec3d& row : rows) sum += row;
    return sum;
}

ProjectedImage projected_cube(const Cubemap& cube, const Mat3& world_to_cube) {
    const ImageView<const float> strip = cube.strip();
    ImageF pixels(strip.width, strip.height, strip.channels);
    std::copy_n(strip.data, pixels.pixels().size(), pixels.pixels().begin());
    return {projection_from_name("cube")->turned(world_to_cube), std::move(pixels)};
}

ProjectedImage reproject(const ProjectedImage& source, const Projection& target, int width, int height, int threads,
                         const Progress& progress) {
    using namespace reproject_detail;
    const int charts = target.charts();
    const double target_texel = target.shape().coverage() / (double(width) * height * charts);
    const ProjectedImage reduced = reduce(source, target_texel, threads);
    const Source from(reduced, threads);
    ProjectedImage out{target, ImageF(width, height * charts, 3)};
    const Reprojector work(from, target, width, height, out.pixels);
    const int down = (height + k_tile - 1) / k_tile, across = (width + k_tile - 1) / k_tile;
    std::atomic<int> done = 0;
    std::mutex telling;
    parallel_for(charts * down, threads, [&](int row) {
        const int chart = row / down, y0 = row % down * k_tile, y1 = std::min(height, y0 + k_tile);
        TileIntegrator integrator;
        for (int t = 0; t < across; ++t)
            work.block(chart, t * k_tile, y0, std::min(width, (t + 1) * k_tile), y1, integrator);
        if (progress) {
            const std::lock_guard lock(telling);
            progress("convert", double(++done) / (charts * down));
        }
    });
    return out;
}

}  // namespace domelight
