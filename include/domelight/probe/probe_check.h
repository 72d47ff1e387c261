#pragma once

#include "domelight/base/result.h"

#include <filesystem>
#include <string>
#include <vector>

namespace domelight {

/// What a set is to be held against; an empty hash is not.
struct ProbeCheck {
    std::string scene_sha256;        ///< scene_sha256() of the scene as it is now
    std::string environment_sha256;  ///< environment_sha256() likewise
};

/// Whether a set of probes is whole, and still that of a scene: a sentence for each thing that is not as probes.json
/// says, none where all is well. Errors: no set, or one whose probes.json cannot be read.
Result<std::vector<std::string>> check_probe_set(const std::filesystem::path& folder, const ProbeCheck& check);

}  // namespace domelight
