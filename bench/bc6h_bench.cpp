// BC6H on real environments: megapixels a second of each quality (encoding alone, and with what `bake` adds: gathering,
// decoding again, the sums of the report; on one thread and on two, by CPU time) and its PSNR beside that of the
// exhaustive search.
//
//   DOMELIGHT_DATA=... bc6h_bench [--step N] [FILE.hdr ...]
//
// PSNR: of log2(v + 1e-4 of the mean), channel by channel, against its range over the picture. The exhaustive search
// runs on every N-th block (257); for the comparison with it, so do the others.
#include "domelight/compare/picture_reader.h"
#include "domelight/texture/texture.h"

#include "base/instruction_set.h"
#include "texture/block/bc6h_encode.h"
#include "texture/block/bc6h_encode_simd.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

namespace {

using namespace domelight;

/// Every `step`-th block of a picture, side by side.
ImageF block_strip(const ImageF& picture, int step) {
    const int columns = picture.width() / 4, blocks = columns * (picture.height() / 4),
              count = (blocks + step - 1) / step;
    ImageF strip(4 * count, 4, 3);
    for (int i = 0; i < count; ++i)
        for (int y = 0; y < 4; ++y)
            std::copy_n(picture.at(i * step % columns * 4, i * step / columns * 4 + y), 12, strip.at(4 * i, y));
    return strip;
}

/// CPU time of the process over all threads, so that other programs on the machine do not count.
double median_seconds(const auto& work, int runs) {
    std::vector<double> seconds;
    for (int i = 0; i < runs; ++i) {
        const std::clock_t cpu = std::clock();
        work();
        seconds.push_back(double(std::clock() - cpu) / CLOCKS_PER_SEC);
    }
    std::sort(seconds.begin(), seconds.end());
    return seconds[seconds.size() / 2];
}

constexpr EncodingQuality k_timed[] = {EncodingQuality::fast, EncodingQuality::standard, EncodingQuality::high};

/// Megapixels a second.
void print_speeds(const ImageF& picture) {
    const std::vector<FilteredMap> map{{Layout::latlong, picture}};
    const double megapixels = double(picture.width()) * picture.height() / 1e6;
    const ImageF all = block_strip(picture, 1);
    std::vector<float> texels;
    for (int b = 0; b < all.width() / 4; ++b)
        for (int y = 0; y < 4; ++y) texels.insert(texels.end(), all.at(4 * b, y), all.at(4 * b, y) + 12);
    std::vector<std::uint8_t> blocks(texels.size() / 3);
    const int count = int(texels.size() / 48);
    for (const EncodingQuality quality : k_timed) {
        const int runs = quality == EncodingQuality::high ? 1 : 5;
        const double search =
            median_seconds([&] { simd::bc6h_encode(texels.data(), count, quality, blocks.data()); }, runs);
        const double whole = median_seconds([&] { encode_texture(map, Encoding::bc6h, 1, nullptr, quality); }, runs);
        const double two = median_seconds([&] { encode_texture(map, Encoding::bc6h, 2, nullptr, quality); }, runs);
        fmt::print("| {:<8} | {:8.2f} | {:8.2f} | {:8.2f} |\n", name_of(quality), megapixels / search,
                   megapixels / whole, 2 * megapixels / two);
    }
    if (simd::instruction_set() != "SCALAR") {
        const int part = std::min(count, 2000);
        const double plain =
            median_seconds([&] { bc6h::encode_plain(texels.data(), part, EncodingQuality::fast, blocks.data()); }, 5);
        fmt::print("| fast, plain | {:.2f} | | |\n", part * 16e-6 / plain);
    }
}

void print_psnr(const std::string& name, const ImageF& picture, int step) {
    const std::vector<FilteredMap> map{{Layout::latlong, block_strip(picture, step)}};
    std::string line = fmt::format("| {:<28} |", name);
    std::vector<EncodingReport> reports;
    for (const EncodingQuality quality :
         {EncodingQuality::fast, EncodingQuality::standard, EncodingQuality::high, EncodingQuality::exhaustive}) {
        encode_texture(map, Encoding::bc6h, 2, &reports, quality);
        line += fmt::format(" {:6.2f} |", reports[0].log_psnr);
    }
    fmt::print("{}\n", line);
}

}  // namespace

int main(int argc, char** argv) {
    std::vector<std::string> files;
    int step = 257;
    for (int i = 1; i < argc; ++i) {
        if (std::string(argv[i]) == "--step" && i + 1 < argc)
            step = std::max(1, std::atoi(argv[++i]));
        else
            files.push_back(argv[i]);
    }
    if (const char* data = std::getenv("DOMELIGHT_DATA"); files.empty() && data) {
        for (const char* name : {"aristea_wreck_puresky", "blocky_photo_studio", "circus_arena", "dikhololo_night",
                                 "forest_slope", "noon_grass", "potsdamer_platz", "studio_small_03"})
            files.push_back(std::string(data) + "/env_latlong/" + name + "_1k.hdr");
    }
    std::vector<std::pair<std::string, ImageF>> pictures;
    for (const std::string& file : files) {
        auto picture = read_picture(file);
        if (!picture) {
            fmt::print(stderr, "{}\n", picture.error().format());
            return 1;
        }
        pictures.emplace_back(std::filesystem::path(file).stem().string(), std::move(picture->rgb));
    }
    if (pictures.empty()) {
        fmt::print(stderr, "no environments: set DOMELIGHT_DATA or name some\n");
        return 2;
    }
    fmt::print(
        "Megapixels a second, {} ({})\n\n| quality | search, 1 core | with report, 1 core | with report, 2 cores "
        "|\n|---|---|---|---|\n",
        simd::instruction_set(), pictures[0].first);
    print_speeds(pictures[0].second);
    fmt::print(
        "\nPSNR of logarithms, dB, every {}th block\n\n| environment | fast | default | high | exhaustive "
        "|\n|---|---|---|---|---|\n",
        step);
    for (const auto& [name, picture] : pictures) print_psnr(name, picture, step);
    return 0;
}
