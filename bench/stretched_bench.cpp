// The errors of split-sum's round lobe and of the stretched lobe: RMSE of L / (1 + L) against the reflection integral,
// without occlusion, by roughness and viewing angle, under real environments.
//
//   stretched_bench [--f0 X] [--directions N] [--samples N] [--brief] [FILE ...]
//
// Without files: five under DOMELIGHT_DATA. Fails if the stretched lobe is more than 5 % worse than split-sum anywhere,
// or, with F0 = 1, not at least twice as good over roughness 0.1 to 0.6 and NdotV < 0.4.

#include "domelight/io/environment/open_environment.h"

#include "shading_error.h"

#include <fmt/core.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>

using namespace domelight;
using namespace domelight::test;

namespace {

constexpr double k_roughness[] = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6};
constexpr double k_cosines[] = {0.05, 0.15, 0.25, 0.35, 0.5, 0.7, 0.9, 1.0};
constexpr double k_grazing = 0.4;

struct Summary {
    SquareErrors grazing;
    double worst = 0;        ///< largest ratio of a cell at grazing angles
    double worst_above = 0;  ///< and at other angles
};

Result<Summary> report(const std::filesystem::path& file, LobeQuestion q, bool brief) {
    EnvironmentOptions options;
    auto environment = open_environment({file}, options);
    if (!environment) return environment.error();
    auto sampler = EnvironmentSampler::build(*environment, reference_sampler_options());
    if (!sampler) return sampler.error();
    auto maps = LightMaps::bake(sampler->image(), sampler->world_to_source());
    if (!maps) return maps.error();
    Summary summary;
    std::string table;
    int cells = 0;
    for (const double roughness : k_roughness) {
        table += fmt::format("  {:>4.1f} ", roughness);
        for (const double NdotV : k_cosines) {
            q.roughness = roughness, q.NdotV = NdotV;
            const SquareErrors squares = lobe_errors(*maps, *sampler, q);
            const LobeErrors e = squares.roots();
            if (NdotV < k_grazing) summary.grazing += squares, ++cells;
            double& worst = NdotV < k_grazing ? summary.worst : summary.worst_above;
            worst = std::max(worst, e.ratio());
            table += fmt::format("  {:.4f} {:.4f} {:4.2f}", e.split_sum, e.stretched, e.ratio());
        }
        table += "\n";
    }
    summary.grazing = summary.grazing / cells;
    const LobeErrors all = summary.grazing.roots();
    fmt::print(
        "{}: split-sum {:.4f}, stretched {:.4f} ({:.2f}) at NdotV < {}, worst cell {:.2f} there, {:.2f} above, noise "
        "{:.5f}\n",
        file.filename().string(), all.split_sum, all.stretched, all.ratio(), k_grazing, summary.worst,
        summary.worst_above, all.truth);
    if (!brief) {
        fmt::print("  r\\NdotV");
        for (const double NdotV : k_cosines) fmt::print("  {:<18.2f}", NdotV);
        fmt::print("\n{}", table);
    }
    std::fflush(stdout);
    return summary;
}

}  // namespace

int main(int argc, char** argv) {
    LobeQuestion q;
    bool brief = false;
    std::vector<std::filesystem::path> files;
    for (int i = 1; i < argc; ++i) {
        if (!std::strcmp(argv[i], "--f0") && i + 1 < argc)
            q.f0 = float(std::atof(argv[++i]));
        else if (!std::strcmp(argv[i], "--directions") && i + 1 < argc)
            q.directions = std::atoi(argv[++i]);
        else if (!std::strcmp(argv[i], "--samples") && i + 1 < argc)
            q.samples = std::atoi(argv[++i]);
        else if (!std::strcmp(argv[i], "--brief"))
            brief = true;
        else
            files.emplace_back(argv[i]);
    }
    if (const char* data = std::getenv("DOMELIGHT_DATA"); files.empty() && data)
        for (const char* name :
             {"kiara_1_dawn", "kloppenheim_05", "spiaggia_di_mondello", "studio_small_03", "leadenhall_market"})
            files.push_back(std::filesystem::path(data) / "env_latlong" / (std::string(name) + "_1k.hdr"));
    SquareErrors all;
    double worst = 0, worst_above = 0;
    for (const auto& file : files) {
        const auto summary = report(file, q, brief);
        if (!summary) {
            fmt::print(stderr, "{}\n", summary.error().format());
            return 1;
        }
        all += summary->grazing;
        worst = std::max(worst, summary->worst);
        worst_above = std::max(worst_above, summary->worst_above);
    }
    if (files.empty()) return 0;
    const LobeErrors e = (all / double(files.size())).roots();
    fmt::print("all: split-sum {:.4f}, stretched {:.4f}, ratio {:.3f}; worst cell {:.2f}, above NdotV {} {:.2f}\n",
               e.split_sum, e.stretched, e.ratio(), worst, k_grazing, worst_above);
    return e.ratio() <= 0.5 && worst <= 1.05 ? 0 : 1;
}
