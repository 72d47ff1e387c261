// uastc_samples OUT.ktx2 OUT.halves: writes a texture of random UASTC HDR blocks of all modes, and the values that our
// decoder gives (RGB halves, row by row). tests/oracles/run_oracles.py decodes the texture with the reference decoder.
#include "texture/uastc_samples.h"

#include "domelight/texture/texture.h"

#include "texture/block/astc_block.h"

#include <cstdio>
#include <fstream>

int main(int count, char** args) {
    using namespace domelight;
    if (count != 3) {
        std::fprintf(stderr, "usage: uastc_samples OUT.ktx2 OUT.halves\n");
        return 2;
    }
    constexpr int k_side = 64;  // blocks
    Texture texture;
    texture.encoding = Encoding::uastc_hdr;
    texture.width = texture.height = 4 * k_side;
    texture.levels.emplace_back(16 * k_side * k_side);
    std::vector<std::uint16_t> halves(3 * 16 * k_side * k_side);
    test::Noise noise;
    for (int b = 0; b < k_side * k_side; ++b) {
        const AstcBlock block = test::random_uastc_block(noise, b);
        pack_astc(block, std::span<std::uint8_t, 16>(texture.levels[0].data() + 16 * b, 16));
        std::array<std::uint16_t, 48> rgb;
        decode_astc(block, rgb);
        for (int i = 0; i < 16; ++i) {
            const int x = b % k_side * 4 + i % 4, y = b / k_side * 4 + i / 4;
            for (int c = 0; c < 3; ++c)
                halves[std::size_t(3 * (y * texture.width + x) + c)] = rgb[std::size_t(3 * i + c)];
        }
    }
    if (const auto written = write_ktx2(args[1], texture, Supercompression::zstd); !written) {
        std::fprintf(stderr, "%s\n", written.error().what.c_str());
        return 1;
    }
    std::ofstream out(args[2], std::ios::binary);
    out.write(reinterpret_cast<const char*>(halves.data()), std::streamsize(halves.size() * 2));
    return out ? 0 : 1;
}
