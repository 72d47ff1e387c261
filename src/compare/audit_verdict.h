#pragma once
// The verdict of an audit.

#include "domelight/compare/bake_audit.h"

namespace domelight {

/// The audit with of_source, within, verdict and notes set by its other members.
BakeAudit judged(BakeAudit audit, const Environment& source, const AuditOptions& options);

}  // namespace domelight
