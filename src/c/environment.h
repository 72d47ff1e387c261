#pragma once

#include "domelight/environment/environment.h"

#include "c/border.h"

#include <memory>
#include <string>
#include <vector>

namespace domelight {
struct EnvironmentOptions;
}

struct domelight_environment {
    domelight::Environment environment;
    /// How its files were opened; null for one from pixels.
    std::shared_ptr<const domelight::EnvironmentOptions> opened = nullptr;
    std::vector<std::string> warnings = {};  ///< those that were counted last
};
