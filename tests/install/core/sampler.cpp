// An environment from pixels in memory, drawn from and prefiltered: all that a renderer with files of its own needs.
#include <domelight/environment/environment.h>
#include <domelight/filtering/prefilter.h>
#include <domelight/sampling/environment_sampler.h>
#include <domelight/sampling/sequences.h>

#include <cstdio>

int main() {
    using namespace domelight;
    ImageF sky(64, 32, 3);
    for (float& value : sky.pixels()) value = 2;
    const Environment environment = Environment::from_latlong(std::move(sky));
    const auto sampler = EnvironmentSampler::build(environment);
    if (!sampler) return 1;
    double density = 0;
    for (int i = 0; i < 16; ++i) density += sampler->sample(unit_point(Sequence::sobol, 1, i, 16)).pdf_solid_angle / 16;
    const auto maps = prefilter(environment, {.specular = {{.size = 8, .kernel = ZonalKernel::ggx(0.5)}}});
    if (!maps) return 1;
    std::printf("%.5f %.5f\n", density, maps->specular[0].pixels()[0]);
    return 0;
}
