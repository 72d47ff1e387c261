// The smallest renderer: the light that a white matte surface facing up sends back under an HDR environment, by
// importance sampling.
//
//     sample_minimal studio.hdr

#include <domelight/domelight.h>

#include <algorithm>
#include <cstdio>

using namespace domelight;

Result<Vec3f> light_of(const char* photograph) {
    auto environment = open_environment({photograph});
    if (!environment) return environment.error();
    auto sampler = EnvironmentSampler::build(*environment);
    if (!sampler) return sampler.error();

    constexpr int count = 4096;
    Vec3f sum;
    for (int i = 0; i < count; ++i) {
        const LightSample light = sampler->sample(unit_point(Sequence::sobol, 1, i, count));
        const float NdotL = std::max(light.direction.y, 0.f);  // the surface faces +Y
        sum += light.radiance * (NdotL / light.pdf_solid_angle);
    }
    return sum / float(k_pi * count);  // a white Lambert surface: f = 1 / pi
}

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    const auto light = light_of(argv[1]);
    if (!light)
        std::fprintf(stderr, "error: %s\n", light.error().format().c_str());
    else
        std::printf("%g %g %g\n", light->x, light->y, light->z);
    return light ? 0 : 1;
}
