#include "domelight/filtering/resample/reproject.h"

#include "domelight/base/parallel.h"

#include "base/mutex.h"
#include "filtering/resample/reproject_interpolate.h"
#include "filtering/resample/reproject_plain.h"
#include "filtering/resample/reproject_sides.h"
#include "filtering/resample/reproject_source.h"
#include "filtering/resample/reproject_tile.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

namespace domelight {

namespace reproject_detail {

namespace {

/// The largest distance (in source texels) between a straight line and the curve that it approximates.
constexpr double k_straight = 0.004;
/// The largest error of an interpolated position, in source texels.
constexpr double k_interpolated = 1e-6;

enum class Method { plain, simd };

/// What a thread keeps from one block to the next.
struct Workspace {
    TileIntegrator plain;
    SideIntegrator simd;
    SideSums sums;
};

/// Whether the projection is a smooth function within a whole chart.
bool smooth_charts(const Projection& p) {
    return p.grid() == SampleGrid::centres && (p.name() == "latlong" || p.name() == "cube");
}

class Reprojector {
  public:
    Reprojector(const Source& source, const Projection& target, int width, int height, Method method, ImageF& out)
        : source_(source),
          target_(target),
          width_(width),
          height_(height),
          method_(method),
          // A lat-long source has no regions: a block is within one chart of it if no pole is near.
          interpolates_(method == Method::simd && source.wraps() && smooth_charts(target)),
          out_(out) {}

    /// Texels [x0, x1) x [y0, y1) of a chart: all together if possible, otherwise in parts, down to a single texel.
    void block(int chart, int x0, int y0, int x1, int y1, Workspace& work) const {
        if (together(chart, x0, y0, x1, y1, work)) return;
        const int w = x1 - x0, h = y1 - y0;
        if (w == 1 && h == 1) {
            supersample(chart, x0, y0);
        } else if (w >= h) {
            block(chart, x0, y0, x0 + w / 2, y1, work);
            block(chart, x0 + w / 2, y0, x1, y1, work);
        } else {
            block(chart, x0, y0, x1, y0 + h / 2, work);
            block(chart, x0, y0 + h / 2, x1, y1, work);
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

    /// The position of a target point in the chart and region of `near`, with x shifted by whole turns to be next to
    /// it.
    SourcePoint place(int chart, double x, double y, const Place& near) const {
        const Place p = source_.locate_near(direction(chart, x, y), near);
        return {unwrapped(p.x, near.x), p.y};
    }
    double unwrapped(double x, double near) const {
        const int w = source_.width();
        return source_.wraps() ? x + w * std::round((near - x) / w) : x;
    }

    /// Integrates a block of texels by their outlines. False where a seam, a pole or a rim lies within, or the block is
    /// too large.
    bool together(int chart, int x0, int y0, int x1, int y1, Workspace& work) const {
        Block block;
        block.chart = chart, block.x0 = x0, block.y0 = y0;
        block.nx = x1 - x0 + 1, block.ny = y1 - y0 + 1;
        if (interpolate_corners(block))
            block.parts = parts(bend_between_corners(block));
        else if (find_corners(block))
            block.parts = parts(bend_of_sides(block));
        else
            return false;
        if (block.parts > 64) return false;
        const PlaceOf place_of = [&](double x, double y) { return place(chart, x, y, block.first); };
        if (method_ == Method::simd) {
            if (!work.simd.prepare(source_, block)) return false;
            work.simd.integrate(block, place_of, work.sums);
        } else {
            if (!work.plain.prepare(source_, block.first.chart, source_box(block))) return false;
            work.plain.integrate(block, place_of, work.sums);
        }
        store_means(block, work.sums);
        return true;
    }

    /// Finds the places of all corners. False where they are not together in one region of a chart, or too far apart.
    bool find_corners(Block& block) const {
        for (int j = 0; j < block.ny; ++j)
            for (int i = 0; i < block.nx; ++i) {
                const UV uv = corner(block.x0 + i, block.y0 + j);
                if (!target_.valid(uv)) return false;
                const Place p = source_.locate(target_.direction(block.chart, uv));
                if (i == 0 && j == 0) block.first = p;
                if (!p.shown || p.chart != block.first.chart || p.region != block.first.region) return false;
                block.x[block.corner(i, j)] = unwrapped(p.x, block.first.x);
                block.y[block.corner(i, j)] = p.y;
            }
        return find_extent(block);
    }

    bool find_extent(Block& block) const {
        const std::size_t count = std::size_t(block.nx) * block.ny;
        const auto [left, right] = std::minmax_element(block.x.begin(), block.x.begin() + count);
        const auto [top, bottom] = std::minmax_element(block.y.begin(), block.y.begin() + count);
        block.least_x = *left, block.most_x = *right, block.least_y = *top, block.most_y = *bottom;
        // A pole: the picture's rows end there.
        if (source_.wraps() && (block.least_y < 0.5 || block.most_y > source_.height() - 0.5)) return false;
        return block.most_x - block.least_x <= 0.4 * source_.width() &&
               block.most_y - block.least_y <= 0.6 * source_.height();
    }

    /// Finds the places of the corners by interpolation between a few. False where that is not exact enough.
    bool interpolate_corners(Block& block) const {
        if (!interpolates_ || block.nx != k_tile + 1 || block.ny != k_tile + 1) return false;
        block.first = source_.locate(target_.direction(block.chart, corner(block.x0, block.y0)));
        const auto at = [&](double x, double y) { return place(block.chart, block.x0 + x, block.y0 + y, block.first); };
        NodeGrid x, y;
        for (int j = 0; j < NodeGrid::k_nodes; ++j)
            for (int i = 0; i < NodeGrid::k_nodes; ++i) {
                const SourcePoint p = at(NodeGrid::node(i), NodeGrid::node(j));
                x.at(i, j) = p.x, y.at(i, j) = p.y;
            }
        for (int k = 0; k < NodeGrid::k_tests; ++k) {
            const SourcePoint test = NodeGrid::test(k), p = at(test.x, test.y);
            if (std::abs(x.at_test(k) - p.x) > k_interpolated || std::abs(y.at_test(k) - p.y) > k_interpolated)
                return false;
        }
        x.at_corners(block.x);
        y.at_corners(block.y);
        return find_extent(block);
    }

    /// Into how many straight parts a side must be cut that a straight line misses by `bend` in its middle.
    static int parts(double bend) {
        return bend <= k_straight ? 1 : int(std::min(1000.0, std::ceil(std::sqrt(bend / k_straight))));
    }

    // The bend is looked at on the border and the middle lines of a block, where it is largest; it varies slowly.

    /// The largest distance of a side's middle from the straight line's, in source texels.
    double bend_of_sides(const Block& block) const {
        double bend = 0;
        const auto test = [&](std::size_t a, std::size_t b, double x, double y) {
            const SourcePoint m = place(block.chart, block.x0 + x, block.y0 + y, block.first);
            bend = std::max({bend, std::abs(m.x - 0.5 * (block.x[a] + block.x[b])),
                             std::abs(m.y - 0.5 * (block.y[a] + block.y[b]))});
        };
        for (const int j : {0, block.ny / 2, block.ny - 1})
            for (int i = 0; i + 1 < block.nx; i += 4) test(block.corner(i, j), block.corner(i + 1, j), i + 0.5, j);
        for (const int i : {0, block.nx / 2, block.nx - 1})
            for (int j = 0; j + 1 < block.ny; j += 4) test(block.corner(i, j), block.corner(i, j + 1), i, j + 0.5);
        return bend;
    }

    /// The same from the corners: their second differences are eight times as large.
    static double bend_between_corners(const Block& block) {
        double bend = 0;
        const auto test = [&](std::size_t middle, std::size_t step) {
            for (const auto* p : {&block.x, &block.y})
                bend = std::max(bend, std::abs((*p)[middle - step] + (*p)[middle + step] - 2 * (*p)[middle]) / 8);
        };
        for (const int j : {0, block.ny / 2, block.ny - 1})
            for (int i = 1; i + 1 < block.nx; i += 2) test(block.corner(i, j), 1);
        for (const int i : {0, block.nx / 2, block.nx - 1})
            for (int j = 1; j + 1 < block.ny; j += 2) test(block.corner(i, j), std::size_t(block.nx));
        return bend;
    }

    /// Each texel's mean: the integral around it by the light, divided by that by solid angle.
    void store_means(const Block& block, const SideSums& sums) const {
        for (int j = 0; j + 1 < block.ny; ++j)
            for (int i = 0; i + 1 < block.nx; ++i) {
                const SideSum *above = &sums.across[std::size_t(j) * (block.nx - 1) + i],
                              *below = above + (block.nx - 1), *left = &sums.down[block.corner(i, j)],
                              *right = left + 1;
                SideSum whole;
                for (std::size_t c = 0; c < 4; ++c) whole[c] = (*above)[c] + (*right)[c] - (*below)[c] - (*left)[c];
                if (std::abs(whole[3]) > 1e-12)
                    store(block.chart, block.x0 + i, block.y0 + j, Vec3d{whole[0], whole[1], whole[2]} / whole[3]);
                else
                    supersample(block.chart, block.x0 + i, block.y0 + j);
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
    Method method_;
    bool interpolates_;
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

namespace reproject_detail {

namespace {

ProjectedImage reproject_by(Method method, const ProjectedImage& source, const Projection& target, int width,
                            int height, int threads, const Progress& progress) {
    const int charts = target.charts();
    const double target_texel = target.shape().coverage() / (double(width) * height * charts);
    std::optional<ProjectedImage> reduced = reduce(source, target_texel, threads);
    const Source from(reduced ? *reduced : source, threads);
    reduced.reset();
    ProjectedImage out{target, ImageF(width, height * charts, 3)};
    const Reprojector work(from, target, width, height, method, out.pixels);
    const int down = (height + k_tile - 1) / k_tile, across = (width + k_tile - 1) / k_tile;
    std::atomic<int> done = 0;
    Mutex telling;
    parallel_for(charts * down, threads, [&](int row) {
        const int chart = row / down, y0 = row % down * k_tile, y1 = std::min(height, y0 + k_tile);
        Workspace workspace;
        for (int t = 0; t < across; ++t)
            work.block(chart, t * k_tile, y0, std::min(width, (t + 1) * k_tile), y1, workspace);
        if (progress) {
            const Lock lock(telling);
            progress("convert", double(++done) / (charts * down));
        }
    });
    return out;
}

}  // namespace

ProjectedImage reproject_plain(const ProjectedImage& source, const Projection& target, int width, int height,
                               int threads) {
    return reproject_by(Method::plain, source, target, width, height, threads, {});
}

}  // namespace reproject_detail

ProjectedImage reproject(const ProjectedImage& source, const Projection& target, int width, int height, int threads,
                         const Progress& progress) {
    using namespace reproject_detail;
    return reproject_by(Method::simd, source, target, width, height, threads, progress);
}

}  // namespace domelight
