#pragma once
// probes.json: what docs/probes.md describes, written and read in one place.

#include "domelight/probe/probe_set.h"

#include "io/file/json.h"

namespace domelight {

inline constexpr const char* k_probes_json = "probes.json";

/// One of the files of cubes.
struct ProbeMapRecord {
    std::string file, sha256, encoding;
    int size = 0;  ///< of a face of level 0
};

struct ProbeSetRecord {
    std::string version;  ///< of the program
    ProbeSource scene, environment;
    Json options = Json::object();  ///< of the capture, for people and for --check
    std::optional<ProbeGrid> grid;
    std::vector<Probe> probes;
    std::vector<std::array<Vec3d, 9>> harmonics;  ///< of each probe's radiance
    std::vector<std::array<int, 4>> tetrahedra;
    std::vector<float> roughness;  ///< of the specular levels
    ProbeMapRecord specular, irradiance;
    std::optional<ProbeMapRecord> distance;
    float farthest = 0;  ///< metres: the distance of directions without a surface
};

/// Its files, relative to its folder; probes.json is the first.
std::vector<std::string> files_of(const ProbeSetRecord& record);

/// A vector, a box and an influence as probes.json has them; numbers in as many digits as a float needs.
Json vector_json(const Vec3f& v);
Json box_json(const ProbeBox& box);
Json influence_json(const ProbeInfluence& influence);

std::string probe_record_text(const ProbeSetRecord& record);

/// Reads FOLDER/probes.json. Errors name it, and the member that is wrong.
Result<ProbeSetRecord> read_probe_record(const std::filesystem::path& folder);

}  // namespace domelight
