#pragma once

#include "io/file/json.h"

#include <filesystem>
#include <map>
#include <optional>
#include <string>

namespace domelight {

/// What the manifest.json of a bake, in a file's folder or the one above it, says of the file.
class ManifestEntry {
  public:
    /// Nothing where there is no manifest, or where it says nothing of the file.
    static std::optional<ManifestEntry> of(const std::filesystem::path& file);

    const std::filesystem::path& manifest() const { return manifest_; }
    /// Of a lat-long file: "latlong/usd". Nothing where none is stated.
    std::optional<std::string> projection() const;
    /// The engine that the bake was made for; empty: not known.
    std::string engine() const;
    /// Whether the file is PlayCanvas's atlas.
    bool is_atlas() const;
    /// How the levels of a specular map were filtered, as the keys of a KTX2 file state it: domelight.lobe,
    /// domelight.texels, and domelight.roughness or domelight.exponent. Empty where the SHA-256 of the file is not the
    /// stated one.
    std::map<std::string, std::string> filter() const;

  private:
    ManifestEntry(std::filesystem::path file, std::filesystem::path manifest, Json document, Json map)
        : file_(std::move(file)),
          manifest_(std::move(manifest)),
          document_(std::move(document)),
          map_(std::move(map)) {}

    std::filesystem::path file_, manifest_;
    Json document_, map_;  ///< the manifest, and the member of it that describes the file
};

}  // namespace domelight
