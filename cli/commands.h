#pragma once
// The commands, one a file. Each takes the words after its name and returns the exit code.

#include <string>
#include <vector>

namespace domelight::cli {

int run_bake(const std::vector<std::string>& words);
int run_batch(const std::vector<std::string>& words);
int run_brdf(const std::vector<std::string>& words);
int run_compare(const std::vector<std::string>& words);
int run_convert(const std::vector<std::string>& words);
int run_info(const std::vector<std::string>& words);
int run_probes(const std::vector<std::string>& words);
int run_render(const std::vector<std::string>& words);
int run_lights(const std::vector<std::string>& words);
int run_sample(const std::vector<std::string>& words);
int run_sky(const std::vector<std::string>& words);
int run_view(const std::vector<std::string>& words);

}  // namespace domelight::cli
