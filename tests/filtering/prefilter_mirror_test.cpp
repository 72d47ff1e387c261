#include "domelight/filtering/prefilter.h"
#include "domelight/projection/projection.h"

#include "test.h"

#include <cmath>

using namespace domelight;

namespace {

/// Light without any symmetry.
ImageF lamps() {
    ImageF image(64, 32, 3);
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 64; ++x) {
            const Vec3d d = latlong_direction({(x + 0.5) / 64, (y + 0.5) / 32});
            for (int c = 0; c < 3; ++c)
                image.at(x, y)[c] =
                    float(1 + std::exp(9 * (dot(normalize(Vec3d{0.8, 0.3 + 0.2 * c, 0.4}), d) - 1)) + 0.2 * d.z);
        }
    return image;
}

}  // namespace

TEST_CASE("prefilter: a source that is mirrored or turned in any way gives the cube with its texels exchanged") {
    const ImageF light = lamps();
    const auto filtered = [&](const Mat3& m) {
        FilterOptions options;
        options.world_to_source = m;
        options.specular = {{8, true, {}}, {8, false, ZonalKernel::ggx(0.6)}};
        ImageRowSource rows(light.view());
        auto result = prefilter(rows, options);
        REQUIRE(bool(result));
        return std::move(*result);
    };
    const FilterResult plain = filtered({});
    const Vec3d axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int order = 0; order < 6; ++order)
        for (int signs = 0; signs < 8; ++signs) {
            constexpr int orders[6][3] = {{0, 1, 2}, {2, 1, 0}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}};
            Mat3 m;
            for (int i = 0; i < 3; ++i) m.row[i] = axes[orders[order][i]] * (signs >> i & 1 ? -1.0 : 1.0);
            const FilterResult turned = filtered(m);
            for (int level = 0; level < 2; ++level) {
                double worst = 0;
                for (int f = 0; f < 6; ++f)
                    for (int y = 0; y < 8; ++y)
                        for (int x = 0; x < 8; ++x) {
                            const CubePoint p = cube_point(m * cube_direction(f, {(x + 0.5) / 8, (y + 0.5) / 8}));
                            const float* a = turned.specular[level].face(f).at(x, y);
                            const float* b = plain.specular[level].face(p.face).at(int(p.uv.u * 8), int(p.uv.v * 8));
                            for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(double(a[c]) - b[c]));
                        }
                CAPTURE(order);
                CAPTURE(signs);
                CAPTURE(level);
                CHECK(worst < 2e-4);  // of light up to 2.2: the prefilter's own error
            }
        }
}
