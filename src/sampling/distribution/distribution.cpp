#include "domelight/sampling/distribution/distribution.h"

#include "sampling/distribution/texel_float.h"
#include "sampling/distribution/weight_rows.h"

#include <algorithm>
#include <cassert>

namespace domelight {

Weights Weights::of(ImageView<const float> image) {
    assert(image.channels == 1);
    return {image.width, image.height, [image](int y, std::span<float>) {
                return std::span<const float>(image.row(y), std::size_t(image.width));
            }};
}

std::optional<UnitPoint> Distribution2D::invert(double, double) const {
    return std::nullopt;
}

void Distribution2D::pdfs_uv(std::span<const float> u, std::span<const float> v, std::span<float> pdf_uv) const {
    assert(u.size() == v.size() && u.size() == pdf_uv.size());
    for (std::size_t i = 0; i < u.size(); ++i) pdf_uv[i] = float(this->pdf_uv(u[i], v[i]));
}

void Distribution2D::sample(std::span<const UnitPoint> points, std::span<float> u, std::span<float> v,
                            std::span<float> pdf_uv) const {
    assert(u.size() == points.size() && v.size() == points.size() && pdf_uv.size() == points.size());
    const int w = width(), h = height();
    for (std::size_t i = 0; i < points.size(); ++i) {
        const DistributionSample s = sample(points[i]);
        const auto point = float_point(s, w, h, continuous());
        u[i] = point[0];
        v[i] = point[1];
        pdf_uv[i] = float(s.pdf_uv);
    }
}

}  // namespace domelight
