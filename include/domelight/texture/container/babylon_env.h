#pragma once

#include "domelight/base/result.h"
#include "domelight/filtering/harmonic/spherical_harmonics.h"
#include "domelight/texture/texture.h"

#include <filesystem>
#include <optional>

namespace domelight {

/// Babylon.js' own container, .env: a cube with its levels as RGBD pictures, and diffuse light as a polynomial.
struct BabylonEnv {
    /// rgbd, levels from width^2 down. In OpenGL's orientation as Babylon's shader sees it: texture(cube, (X, Y, Z)) in
    /// its left-handed world, where glTF's direction (x, y, z) is (-x, y, z).
    Texture cube;
    /// E / pi convolved with the clamped cosine once more, in that world (docs/engines/babylon.md). Old files may lack
    /// it.
    std::optional<QuadraticPolynomial> irradiance;
    double lod_scale = 0.8;  ///< level = lod_scale log2(width alpha)
};

/// The polynomial that Babylon expects, in its left-handed world, from the radiance coefficients (nine or more) in
/// Domelight's world: this function mirrors x. When Babylon turns the polynomial into harmonics, it divides by the
/// factors of one convolution with the clamped cosine, so one more convolution is included here.
QuadraticPolynomial babylon_polynomial(std::span<const Vec3d> radiance);

/// Writes version 2. `cube` must have square faces, a power of two wide, and every level down to 1. Errors: any other
/// cube; a failure to write.
Result<void> write_env(const std::filesystem::path& file, const BabylonEnv& env, int threads = 0);

/// Reads versions 1 and 2. Every size and offset is checked against the file, and a picture's size against its level,
/// before memory is allocated for it.
Result<BabylonEnv> read_env(const std::filesystem::path& file);

}  // namespace domelight
