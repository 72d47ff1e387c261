#pragma once
// What the manifest.json of a bake says of one of its files.

#include <filesystem>
#include <map>
#include <optional>
#include <string>

namespace domelight {

/// The manifest.json, in the file's folder or the one above it, that describes the file. Nothing where there is none.
std::optional<std::filesystem::path> manifest_naming(const std::filesystem::path& file);

/// The projection that the bake's manifest.json, in the file's folder or the one above it, states for a lat-long file:
/// "latlong/usd". Nothing where there is no manifest, or where it says nothing of the file.
std::optional<std::string> projection_in_manifest(const std::filesystem::path& file);

/// How the levels of a specular map were filtered, by the same manifest, as the keys of a KTX2 file state it:
/// domelight.lobe, domelight.texels, and domelight.roughness or domelight.exponent. Empty where there is no manifest,
/// where it says nothing of the file, or where the SHA-256 of the file is not the stated one.
std::map<std::string, std::string> filter_in_manifest(const std::filesystem::path& file);

/// The engine that the bake was made for, and whether the file is PlayCanvas's atlas, by the same manifest.
struct ManifestEngine {
    std::string name;  ///< empty: not known
    bool atlas = false;
};
ManifestEngine engine_in_manifest(const std::filesystem::path& file);

}  // namespace domelight
