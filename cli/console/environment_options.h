#pragma once

#include "domelight/environment/environment.h"
#include "domelight/io/environment/open_environment.h"

#include "cli/console/arguments.h"

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace domelight::cli {

/// What a command uses where no environment is given, for help texts.
inline constexpr const char* k_built_in_sky =
    "the built-in sky, darkened by eight stops so that its sun fits into half floats";

/// The other lat-long conventions, after latlong_convention_names(), for help texts.
inline constexpr const char* k_other_conventions =
    ", or centre=+X,right=+Z[,up=+Y]; mod is centre=-X,right=-Z, the shader form s = 1 - mod(phi / 2 pi, 1) of a world "
    "with +Z up, where phi = atan2(y, x)";

/// The options of every command that takes an environment.
void add_environment_options(Arguments& arguments, EnvironmentOptions& options);

/// The names of all projections for a help text, each followed by its remark, if any: "latlong, cube, sphere-map, ...".
std::string projection_list(const std::map<std::string, std::string>& remarks = {});

/// The environment in `files` (one image, the six faces of a cube, or a folder with these); the built-in sky where
/// there is none.
Result<Environment> open_environment_or_sky(const std::vector<std::string>& files, const EnvironmentOptions& options);

/// The same for commands that need radiance without negative values: with an error where these are to be kept.
Result<Environment> open_light_to_draw_from(const std::vector<std::string>& files, const EnvironmentOptions& options);

/// The files that make up an environment: the six faces of a cube in their order, else the arguments themselves.
std::vector<std::filesystem::path> environment_files(const std::vector<std::string>& arguments,
                                                     const EnvironmentOptions& options = {});

/// Whether the arguments are at most one environment: one file or folder, or the six faces of one cube, by their names
/// or because the options say so.
bool is_one_environment(const std::vector<std::string>& arguments, const EnvironmentOptions& options);

/// An error unless they are.
Result<void> check_one_environment(const std::vector<std::string>& arguments, const EnvironmentOptions& options);

}  // namespace domelight::cli
