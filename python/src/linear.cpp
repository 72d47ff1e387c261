#include "linear.h"

#include "domelight/filtering/prefilter.h"
#include "domelight/filtering/prefilter_transpose.h"

#include "base/field_place.h"
#include "environment.h"
#include "keywords.h"
#include "maps.h"
#include "projection/latlong_convention.h"
#include "work.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace domelight::python {
namespace {

/// One level for each of `widths` (roughness, or Phong exponents), of the `sizes`.
FilterOptions linear_options(const Keywords& words) {
    FilterOptions options;
    Lobe lobe = Lobe::ggx;
    std::vector<double> sizes, widths;
    words.read("lobe", lobe);
    words.read("sizes", sizes);
    words.read("widths", widths);
    words.read("layout", options.layout);
    words.read("irradiance_size", options.irradiance_size);
    options.sh_bands = 0;
    words.read("sh_bands", options.sh_bands);
    words.read("world_to_source", options.world_to_source);
    words.read("threads", options.threads);
    const char* const keyword = is_phong(lobe) ? "exponents" : "roughness";
    for (std::size_t l = 0; l < widths.size(); ++l) {
        const LevelSpec level = value_of(level_spec(lobe, int(sizes.at(l)), widths[l]));
        if (level.mirror)
            throw Failure({fmt::format("level {} is the environment itself, which is not filtered", l),
                           field_place(keyword), "Use a roughness above 0."});
        options.specular.push_back(level);
    }
    if (words.has("directions")) options.directions = directions_of(words.find("directions"), "directions");
    value_of(check_filter_options(options));
    return options;
}

void check_finite(const ImageF& image) {
    for (std::size_t i = 0; i < image.pixels().size(); ++i)
        if (!std::isfinite(image.pixels()[i]))
            throw Failure({fmt::format("{} at row {}, column {} is not finite", image.pixels()[i],
                                       i / std::size_t(3 * image.width()), i / 3 % std::size_t(image.width())),
                           field_place("environment"), ""});
}

FilterResult filter(const ImageF& image, const FilterOptions& options) {
    ImageRowSource rows(image);
    return value_of(prefilter(rows, options));
}

void subtract(FilteredMap& map, const FilteredMap& other) {
    for (std::size_t i = 0; i < map.pixels().size(); ++i) map.pixels()[i] -= other.pixels()[i];
}

/// The filter of an image of any sign: the difference of those of its two signs.
FilterResult filter_signed(ImageF image, const FilterOptions& options) {
    const auto pixels = image.pixels();
    if (std::none_of(pixels.begin(), pixels.end(), [](float v) { return v < 0; })) return filter(image, options);
    ImageF negative = image;
    for (float& v : negative.pixels()) v = std::max(-v, 0.f);
    for (float& v : image.pixels()) v = std::max(v, 0.f);
    FilterResult result = filter(image, options);
    const FilterResult other = filter(negative, options);
    for (std::size_t l = 0; l < result.specular.size(); ++l) subtract(result.specular[l], other.specular[l]);
    if (!result.irradiance_over_pi.empty()) subtract(result.irradiance_over_pi, other.irradiance_over_pi);
    for (std::size_t i = 0; i < result.sh.size(); ++i) result.sh[i] = result.sh[i] - other.sh[i];
    return result;
}

/// Lists of arrays: the levels; E / pi; the harmonics.
nb::tuple run_filter(nb::handle array, const nb::dict& dictionary) {
    const FilterOptions options = linear_options(Keywords(dictionary));
    ImageF image = ArrayPixels::borrow(array, 3, "environment").copy();
    check_finite(image);
    FilterResult result =
        run_work_for(nb::none(), [&](const Progress&) { return filter_signed(std::move(image), options); });
    const bool directed = !options.directions.empty();
    nb::list specular, sh;
    for (FilteredMap& map : result.specular) specular.append(array_of(std::move(map), directed));
    for (const Vec3d& v : result.sh) sh.append(tuple_of(v));
    return nb::make_tuple(specular,
                          result.irradiance_over_pi.empty()
                              ? nb::none()
                              : array_of(std::move(result.irradiance_over_pi), directed),
                          sh);
}

FilteredMap map_or_row(nb::handle array, bool directed) {
    if (array.is_none()) return {};
    if (!directed) return map_of(array, "gradient");
    const ArrayPixels pixels = ArrayPixels::borrow(array, 3, "gradient");
    return {Layout::latlong, pixels.copy()};
}

/// `values`: as run_filter() gives them, None for 0; with directions each map has the shape (1, count, 3).
nb::object run_transpose(int width, int height, const nb::tuple& values, const nb::dict& dictionary) {
    const FilterOptions options = linear_options(Keywords(dictionary));
    const bool directed = !options.directions.empty();
    FilterResult given;
    for (nb::handle map : values[0]) given.specular.push_back(map_or_row(map, directed));
    given.irradiance_over_pi = map_or_row(values[1], directed);
    for (nb::handle row : values[2])
        given.sh.push_back({nb::cast<double>(row[0]), nb::cast<double>(row[1]), nb::cast<double>(row[2])});
    return numpy_of(run_work_for(nb::none(), [&](const Progress&) {
        return value_of(prefilter_transpose(width, height, given, options));
    }));
}

/// The conventions that have names: for each the matrix (rows) from world directions to those of the default, and whether
/// the first and last rows lie on the poles, and the first and last columns on the picture's edges.
nb::dict latlong_conventions() {
    nb::dict conventions;
    for (const std::string& name : latlong_convention_names()) {
        const LatlongConvention c = value_of(latlong_convention(name));
        const Mat3 m = c.world_to_default();
        conventions[name.c_str()] =
            nb::make_tuple(nb::make_tuple(tuple_of(m.row[0]), tuple_of(m.row[1]), tuple_of(m.row[2])),
                           c.grid != SampleGrid::centres, c.grid == SampleGrid::both_on_edges);
    }
    return conventions;
}

}  // namespace

void declare_linear(nb::module_& module) {
    module.def("latlong_conventions", &latlong_conventions);
    module.def("linear_filter", &run_filter, nb::arg("environment"), nb::arg("options"));
    module.def("linear_transpose", &run_transpose, nb::arg("width"), nb::arg("height"), nb::arg("values"),
               nb::arg("options"));
}

}  // namespace domelight::python
