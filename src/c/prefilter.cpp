#include "domelight/filtering/prefilter.h"

#include "domelight/filtering/harmonic/spherical_harmonics.h"
#include "domelight/filtering/probe_filter.h"
#include "domelight/filtering/quantity.h"

#include "c/environment.h"
#include "c/filtered.h"
#include "c/pixels.h"

#include <type_traits>

using namespace domelight;

namespace {

// The coefficients are handed out as an array of numbers.
static_assert(sizeof(Vec3d) == 3 * sizeof(double) && std::is_standard_layout_v<Vec3d>);

constexpr domelight_level k_level{sizeof(domelight_level), nullptr, 1, 1, 0};
constexpr domelight_prefilter_options k_options{};

Result<LevelSpec> read_level(const domelight_level* given) {
    const auto level = c::read_struct(given, k_level);
    if (!level) return level.error();
    const auto lobe = c::read_word(level->lobe, Lobe::ggx, "lobe");
    if (!lobe) return lobe.error();
    return level_spec(*lobe, level->size, is_phong(*lobe) ? level->exponent : level->roughness);
}

/// Levels lie one after the other in the size that the caller's struct has.
Result<std::vector<LevelSpec>> read_levels(const domelight_level* levels, std::size_t count) {
    std::vector<LevelSpec> read;
    if (count == 0) return read;
    if (auto ok = c::check_given({{levels, "levels"}}); !ok) return ok.error();
    for (std::size_t l = 0; l < count; ++l) {
        const auto level = read_level(c::element(levels, l));
        if (!level)
            return Error{text("level ", int(l), ": ", level.error().what), level.error().where, level.error().hint};
        read.push_back(*level);
    }
    return read;
}

Result<std::vector<Vec3d>> read_directions(const double* directions, std::size_t count) {
    std::vector<Vec3d> read;
    if (!directions) return read;
    if (count == 0) return Error{"there are none", field_place("direction_count"), "NULL stands for whole maps."};
    for (std::size_t i = 0; i < count; ++i, directions += 3)
        read.emplace_back(directions[0], directions[1], directions[2]);
    return read;
}

Result<FilterOptions> read_options(const domelight_prefilter_options& given) {
    FilterOptions options;
    if (auto ok = c::read_choice(given.layout, options.layout, "layout"); !ok) return ok.error();
    if (auto ok = c::read_choice(given.texels, options.texels, "texels"); !ok) return ok.error();
    auto levels = read_levels(given.levels, given.level_count);
    if (!levels) return levels.error();
    auto directions = read_directions(given.directions, given.direction_count);
    if (!directions) return directions.error();
    const auto turn = c::read_turn(given.world_to_source);
    if (!turn) return turn.error();
    options.specular = *std::move(levels);
    options.directions = *std::move(directions);
    options.world_to_source = *turn;
    options.irradiance_size = given.irradiance_size;
    options.sh_bands = given.sh_bands;
    options.threads = given.threads;
    options.progress = c::progress_of(given.progress, given.progress_data);
    if (auto ok = check_filter_options(options); !ok) return ok.error();
    return options;
}

Result<void> show(const FilteredMap& map, domelight_pixels* pixels) {
    return c::write_struct(pixels, c::pixels_of(map.image, map.faces()));
}

}  // namespace

extern "C" {

void domelight_level_init_sized(domelight_level* level, size_t struct_size) {
    c::init_struct(level, struct_size, k_level);
}

void domelight_prefilter_options_init_sized(domelight_prefilter_options* options, size_t struct_size) {
    c::init_struct(options, struct_size, k_options);
}

domelight_error* domelight_prefilter(const domelight_environment* environment,
                                     const domelight_prefilter_options* options, domelight_filtered** filtered) {
    return c::guarded([&]() -> Result<void> {
        if (auto ok = c::check_given({{environment, "environment"}, {options, "options"}, {filtered, "filtered"}}); !ok)
            return ok;
        const auto given = c::read_struct(options, k_options);
        if (!given) return given.error();
        const auto wanted = read_options(*given);
        if (!wanted) return wanted.error();
        auto result = prefilter(environment->environment, *wanted);
        if (!result) return result.error();
        return c::hand_out(filtered, *std::move(result));
    });
}

domelight_error* domelight_probe_filter_make(int32_t size, const domelight_prefilter_options* options,
                                             domelight_probe_filter** filter) {
    return c::guarded([&]() -> Result<void> {
        if (auto ok = c::check_given({{options, "options"}, {filter, "filter"}}); !ok) return ok;
        const auto given = c::read_struct(options, k_options);
        if (!given) return given.error();
        const auto wanted = read_options(*given);
        if (!wanted) return wanted.error();
        auto made = ProbeFilter::make(size, *wanted);
        if (!made) return made.error();
        return c::hand_out(filter, *std::move(made));
    });
}

domelight_error* domelight_probe_filter_filter(const domelight_probe_filter* filter, const domelight_pixels* cube,
                                               domelight_filtered** filtered) {
    return c::guarded([&]() -> Result<void> {
        if (auto ok = c::check_given({{filter, "filter"}, {cube, "cube"}, {filtered, "filtered"}}); !ok) return ok;
        const auto given = c::read_struct(cube, {});
        if (!given) return given.error();
        if (given->faces != 6) return Error{text(given->faces, " faces, expected 6"), field_place("cube"), ""};
        auto image = c::copy_pixels(*given, 3);
        if (!image) return image.error();
        if (auto ok = c::check_faces(*image, 6); !ok) return ok;
        auto result = filter->filter.filter(Cubemap(*std::move(image)));
        if (!result) return result.error();
        return c::hand_out(filtered, *std::move(result));
    });
}

void domelight_probe_filter_free(domelight_probe_filter* filter) {
    delete filter;
}

size_t domelight_filtered_level_count(const domelight_filtered* filtered) {
    return filtered ? filtered->result.specular.size() : 0;
}

domelight_error* domelight_filtered_level(const domelight_filtered* filtered, size_t level, domelight_pixels* pixels) {
    return c::guarded([&]() -> Result<void> {
        if (auto ok = c::check_given({{filtered, "filtered"}, {pixels, "pixels"}}); !ok) return ok;
        const auto& levels = filtered->result.specular;
        if (auto ok = c::check_index(level, levels.size(), "level"); !ok) return ok;
        return show(levels[level], pixels);
    });
}

domelight_error* domelight_filtered_irradiance_over_pi(const domelight_filtered* filtered, domelight_pixels* pixels) {
    return c::guarded([&]() -> Result<void> {
        if (auto ok = c::check_given({{filtered, "filtered"}, {pixels, "pixels"}}); !ok) return ok;
        if (filtered->result.irradiance_over_pi.empty())
            return Error{"no irradiance was filtered", field_place("irradiance_size"), "Set it in the options."};
        return show(filtered->result.irradiance_over_pi, pixels);
    });
}

const double* domelight_filtered_sh(const domelight_filtered* filtered, size_t* count) {
    const bool some = filtered && !filtered->result.sh.empty();
    if (count) *count = some ? filtered->result.sh.size() : 0;
    return some ? &filtered->result.sh.front().x : nullptr;
}

void domelight_filtered_mean(const domelight_filtered* filtered, double rgb[3]) {
    if (!filtered || !rgb) return;
    const Vec3d& mean = filtered->result.mean;
    rgb[0] = mean.x, rgb[1] = mean.y, rgb[2] = mean.z;
}

void domelight_filtered_free(domelight_filtered* filtered) {
    delete filtered;
}

domelight_error* domelight_irradiance(const domelight_environment* environment, const char* layout, int32_t size,
                                      int32_t threads, domelight_image** image) {
    return c::guarded([&]() -> Result<void> {
        if (auto ok = c::check_given({{environment, "environment"}, {image, "image"}}); !ok) return ok;
        const auto shape = c::read_word(layout, Layout::cube, "layout");
        if (!shape) return shape.error();
        if (size < 1 || size > 4096) return Error{text(size, " is not from 1 to 4096"), field_place("size"), ""};
        FilterOptions options;
        options.layout = *shape;
        options.irradiance_size = size;
        options.sh_bands = 0;
        options.threads = threads;
        if (auto ok = check_filter_options(options); !ok) return ok;
        auto result = prefilter(environment->environment, options);
        if (!result) return result.error();
        FilteredMap& map = result->irradiance_over_pi;
        for (float& value : map.pixels()) value = float(value * k_pi);
        const int faces = map.faces();
        return c::hand_out(image, std::make_shared<const ImageF>(std::move(map.image)), faces);
    });
}

domelight_error* domelight_spherical_harmonics(const domelight_environment* environment, int32_t bands,
                                               const char* quantity, const char* window, int32_t threads, double* rgb) {
    return c::guarded([&]() -> Result<void> {
        if (auto ok = c::check_given({{environment, "environment"}, {rgb, "rgb"}}); !ok) return ok;
        const auto what = c::read_word(quantity, Quantity::radiance, "quantity");
        if (!what) return what.error();
        const auto taper = c::read_word(window, ShWindow::none, "window");
        if (!taper) return taper.error();
        if (bands < 1 || bands > 64) return Error{text(bands, " is not from 1 to 64"), field_place("bands"), ""};
        FilterOptions options;
        options.sh_bands = bands;
        options.threads = threads;
        if (auto ok = check_filter_options(options); !ok) return ok;
        auto result = prefilter(environment->environment, options);
        if (!result) return result.error();
        std::vector<Vec3d> sh = std::move(result->sh);
        sh_window(sh, *taper);
        if (*what != Quantity::radiance) sh = sh_irradiance_over_pi(sh);
        for (const Vec3d& v : sh) {
            const Vec3d scaled = *what == Quantity::irradiance ? v * k_pi : v;
            *rgb++ = scaled.x, *rgb++ = scaled.y, *rgb++ = scaled.z;
        }
        return {};
    });
}

}  // extern "C"
