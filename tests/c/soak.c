/* Calls every group of the C interface again and again, with right and with wrong arguments, and measures the memory.
 *
 *     soak ROUNDS
 *
 * Prints the number of calls and by how many KiB the memory in use grew after a tenth of the rounds; exits 1 where a call
 * did not answer as it should. With more than one round, it also asks for more memory than there is.
 */

#define _POSIX_C_SOURCE 200809L
#include <domelight/domelight_c.h>

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <sys/resource.h>

enum { width = 32, height = 16 };

static long calls = 0;

static void wrong(int line) {
    fprintf(stderr, "soak.c:%d: not the answer that was expected\n", line);
    exit(1);
}
static void check(domelight_error* error, int expected, int line) {
    ++calls;
    if ((error != NULL) != expected) {
        fprintf(stderr, "%s\n", domelight_error_text(error));
        wrong(line);
    }
    if (error && !domelight_error_message(error)[0]) wrong(line);
    domelight_error_free(error);
}
#define DONE(call) check(call, 0, __LINE__)
#define REFUSED(call) check(call, 1, __LINE__)

/* KiB of memory in use. What is free is given back first: how much of it the allocator keeps is chance, some MiB either way. */
static long memory_in_use(void) {
    long pages = 0, resident = 0;
#ifdef __GLIBC__
    malloc_trim(0);
#endif
    FILE* file = fopen("/proc/self/statm", "r");
    if (!file || fscanf(file, "%ld %ld", &pages, &resident) != 2) wrong(__LINE__);
    fclose(file);
    return resident * 4;
}

/* A Radiance HDR file without compression; returns its size. */
static size_t make_hdr(unsigned char* bytes) {
    int length = sprintf((char*)bytes, "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n", height, width);
    size_t i;
    for (i = 0; i < width * height; ++i) {
        unsigned char* texel = bytes + length + 4 * i;
        texel[0] = texel[1] = texel[2] = (unsigned char)(128 + i % 100);
        texel[3] = i == 100 ? 138 : 129;
    }
    return (size_t)length + 4 * width * height;
}

static int32_t cancel(void* data, const char* stage, double done) {
    (void)data, (void)stage, (void)done;
    return 1;
}

static void try_filter(const domelight_environment* environment) {
    domelight_level levels[2];
    domelight_prefilter_options options;
    domelight_filtered* filtered = NULL;
    domelight_texture* texture = NULL;
    domelight_bytes* file = NULL;
    domelight_pixels pixels;
    domelight_level_init(&levels[0]);
    domelight_level_init(&levels[1]);
    levels[0].size = 8, levels[0].roughness = 0;
    levels[1].size = 4;
    domelight_prefilter_options_init(&options);
    options.levels = levels;
    options.level_count = 2;
    options.sh_bands = 3;
    options.threads = 1;
    DONE(domelight_prefilter(environment, &options, &filtered));
    domelight_pixels_init(&pixels);
    DONE(domelight_filtered_level(filtered, 1, &pixels));
    REFUSED(domelight_filtered_level(filtered, 2, &pixels));
    REFUSED(domelight_filtered_irradiance_over_pi(filtered, &pixels));
    DONE(domelight_encode_filtered(filtered, NULL, &texture));
    DONE(domelight_texture_file(texture, "ktx2", "zstd", &file));
    domelight_bytes_free(file);
    REFUSED(domelight_texture_file(texture, "tiff", NULL, &file));
    domelight_texture_free(texture);
    domelight_filtered_free(filtered);
    options.progress = cancel;
    REFUSED(domelight_prefilter(environment, &options, &filtered));
    options.progress = NULL, levels[1].roughness = 2;
    REFUSED(domelight_prefilter(environment, &options, &filtered));
}

static void try_sampler(const domelight_environment* environment) {
    uint32_t points[64];
    float pdf[32];
    float direction[3] = {0, 1, 0}, nowhere[3] = {0, 0, 0};
    domelight_light_sample sample;
    domelight_light_samples samples = {0};
    domelight_sampler* sampler = NULL;
    samples.pdf = pdf;
    DONE(domelight_sampler_build(environment, NULL, &sampler));
    DONE(domelight_sequence_points("sobol", 1, 0, 32, 32, points));
    DONE(domelight_sampler_sample_many(sampler, points, 32, &samples));
    REFUSED(domelight_sampler_sample_many(sampler, NULL, 32, &samples));
    DONE(domelight_sampler_look_up(sampler, direction, &sample));
    REFUSED(domelight_sampler_look_up(sampler, nowhere, &sample));
    domelight_sampler_free(sampler);
}

static void try_lights(const domelight_environment* environment) {
    domelight_lights* lights = NULL;
    domelight_environment* rest = NULL;
    domelight_convert_options options;
    domelight_image* image = NULL;
    DONE(domelight_extract_lights(environment, NULL, &lights));
    DONE(domelight_lights_remainder(lights, &rest));
    domelight_lights_free(lights);
    domelight_convert_options_init(&options);
    options.to = "cube";
    options.height = 4;
    DONE(domelight_convert(rest, &options, &image));
    domelight_image_free(image);
    domelight_environment_free(rest);
}

static void try_pixels(void) {
    static float radiance[width * height * 3];
    domelight_pixels pixels;
    domelight_environment* environment = NULL;
    domelight_pixels_init(&pixels);
    pixels.data = radiance;
    pixels.width = width;
    pixels.height = height;
    DONE(domelight_environment_from_pixels(&pixels, NULL, &environment));
    domelight_environment_free(environment);
    radiance[77] = (float)NAN;
    REFUSED(domelight_environment_from_pixels(&pixels, NULL, &environment));
    radiance[77] = 0;
    pixels.struct_size = 3;
    REFUSED(domelight_environment_from_pixels(&pixels, NULL, &environment));
}

static void one_round(const unsigned char* hdr, size_t size) {
    domelight_environment* environment = NULL;
    domelight_environment_info info;
    domelight_image* image = NULL;
    DONE(domelight_environment_open_memory(hdr, size, NULL, NULL, &environment));
    info.struct_size = sizeof info;
    DONE(domelight_environment_get_info(environment, &info));
    DONE(domelight_environment_latlong(environment, &image));
    domelight_image_free(image);
    try_filter(environment);
    try_sampler(environment);
    try_lights(environment);
    domelight_environment_free(environment);
    environment = NULL;
    DONE(domelight_environment_open_memory(hdr, size / 2, NULL, NULL, &environment));
    REFUSED(domelight_environment_latlong(environment, &image)); /* its rows end too early */
    domelight_environment_free(environment);
    REFUSED(domelight_environment_open_memory(hdr, 12, NULL, NULL, &environment));
    try_pixels();
}

/* More memory than there is: an error, and the next call works. */
static void try_without_memory(const unsigned char* hdr, size_t size) {
    struct rlimit limit, narrow;
    domelight_level level;
    domelight_prefilter_options options;
    domelight_environment* environment = NULL;
    domelight_filtered* filtered = NULL;
    domelight_error* error;
    domelight_level_init(&level);
    domelight_prefilter_options_init(&options);
    options.levels = &level;
    options.level_count = 1;
    level.size = 16384;
    DONE(domelight_environment_open_memory(hdr, size, NULL, NULL, &environment));
    if (getrlimit(RLIMIT_AS, &limit) != 0) wrong(__LINE__);
    narrow = limit;
    narrow.rlim_cur = (rlim_t)2 << 30;
    if (setrlimit(RLIMIT_AS, &narrow) != 0) wrong(__LINE__);
    error = domelight_prefilter(environment, &options, &filtered);
    if (!error || filtered || strcmp(domelight_error_text(error), "out of memory") != 0) wrong(__LINE__);
    domelight_error_free(error);
    if (setrlimit(RLIMIT_AS, &limit) != 0) wrong(__LINE__);
    level.size = 4;
    DONE(domelight_prefilter(environment, &options, &filtered));
    domelight_filtered_free(filtered);
    domelight_environment_free(environment);
}

int main(int argc, char** argv) {
    static unsigned char hdr[200 + 4 * width * height];
    const size_t size = make_hdr(hdr);
    const int rounds = argc > 1 ? atoi(argv[1]) : 1;
    long before = 0;
    int i;
    for (i = 0; i < rounds; ++i) {
        if (i == rounds / 10) before = memory_in_use();
        one_round(hdr, size);
    }
    if (rounds > 1) try_without_memory(hdr, size);
    printf("%ld calls, %ld KiB more\n", calls, memory_in_use() - before);
    return 0;
}
