#pragma once
// glTF's EXT_lights_image_based: a prefiltered cube as pictures, one for each face of each level, and nine spherical
// harmonics coefficients of the irradiance.

#include "domelight/base/result.h"
#include "domelight/base/vec.h"
#include "domelight/image/image.h"
#include "domelight/texture/texture.h"

#include "io/file/file_reader.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace domelight {

struct GltfImageLightFile {
    Texture cube;                   ///< rgbd, OpenGL's orientation; the levels' roughness runs evenly from 0 to 1
    std::vector<Vec3d> irradiance;  ///< nine coefficients of E
    std::string name, generator;
};

/// One self-contained .gltf: its pictures are data URIs. Errors: the cube is not rgbd with a power of two's width.
Result<void> write_gltf_image_light(const std::filesystem::path& file, const GltfImageLightFile& light,
                                    int threads = 0);

/// The light of a file's scene (else its first light).
struct GltfImageLight {
    double intensity = 1;                       ///< the factor on all light
    std::array<float, 4> rotation{0, 0, 0, 1};  ///< of the environment: a quaternion x, y, z, w
    std::vector<Vec3d> irradiance;              ///< as stored, without the intensity
    std::vector<Cubemap> levels;                ///< as stored, without intensity and rotation
    bool low_dynamic_range = false;             ///< pictures without the fourth channel: sRGB
};

/// Whether the bytes may be a glTF file with such a light: checks the beginning, and searches for the extension's name.
bool may_be_gltf_image_light(std::span<const std::uint8_t> bytes);

/// `folder`: where the pictures' URIs are looked up; empty: nowhere. `most_levels`: 1 for the environment alone. Every picture's size
/// is checked against its level before it is decoded. Errors name no file.
Result<GltfImageLight> read_gltf_image_light(std::shared_ptr<const FileBytes> bytes,
                                             const std::optional<std::filesystem::path>& folder, std::int64_t max_bytes,
                                             int most_levels = 32);

}  // namespace domelight
