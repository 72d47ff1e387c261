#pragma once

#include "compare/stored_bake.h"
#include "io/file/json.h"

#include <optional>
#include <string>
#include <vector>

namespace domelight {

/// An audit as a document (docs/manifest.md).
///
/// bake_files, env_files   as the user named them
/// as_convention           of convention_of()
/// warnings                of reading the environment; the audit's notes come behind them
Json audit_json(const std::vector<std::string>& bake_files, const std::vector<std::string>& env_files,
                const StoredBake& bake, const BakeAudit& audit, const std::optional<ReadErrors>& as_read,
                const std::string& as_convention, std::vector<std::string> warnings);

}  // namespace domelight
