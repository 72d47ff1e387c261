#include "domelight/bake/bake.h"

#include "c/environment.h"

#include <cstdint>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

using namespace domelight;

namespace {

domelight_bake_options defaults() {
    domelight_bake_options options{};
    options.sh_bands = BakeOptions().sh_bands;
    options.preview = options.hashes = 1;
    return options;
}

/// A word for a field that each engine has a default of its own for.
/// "three, babylon" in its parts.
std::vector<std::string> parts_of(const std::string& words) {
    std::vector<std::string> parts(1);
    for (const char letter : words) {
        if (letter == ',')
            parts.emplace_back();
        else if (letter != ' ')
            parts.back() += letter;
    }
    return parts;
}

Result<void> read_words(const domelight_bake_options& given, BakeOptions& options) {
    if (given.engines) options.engines = parts_of(given.engines);
    if (given.latlong_out) options.latlong_out = given.latlong_out;
    if (auto ok = c::read_optional(given.layout, options.layout, "layout"); !ok) return ok;
    if (auto ok = c::read_optional(given.lobe, options.lobe, "lobe"); !ok) return ok;
    if (auto ok = c::read_optional(given.texels, options.texels, "texels"); !ok) return ok;
    if (auto ok = c::read_optional(given.encoding, options.encoding, "encoding"); !ok) return ok;
    if (auto ok = c::read_optional(given.format, options.format, "format"); !ok) return ok;
    if (auto ok = c::read_optional(given.irradiance_quantity, options.irradiance_quantity, "irradiance_quantity"); !ok)
        return ok;
    if (auto ok = c::read_choice(given.encoding_quality, options.encoding_quality, "encoding_quality"); !ok) return ok;
    if (auto ok = c::read_choice(given.sh_window, options.sh_window, "sh_window"); !ok) return ok;
    return c::read_choice(given.brdf_masking, options.brdf_g, "brdf_masking");
}

Result<BakeOptions> read_options(const domelight_bake_options* options) {
    const auto given = c::read_struct(options, defaults());
    if (!given) return given.error();
    BakeOptions read;
    if (auto ok = read_words(*given, read); !ok) return ok.error();
    for (const auto& [numbers, count, name] : {std::tuple(given->roughness, given->roughness_count, "roughness"),
                                               std::tuple(given->exponents, given->exponent_count, "exponents")})
        if (count > 0)
            if (auto ok = c::check_given({{numbers, name}}); !ok) return ok.error();
    read.roughness.assign(given->roughness, given->roughness + given->roughness_count);
    read.exponents.assign(given->exponents, given->exponents + given->exponent_count);
    if (given->size) read.size = given->size;
    if (given->levels) read.levels = given->levels;
    if (given->irradiance_size) read.irradiance_size = given->irradiance_size;
    if (given->brdf_size) read.brdf_size = given->brdf_size;
    read.sh_bands = given->sh_bands;
    read.preview = given->preview != 0;
    read.hashes = given->hashes != 0;
    read.threads = given->threads;
    read.progress = c::progress_of(given->progress, given->progress_data);
    if (auto ok = check_bake_options(read); !ok) return ok.error();
    return read;
}

}  // namespace

extern "C" {

void domelight_bake_options_init_sized(domelight_bake_options* options, size_t struct_size) {
    c::init_struct(options, struct_size, defaults());
}

domelight_error* domelight_bake(const domelight_environment* environment, const domelight_bake_options* options,
                                const char* folder) {
    return c::guarded([&]() -> Result<void> {
        if (auto ok = c::check_given({{environment, "environment"}, {folder, "folder"}}); !ok) return ok;
        auto wanted = read_options(options);
        if (!wanted) return wanted.error();
        wanted->source_files = environment->environment.files;
        if (environment->opened) wanted->environment = *environment->opened;
        const auto report = bake(environment->environment, *wanted, folder);
        if (!report) return report.error();
        return {};
    });
}

}  // extern "C"
