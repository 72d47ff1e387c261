#include "compare_bake.h"

#include "environment_options.h"

#include <fmt/core.h>

namespace domelight::cli {

void add_bake_options(Arguments& a, BakeWords& w) {
    a.group("A bake against its source");
    a.texts("--bake", "FILE", w.bake, "a baked specular cube: KTX2, KTX or DDS with its levels, or one cube picture or folder of faces a level");
    a.texts("--env", "SRC", w.env, "the environment it was baked from");
    add_environment_options(a, w.environment);
}

int compare_bake(const BakeWords&, const CommonOptions&) {
    return exit_failed;
}

}  // namespace domelight::cli
