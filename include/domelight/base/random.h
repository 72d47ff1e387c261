#pragma once

#include <array>
#include <cstdint>

namespace domelight {

/// Four words of random bits from a 128-bit counter and a 64-bit key: Philox4x32-10 (Salmon et al. 2011, "Parallel
/// random numbers: as easy as 1, 2, 3").
///
/// A bijection of the counter for each key, with no state: the same arguments give the same words on any thread, in any
/// order. Every counter and key is valid.
constexpr std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> counter,
                                                  std::array<std::uint32_t, 2> key) {
    for (int round = 0; round < 10; ++round) {
        const std::uint64_t a = 0xd2511f53ull * counter[0], b = 0xcd9e8d57ull * counter[2];
        counter = {std::uint32_t(b >> 32) ^ counter[1] ^ key[0], std::uint32_t(b),
                   std::uint32_t(a >> 32) ^ counter[3] ^ key[1], std::uint32_t(a)};
        key = {key[0] + 0x9e3779b9u, key[1] + 0xbb67ae85u};
    }
    return counter;
}

/// A bijection of 64-bit words in which every bit of the argument affects every bit of the result: one step of
/// SplitMix64 (Steele, Lea and Flood 2014) from state `x`. Used for keys, where Philox would be more than is needed.
constexpr std::uint64_t mix_bits(std::uint64_t x) {
    x += 0x9e3779b97f4a7c15ull;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
    return x ^ (x >> 31);
}

/// A different key for each seed and each value of `which` (a pair of dimensions, for example).
constexpr std::uint64_t derive_key(std::uint64_t seed, std::uint64_t which) {
    return mix_bits(mix_bits(seed) + which);
}

/// The image of `i` under a random permutation of 0..n-1 that `key` selects; i < n, n >= 1.
///
/// A keyed bijection of 0..2^k-1, with 2^k the next power of two (add, multiply by an odd number, fold the high bits
/// down), is repeated until the result is below n. This is still a bijection, because a cycle is followed until it
/// returns to the set (Black and Rogaway 2002, "Ciphers with arbitrary finite domains"; in sampling, Kensler 2013).
constexpr std::uint32_t permute(std::uint32_t i, std::uint32_t n, std::uint64_t key) {
    int bits = 1;
    while (bits < 32 && ((n - 1) >> bits) != 0) ++bits;
    const std::uint32_t mask = 0xffffffffu >> (32 - bits);
    const int fold = (bits + 1) / 2;
    do {
        std::uint64_t k = key;
        for (int round = 0; round < 8; ++round) {  // with 4 rounds, the orders of 4 items are not equally likely
            i = (i + std::uint32_t(k >> 32)) & mask;
            i = (i * (std::uint32_t(k >> 8) | 1u)) & mask;
            i ^= i >> fold;
            k = k * 0x5851f42d4c957f2dull +
                0x14057b7ef767814full;  // Knuth's MMIX generator: another word for each round
        }
    } while (i >= n);
    return i;
}

}  // namespace domelight
