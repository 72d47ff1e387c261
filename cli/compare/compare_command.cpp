#include "domelight/bake/bake.h"

#include "cli/commands.h"
#include "cli/compare/compare_bake.h"
#include "cli/compare/compare_pictures.h"
#include "cli/console/console.h"

#include <fmt/core.h>

namespace domelight::cli {

int run_compare(const std::vector<std::string>& words) {
    CommonOptions common;
    PictureWords pictures;
    BakeWords bake;
    std::vector<std::string> inputs;
    Arguments arguments(
        "compare",
        "Compares picture A with the reference B: in numbers, as a heat map, side by side. With --bake, compares a "
        "specular cube baked by any tool with the exact filter of its source; the exit status is then 0 for a bake of "
        "that environment whose errors --within allows, and 1 for any other.",
        {"domelight compare studio.hdr evening.hdr",
         "domelight compare studio.hdr studio.hdr --fail-above relative=0.01 --json",
         "domelight compare studio.hdr evening.hdr --heat heat.png --sheet sheet.png",
         "domelight compare --bake out/specular.ktx2 --env studio.hdr"});
    arguments.positional("A B", inputs,
                         "the picture and the reference: OpenEXR, Radiance HDR, PNG, JPEG, KTX2, KTX, DDS");
    add_picture_options(arguments, pictures);
    add_bake_options(arguments, bake);
    add_common_options(arguments, common);
    if (const auto code = begin_command(arguments, words, common)) return *code;
    const bool audit = !bake.bake.empty();
    warn_of_idle_options(arguments,
                         {{"--env", audit, "--bake"},
                          {"--for", audit, "--bake"},
                          {"--lobe", audit, "--bake"},
                          {"--within", audit, "--bake"},
                          {"--texels", audit, "--bake"},
                          {"--layer-b", !audit, "two pictures"},
                          {"--level", !audit, "two pictures"},
                          {"--mask", !audit, "two pictures"},
                          {"--objects", !audit, "two pictures"},
                          {"--variance", !audit, "two pictures"},
                          {"--skip-bad", !audit, "two pictures"},
                          {"--no-flip", !audit, "two pictures"},
                          {"--heat", !audit, "two pictures"},
                          {"--sheet", !audit, "two pictures"},
                          {"--fail-above", !audit, "two pictures"},
                          {"--fail-below", !audit, "two pictures"},
                          {"--heat-of", !pictures.heat.empty(), "--heat"},
                          {"--heat-max", !pictures.heat.empty(), "--heat"},
                          {"--pixels-per-degree", !audit && !pictures.no_flip, "FLIP, which --no-flip leaves out"}},
                         common);
    if (audit) {
        if (!inputs.empty())
            return print_error({"audits a bake: it takes no pictures A and B", "--bake", "Name the source with --env."},
                               exit_usage);
        return compare_bake(bake, common);
    }
    if (inputs.size() != 2)
        return print_error({fmt::format("needs two pictures, got {}", inputs.size()), "compare",
                            "Say: domelight compare A B, or: domelight compare --bake THEIRS --env SRC."},
                           exit_usage);
    pictures.layer = bake.environment.layer;
    return compare_pictures(inputs[0], inputs[1], pictures, common);
}

}  // namespace domelight::cli
