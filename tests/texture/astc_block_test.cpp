#include "texture/block/astc_block.h"

#include "test.h"
#include "texture/block/astc_codec.h"
#include "texture/block/astc_ise.h"
#include "texture/block/bc6h.h"
#include "texture/block/uastc_hdr.h"
#include "texture/texel/half.h"
#include "texture/uastc_samples.h"

#include <algorithm>
#include <set>

using namespace domelight;

TEST_CASE("astc_ise: numbers come back from every range, whatever their count") {
    test::Noise noise;
    for (const IseRange& range : k_ise_ranges)
        for (int count = 1; count <= 16; ++count) {
            if (range.size(count) > 100) continue;
            std::vector<std::uint8_t> numbers(std::size_t(count), 0), back(numbers.size());
            for (auto& n : numbers) n = std::uint8_t(noise.below(range.levels));
            Bits128 bits;
            ise_encode(range, numbers, bits, 17);
            ise_decode(range, bits, 17, back);
            CHECK(back == numbers);
            // Bits outside of those that they occupy are not touched.
            CHECK(bits.get(0, 17) == 0);
            for (int at = 17 + range.size(count); at < 128; ++at) CHECK(bits.get(at, 1) == 0);
        }
}

TEST_CASE("astc_ise: weights run from 0 to 64, symmetrically") {
    for (int range = 0; range < 12; ++range) {
        const int levels = k_ise_ranges[std::size_t(range)].levels;
        const auto weight = [&](int rank) { return ise_weight(range, ise_weight_number(range, rank)); };
        CHECK(weight(0) == 0);
        CHECK(weight(levels - 1) == 64);
        for (int rank = 0; rank < levels; ++rank) {
            CHECK(weight(rank) + weight(levels - 1 - rank) == 64);
            CHECK(ise_weight_rank(range, ise_weight_number(range, rank)) == rank);
            if (rank) CHECK(weight(rank) > weight(rank - 1));
        }
    }
}

TEST_CASE("astc_ise: colours of a range are spread over 0 to 255") {
    for (int range = 4; range <= k_ise_256; ++range) {
        const int levels = k_ise_ranges[std::size_t(range)].levels;
        std::set<int> values;
        for (int i = 0; i < levels; ++i) {
            values.insert(ise_colour(range, i));
            CHECK(ise_colour_number(range, ise_colour(range, i)) == i);
        }
        CHECK(int(values.size()) == levels);
        CHECK(*values.begin() == 0);
        CHECK(*values.rbegin() == 255);
        int widest = 0;
        for (auto v = values.begin(), next = std::next(v); next != values.end(); ++v, ++next)
            widest = std::max(widest, *next - *v);
        CHECK(widest <= 255 / (levels - 1) + 3);
    }
}

TEST_CASE("astc_partition: the common seeds draw BC6H's patterns") {
    // In the order of BC6H, without the five that ASTC does not have. Which of the two subsets is the first may differ.
    constexpr int k_of_bc6h[k_uastc_partitions] = {0,  1,  2,  3,  4,  5,  6,  7,  8,  9,  10, 11, 12, 13,
                                                   14, 15, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 29};
    for (int k = 0; k < k_uastc_partitions; ++k) {
        const std::uint32_t ours = astc_partition(k_uastc_seeds[std::size_t(k)]),
                            theirs = bc6h::k_partition[std::size_t(k_of_bc6h[k])];
        CHECK((ours == theirs || ours == (theirs ^ 0xffff)));
    }
}

TEST_CASE("astc_block: packing and unpacking keep every number") {
    test::Noise noise;
    for (int i = 0; i < 2000; ++i) {
        const AstcBlock block = test::random_uastc_block(noise, i);
        std::array<std::uint8_t, 16> bytes;
        pack_astc(block, bytes);
        const auto back = unpack_astc(bytes);
        REQUIRE(back);
        CHECK(back->solid == block.solid);
        CHECK(back->colour == block.colour);
        if (block.solid) continue;
        CHECK(back->weight_range == block.weight_range);
        CHECK(back->endpoint_mode == block.endpoint_mode);
        CHECK(back->subsets == block.subsets);
        if (block.subsets == 2) CHECK(back->seed == block.seed);
        CHECK(back->values == block.values);
        CHECK(back->weights == block.weights);
    }
}

TEST_CASE("astc_block: decodes bit by bit as Arm's decoder, all modes") {
    test::Noise noise;
    std::set<std::string> seen;
    for (int i = 0; i < 8000; ++i) {
        const AstcBlock block = test::random_uastc_block(noise, i);
        seen.insert(test::mode_name(block));
        std::array<std::uint8_t, 16> bytes;
        pack_astc(block, bytes);
        std::array<std::uint16_t, 48> ours;
        decode_astc(block, ours);
        std::array<float, 48> theirs;
        decode_astc_hdr(4, bytes.data(), 1, theirs.data());
        int different = 0;
        for (std::size_t t = 0; t < 48; ++t) different += float_from_half(ours[t]) != theirs[t];
        CHECK_MESSAGE(different == 0, test::mode_name(block));
    }
    CHECK(seen.size() == 24);
}

TEST_CASE("astc_block: bytes of any kind are refused or decode as Arm's decoder has them") {
    test::Noise noise;
    int known = 0;
    for (int i = 0; i < 20000; ++i) {
        std::array<std::uint8_t, 16> bytes;
        for (auto& byte : bytes) byte = std::uint8_t(noise.below(256));
        // Some are changed so that the forms known here occur.
        if (i % 2) bytes[0] = std::uint8_t(0x40 | (bytes[0] & 0x13)), bytes[1] = std::uint8_t(bytes[1] & 0xea);
        const auto block = unpack_astc(bytes);
        if (!block) continue;
        ++known;
        std::array<std::uint16_t, 48> ours;
        decode_astc(*block, ours);
        std::array<float, 48> theirs;
        decode_astc_hdr(4, bytes.data(), 1, theirs.data());
        int different = 0;
        for (std::size_t t = 0; t < 48; ++t) different += float_from_half(ours[t]) != theirs[t];
        CAPTURE(test::mode_name(*block));
        CAPTURE(ours[0]);
        CAPTURE(theirs[0]);
        CHECK(different == 0);
    }
    CHECK(known > 200);
}

TEST_CASE("astc_block: a solid block that is negative, infinite or not a number is refused") {
    AstcBlock block;
    block.solid = true;
    for (const int half : {0x7c00, 0x7e00, 0x8001, 0xffff}) {
        block.colour = {0, std::uint16_t(half), 0};
        std::array<std::uint8_t, 16> bytes;
        pack_astc(block, bytes);
        CHECK_FALSE(unpack_astc(bytes));
    }
}
