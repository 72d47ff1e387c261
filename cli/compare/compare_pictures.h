#pragma once
// domelight compare A B: two pictures.

#include "cli/console/arguments.h"
#include "cli/console/console.h"

#include <optional>
#include <string>
#include <vector>

namespace domelight::cli {

/// What `compare` was asked on its command line for two pictures.
struct PictureWords {
    std::string layer, layer_b, mask, objects, heat, heat_of, sheet, variance = "pixel";
    std::optional<int> level;
    std::string view_exposure = "auto";
    double pixels_per_degree = 67.0206, heat_max = 0;
    bool skip_bad = false, no_flip = false;
    std::vector<std::string> fail_above, fail_below;
};
void add_picture_options(Arguments& arguments, PictureWords& words);

/// Compares and prints. Returns the exit code: 1 also where a limit is exceeded.
int compare_pictures(const std::string& a, const std::string& b, const PictureWords& words,
                     const CommonOptions& common);

}  // namespace domelight::cli
