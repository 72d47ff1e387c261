#include "filtering/sphere_grid.h"

#include "domelight/parallel.h"
#include "domelight/projection.h"

#include "simd/row_kernels.h"

#include <algorithm>

namespace domelight {
namespace {

/// How far a filtered spectrum has fallen at its band limit: see InterpolationTaps.
constexpr double k_decay = 16;

/// Sets negative values of a row to 0; returns how many texels had one.
int clamp_texels(float* rgb, int width) {
    int count = 0;
    for (int x = 0; x < width; ++x) {
        float* p = rgb + 3 * std::ptrdiff_t(x);
        count += p[0] < 0 || p[1] < 0 || p[2] < 0;
    }
    simd::clamp_negative(rgb, 3 * width);
    return count;
}

/// Fills `out`; direction(x, y) is the world direction of a texel.
template <typename Direction>
std::int64_t lookup_rows(const SphereGrid& grid, ImageView<float> out, const LookupOptions& options,
                         const Direction& direction) {
    const simd::TapTable table(InterpolationTaps(8, options.band, k_decay));
    const simd::GridView view = grid.view();
    std::vector<std::int64_t> clamped(out.height);
    parallel_ranges(out.height, 4, options.threads, [&](int begin, int end) {
        std::vector<double> x(out.width), y(out.width), z(out.width);
        std::vector<float> unit(3 * std::size_t(out.width));
        for (int row = begin; row < end; ++row) {
            for (int i = 0; i < out.width; ++i) {
                const Vec3d d = options.world_to_source * direction(i, row);
                x[i] = d.x, y[i] = d.y, z[i] = d.z;
            }
            float* rgb = out.row(row);
            simd::lookup_directions(view, table, x.data(), y.data(), z.data(), out.width, rgb);
            if (options.bright || options.lights) {
                float *ux = unit.data(), *uy = ux + out.width, *uz = uy + out.width;
                for (int i = 0; i < out.width; ++i) {
                    const double n = 1 / std::sqrt(x[i] * x[i] + y[i] * y[i] + z[i] * z[i]);
                    ux[i] = float(x[i] * n), uy[i] = float(y[i] * n), uz[i] = float(z[i] * n);
                }
                if (options.bright)
                    simd::add_zonal_sum(options.bright->view(), options.residual, ux, uy, uz, out.width, rgb);
                if (options.lights)
                    simd::add_direct_lights(options.lights->nodes.data(), int(options.lights->nodes.size()),
                                            options.lights->points.view(), options.kernel, ux, uy, uz, out.width, rgb);
            }
            clamped[row] = clamp_texels(rgb, out.width);
        }
    });
    std::int64_t sum = 0;
    for (const std::int64_t c : clamped) sum += c;
    return sum;
}

}  // namespace

SphereGrid::SphereGrid(RingGrid grid)
    : grid_(grid),
      stride_(4 * (std::ptrdiff_t(grid.width) + 3 * k_pad)),
      data_(std::size_t(grid.rings + 2 * k_pad) * stride_) {}

void SphereGrid::wrap() {
    const int w = grid_.width, h = grid_.rings;
    for (int k = 0; k < h; ++k) {
        float* row = ring(k);
        std::copy_n(row + 4 * std::ptrdiff_t(w - k_pad), 4 * k_pad, row - 4 * k_pad);
        std::copy_n(row, 8 * k_pad, row + 4 * std::ptrdiff_t(w));
    }
    // Beyond a pole lies the mirror ring, half a turn away.
    const auto beyond = [&](int to, int from) {
        const float* source = ring(from);
        float* row = ring(to);
        for (int i = -k_pad; i < w + 2 * k_pad; ++i)
            std::copy_n(source + 4 * ((i + w + w / 2) % w), 4, row + 4 * std::ptrdiff_t(i));
    };
    for (int k = 0; k < k_pad; ++k) {
        beyond(-1 - k, k);
        beyond(h + k, h - 1 - k);
    }
}

Cubemap grid_to_cube(const SphereGrid& grid, int size, const LookupOptions& options, std::int64_t& clamped) {
    Cubemap cube(size);
    clamped += lookup_rows(grid, cube.strip(), options, [size](int x, int row) {
        return cube_direction(row / size, {(x + 0.5) / size, (row % size + 0.5) / size});
    });
    return cube;
}

ImageF grid_to_latlong(const SphereGrid& grid, int height, const LookupOptions& options, std::int64_t& clamped) {
    ImageF image(2 * height, height, 3);
    std::vector<Vec3d> equator(2 * height);
    for (int x = 0; x < 2 * height; ++x) equator[x] = latlong_direction({(x + 0.5) / (2 * height), 0.5});
    clamped += lookup_rows(grid, image.view(), options, [&](int x, int row) {
        const double theta = k_pi * (row + 0.5) / height, s = std::sin(theta);
        return Vec3d{s * equator[x].x, std::cos(theta), s * equator[x].z};
    });
    return image;
}

}  // namespace domelight
