/* From an HDR photograph in C: a specular cube of five levels as a texture, spherical harmonics, and light directions.
 *
 *     bake studio.hdr specular.ktx2
 */

#include <domelight/domelight_c.h>

#include <stdint.h>
#include <stdio.h>

#define LEVELS 5

/* Prints and frees an error, if there is one. */
static int failed(domelight_error* error) {
    if (!error) return 0;
    fprintf(stderr, "error: %s\n", domelight_error_text(error));
    domelight_error_free(error);
    return 1;
}

/* 256 x 256 texels a face, the environment itself, to 16 x 16, fully rough. */
static int filter(const domelight_environment* environment, domelight_filtered** filtered) {
    domelight_level levels[LEVELS];
    domelight_prefilter_options options;
    int l;
    for (l = 0; l < LEVELS; ++l) {
        domelight_level_init(&levels[l]);
        levels[l].size = 256 >> l;
        levels[l].roughness = l / (LEVELS - 1.0);
    }
    domelight_prefilter_options_init(&options);
    options.levels = levels;
    options.level_count = LEVELS;
    options.sh_bands = 3;
    return !failed(domelight_prefilter(environment, &options, filtered));
}

static int write_texture(const domelight_filtered* filtered, const char* file) {
    domelight_texture* texture = NULL;
    int done = !failed(domelight_encode_filtered(filtered, NULL, &texture)) &&
               !failed(domelight_texture_write(texture, file, NULL, NULL));
    domelight_texture_free(texture);
    return done;
}

static void print_mean(const domelight_filtered* filtered) {
    size_t count = 0;
    const double* sh = domelight_filtered_sh(filtered, &count);
    double mean[3];
    domelight_filtered_mean(filtered, mean);
    printf("mean radiance %g %g %g; %u coefficients, the first %g %g %g\n", mean[0], mean[1], mean[2], (unsigned)count,
           sh[0], sh[1], sh[2]);
}

/* The irradiance on a floor, estimated by drawing light directions. */
static int light_floor(const domelight_environment* environment) {
    enum { count = 4096 };
    static uint32_t points[2 * count];
    static float x[count], y[count], z[count], r[count], g[count], b[count], pdf[count];
    domelight_light_samples samples = {0};
    domelight_sampler* sampler = NULL;
    double sum[3] = {0, 0, 0};
    int i, done;
    samples.x = x, samples.y = y, samples.z = z, samples.r = r, samples.g = g, samples.b = b, samples.pdf = pdf;
    done = !failed(domelight_sampler_build(environment, NULL, &sampler)) &&
           !failed(domelight_sequence_points("sobol", 1, 0, count, count, points)) &&
           !failed(domelight_sampler_sample_many(sampler, points, count, &samples));
    for (i = 0; done && i < count; ++i) {
        if (y[i] <= 0) continue;
        sum[0] += r[i] * y[i] / pdf[i];
        sum[1] += g[i] * y[i] / pdf[i];
        sum[2] += b[i] * y[i] / pdf[i];
    }
    if (done) printf("irradiance on the floor %g %g %g\n", sum[0] / count, sum[1] / count, sum[2] / count);
    domelight_sampler_free(sampler);
    return done;
}

int main(int argc, char** argv) {
    const char* photograph;
    domelight_environment* environment = NULL;
    domelight_filtered* filtered = NULL;
    int done;
    if (argc != 3) return 2;
    photograph = argv[1];
    done = !failed(domelight_environment_open(&photograph, 1, NULL, &environment)) && filter(environment, &filtered) &&
           write_texture(filtered, argv[2]) && light_floor(environment);
    if (done) print_mean(filtered);
    domelight_filtered_free(filtered);
    domelight_environment_free(environment);
    return done ? 0 : 1;
}
