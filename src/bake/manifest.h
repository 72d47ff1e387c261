#pragma once
// The JSON documents that a bake writes and reads back.

#include "domelight/bake/bake.h"

#include "bake/plan.h"

#include <filesystem>
#include <string>

namespace domelight {

/// The part of manifest.json about the source.
struct SourceReport {
    std::string file;  ///< without its folder, so that the bytes do not depend on its location; six faces: their names
    std::string sha256;
    std::string format, projection;
    std::string layer;  ///< of an OpenEXR file, as in Environment
    int width = 0, height = 0;
    RepairReport repaired;
};

/// manifest.json of one engine: no times, nothing that depends on the machine or on the engines baked with it.
std::string manifest_json(const EngineReport& report, const EnginePlan& plan, const BakeOptions& options,
                          const SourceReport& source, const Vec3d& mean_radiance);

/// sh.json: radiance and irradiance coefficients with the convention spelled out, and their error.
std::string sh_json(const ShReport& sh);

/// Whether `folder` has a manifest of this version, these options and this source, and every file that it names,
/// unchanged.
bool manifest_matches(const std::filesystem::path& folder, const EnginePlan& plan, const BakeOptions& options,
                      const std::string& source_sha256);

}  // namespace domelight
