#include "filtering/bright_texels.h"

#include <algorithm>
#include <cmath>

#include "domelight/projection.h"
#include "math/gauss_legendre.h"
#include "simd/row_kernels.h"

namespace domelight {

BrightTexels::BrightTexels(int width, int height, int most) : width_(width), height_(height), most_(most) { heap_.reserve(most + 1); }

void BrightTexels::add_rows(ImageView<const float> rows) {
    for (int y = 0; y < rows.height; ++y, ++next_row_) {
        const float* row = rows.row(y);
        const double solid_angle = latlong_solid_angle(next_row_, width_, height_);
        const auto weakest = [&] { return int(heap_.size()) < most_ ? 0.0 : heap_.front().power; };
        if (simd::largest(row, 3 * width_) * solid_angle <= weakest()) continue;
        for (int x = 0; x < width_; ++x) {
            const float* p = row + 3 * x;
            const double power = std::max({p[0], p[1], p[2]}) * solid_angle;
            if (power <= weakest()) continue;
            heap_.push_back({power, x, next_row_, {p[0], p[1], p[2]}});
            std::push_heap(heap_.begin(), heap_.end(), stronger);
            if (int(heap_.size()) > most_) {
                std::pop_heap(heap_.begin(), heap_.end(), stronger);
                heap_.pop_back();
            }
        }
    }
}

BrightPoints BrightTexels::points(const Vec3d& mean, double least_share, int band_limit) const {
    const double total = 4 * k_pi * std::max({mean.x, mean.y, mean.z});
    std::vector<Texel> texels;
    for (const Texel& t : heap_)
        if (t.power > least_share * total) texels.push_back(t);
    std::sort(texels.begin(), texels.end(), stronger);

    const double step_theta = k_pi / height_, step_phi = 2 * k_pi / width_;
    const auto& rule = gauss_legendre(std::clamp(1 + int(step_theta * band_limit), 1, 8));
    BrightPoints points;
    for (const Texel& t : texels) {
        // The tent's four patches; in the half row at a pole it is constant in theta.
        for (int down = -1; down <= 1; down += 2)
            for (int right = -1; right <= 1; right += 2) {
                const bool cap = (down < 0 && t.y == 0) || (down > 0 && t.y == height_ - 1);
                const double length = (cap ? 0.5 : 1.0) * step_theta;
                for (std::size_t i = 0; i < rule.x.size(); ++i)
                    for (std::size_t j = 0; j < rule.x.size(); ++j) {
                        const double a = 0.5 * (1 + rule.x[i]), b = 0.5 * (1 + rule.x[j]);
                        const double theta = step_theta * (t.y + 0.5) + down * a * length;
                        const double phi = step_phi * (t.x + 0.5) - k_pi + right * b * step_phi;
                        const double tent = (cap ? 1 : 1 - a) * (1 - b);
                        const double weight = tent * std::sin(theta) * 0.25 * rule.w[i] * rule.w[j] * length * step_phi;
                        points.add({std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)}, weight, t.rgb);
                    }
            }
    }
    return points;
}

}  // namespace domelight
