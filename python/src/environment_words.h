#pragma once

#include "domelight/io/environment/open_environment.h"

#include "keywords.h"

namespace domelight::python {

/// How a file is read, from the keywords of domelight.read.
EnvironmentOptions environment_options(const Keywords& words);

}  // namespace domelight::python
