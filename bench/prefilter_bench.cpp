// The exact filter's time from float rows in memory to float maps, with level 0 and irradiance: a 4096 x 2048 photograph to
// 1024^2 and 11 levels, and five photographs of 1024 x 512 (bench/photographs.py names them) to 256^2 and 5 levels, with
// the built-in sky beside them. CPU time of the whole process. In the rows "AVX2" the kernels use at most AVX2. The
// photographs are those of DOMELIGHT_DATA; without it there is the sky only. One more row for each photograph filters a
// single level of 128^2 at roughness 0.4, 0.6, 0.8 and 1. Two more filter a cube of it to 5 levels, as a probe.
#include "domelight/environment/sky/sky.h"
#include "domelight/filtering/prefilter.h"
#include "domelight/filtering/probe_filter.h"
#include "domelight/filtering/resample/area_resample.h"
#include "domelight/image/row_source.h"
#include "domelight/io/environment/open_environment.h"

#include "base/instruction_set.h"

#include <benchmark/benchmark.h>

#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>

using namespace domelight;

namespace {

ImageF make_sky_image(int height) {
    SkyOptions options;
    options.height = height;
    ImageF image(2 * height, height, 3);
    (void)make_sky(options)->read(image.view());
    return image;
}

void filter(benchmark::State& state, const ImageF& image, const FilterOptions& options, const std::string& set) {
    simd::limit_instruction_set(set.c_str());
    for (auto _ : state) {
        ImageRowSource source(image);
        auto result = prefilter(source, options);
        benchmark::DoNotOptimize(result);
    }
    simd::limit_instruction_set("");
}

FilterOptions chain(int size, int levels, int threads) {
    FilterOptions options;
    options.threads = threads;
    options.irradiance_size = 32;
    for (int l = 0; l < levels; ++l)
        options.specular.push_back({std::max(1, size >> l), l == 0, ZonalKernel::ggx(double(l) / (levels - 1))});
    return options;
}

void add(const std::string& name, const ImageF& image, const FilterOptions& options, const std::string& set = "") {
    benchmark::RegisterBenchmark(
        name.c_str(), [&image, options, set](benchmark::State& state) { filter(state, image, options, set); })
        ->Unit(benchmark::kMillisecond)
        ->MeasureProcessCPUTime()
        ->UseRealTime();
}

/// A cube of the image's light, filtered as ProbeFilter does from the second on.
void add_probe(const std::string& name, const ImageF& image, int size) {
    ImageRowSource rows(image);
    FilterOptions options;
    options.specular = {glossy_level_spec(Lobe::ggx, size, 0)};
    const Cubemap cube = prefilter(rows, options)->specular[0].cube();
    options = chain(size, 5, 1);
    options.irradiance_size = 0;
    const auto filter = std::make_shared<ProbeFilter>(*ProbeFilter::make(size, options));
    benchmark::RegisterBenchmark((name + " " + std::to_string(size)).c_str(),
                                 [cube, filter](benchmark::State& state) {
                                     for (auto _ : state) {
                                         auto result = filter->filter(cube);
                                         benchmark::DoNotOptimize(result);
                                     }
                                 })
        ->Unit(benchmark::kMillisecond)
        ->MeasureProcessCPUTime();
}

}  // namespace

int main(int argc, char** argv) {
    std::map<std::string, ImageF> images;  // their addresses must last until the benchmarks have run
    images["sky 1k"] = make_sky_image(512);
    images["4k"] = make_sky_image(2048);
    if (const char* data = std::getenv("DOMELIGHT_DATA")) {
        const std::filesystem::path folder(data);
        const auto read = [&](const std::string& name, const std::filesystem::path& file) {
            const auto environment = open_environment({file});
            if (!environment || environment->cube()) return;
            auto rows = environment->rows();
            if (!rows) return;
            if (auto image = read_latlong(**rows)) images[name] = std::move(*image);
        };
        for (const auto& [name, file] : {std::pair{"sun 1k", "noon_grass_1k"},
                                         {"studio 1k", "blocky_photo_studio_1k"},
                                         {"night 1k", "dikhololo_night_1k"},
                                         {"interior 1k", "leadenhall_market_1k"},
                                         {"overcast 1k", "kloppenheim_05_1k"}})
            read(name, folder / "env_latlong" / (std::string(file) + ".hdr"));
        read("4k", folder / "env_highres/spruit_sunrise_4k_from_ultrahdr.hdr");
    }
    for (const auto& [name, image] : images) {
        if (name == "4k") {
            for (const int threads : {1, 2}) {
                const std::string suffix = "/" + std::to_string(threads) + " threads";
                add("4k to 1024, 11 levels" + suffix, image, chain(1024, 11, threads));
                add("4k to 1024, 11 levels, AVX2" + suffix, image, chain(1024, 11, threads), "AVX2");
            }
            continue;
        }
        add(name + " to 256, 5 levels", image, chain(256, 5, 1));
        for (const int size : {64, 32}) add_probe(name + " probe", image, size);
        for (const double roughness : {0.4, 0.6, 0.8, 1.0}) {
            FilterOptions one;
            one.threads = 1;
            one.specular.push_back({128, false, ZonalKernel::ggx(roughness)});
            add(name + " to one level of 128, roughness " + std::to_string(roughness).substr(0, 3), image, one);
        }
    }
    benchmark::Initialize(&argc, argv);
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
