#include "domelight/probe/probe_check.h"

#include "io/file/sha256.h"
#include "probe/probe_record.h"

#include <fmt/core.h>

namespace domelight {
namespace {

void check_source(const char* what, const ProbeSource& recorded, const std::string& now,
                  std::vector<std::string>& changes) {
    if (!now.empty() && !recorded.sha256.empty() && now != recorded.sha256)
        changes.push_back(fmt::format("the {} is not the one that was captured{}", what,
                                      recorded.file.empty() ? "" : fmt::format(": {}, as it was then", recorded.file)));
}

}  // namespace

Result<std::vector<std::string>> check_probe_set(const std::filesystem::path& folder, const ProbeCheck& check) {
    const auto record = read_probe_record(folder);
    if (!record) return record.error();
    std::vector<std::string> changes;
    check_source("scene", record->scene, check.scene_sha256, changes);
    check_source("environment", record->environment, check.environment_sha256, changes);
    for (const ProbeMapRecord* map :
         {&record->specular, &record->irradiance, record->distance ? &*record->distance : nullptr}) {
        if (!map) continue;
        const auto hash = sha256_in_folder(folder, map->file);
        if (!hash)
            changes.push_back(fmt::format("{}: {}", map->file, hash.error().what));
        else if (*hash != map->sha256)
            changes.push_back(fmt::format("{} is not the file that was written", map->file));
    }
    return changes;
}

}  // namespace domelight
