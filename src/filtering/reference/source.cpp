#include "filtering/reference/source.h"

#include "domelight/base/parallel.h"
#include "domelight/filtering/harmonic/spherical_harmonics.h"

#include "base/gauss_legendre.h"

namespace domelight {

ReferenceSource::ReferenceSource(ImageView<const float> latlong) : image_(latlong) {
    assert(latlong.width >= 1 && latlong.height >= 1 && latlong.channels == 3);
    // In phi, the mean of a patch row is that of its two texel rows; in theta, it is ∫ (1 - t, t) sin theta in closed
    // form.
    std::vector<Vec3d> row_mean(height());
    for (int y = 0; y < height(); ++y) {
        for (int x = 0; x < width(); ++x) row_mean[y] += texel(x, y);
        row_mean[y] = row_mean[y] / width();
    }
    for (int r = 0; r < patch_rows(); ++r) {
        const double a = theta_begin(r), b = theta_end(r), half = (b - a) / 2, middle = (a + b) / 2;
        const double area = 2 * std::sin(middle) * std::sin(half);  // ∫ sin
        // ∫ (theta - middle) sin theta = 2 cos(middle) (sin(half) - half cos(half)); the lower row's weight is 1/2 +
        // (theta - middle) / (b - a)
        const double moment = 2 * std::cos(middle) * (std::sin(half) - half * std::cos(half)) / (b - a);
        const Vec3d above = row_mean[std::max(r - 1, 0)], below = row_mean[std::min(r, height() - 1)];
        mean_ += (above * (area / 2 - moment) + below * (area / 2 + moment)) / 2.0;
    }
}

Vec3d ReferenceSource::lookup(const Vec3d& direction) const {
    const UV uv = latlong_uv(direction);
    const double x = uv.u * width() - 0.5, y = std::clamp(uv.v * height() - 0.5, 0.0, height() - 1.0);
    const double fx = std::floor(x), fy = std::floor(y), s = x - fx, t = y - fy;
    const int x0 = (int(fx) + width()) % width(), y0 = int(fy);
    const int x1 = (x0 + 1) % width(), y1 = std::min(y0 + 1, height() - 1);
    return (texel(x0, y0) * (1 - s) + texel(x1, y0) * s) * (1 - t) + (texel(x0, y1) * (1 - s) + texel(x1, y1) * s) * t;
}

std::vector<Vec3d> ReferenceSource::spherical_harmonics(int bands, const Mat3& world_to_source, int threads) const {
    const int count = bands * bands;
    // The basis oscillates l times per radian: half as many nodes resolve it, and a few more make the integral precise.
    const double turns = std::max(patch_width(), k_pi / height()) * bands;
    const GaussLegendre& rule = gauss_legendre(2 + int(std::ceil(turns + std::min(6.0, 40 * turns))));
    const Mat3 source_to_world = world_to_source.transposed();
    std::vector<std::vector<Vec3d>> rows(patch_rows(), std::vector<Vec3d>(count));
    parallel_for(patch_rows(), threads, [&](int r) {
        std::vector<double> basis(count);
        const double height_of_patch = theta_end(r) - theta_begin(r);
        for (int x = 0; x < width(); ++x) {
            const auto g = corners(x, r);
            for (std::size_t i = 0; i < rule.x.size(); ++i)
                for (std::size_t j = 0; j < rule.x.size(); ++j) {
                    const double t = (1 + rule.x[i]) / 2, s = (1 + rule.x[j]) / 2;
                    const double theta = theta_begin(r) + t * height_of_patch, phi = phi_begin(x) + s * patch_width();
                    const double weight = rule.w[i] * rule.w[j] / 4 * height_of_patch * patch_width() * std::sin(theta);
                    const Vec3d value = (g[0] * (1 - s) + g[1] * s) * (1 - t) + (g[2] * (1 - s) + g[3] * s) * t;
                    const Vec3d source{std::sin(theta) * std::cos(phi), std::cos(theta),
                                       std::sin(theta) * std::sin(phi)};
                    sh_basis(source_to_world * source, bands, basis);
                    for (int k = 0; k < count; ++k) rows[r][k] += value * (weight * basis[k]);
                }
        }
    });
    std::vector<Vec3d> sum(count);
    for (const auto& row : rows)
        for (int k = 0; k < count; ++k) sum[k] += row[k];
    return sum;
}

}  // namespace domelight
