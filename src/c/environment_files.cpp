// Environments from files, and from files in memory.
#include "domelight/io/environment/open_environment.h"

#include "c/environment.h"

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

using namespace domelight;

namespace {

domelight_environment_options defaults() {
    domelight_environment_options options{};
    options.max_bytes = EnvironmentOptions().max_bytes;
    return options;
}

Result<EnvironmentOptions> read_options(const domelight_environment_options* options) {
    const auto given = c::read_struct(options, defaults());
    if (!given) return given.error();
    EnvironmentOptions read;
    const auto decode = c::read_word(given->decode, read.decode, "decode");
    if (!decode) return decode.error();
    const auto negatives = c::read_word(given->negatives, read.negatives, "negatives");
    if (!negatives) return negatives.error();
    if (given->face_orientation) {
        const auto orientation = c::read_word(given->face_orientation, FaceOrientation::opengl, "face_orientation");
        if (!orientation) return orientation.error();
        read.face_orientation = *orientation;
    }
    if (given->max_bytes < 1)
        return Error{text(std::int64_t(given->max_bytes), " is not above 0"), field_place("max_bytes"), ""};
    if (auto ok = c::check_threads(given->threads); !ok) return ok.error();
    read.projection = c::text_or(given->projection, read.projection.c_str());
    read.latlong = c::text_or(given->latlong, "");
    read.layer = c::text_or(given->layer, "");
    read.faces = c::text_or(given->faces, "");
    read.up = c::text_or(given->up, read.up.c_str());
    read.decode = *decode;
    read.negatives = *negatives;
    read.rotate_y_deg = given->rotate_y_deg;
    read.exposure = given->exposure;
    read.max_bytes = given->max_bytes;
    read.threads = given->threads;
    return read;
}

Result<void> hand_out(Result<Environment> opened, const EnvironmentOptions& options, domelight_environment** place) {
    if (!opened) return opened.error();
    return c::hand_out(place, *std::move(opened), std::make_shared<const EnvironmentOptions>(options));
}

}  // namespace

extern "C" {

void domelight_environment_options_init_sized(domelight_environment_options* options, size_t struct_size) {
    c::init_struct(options, struct_size, defaults());
}

domelight_error* domelight_environment_open(const char* const* files, size_t count,
                                            const domelight_environment_options* options,
                                            domelight_environment** environment) {
    return c::guarded([&]() -> Result<void> {
        if (auto ok = c::check_given({{files, "files"}, {environment, "environment"}}); !ok) return ok;
        const auto read = read_options(options);
        if (!read) return read.error();
        std::vector<std::filesystem::path> paths;
        for (std::size_t i = 0; i < count; ++i) {
            if (auto ok = c::check_given({{files[i], "files"}}); !ok) return ok;
            paths.emplace_back(files[i]);
        }
        return hand_out(open_environment(paths, *read), *read, environment);
    });
}

domelight_error* domelight_environment_open_memory(const void* bytes, size_t size, const char* name,
                                                   const domelight_environment_options* options,
                                                   domelight_environment** environment) {
    return c::guarded([&]() -> Result<void> {
        if (auto ok = c::check_given({{bytes, "bytes"}, {environment, "environment"}}); !ok) return ok;
        const auto read = read_options(options);
        if (!read) return read.error();
        const std::span all(static_cast<const std::uint8_t*>(bytes), size);
        return hand_out(open_environment_bytes(all, c::text_or(name, "memory"), *read), *read, environment);
    });
}

}  // extern "C"
