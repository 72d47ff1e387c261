#pragma once

#include "domelight/base/result.h"
#include "domelight/image/image.h"
#include "domelight/image/repair_report.h"
#include "domelight/io/decode.h"

#include "image/repair.h"
#include "io/file/file_reader.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>

namespace domelight {

/// "KTX2", "KTX", "DDS" or "Babylon .env" by a file's first bytes, else empty.
std::string texture_container(std::span<const std::uint8_t> bytes);

/// The finest level of a cube texture in one of our encodings, repaired. The faces are taken to be
/// OpenGL's; those of a .env file are turned from Babylon's world into ours. `decode`: what eight bits a channel mean
/// (screen_texels.h). Errors name no file.
Result<Cubemap> read_cube_texture(std::span<const std::uint8_t> bytes, std::int64_t max_bytes, RepairOptions repair,
                                  RepairReport& report, Decode decode = Decode::automatic);

/// The finest level of the light in a glTF file with EXT_lights_image_based, repaired and times its own intensity;
/// `rotation`: the environment's, a unit quaternion x, y, z, w. `folder`: where files that it names lie; empty: nowhere.
/// Errors name no file.
struct GltfEnvironment {
    Cubemap cube;
    std::array<float, 4> rotation;
};
Result<GltfEnvironment> read_gltf_environment(std::shared_ptr<const FileBytes> bytes,
                                              const std::optional<std::filesystem::path>& folder,
                                              std::int64_t max_bytes, RepairOptions repair, RepairReport& report);

}  // namespace domelight
