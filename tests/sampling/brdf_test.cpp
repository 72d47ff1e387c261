#include "domelight/brdf.h"

#include "domelight/domelight.h"

#include "test.h"

using namespace domelight;

namespace {

Vec3f view(double degrees) {
    const double theta = degrees * k_pi / 180;
    return {float(std::sin(theta) * std::cos(0.7)), float(std::sin(theta) * std::sin(0.7)), float(std::cos(theta))};
}

template <typename Brdf>
void check_robust(const char* name, const Brdf& brdf) {
    const std::uint32_t edges[]{0, 1, 255, 256, 0x3fffffff, 0x40000000, 0x80000000, 0xc0000000, 0xfffffeff, 0xffffffff};
    int bad = 0;
    for (Vec3f V : {Vec3f{0, 0, 1}, view(45), view(89.9), view(89.9999), Vec3f{1, 0, 0}, Vec3f{-0.6f, 0.8f, 0},
                    Vec3f{0.6f, 0, -0.8f}, Vec3f{0, 0, -1}})
        for (int i = 0; i < 3000; ++i) {
            UnitPoint u = random_point(9, std::uint32_t(i));
            if (i < 100) u = {edges[i / 10], edges[i % 10]};
            const BrdfSample s = brdf.sample(V, u);
            const Vec3f f = brdf.evaluate(V, s.L);
            const bool unit = std::abs(length(s.L) - 1) < 1e-3f;
            const bool finite = std::isfinite(s.pdf_solid_angle) && std::isfinite(s.weight.x) && std::isfinite(f.x);
            const bool positive = s.pdf_solid_angle >= 0 && s.weight.x >= 0 && f.x >= 0;
            const bool same = s.pdf_solid_angle == brdf.pdf_solid_angle(V, s.L);
            const bool horizon =
                V.z >= 0 && s.L.z > k_least_cosine ? true : s.pdf_solid_angle == 0 && s.weight.x == 0 && f.x == 0;
            if (!(unit && finite && positive && same && horizon) && ++bad < 5)
                MESSAGE(name, " V ", V.x, " ", V.y, " ", V.z, " L ", s.L.x, " ", s.L.y, " ", s.L.z, " pdf ",
                        s.pdf_solid_angle, " weight ", s.weight.x, " u ", u.x, " ", u.y, " length ", length(s.L));
        }
    CHECK_MESSAGE(bad == 0, name);
}

}  // namespace

TEST_CASE("brdf: no argument in range makes anything but finite, unit and consistent values") {
    check_robust("lambert", LambertBrdf{});
    for (float exponent : {0.f, 1.f, 50.f, 1e4f, 1e7f}) check_robust("phong", PhongBrdf{exponent});
    for (float alpha : {0.f, 1e-4f, 1e-3f, 0.01f, 0.3f, 1.f}) {
        check_robust("half vectors", BasicGgxBrdf<GgxNormals::half_vectors>{alpha});
        check_robust("heitz", BasicGgxBrdf<GgxNormals::heitz>{alpha});
        check_robust("caps", BasicGgxBrdf<GgxNormals::caps>{alpha});
        check_robust("bounded caps", GgxBrdf{alpha});
        check_robust("charlie", CharlieBrdf{alpha});
    }
}
