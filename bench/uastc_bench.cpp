// The encoder of UASTC HDR on each instruction set, and its decoder, with the error beside the time.
#include "base/instruction_set.h"
#include "texture/block/uastc_hdr.h"
#include "texture/texel/half.h"

#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

namespace {

using namespace domelight;

constexpr int k_blocks = 16384;

/// Blocks of smooth light: a brightness and a colour that change slowly, and an edge through every fourth.
std::vector<float> smooth_blocks() {
    std::vector<float> rgb(48 * k_blocks);
    for (int b = 0; b < k_blocks; ++b)
        for (int i = 0; i < 16; ++i) {
            const double x = 4 * (b % 128) + i % 4, y = 4 * (b / 128) + i / 4;
            const double edge = b % 4 == 0 && i % 4 + i / 4 > 3 ? 3 : 0;
            for (int c = 0; c < 3; ++c)
                rgb[std::size_t(48 * b + 3 * i + c)] = float(
                    std::exp2(edge + 3 * std::sin(x / (17 + 5 * c)) * std::cos(y / 23) + 0.3 * std::sin(x * y / 50)));
        }
    return rgb;
}

void encode(benchmark::State& state, const char* set, EncodingQuality quality = EncodingQuality::standard) {
    simd::limit_instruction_set(set);
    if (*set && simd::instruction_set() != set) {
        state.SkipWithError("this machine has it not");
        return;
    }
    const auto rgb = smooth_blocks();
    std::vector<std::uint8_t> blocks(16 * k_blocks);
    for (auto _ : state) encode_uastc_hdr(rgb.data(), k_blocks, quality, blocks.data());
    simd::limit_instruction_set("");
    std::vector<float> back(rgb.size());
    decode_uastc_hdr(blocks.data(), k_blocks, back.data());
    double sum = 0;
    for (std::size_t i = 0; i < rgb.size(); ++i) sum += std::pow(std::log2(back[i] / rgb[i]), 2);
    state.counters["Mpixel/s"] =
        benchmark::Counter(16e-6 * k_blocks * double(state.iterations()), benchmark::Counter::kIsRate);
    state.counters["rms_octaves"] = std::sqrt(sum / double(rgb.size()));
}
BENCHMARK_CAPTURE(encode, AVX3, "AVX3")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(encode, AVX2, "AVX2")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(encode, SSE4, "SSE4")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(encode, plain, "SCALAR")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(encode, fast, "", EncodingQuality::fast)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(encode, high, "", EncodingQuality::high)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(encode, exhaustive, "", EncodingQuality::exhaustive)->Unit(benchmark::kMillisecond);

void decode(benchmark::State& state) {
    const auto rgb = smooth_blocks();
    std::vector<std::uint8_t> blocks(16 * k_blocks);
    encode_uastc_hdr(rgb.data(), k_blocks, EncodingQuality::standard, blocks.data());
    std::vector<float> back(rgb.size());
    for (auto _ : state) decode_uastc_hdr(blocks.data(), k_blocks, back.data());
    state.counters["Mpixel/s"] =
        benchmark::Counter(16e-6 * k_blocks * double(state.iterations()), benchmark::Counter::kIsRate);
}
BENCHMARK(decode)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
