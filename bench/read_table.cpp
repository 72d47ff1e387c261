// The error of each engine's chain as a shader reads it, in the encoding that is stored: between texels and between
// levels.
//
//     read_table [--for ENGINE]... [--size N] [--levels N] [--roughness r0,r1,...]
//                               [--texels centre|read] FILE...
//
// Prints a line for each engine and file, and the levels of each at their own roughness. Engines that filter by
// themselves have no chain and are left out.

#include "domelight/bake/bake.h"
#include "domelight/io/environment/open_environment.h"

#include "bake/chain_as_read.h"

#include <fmt/core.h>

#include <cstdlib>
#include <cstring>
#include <sstream>

using namespace domelight;

namespace {

[[noreturn]] void fail(const Error& error) {
    fmt::print(stderr, "error: {}\n", error.format());
    std::exit(1);
}

template <typename T>
T take(Result<T> result) {
    if (!result) fail(result.error());
    return std::move(*result);
}

std::vector<std::string> engines_with_chains() {
    std::vector<std::string> names;
    for (const Engine& engine : engines())
        if (!engine.environment_only) names.push_back(engine.name);
    return names;
}

std::vector<FilteredMap> filtered(const EnginePlan& plan, const std::vector<LevelPlan>& levels,
                                  const Environment& environment) {
    FilterOptions filter;
    filter.layout = plan.layout;
    filter.texels = plan.texels;
    filter.sh_bands = 0;
    for (const LevelPlan& level : levels) filter.specular.push_back(level.spec);
    return take(prefilter(environment, filter)).specular;
}

void print_row(const std::string& name, const ReadErrors& errors) {
    fmt::print("  {:<20} {:>9.2e} {:>9.2e}  |", name, errors.relative_rmse, errors.largest);
    for (const ReadErrorAt& at : errors.levels)
        fmt::print(" {:.3f}: {:.1e} {:.1e} ", at.roughness, at.relative_rmse, at.largest);
    fmt::print("\n");
}

void measure(const EnginePlan& plan, const BakeOptions& options, const Environment& environment) {
    const auto row = [&](const std::string& name, Lobe lobe, const std::vector<LevelPlan>& levels) {
        if (levels.empty()) return;
        const auto maps = filtered(plan, levels, environment);
        print_row(name, take(measure_as_read(chain_as_read(plan, lobe, levels, maps, options), environment)));
    };
    row(plan.engine->name, plan.lobe, plan.specular);
    row(plan.engine->name + ", sheen", Lobe::charlie, plan.sheen);
}

}  // namespace

int main(int argc, char** argv) {
    BakeOptions options;
    options.engines.clear();
    std::vector<std::filesystem::path> files;
    for (int i = 1; i < argc; ++i) {
        const auto is = [&](const char* name) { return !std::strcmp(argv[i], name) && i + 1 < argc; };
        if (is("--for"))
            options.engines.push_back(argv[++i]);
        else if (is("--size"))
            options.size = std::atoi(argv[++i]);
        else if (is("--levels"))
            options.levels = std::atoi(argv[++i]);
        else if (is("--texels"))
            options.texels = take(from_name<Texels>(argv[++i]));
        else if (is("--roughness")) {
            std::stringstream words(argv[++i]);
            for (std::string word; std::getline(words, word, ',');) options.roughness.push_back(std::stod(word));
        } else
            files.emplace_back(argv[i]);
    }
    if (options.engines.empty()) options.engines = engines_with_chains();
    for (const auto& file : files) {
        const Environment environment = take(open_environment({file}));
        fmt::print("{}\n  {:<20} {:>9} {:>9}  | each level's roughness: RMSE, largest\n", file.filename().string(), "",
                   "RMSE", "largest");
        for (const EnginePlan& plan : take(plan_bake(options, &environment))) measure(plan, options, environment);
    }
}
