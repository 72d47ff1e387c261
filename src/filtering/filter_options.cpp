#include "domelight/filtering/prefilter.h"

#include "base/field_place.h"
#include "base/text.h"

#include <algorithm>
#include <cmath>

namespace domelight {

LevelSpec glossy_level_spec(Lobe lobe, int size, double roughness) {
    // Charlie has no mirror: its lobe lies along the horizon.
    if (lobe == Lobe::charlie) roughness = std::max(roughness, k_charlie_least_roughness);
    const bool mirror = roughness == 0;
    return {size, mirror, {lobe, mirror ? 1 : roughness * roughness}};  // of a mirror any valid kernel: not used
}

LevelSpec phong_level_spec(Lobe lobe, int size, double exponent) {
    const bool mirror = std::isinf(exponent);
    return {size, mirror, {lobe, mirror ? 1 : exponent}};
}

namespace {

constexpr int k_most_size = 16384;

Error outside(const char* field, double value, const std::string& range) {
    return {text(value, " is not ", range), field_place(field), ""};
}

Result<void> check_kernel(const ZonalKernel& kernel) {
    if (is_phong(kernel.lobe)) {
        if (!(kernel.width >= 0 && std::isfinite(kernel.width))) return outside("exponent", kernel.width, "0 or more");
    } else if (!(kernel.width > 0 && kernel.width <= 1)) {
        return outside("alpha", kernel.width, "above 0 and at most 1");
    }
    return {};
}

Result<void> check_size(int size) {
    if (size < 1 || size > k_most_size) return outside("size", size, text("from 1 to ", k_most_size));
    return {};
}

Result<void> check_level(const LevelSpec& level, bool in_directions) {
    if (!in_directions)
        if (auto ok = check_size(level.size); !ok) return ok;
    if (!level.mirror) return check_kernel(level.kernel);
    if (in_directions)
        return Error{"a level that is the environment itself has no value in single directions",
                     field_place("directions"), "Environment::radiance looks the light up."};
    return {};
}

bool is_finite(const Vec3d& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool is_orthogonal(const Mat3& m) {
    constexpr double tolerance = 1e-6;  // of matrices that were made in float
    const Mat3 product = m * m.transposed();
    double off = 0;
    for (int i = 0; i < 3; ++i) {
        if (!is_finite(product.row[i])) return false;
        const Vec3d difference = product.row[i] - Mat3().row[i];
        off = std::fmax(off, length(difference));
    }
    return off <= tolerance;
}

}  // namespace

Result<LevelSpec> level_spec(Lobe lobe, int size, double width) {
    if (auto ok = check_size(size); !ok) return ok.error();
    if (is_phong(lobe)) {
        if (!(width >= 0)) return outside("exponent", width, "0 or more");
        return phong_level_spec(lobe, size, width);
    }
    if (!(width >= 0 && width <= 1)) return outside("roughness", width, "from 0 to 1");
    return glossy_level_spec(lobe, size, width);
}

Result<void> check_filter_options(const FilterOptions& options) {
    const bool in_directions = !options.directions.empty();
    for (const LevelSpec& level : options.specular)
        if (auto ok = check_level(level, in_directions); !ok) return ok;
    for (const Vec3d& direction : options.directions)
        if (!is_finite(direction) || length(direction) == 0)
            return Error{text("(", direction.x, ", ", direction.y, ", ", direction.z, ") is not a direction"),
                         field_place("directions"), ""};
    if (options.irradiance_size < 0 || options.irradiance_size > 4096)
        return outside("irradiance_size", options.irradiance_size, "from 0 to 4096");
    if (options.sh_bands < 0 || options.sh_bands > 64) return outside("sh_bands", options.sh_bands, "from 0 to 64");
    if (!is_orthogonal(options.world_to_source))
        return Error{"is not an orthogonal matrix", field_place("world_to_source"),
                     "Its rows must be of unit length and at right angles to each other."};
    if (options.threads < 0 || options.threads > 1024) return outside("threads", options.threads, "from 0 to 1024");
    return {};
}

}  // namespace domelight
