// The renderer against a convolution of its own lobe: at normal incidence GGX reflects the environment weighted by D G2
// / 4 (F = 1), a function of the angle to the normal alone, so that the picture of a distant patch is an integral that
// can be written down.

#include "domelight/environment/sky/sky.h"
#include "domelight/projection/projection.h"
#include "domelight/render/render.h"
#include "domelight/sampling/microfacet.h"

#include "render/shapes.h"
#include "test.h"

#include <cmath>

using namespace domelight;
using namespace domelight::test;

namespace {

constexpr int k_height = 32;

ImageF sky_with_sun() {
    SkyOptions options;
    options.height = k_height;
    options.sun_elevation_deg = 40;
    options.sun_azimuth_deg = 60;
    ImageF image(2 * k_height, k_height, 3);
    REQUIRE(make_sky(options)->read(image.view()));
    for (float& p : image.pixels()) p /= 3000;
    // and a bright light on a seam
    for (int c = 0; c < 3; ++c) image.at(0, 20)[c] = 5.f + float(c);
    return image;
}

/// The half vector of a normal and a direction at cosine c to it.
Vec3d half_vector(double c) {
    return {std::sqrt(std::max(0.0, (1 - c) / 2)), 0, std::sqrt((1 + c) / 2)};
}

/// Integral of radiance times lobe(c), c the cosine to N: the midpoint sum over `fine`^2 points a texel of the image,
/// bilinear between texel centres as the renderer reads it.
template <typename Lobe>
Vec3d convolve(const EnvironmentSampler& sampler, const Vec3d& N, int fine, const Lobe& lobe) {
    Vec3d sum;
    const int w = 2 * k_height * fine, h = k_height * fine;
    for (int y = 0; y < h; ++y) {
        const double theta = k_pi * (y + 0.5) / h, area = 2 * k_pi / w * k_pi / h * std::sin(theta);
        for (int x = 0; x < w; ++x) {
            const Vec3d L = latlong_direction({(x + 0.5) / w, (y + 0.5) / h});
            const double c = dot(L, N);
            if (c <= 0) continue;
            sum += Vec3d(sampler.radiance(Vec3f(L))) * (lobe(c) * area);
        }
    }
    return sum;
}

/// The radiance that the renderer's metal reflects along N.
double own_lobe(double c, double alpha) {
    return ggx_d(half_vector(c), alpha) * ggx_visibility(c, 1.0, alpha) * c;
}

/// A small square at the origin that faces `N`, seen along it by parallel rays.
RenderResult look_straight_at(const Vec3f& N, float roughness, const EnvironmentSampler& sampler, int samples) {
    Scene scene;
    Affine frame;
    frame.y = N;
    frame.x = normalize(cross(std::abs(N.y) < 0.9f ? Vec3f{0, 1, 0} : Vec3f{1, 0, 0}, N));
    frame.z = cross(frame.x, N);
    add(scene, floor_mesh(1, 0), metal_material(roughness), frame);
    auto traced = RayScene::build(std::move(scene));
    REQUIRE(traced);
    RenderOptions o;
    o.width = o.height = 8;
    o.samples = samples;
    o.camera.orthographic = true;
    o.camera.half_height = 0.5f;
    o.camera.to_world = {frame.x, frame.z * -1.f, N, N * 100.f};
    o.threads = 1;
    auto r = render_reference(*traced, sampler, o);
    REQUIRE(r);
    return std::move(*r);
}

}  // namespace

TEST_CASE("render: a distant metal's reflection at normal incidence is the environment under D G2 / 4") {
    const ImageF image = sky_with_sun();
    auto sampler = EnvironmentSampler::build(image, reference_sampler_options());
    REQUIRE(sampler);
    const Vec3f normals[] = {{0, 1, 0}, {0.6f, 0.64f, 0.48f}, {-1, 0, 0}, {0.36f, -0.48f, -0.8f}};
    double worst = 0, squares = 0;
    int values = 0;
    for (const float roughness : {0.2f, 0.3f, 0.6f, 1.f})
        for (const Vec3f& n : normals) {
            const Vec3f N = normalize(n);
            const double alpha = double(roughness) * roughness;
            const Vec3d exact =
                convolve(*sampler, Vec3d(N), roughness < 0.3f ? 12 : 8, [&](double c) { return own_lobe(c, alpha); });
            const RenderResult r = look_straight_at(N, roughness, *sampler, 256);
            Vec3d mean, variance;
            for (int y = 0; y < 8; ++y)
                for (int x = 0; x < 8; ++x) {
                    REQUIRE(*r.opacity.at(x, y) == 1);
                    const float *p = r.radiance.at(x, y), *v = r.variance.at(x, y);
                    mean += Vec3d{p[0], p[1], p[2]} / 64.0;
                    variance += Vec3d{v[0], v[1], v[2]} / (64.0 * 64.0);
                }
            INFO("roughness " << roughness << ", normal " << n.x << " " << n.y << " " << n.z);
            for (const auto& [ours, truth, v] : {std::tuple{mean.x, exact.x, variance.x},
                                                 {mean.y, exact.y, variance.y},
                                                 {mean.z, exact.z, variance.z}}) {
                // Three standard errors, plus the error of the midpoint sum.
                CHECK(std::abs(ours - truth) < 3 * std::sqrt(v) + 2e-4 * truth);
                CHECK(std::sqrt(v) < 0.01 * truth);  // otherwise the check above would prove nothing
                worst = std::max(worst, std::abs(ours / truth - 1));
                squares += (ours / truth - 1) * (ours / truth - 1);
                ++values;
            }
        }
    MESSAGE("rms difference " << std::sqrt(squares / values) << ", largest " << worst);
    CHECK(std::sqrt(squares / values) < 2e-3);
}

TEST_CASE("render: that lobe is not the prefilter's D n.l") {
    // The test above must be able to tell the two apart: at roughness 0.6 they differ by far more than its tolerance.
    const ImageF image = sky_with_sun();
    auto sampler = EnvironmentSampler::build(image, reference_sampler_options());
    REQUIRE(sampler);
    const double alpha = 0.36;
    const Vec3d N = normalize(Vec3d{0.6, 0.64, 0.48});
    const Vec3d own = convolve(*sampler, N, 4, [&](double c) { return own_lobe(c, alpha); }),
                prefilter = convolve(*sampler, N, 4, [&](double c) { return ggx_d(half_vector(c), alpha) * c / 4; });
    double own_total = 0, prefilter_total = 0;
    for (int i = 0; i < 2000; ++i) {
        const double c = (i + 0.5) / 2000;
        own_total += own_lobe(c, alpha);
        prefilter_total += ggx_d(half_vector(c), alpha) * c / 4;
    }
    CHECK(std::abs(own.y / own_total / (prefilter.y / prefilter_total) - 1) > 0.02);
}
