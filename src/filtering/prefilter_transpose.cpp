#include "domelight/filtering/prefilter_transpose.h"

#include "domelight/base/parallel.h"
#include "domelight/filtering/harmonic/spherical_harmonics.h"
#include "domelight/projection/projection.h"

#include "base/field_place.h"
#include "base/large_memory.h"
#include "base/text.h"
#include "filtering/filter_plan.h"
#include "filtering/harmonic/ring_grid.h"
#include "filtering/harmonic/scatter_analysis.h"
#include "filtering/harmonic/sh_synthesis.h"
#include "filtering/harmonic/transposed_analysis.h"

#include <algorithm>
#include <cmath>

namespace domelight {
namespace {

/// A map of the filter: where its values lie, and with which kernel they were filtered.
struct FilteredPart {
    const FilteredMap* map;
    ZonalKernel kernel;
    int size;
};

Result<std::vector<FilteredPart>> parts_of(const FilterResult& values, const FilterOptions& options) {
    std::vector<FilteredPart> parts;
    if (!values.specular.empty() && values.specular.size() != options.specular.size())
        return Error{text(int(values.specular.size()), " maps for ", int(options.specular.size()), " levels"),
                     field_place("specular"), ""};
    for (std::size_t l = 0; l < values.specular.size(); ++l) {
        if (options.specular[l].mirror)
            return Error{text("level ", int(l), " is the environment itself, which has no transpose here"),
                         field_place("specular"), "Use a roughness above 0."};
        parts.push_back({&values.specular[l], options.specular[l].kernel, options.specular[l].size});
    }
    if (options.irradiance_size > 0)
        parts.push_back({&values.irradiance_over_pi, ZonalKernel::cosine(), options.irradiance_size});
    std::erase_if(parts, [](const FilteredPart& part) { return part.map->empty(); });
    for (const FilteredPart& part : parts) {
        const ImageF& image = part.map->image;
        const bool directed = !options.directions.empty(), cube = options.layout == Layout::cube;
        const int width = directed ? int(options.directions.size()) : cube ? part.size : 2 * part.size;
        const int height = directed ? 1 : cube ? 6 * part.size : part.size;
        if (image.width() != width || image.height() != height || image.channels() != 3)
            return Error{
                text("a map has ", image.width(), " x ", image.height(), " texels, expected ", width, " x ", height),
                field_place("values"), ""};
    }
    return parts;
}

/// The values of a map as points on the source's sphere.
PointLights points_of(const FilteredPart& part, const FilterOptions& options) {
    PointLights points;
    const ImageF& image = part.map->image;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            const Vec3d world = options.directions.empty()
                                    ? map_direction(options.layout, part.map->width(), part.map->height(), x, y)
                                    : normalize(options.directions[std::size_t(x)]);
            points.add(options.world_to_source * world, 1, image.at(x, y));
        }
    return points;
}

/// Adds the degrees of a spectrum, each times the kernel's coefficient.
void add_filtered(Spectrum& sum, const Spectrum& spectrum, const std::vector<double>& factors) {
    const int band_limit = int(factors.size()) - 1;
    for (int m = 0; m <= band_limit; ++m)
        for (int parity = 0; parity < 2; ++parity) {
            float* to = sum.block(m, parity);
            const float* from = spectrum.block(m, parity);
            for (int l = m + parity, i = 0; l <= band_limit; l += 2, ++i)
                for (int c = 0; c < 6; ++c) to[6 * i + c] += float(factors[std::size_t(l)] * from[6 * i + c]);
        }
}

/// The maps' part: the points are spread by their kernels, and what arrives at each texel's tent is gathered.
void add_maps(const std::vector<FilteredPart>& parts, const FilterOptions& options, ImageView<float> image) {
    int band_limit = 0;
    for (const FilteredPart& part : parts) band_limit = std::max(band_limit, required_band_limit(part.kernel, false));
    if (band_limit == 0) return;
    Spectrum sum(band_limit);
    for (const FilteredPart& part : parts) {
        const int own = required_band_limit(part.kernel, false);
        add_filtered(sum, analyse_lights(points_of(part, options), grid_transform(own), options.threads),
                     part.kernel.coefficients(own));
    }
    const SynthesisFactors whole{std::vector<double>(std::size_t(band_limit) + 1, 1), {}};
    const auto grids = sh_synthesis(sum, nullptr, {&whole, 1}, *grid_transform(band_limit), options.threads);
    add_tent_integrals(grids[0], band_limit, image, options.threads);
}

/// The harmonics' part: their sum with the given coefficients, a smooth function, against the tents.
void add_harmonics(std::span<const Vec3d> sh, const FilterOptions& options, ImageView<float> image) {
    if (sh.empty()) return;
    const int bands = int(std::lround(std::sqrt(double(sh.size())))), band_limit = std::max(64, 3 * (bands - 1));
    SphereGrid function(ring_grid_for(band_limit));
    const RingGrid grid = function.grid();
    const Mat3 to_world = options.world_to_source.transposed();
    parallel_for(grid.rings, options.threads, [&](int k) {
        for (int i = 0; i < grid.width; ++i) {
            const double theta = k_pi * (k + 0.5) / grid.rings, phi = 2 * k_pi * i / grid.width, s = std::sin(theta);
            const Vec3d value =
                sh_evaluate(sh, to_world * Vec3d{s * std::cos(phi), std::cos(theta), s * std::sin(phi)});
            float* rgb = function.ring(k) + 4 * i;
            rgb[0] = float(value.x), rgb[1] = float(value.y), rgb[2] = float(value.z);
        }
    });
    function.wrap();
    add_tent_integrals(function, band_limit, image, options.threads);
}

}  // namespace

Result<ImageF> prefilter_transpose(int width, int height, const FilterResult& values, const FilterOptions& options) {
    if (width < 1 || height < 1) return Error{"has no texels", field_place("width"), ""};
    if (auto ok = check_filter_options(options); !ok) return ok.error();
    if (options.texels != Texels::centre)
        return Error{"read has no transpose", field_place("texels"), "Use texels centre."};
    const auto parts = parts_of(values, options);
    if (!parts) return parts.error();
    if (const std::size_t count = std::size_t(options.sh_bands) * std::size_t(options.sh_bands);
        !values.sh.empty() && values.sh.size() != count)
        return Error{text(int(values.sh.size()), " coefficients, expected ", int(count)), field_place("sh"), ""};
    const LargeMemoryReuse reuse;
    ImageF image(width, height, 3);
    add_maps(*parts, options, image);
    add_harmonics(values.sh, options, image);
    return image;
}

}  // namespace domelight
