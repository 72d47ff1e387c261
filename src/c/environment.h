#pragma once

#include "domelight/environment/environment.h"

#include "c/border.h"

#include <string>
#include <vector>

struct domelight_environment {
    domelight::Environment environment;
    std::vector<std::string> warnings = {};  ///< those that were counted last
};
