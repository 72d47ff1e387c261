#ifndef DOMELIGHT_C_H
#define DOMELIGHT_C_H
/* Domelight for C, and for every language that calls C: image-based lighting, computed exactly.
 *
 *     domelight_environment* environment;
 *     const char* file = "studio.hdr";
 *     domelight_error* error = domelight_environment_open(&file, 1, NULL, &environment);
 *     if (error) {
 *         fprintf(stderr, "error: %s\n", domelight_error_text(error));
 *         domelight_error_free(error);
 *     }
 *
 * examples/c/bake.c is a whole program; docs/c.md explains the rules, which are:
 *
 * Errors     A function that can fail returns a domelight_error*: NULL, or an error that the caller frees. No result is
 *            then written, except where a comment says so. A pointer that must not be NULL is checked.
 * Options    A struct of options begins with struct_size. domelight_..._options_init(&options) fills in every default;
 *            then set what differs. NULL in place of a struct means all defaults, where a comment does not say otherwise.
 *            New fields are added at the end only: a program keeps working with later libraries of the same ABI version.
 * Words      Choices are words, the same as those of the command line: "ggx", "latlong", "rgba16f". NULL is the default.
 *            A word that is not known is an error that lists the accepted ones.
 * Ownership  Each function that makes a handle has a function that frees it, which accepts NULL. Pixels, bytes and texts
 *            that an accessor returns belong to the handle and live as long as it does.
 * Threads    A handle may be read by several threads at once. `threads`: 0 takes all cores, at most 1024. Results have
 *            the same bits on any number of threads.
 * Units      Radiance is linear Rec. 709, finite and >= 0. Directions are in the world, right-handed, +Y up; they point
 *            away from the surface, and need not be of unit length. docs/conventions.md draws axes, cubes and maps.
 */

#include <stddef.h>
#include <stdint.h>

#if defined(_WIN32)
#define DOMELIGHT_API
#else
#define DOMELIGHT_API __attribute__((visibility("default")))
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Version ------------------------------------------------------------------------------------------------------ */

/* The version of this interface. It changes only when programs have to be compiled anew, and is part of the shared
 * library's name (libdomelight_c.so.1). */
#define DOMELIGHT_C_ABI_VERSION 1
DOMELIGHT_API int32_t domelight_c_abi_version(void);
/* The version of the library that is linked: "0.3.0". */
DOMELIGHT_API const char* domelight_version(void);

/* ---- Errors ------------------------------------------------------------------------------------------------------- */

typedef struct domelight_error domelight_error;

/* What went wrong, in one sentence without a full stop: "7 is not from 1 to 4". */
DOMELIGHT_API const char* domelight_error_message(const domelight_error* error);
/* The file, or between backticks the field of the options, that is wrong: "`size`". May be empty. */
DOMELIGHT_API const char* domelight_error_where(const domelight_error* error);
/* What to do about it. May be empty. */
DOMELIGHT_API const char* domelight_error_hint(const domelight_error* error);
/* All of it: "WHERE: MESSAGE", and the hint on a line of its own. */
DOMELIGHT_API const char* domelight_error_text(const domelight_error* error);
/* 1 if the work was stopped by its progress callback. */
DOMELIGHT_API int32_t domelight_error_is_cancelled(const domelight_error* error);
DOMELIGHT_API void domelight_error_free(domelight_error* error);

/* ---- Progress ----------------------------------------------------------------------------------------------------- */

/* Called during long work with the name of the stage ("filter") and the part of it that is done, 0 to 1; on one thread
 * at a time, which need not be the caller's. Return 0 to go on, anything else to cancel. It must return: no longjmp, no
 * exception. `data` is the pointer that stands beside the callback in the options. */
typedef int32_t (*domelight_progress)(void* data, const char* stage, double done);

/* ---- Pixels ------------------------------------------------------------------------------------------------------- */

/* Pixels in memory, which somebody else owns: the input of domelight_environment_from_pixels and others, and what
 * accessors return. Rows run from the top to the bottom, channels are interleaved.
 *
 * faces 6: a cube, its faces one after the other in the order +X -X +Y -Y +Z -Z, each with OpenGL's orientation, so that
 * texture(cube, d) is the light from direction d. faces 1: a picture; of an environment a lat-long map, whose centre
 * shows +X, a point to the right of it +Z, and the top row +Y. */
typedef struct domelight_pixels {
    size_t struct_size; /* sizeof(domelight_pixels) */
    const void* data;   /* floats, or half floats */
    int32_t width;      /* of a face */
    int32_t height;     /* of a face */
    int32_t faces;      /* 1 or 6 */
    int32_t channels;   /* of a pixel; environments have 3, or 4 of which the last is ignored */
    int32_t bits;       /* of a channel: 32, or 16 for half floats. What the library returns has 32 */
    int32_t row_stride; /* channels from the start of a row to the next; 0: rows follow without gaps */
} domelight_pixels;

/* Sets struct_size, faces = 1, channels = 3, bits = 32, and all else to 0. */
DOMELIGHT_API void domelight_pixels_init_sized(domelight_pixels* pixels, size_t struct_size);

/* Pixels that the library made: a BRDF table, a map of irradiance, a converted environment. */
typedef struct domelight_image domelight_image;
DOMELIGHT_API domelight_error* domelight_image_pixels(const domelight_image* image, domelight_pixels* pixels);
DOMELIGHT_API void domelight_image_free(domelight_image* image);

/* ---- Environments ------------------------------------------------------------------------------------------------- */

/* The light from every direction. */
typedef struct domelight_environment domelight_environment;

/* How to read a file that does not say it itself; the words are those of `domelight bake --help`. */
typedef struct domelight_environment_options {
    size_t struct_size;
    const char* projection;       /* auto (default), latlong, cube, cube-cross, cube-strip, mirror-ball/fov=20, ... */
    const char* latlong;          /* convention of a lat-long map: default, usd, mitsuba, ... NULL: what the file states */
    const char* layer;            /* OpenEXR: the layer to read. NULL: the picture itself */
    const char* faces;            /* order of the pictures of a cube: "px nx py ny pz nz". NULL: by their names */
    const char* face_orientation; /* opengl, directx, openexr. NULL: what the files state or show, otherwise opengl */
    const char* decode;           /* 8-bit pictures: auto (default), srgb, gamma22, linear, rgbm, rgbd, rgbp */
    const char* negatives;        /* negative values: balance (default), clamp, keep */
    const char* up;               /* the author's axis at the top of the image: "+Y" (default), "+Z", ... */
    double rotate_y_deg;          /* turns the light about +Y: +X moves towards +Z */
    double exposure;              /* stops: radiance is multiplied by 2^exposure; -64 to 64 */
    int64_t max_bytes;            /* images whose decoding would need more memory are refused; 2^30 */
    int32_t threads;
} domelight_environment_options;
DOMELIGHT_API void domelight_environment_options_init_sized(domelight_environment_options* options, size_t struct_size);

/* Opens files: one image or cube texture (.hdr, .exr, .png, .jpg, .ktx2, .ktx, .dds, .env, .gltf), six faces of a cube, or
 * two halves of a dual paraboloid. File names are UTF-8. */
DOMELIGHT_API domelight_error* domelight_environment_open(const char* const* files, size_t count,
                                                          const domelight_environment_options* options,
                                                          domelight_environment** environment);
/* Opens the bytes of one such file, which are copied. `name` is what errors call it; NULL: "memory". */
DOMELIGHT_API domelight_error* domelight_environment_open_memory(const void* bytes, size_t size, const char* name,
                                                                 const domelight_environment_options* options,
                                                                 domelight_environment** environment);
/* Makes an environment of radiance in memory, which is copied: a lat-long map (faces 1) or a cube (faces 6).
 *
 * world_to_source   nine numbers, a 3 x 3 matrix by rows: the light from world direction d is where the pixels have the
 *                   direction world_to_source * d. Orthogonal, may mirror. NULL: the identity
 * Errors: no pixels; faces, channels or bits other than those that domelight_pixels lists; a cube that is not square; a
 * value that is NaN, infinite or negative (the first is named). */
DOMELIGHT_API domelight_error* domelight_environment_from_pixels(const domelight_pixels* pixels,
                                                                 const double* world_to_source,
                                                                 domelight_environment** environment);
DOMELIGHT_API void domelight_environment_free(domelight_environment* environment);

/* What is known of an environment. Texts belong to it. */
typedef struct domelight_environment_info {
    size_t struct_size;         /* set it to sizeof(domelight_environment_info) */
    const char* format;         /* "Radiance HDR", "OpenEXR", ...; empty for pixels in memory */
    const char* projection;     /* "latlong", "cube", or another of docs/projections.md */
    const char* convention;     /* of a lat-long file: "default", "usd", ... */
    int32_t width;              /* of the image as stored, or of a face of a cube */
    int32_t height;             /* likewise */
    int32_t latlong_width;      /* of the lat-long map that domelight_environment_latlong returns */
    int32_t latlong_height;     /* likewise */
    double world_to_source[9];  /* as in domelight_environment_from_pixels */
} domelight_environment_info;
DOMELIGHT_API domelight_error* domelight_environment_get_info(const domelight_environment* environment,
                                                              domelight_environment_info* info);
/* Warnings about the files, and a line on what was repaired, once the image has been read. The texts belong to the
 * environment until the next call of domelight_environment_warning_count. */
DOMELIGHT_API size_t domelight_environment_warning_count(domelight_environment* environment);
DOMELIGHT_API const char* domelight_environment_warning(const domelight_environment* environment, size_t index);
/* The radiance from a direction, bilinear between texels: rgb[3]. */
DOMELIGHT_API domelight_error* domelight_environment_radiance(const domelight_environment* environment,
                                                              const double direction[3], float rgb[3]);
/* The environment as a lat-long map in its own frame (domelight_environment_info::world_to_source). */
DOMELIGHT_API domelight_error* domelight_environment_latlong(const domelight_environment* environment,
                                                             domelight_image** image);

/* ---- Prefiltering ------------------------------------------------------------------------------------------------- */

/* One level of a specular chain: the environment convolved with a lobe. */
typedef struct domelight_level {
    size_t struct_size; /* sizeof(domelight_level): the same in all levels of an array, because it is their distance */
    const char* lobe;   /* ggx (default), charlie, phong, phong-plain */
    double roughness;   /* ggx and charlie: 0 to 1, alpha = roughness^2. 0: the environment itself; charlie: at least 0.1 */
    double exponent;    /* phong and phong-plain: 0 or more; infinity: the environment itself */
    int32_t size;       /* cube: width of a face, 1 to 16384; lat-long: height, and the width is twice that */
} domelight_level;
/* Fills in ggx, roughness 1, exponent 1, size 0. */
DOMELIGHT_API void domelight_level_init_sized(domelight_level* level, size_t struct_size);

typedef struct domelight_prefilter_options {
    size_t struct_size;
    const char* layout;            /* cube (default), latlong */
    const char* texels;            /* centre (default): the light in the direction of the texel's centre; read: those that
                                      are nearest to the filtered light when they are interpolated (cubes only) */
    const domelight_level* levels; /* level_count of them, in any sizes */
    size_t level_count;
    const double* directions;      /* not NULL: the light in these directions (3 numbers each) in place of whole maps */
    size_t direction_count;
    const double* world_to_source; /* a turn of the light, as in domelight_environment_from_pixels; NULL: none */
    int32_t irradiance_size;       /* also a map of irradiance: width of a face or height, to 4096; 0 (default): none */
    int32_t sh_bands;              /* also spherical harmonics: 1 to 64; 0 (default): none */
    int32_t threads;
    domelight_progress progress;   /* may be NULL */
    void* progress_data;
} domelight_prefilter_options;
DOMELIGHT_API void domelight_prefilter_options_init_sized(domelight_prefilter_options* options, size_t struct_size);

/* A filtered environment. */
typedef struct domelight_filtered domelight_filtered;
/* Everything in one reading of the environment. `options` must not be NULL. */
DOMELIGHT_API domelight_error* domelight_prefilter(const domelight_environment* environment,
                                                   const domelight_prefilter_options* options,
                                                   domelight_filtered** filtered);
DOMELIGHT_API size_t domelight_filtered_level_count(const domelight_filtered* filtered);
/* A level's radiance: six faces or a lat-long map; or, with directions, one row of a pixel for each. */
DOMELIGHT_API domelight_error* domelight_filtered_level(const domelight_filtered* filtered, size_t level,
                                                        domelight_pixels* pixels);
/* E / pi, where options.irradiance_size asked for it. */
DOMELIGHT_API domelight_error* domelight_filtered_irradiance_over_pi(const domelight_filtered* filtered,
                                                                     domelight_pixels* pixels);
/* Coefficients of the radiance, RGB each, sh_bands^2 of them (docs/conventions.md); NULL and 0 without sh_bands. */
DOMELIGHT_API const double* domelight_filtered_sh(const domelight_filtered* filtered, size_t* count);
/* Mean radiance over the sphere. */
DOMELIGHT_API void domelight_filtered_mean(const domelight_filtered* filtered, double rgb[3]);
DOMELIGHT_API void domelight_filtered_free(domelight_filtered* filtered);

/* Filters many cubes of one size, such as the light probes of a scene that moves: what depends on the size alone is computed
 * once, here. `options` as above, without its progress.
 *
 * size      of a face: 16 to 256 */
typedef struct domelight_probe_filter domelight_probe_filter;
DOMELIGHT_API domelight_error* domelight_probe_filter_make(int32_t size, const domelight_prefilter_options* options,
                                                           domelight_probe_filter** filter);
/* cube      six faces of that size, finite values of 0 and more; they are not kept */
DOMELIGHT_API domelight_error* domelight_probe_filter_filter(const domelight_probe_filter* filter,
                                                             const domelight_pixels* cube,
                                                             domelight_filtered** filtered);
DOMELIGHT_API void domelight_probe_filter_free(domelight_probe_filter* filter);

/* The irradiance E alone: the cosine integral, which is pi for a constant radiance of 1.
 *
 * layout    cube or latlong; NULL: cube
 * size      width of a face, or height; 1 to 4096 */
DOMELIGHT_API domelight_error* domelight_irradiance(const domelight_environment* environment, const char* layout,
                                                    int32_t size, int32_t threads, domelight_image** image);
/* Spherical harmonics alone.
 *
 * bands        1 to 64
 * quantity     what is expanded: radiance, irradiance (E), irradiance_over_pi; NULL: radiance
 * window       against ringing: none, hann, lanczos; NULL: none
 * rgb          room for bands^2 * 3 numbers */
DOMELIGHT_API domelight_error* domelight_spherical_harmonics(const domelight_environment* environment, int32_t bands,
                                                             const char* quantity, const char* window, int32_t threads,
                                                             double* rgb);

/* ---- The BRDF table of the split sum ------------------------------------------------------------------------------ */

/* size x size pixels of three channels; u = NdotV, v = roughness (row 0 is the smoothest), at texel centres. Channels: scale,
 * bias (specular reflectance = F0 scale + bias), albedo of Charlie's sheen.
 *
 * size      1 to 4096
 * masking   correlated, smith, karis; NULL: correlated */
DOMELIGHT_API domelight_error* domelight_brdf_table(int32_t size, const char* masking, int32_t threads,
                                                    domelight_image** image);

/* ---- Light directions --------------------------------------------------------------------------------------------- */

/* Draws light directions in proportion to the radiance. */
typedef struct domelight_sampler domelight_sampler;

typedef struct domelight_sampler_options {
    size_t struct_size;
    const char* method;   /* bilinear (default), guided, alias, hierarchical, binary, linear, walk, bilinear-plain */
    const char* weight;   /* radiant-power (default), grayscale */
    double uniform_share; /* of the samples that is drawn uniformly over the sphere; 0 to 1 */
    int32_t compensate;   /* 1: leaves the dim part of the sky to another strategy (MIS compensation) */
    int32_t threads;      /* for building */
} domelight_sampler_options;
DOMELIGHT_API void domelight_sampler_options_init_sized(domelight_sampler_options* options, size_t struct_size);
DOMELIGHT_API domelight_error* domelight_sampler_build(const domelight_environment* environment,
                                                       const domelight_sampler_options* options,
                                                       domelight_sampler** sampler);
DOMELIGHT_API void domelight_sampler_free(domelight_sampler* sampler);

/* A light direction. This struct never grows. */
typedef struct domelight_light_sample {
    float u, v;         /* on the sampler's lat-long map, [0, 1) */
    float direction[3]; /* in the world, unit length */
    float radiance[3];  /* from there */
    float pdf;          /* density per steradian with which the direction is drawn */
} domelight_light_sample;

/* A direction for a point of the unit square, whose coordinates are x / 2^32 and y / 2^32. */
DOMELIGHT_API domelight_error* domelight_sampler_sample(const domelight_sampler* sampler, uint32_t x, uint32_t y,
                                                        domelight_light_sample* sample);
/* Radiance and density for a direction: the other half of multiple importance sampling. */
DOMELIGHT_API domelight_error* domelight_sampler_look_up(const domelight_sampler* sampler, const float direction[3],
                                                         domelight_light_sample* sample);

/* Many samples as arrays of one number each, all of the same length. Arrays that are NULL are not written. This struct
 * never grows. */
typedef struct domelight_light_samples {
    float *u, *v;
    float *x, *y, *z; /* direction */
    float *r, *g, *b; /* radiance */
    float* pdf;       /* density per steradian */
} domelight_light_samples;

/* Many directions at once, several times as fast. points: count pairs x, y. */
DOMELIGHT_API domelight_error* domelight_sampler_sample_many(const domelight_sampler* sampler, const uint32_t* points,
                                                             size_t count, const domelight_light_samples* samples);
/* Many lookups at once: reads samples->x, y, z (no direction may be 0), and writes the other arrays. */
DOMELIGHT_API domelight_error* domelight_sampler_look_up_many(const domelight_sampler* sampler, size_t count,
                                                              const domelight_light_samples* samples);
/* Points for the sampler: number first to first + count - 1 of `total` points of a sequence.
 *
 * sequence   sobol, halton, hammersley, stratified, r2, random; NULL: sobol
 * seed       chooses the randomisation; 0: none, where the sequence has a plain form
 * total      1 to 2^31; only hammersley and stratified look at it
 * points     room for 2 * count numbers */
DOMELIGHT_API domelight_error* domelight_sequence_points(const char* sequence, uint64_t seed, uint32_t first, size_t count,
                                                         uint32_t total, uint32_t* points);

/* ---- Lights ------------------------------------------------------------------------------------------------------- */

/* The sun and other small bright sources as lights of their own, and the environment without them (docs/lights.md). */
typedef struct domelight_lights domelight_lights;

typedef struct domelight_lights_options {
    size_t struct_size;
    double least_share;          /* of the environment's luminance that a light must hold, 0 to 1; 0.01 */
    double least_contrast;       /* of a light against its surroundings, 1.5 to 1e6; 4 */
    double largest_diameter_deg; /* of a light, 0.001 to 30; 6 */
    double merge_deg;            /* sources closer than this are one light, 0 to 30; 1.5 */
    int32_t max_lights;          /* the strongest are kept, 0 to 1024; 8 */
    int32_t threads;
} domelight_lights_options;
DOMELIGHT_API void domelight_lights_options_init_sized(domelight_lights_options* options, size_t struct_size);

typedef struct domelight_light {
    size_t struct_size;          /* set it to sizeof(domelight_light) */
    double direction[3];         /* towards the light, in the world, unit length */
    double u, v;                 /* the same on the environment's lat-long map, 0 to 1 */
    double angular_diameter_deg; /* of a uniform disc with the same second moment */
    double irradiance[3];        /* on a surface that faces the light */
    double mean_radiance[3];     /* over a disc of that diameter */
    double colour[3];            /* irradiance over its largest channel */
    double share;                /* of the environment's luminance, 0 to 1 */
    double contrast;             /* infinite in front of black */
    int64_t texels;              /* that the light was taken from */
    int32_t resolved;            /* 1: wider than a texel; 0: the diameter is an upper bound */
} domelight_light;

DOMELIGHT_API domelight_error* domelight_extract_lights(const domelight_environment* environment,
                                                        const domelight_lights_options* options,
                                                        domelight_lights** lights);
DOMELIGHT_API size_t domelight_lights_count(const domelight_lights* lights);
/* The largest share first. */
DOMELIGHT_API domelight_error* domelight_lights_get(const domelight_lights* lights, size_t index,
                                                    domelight_light* light);
/* The environment without the lights: to bake or to sample. */
DOMELIGHT_API domelight_error* domelight_lights_remainder(const domelight_lights* lights,
                                                          domelight_environment** environment);
DOMELIGHT_API void domelight_lights_free(domelight_lights* lights);

/* ---- Textures ----------------------------------------------------------------------------------------------------- */

/* Maps as the texels that graphics processors read. */
typedef struct domelight_texture domelight_texture;

typedef struct domelight_encode_options {
    size_t struct_size;
    const char* encoding; /* rgba16f (default), rgba32f, rgb9e5, r11g11b10f, bc6h, uastc-hdr, astc4x4-hdr, astc6x6-hdr,
                             rgbm, rgbd, rgbp; for a table of fewer channels rg16f, rg32f, r32f */
    const char* quality;  /* of the encodings in blocks: fast, default, high, exhaustive */
    int32_t threads;
} domelight_encode_options;
DOMELIGHT_API void domelight_encode_options_init_sized(domelight_encode_options* options, size_t struct_size);

/* Encodes `count` levels, each half as large as the one before (rounded down). One level of pixels of one to three
 * channels, as of a BRDF table, may be encoded as rg16f, rg32f or r32f. */
DOMELIGHT_API domelight_error* domelight_encode(const domelight_pixels* levels, size_t count,
                                                const domelight_encode_options* options, domelight_texture** texture);
/* Encodes all levels of a filtered environment. */
DOMELIGHT_API domelight_error* domelight_encode_filtered(const domelight_filtered* filtered,
                                                         const domelight_encode_options* options,
                                                         domelight_texture** texture);

typedef struct domelight_texture_info {
    size_t struct_size;  /* set it to sizeof(domelight_texture_info) */
    int32_t width;       /* of a face of level 0 */
    int32_t height;
    int32_t faces;       /* 1 or 6 */
    int32_t levels;
    int32_t block;       /* texels along a side of a block; 1: single texels */
    int32_t block_bytes; /* of a block, or of a texel */
} domelight_texture_info;
DOMELIGHT_API domelight_error* domelight_texture_get_info(const domelight_texture* texture,
                                                          domelight_texture_info* info);
/* The bytes of a level: its faces one after the other, each of tightly packed rows of texels or blocks. */
DOMELIGHT_API domelight_error* domelight_texture_level(const domelight_texture* texture, size_t level,
                                                       const void** bytes, size_t* size);

typedef struct domelight_encoding_report {
    size_t struct_size;     /* set it to sizeof(domelight_encoding_report) */
    int64_t clipped_texels; /* with a value that the encoding cannot hold */
    double clipped_energy;  /* the share of the level's power that clipping lost, 0 to 1 */
    double rms_error;       /* relative, without clipped texels */
    double log_psnr;        /* dB, of logarithms; infinite if nothing was lost */
} domelight_encoding_report;
DOMELIGHT_API domelight_error* domelight_texture_report(const domelight_texture* texture, size_t level,
                                                        domelight_encoding_report* report);
/* A texture of texels that are encoded already, such as those of domelight_texture_level(): to be written as a file. They
 * are copied.
 *
 * info       width, height, faces and levels; its other fields are ignored
 * encoding   as in domelight_encode_options
 * levels     info->levels addresses, each of a level's bytes in the form of domelight_texture_level()
 * sizes      how many bytes each level has, which must be as many as the encoding needs */
DOMELIGHT_API domelight_error* domelight_texture_from_levels(const domelight_texture_info* info, const char* encoding,
                                                             const void* const* levels, const size_t* sizes,
                                                             domelight_texture** texture);
/* Spherical harmonics of the radiance, from which a .env file gets its diffuse light: bands * bands coefficients of three
 * numbers each, in the form of domelight_filtered_sh(). bands: 0 (none) to 64. */
DOMELIGHT_API domelight_error* domelight_texture_set_sh(domelight_texture* texture, const double* rgb, int32_t bands);
/* Sets a key of the texture's metadata (KTX2 and KTX); value NULL removes it. */
DOMELIGHT_API domelight_error* domelight_texture_set_metadata(domelight_texture* texture, const char* key,
                                                              const char* value);
DOMELIGHT_API void domelight_texture_free(domelight_texture* texture);

/* Writes the texture as a file, which appears whole or not at all.
 *
 * format             ktx2, ktx1, dds, dds9 (the header from before DX10), env (Babylon.js: rgbd, a power of two wide, every
 *                    level down to 1; the faces are mirrored for its world, and diffuse light is in it if the texture was
 *                    encoded from a filtered environment with three or more bands). NULL: by the file's ending
 * supercompression   of ktx2: none, zstd; NULL: none */
DOMELIGHT_API domelight_error* domelight_texture_write(const domelight_texture* texture, const char* file,
                                                       const char* format, const char* supercompression);
/* Bytes that the library made. */
typedef struct domelight_bytes domelight_bytes;
/* The same file in memory. format NULL: ktx2. */
DOMELIGHT_API domelight_error* domelight_texture_file(const domelight_texture* texture, const char* format,
                                                      const char* supercompression, domelight_bytes** bytes);
DOMELIGHT_API const void* domelight_bytes_data(const domelight_bytes* bytes, size_t* size);
DOMELIGHT_API void domelight_bytes_free(domelight_bytes* bytes);

/* ---- Converting --------------------------------------------------------------------------------------------------- */

typedef struct domelight_convert_options {
    size_t struct_size;
    const char* to;              /* projection and convention: "latlong" (default), "latlong/usd", "cube", "angular", ... */
    domelight_progress progress; /* may be NULL */
    void* progress_data;
    int32_t height;              /* of a face or of the picture, to 32768; 0 (default): as fine as the environment */
    int32_t sharp;               /* 1: keeps more detail in a conversion there and back, and takes longer */
    int32_t threads;
} domelight_convert_options;
DOMELIGHT_API void domelight_convert_options_init_sized(domelight_convert_options* options, size_t struct_size);

/* The environment as a picture of another projection or convention. Its faces are those of the cube, the two halves of a
 * dual paraboloid, or one. */
DOMELIGHT_API domelight_error* domelight_convert(const domelight_environment* environment,
                                                 const domelight_convert_options* options, domelight_image** image);
/* Writes pixels of three or four channels as .exr (half floats where they suffice) or .hdr; faces one below the other. */
DOMELIGHT_API domelight_error* domelight_pixels_write(const domelight_pixels* pixels, const char* file);

/* ---- Baking ------------------------------------------------------------------------------------------------------- */

/* What `domelight bake` takes, by the same words. A word that is NULL, and a size or number of levels that is 0, is the
 * engine's own. */
typedef struct domelight_bake_options {
    size_t struct_size;
    const char* engines;             /* "generic" (default); several with commas: "three,babylon" */
    const char* layout;              /* cube, latlong */
    const char* lobe;                /* ggx, charlie, phong, phong-plain */
    const char* texels;              /* read, centre */
    const char* encoding;            /* rgba16f, rgb9e5, bc6h, ... */
    const char* encoding_quality;    /* fast, default, high, exhaustive */
    const char* format;              /* ktx2, ktx1, dds, dds9, exr, exr-mip, hdr */
    const char* latlong_out;         /* convention of lat-long maps that are written: default, usd, ... */
    const char* irradiance_quantity; /* irradiance, irradiance_over_pi */
    const char* sh_window;           /* none (default), hann, lanczos */
    const char* brdf_masking;        /* correlated (default), smith, karis */
    const double* roughness;         /* of each level, 0 to 1 */
    size_t roughness_count;
    const double* exponents;         /* phong: of each level; infinity: the environment itself */
    size_t exponent_count;
    domelight_progress progress;     /* may be NULL */
    void* progress_data;
    int32_t size;                    /* of level 0: of a cube's face, or the height of a lat-long map */
    int32_t levels;
    int32_t irradiance_size;
    int32_t brdf_size;
    int32_t sh_bands;                /* 1 to 64; 3 */
    int32_t preview;                 /* 1 (default): preview.png */
    int32_t hashes;                  /* 1 (default): SHA-256 of source and files in the manifest */
    int32_t threads;
} domelight_bake_options;
DOMELIGHT_API void domelight_bake_options_init_sized(domelight_bake_options* options, size_t struct_size);

/* Writes what the engines load into `folder` (several engines: each into a folder of its name inside), which changes only
 * when everything is complete. docs/manifest.md describes manifest.json. */
DOMELIGHT_API domelight_error* domelight_bake(const domelight_environment* environment,
                                              const domelight_bake_options* options, const char* folder);

#ifdef __cplusplus
}
#endif

/* ---- Defaults ----------------------------------------------------------------------------------------------------- */

/* The functions above that end in _sized are told how large the caller's struct is. These know it. */
static inline void domelight_pixels_init(domelight_pixels* pixels) {
    domelight_pixels_init_sized(pixels, sizeof *pixels);
}
static inline void domelight_environment_options_init(domelight_environment_options* options) {
    domelight_environment_options_init_sized(options, sizeof *options);
}
static inline void domelight_level_init(domelight_level* level) {
    domelight_level_init_sized(level, sizeof *level);
}
static inline void domelight_prefilter_options_init(domelight_prefilter_options* options) {
    domelight_prefilter_options_init_sized(options, sizeof *options);
}
static inline void domelight_sampler_options_init(domelight_sampler_options* options) {
    domelight_sampler_options_init_sized(options, sizeof *options);
}

static inline void domelight_lights_options_init(domelight_lights_options* options) {
    domelight_lights_options_init_sized(options, sizeof *options);
}
static inline void domelight_encode_options_init(domelight_encode_options* options) {
    domelight_encode_options_init_sized(options, sizeof *options);
}
static inline void domelight_convert_options_init(domelight_convert_options* options) {
    domelight_convert_options_init_sized(options, sizeof *options);
}
static inline void domelight_bake_options_init(domelight_bake_options* options) {
    domelight_bake_options_init_sized(options, sizeof *options);
}

#endif
