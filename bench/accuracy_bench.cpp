// The error of the exact filter: every level of the usual chains, for real environments and a hard sun, against the
// kernel integrated in double over the bilinear reconstruction.
//
//   accuracy_bench [--full | --ten] [--chain TEXT] [FILE.hdr ...]
//
// --chain TEXT: only chains with TEXT in their names.
// Without files: the environments under DOMELIGHT_DATA (four; --ten: ten; --full: all, and 4096 x 2048 ones) and a
// synthetic 100000:1 half-degree sun.

#include "domelight/image/row_source.h"
#include "domelight/io/environment/open_environment.h"

#include "accuracy.h"

#include <fmt/core.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <map>

using namespace domelight;
using namespace domelight::test;

namespace {

struct Chain {
    std::string name;
    FilterOptions options;
    double rmse, largest;  ///< the largest error that is accepted
};

std::vector<Chain> chains() {
    const auto linear = [](int count) { return [count](int l) { return double(l) / (count - 1); }; };
    const auto quadratic = [](int count) {
        return [count](int l) { return 1 - std::sqrt(1 - double(l) / (count - 1)); };
    };
    std::vector<Chain> list;
    const auto add = [&](std::string name, std::vector<LevelSpec> levels, double rmse, double largest) {
        FilterOptions options;
        options.specular = std::move(levels);
        options.irradiance_size = 16;
        list.push_back({std::move(name), std::move(options), rmse, largest});
    };
    // Level 1 is narrower (α 0.017) than any of the Khronos chain, so a softbox 300 000 times as bright as the walls
    // leaves more of the rounding of the expansion beside it.
    add("generic, 512, 6 geometric levels", ggx_chain(512, 6, [](int l) { return std::pow(0.6, 5 - l); }), 1e-4, 5e-3);
    add("khronos, 256, 5 linear levels", ggx_chain(256, 5, linear(5)), 1e-4, 2e-3);
    add("1024, 11 linear levels", ggx_chain(1024, 11, linear(11)), 1e-4, 2e-3);
    add("1024, 11 quadratic levels", ggx_chain(1024, 11, quadratic(11)), 3e-4, 1e-2);
    std::vector<LevelSpec> charlie, sheen_narrow, phong;
    for (double roughness : {0.25, 0.5, 0.75, 1.0}) charlie.push_back({128, false, ZonalKernel::charlie(roughness)});
    for (double roughness : {0.1, 0.15, 0.2}) sheen_narrow.push_back({128, false, ZonalKernel::charlie(roughness)});
    for (double exponent : {1.0, 2.0, 8.0, 32.0, 256.0, 2048.0})
        phong.push_back({128, false, {Lobe::phong_brdf, exponent}});
    add("Charlie, roughness 0.25 to 1", std::move(charlie), 1e-4, 2e-3);
    add("Charlie, roughness 0.1 to 0.2", std::move(sheen_narrow), 1e-3, 2e-2);
    add("modified Phong, exponents 1 to 2048", std::move(phong), 1e-4, 2e-3);
    return list;
}

/// Prints the table of one environment. Returns how many errors are too large.
int report(const std::string& name, const ImageF& image, const std::string& only, int random,
           std::map<std::string, std::pair<double, double>>& worst, int& figures) {
    fmt::print("\n{} ({} x {})\n", name, image.width(), image.height());
    fmt::print("  {:<36} {:>14} {:>5} {:>9} {:>9} {:>9}\n", "chain", "map", "size", "width", "RMSE", "max");
    int short_of = 0;
    for (const Chain& chain : chains()) {
        if (chain.name.find(only) == std::string::npos) continue;
        for (const Accuracy& row : measure_levels(image, chain.options, random)) {
            const bool irradiance = row.name == "irradiance";
            const bool reached = row.rmse <= chain.rmse && row.largest <= (irradiance ? 1e-3 : chain.largest);
            short_of += !reached;
            ++figures;
            auto& [rmse, largest] = worst[irradiance ? "irradiance" : chain.name];
            rmse = std::max(rmse, row.rmse);
            largest = std::max(largest, row.largest);
            fmt::print("  {:<36} {:>14} {:>5} {:>9.4f} {:>9.1e} {:>9.1e}{}\n", chain.name, row.name, row.size,
                       row.width, row.rmse, row.largest, reached ? "" : "  short of its aim");
        }
    }
    return short_of;
}

}  // namespace

int main(int argc, char** argv) {
    bool full = false, ten = false;
    std::string only;
    std::vector<std::filesystem::path> files;
    for (int i = 1; i < argc; ++i) {
        if (!std::strcmp(argv[i], "--full"))
            full = true;
        else if (!std::strcmp(argv[i], "--ten"))
            ten = true;
        else if (!std::strcmp(argv[i], "--chain") && i + 1 < argc)
            only = argv[++i];
        else
            files.emplace_back(argv[i]);
    }
    const char* data = std::getenv("DOMELIGHT_DATA");
    if (files.empty() && data) {
        const std::filesystem::path folder(data);
        if (full) {
            for (const char* sub : {"env_latlong", "env_latlong_blender", "env_highres"})
                for (const auto& entry : std::filesystem::directory_iterator(folder / sub))
                    if (entry.path().extension() == ".hdr" || entry.path().extension() == ".exr")
                        files.push_back(entry.path());
            std::sort(files.begin(), files.end());
        } else {
            for (const char* name : {"env_highres/spruit_sunrise_1k.hdr", "env_latlong/potsdamer_platz_1k.hdr",
                                     "env_latlong/vestibule_1k.hdr", "env_latlong/noon_grass_1k.hdr"})
                files.push_back(folder / name);
            for (const char* name : {"circus_arena", "studio_small_03", "blocky_photo_studio", "lebombo",
                                     "kloppenheim_05", "narrow_moonlit_road"})
                if (ten) files.push_back(folder / "env_latlong" / (std::string(name) + "_1k.hdr"));
        }
    }
    if (!data && files.empty()) fmt::print("DOMELIGHT_DATA is not set: the synthetic sun only\n");

    const int random = full ? 200 : 60;
    int short_of = 0, figures = 0;
    std::map<std::string, std::pair<double, double>> worst;
    short_of +=
        report("100000:1 half-degree sun", sun_image(full ? 1024 : 512, 1e5, 0.4, 1.0), only, random, worst, figures);
    for (const auto& file : files) {
        auto environment = open_environment({file});
        auto image = environment && !environment->cube() ? read_latlong(**environment->rows())
                                                         : Result<ImageF>(Error{"not a lat-long", "", ""});
        if (!image) {
            fmt::print("\n{}: {}\n", file.filename().string(), image.error().format());
            continue;
        }
        short_of += report(file.filename().string(), *image, only, random, worst, figures);
    }
    fmt::print("\nworst of all\n");
    for (const auto& [chain, largest] : worst)
        fmt::print("  {:<36} RMSE {:.1e}  max {:.1e}\n", chain, largest.first, largest.second);
    fmt::print("accuracy: {} passed, {} failed, 0 skipped\n", figures - short_of, short_of);
    return short_of == 0 ? 0 : 1;
}
