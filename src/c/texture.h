#pragma once

#include "domelight/texture/texture.h"

#include "c/border.h"

#include <vector>

struct domelight_texture {
    domelight::Texture texture;
    std::vector<domelight::EncodingReport> reports;  ///< one for each level
    std::vector<domelight::Vec3d> sh;                ///< of the radiance, for Babylon's container; may be empty
};
