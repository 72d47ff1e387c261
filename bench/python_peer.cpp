// The C++ calls that bench/python_bench.py measures beside their Python counterparts.
//
//     python_peer PIXELS WIDTH HEIGHT       PIXELS: float32 RGB, rows from the top, a lat-long map
//
// Reads words from stdin, one a line, and answers each with its wall-clock and CPU seconds: "prefilter" (256^2, 5 levels of GGX,
// texel centres), "sample N" (a batch of N light samples at Sobol points, on one thread).

#include "domelight/domelight.h"

#include <chrono>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <iostream>
#include <sstream>

using namespace domelight;

namespace {

ImageF read_pixels(const char* file, int width, int height) {
    auto image = ImageF::uninitialized(width, height, 3);
    std::ifstream(file, std::ios::binary).read(reinterpret_cast<char*>(image.pixels().data()), std::streamsize(image.pixels().size_bytes()));
    return image;
}

template <typename F>
void measure(const F& work) {
    const auto begin = std::chrono::steady_clock::now();
    const std::clock_t cpu = std::clock();
    work();
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    std::printf("%.6f %.6f\n", seconds, double(std::clock() - cpu) / CLOCKS_PER_SEC);
    std::fflush(stdout);
}

void filter(const ImageF& image) {
    FilterOptions options;
    options.sh_bands = 0;
    for (int level = 0; level < 5; ++level) options.specular.push_back(glossy_level_spec(Lobe::ggx, 256 >> level, level / 4.0));
    ImageRowSource rows(image);
    if (!prefilter(rows, options)) std::abort();
}

/// The memory of a batch.
struct Batch {
    std::vector<UnitPoint> points;
    ImageF rows;
    explicit Batch(int count) : points(std::size_t(count)), rows(ImageF::uninitialized(count, 9, 1)) {
        for (int i = 0; i < count; ++i) points[std::size_t(i)] = unit_point(Sequence::sobol, 1, std::uint32_t(i), std::uint32_t(count));
    }
    std::span<float> row(int r) { return {rows.row(r), points.size()}; }
    void draw(const EnvironmentSampler& sampler) {
        sampler.sample(points, {row(0), row(1), row(2), row(3), row(4), row(5), row(6), row(7), row(8)});
    }
};

}  // namespace

int main(int argc, char** argv) {
    if (argc != 4) return 2;
    const ImageF image = read_pixels(argv[1], std::atoi(argv[2]), std::atoi(argv[3]));
    const auto sampler = EnvironmentSampler::build(image.view());
    if (!sampler) return 1;
    for (std::string line; std::getline(std::cin, line);) {
        std::istringstream words(line);
        std::string word;
        int count = 0;
        words >> word >> count;
        if (word == "prefilter") measure([&] { filter(image); });
        if (word == "sample") {
            Batch batch(count);
            batch.draw(*sampler);  // the pages of its memory are touched once, as those of `out` in Python
            measure([&] { batch.draw(*sampler); });
        }
    }
}
