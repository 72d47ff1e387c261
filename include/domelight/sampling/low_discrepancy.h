#pragma once

#include "domelight/base/random.h"
#include "domelight/base/unit_point.h"

#include <array>
#include <cstdint>

namespace domelight {

/// The bits of `i` in reverse order; as a fraction of 2^32, the base-2 radical inverse (van der Corput's sequence).
constexpr std::uint32_t reverse_bits(std::uint32_t i) {
    i = (i >> 24) | ((i >> 8) & 0xff00u) | ((i << 8) & 0xff0000u) | (i << 24);  // compilers turn this into one
                                                                                // instruction
    i = ((i & 0x0f0f0f0fu) << 4) | ((i & 0xf0f0f0f0u) >> 4);
    i = ((i & 0x33333333u) << 2) | ((i & 0xccccccccu) >> 2);
    i = ((i & 0x55555555u) << 1) | ((i & 0xaaaaaaaau) >> 1);
    return i;
}

/// The base-2 radical inverse of i as a number in [0, 1): second coordinate of the Hammersley points.
constexpr double radical_inverse(std::uint32_t i) {
    return unit_double(reverse_bits(i));
}

/// Bases of the Halton sequence: the first 64 primes.
inline constexpr int k_halton_dimensions = 64;
inline constexpr std::array<std::uint16_t, k_halton_dimensions> k_primes{
    2,   3,   5,   7,   11,  13,  17,  19,  23,  29,  31,  37,  41,  43,  47,  53,  59,  61,  67,  71,  73,  79,
    83,  89,  97,  101, 103, 107, 109, 113, 127, 131, 137, 139, 149, 151, 157, 163, 167, 173, 179, 181, 191, 193,
    197, 199, 211, 223, 227, 229, 233, 239, 241, 251, 257, 263, 269, 271, 277, 281, 283, 293, 307, 311};

/// Coordinate `dimension` (0..63) of point `index` of the Halton sequence: the radical inverse of `index` in base
/// k_primes[dimension], which is its digits mirrored about the radix point (Halton 1960). Rounded down to a multiple of
/// 2^-32.
constexpr std::uint32_t halton(std::uint32_t index, int dimension) {
    const std::uint32_t base = k_primes[dimension];
    if (base == 2) return reverse_bits(index);
    std::uint64_t mirrored = 0, scale = 1;  // both below 2^32 base < 2^41: exact in double
    for (; index != 0; index /= base) mirrored = mirrored * base + index % base, scale *= base;
    return unit_fixed(double(mirrored) / double(scale));
}

/// Owen's nested uniform scrambling in base 2 of a fraction whose bits are in reverse order (the highest bit of the
/// fraction is bit 0): a hash of the seed and of the higher bits decides whether a bit is flipped.
///
/// Additions, multiplications and `n ^= n * even` carry only upwards, so bit k of the result depends on bits 0..k alone
/// (Laine and Karras 2011; Burley 2020, "Practical hash-based Owen scrambling"). The constants are Vegdahl's (2021),
/// which a search found to make all flips equally likely and independent.
constexpr std::uint32_t owen_scramble_reversed(std::uint32_t n, std::uint32_t seed) {
    n ^= n * 0x3d20adeau;
    n += seed;
    n *= (seed >> 16) | 1u;
    n ^= n * 0x05526c56u;
    n ^= n * 0x53a22864u;
    return n;
}

/// Owen scrambling of a 32-bit fraction: elementary intervals in base 2 are mapped to each other, each equally likely.
constexpr std::uint32_t owen_scramble(std::uint32_t fraction, std::uint32_t seed) {
    return reverse_bits(owen_scramble_reversed(reverse_bits(fraction), seed));
}

/// halton(), scrambled by `key` following Owen 1995: each digit is permuted, and the permutation depends on the digits
/// before it. Every coordinate is uniform in [0, 1) over the keys; elementary intervals keep their number of points.
///
/// The permutations are affine: digit -> a digit + b mod base with a != 0. In a prime base every pair of digits is then
/// mapped to every other pair with equal probability, and the variance depends on nothing else (Matousek 1998, "On the
/// L2-discrepancy for anchored boxes"). Digits are used until base^k >= 2^24; within a cell of that size the point is
/// random.
constexpr std::uint32_t halton_scrambled(std::uint64_t key, std::uint32_t index, int dimension) {
    const std::uint32_t base = k_primes[dimension];
    std::uint64_t before = mix_bits(key);  // a hash of the digits so far
    if (base == 2) return owen_scramble(reverse_bits(index), std::uint32_t(before >> 32));
    std::uint64_t mirrored = 0, scale = 1;  // below 2^24 base < 2^33
    for (; scale < (1u << 24); scale *= base, index /= base) {
        const std::uint32_t digit = index % base;
        const std::uint64_t a = 1 + ((before & 0xffffffffu) * (base - 1) >> 32), b = (before >> 32) * base >> 32;
        mirrored = mirrored * base + std::uint32_t(a * digit + b) % base;
        before = mix_bits(before + digit);
    }
    const double within = double(before >> 44) * 0x1p-20;  // 33 + 20 bits: exact, and so under 1
    return unit_fixed((double(mirrored) + within) / double(scale));
}

/// Point `index` of `count` of the Hammersley set, (index / count, radical inverse); index < count.
constexpr UnitPoint hammersley(std::uint32_t index, std::uint32_t count) {
    return {std::uint32_t((std::uint64_t(index) << 32) / count), reverse_bits(index)};
}

/// The binomial coefficients mod 2 applied to the bits of i: bit k of the result is the sum of C(j, k) times bit j. By
/// Lucas's theorem, C(j, k) is odd where every bit of k is also set in j, so a butterfly of five steps computes the
/// sums.
constexpr std::uint32_t pascal_transform(std::uint32_t i) {
    i ^= (i >> 1) & 0x55555555u;
    i ^= (i >> 2) & 0x33333333u;
    i ^= (i >> 4) & 0x0f0f0f0fu;
    i ^= (i >> 8) & 0x00ff00ffu;
    i ^= (i >> 16) & 0x0000ffffu;
    return i;
}

/// Point `index` of the two-dimensional Sobol sequence, a (0, 2)-sequence in base 2: among 2^m consecutive points whose
/// first index is a multiple of 2^m, each elementary interval of area 2^-m contains exactly one (Sobol 1967; the second
/// coordinate's matrix is Pascal's).
constexpr UnitPoint sobol(std::uint32_t index) {
    return {reverse_bits(index), reverse_bits(pascal_transform(index))};
}

/// The Sobol sequence, shuffled and Owen-scrambled by `key` (Burley 2020). Each point is uniform over the keys, sets of
/// 2^m points stay (0, m, 2)-nets, and two keys give independent sequences, so any number of pairs of dimensions can be
/// made.
constexpr UnitPoint sobol_owen(std::uint64_t key, std::uint32_t index) {
    const std::uint64_t more = mix_bits(key);
    // The index is shuffled by scrambling it, too: aligned blocks of 2^m indices are mapped to such blocks.
    const std::uint32_t i = owen_scramble(index, std::uint32_t(key >> 32));
    return {reverse_bits(owen_scramble_reversed(i, std::uint32_t(more >> 32))),
            reverse_bits(owen_scramble_reversed(pascal_transform(i), std::uint32_t(more)))};
}

/// `p` moved by `by` on the torus (Cranley and Patterson 1976); exact in fixed point.
constexpr UnitPoint rotate(UnitPoint p, UnitPoint by) {
    return {p.x + by.x, p.y + by.y};
}

/// Point `index` of Roberts' R2 sequence (2018): (1/2, 1/2) + index (1/g, 1/g^2) mod 1, with g^3 = g + 1, the plane's
/// counterpart of the golden ratio. Any run of consecutive points is spread well.
constexpr UnitPoint r2(std::uint32_t index) {
    constexpr std::uint32_t a = unit_fixed(0.7548776662466927), b = unit_fixed(0.5698402909980532);
    return {0x80000000u + index * a, 0x80000000u + index * b};
}

/// A rotation for each pixel of a picture. Rotations of neighbouring pixels differ most, so that the pixels' errors
/// cancel where the eye (or a denoiser) averages. rotate(p, pixel_rotation(x, y)) makes a sequence for each pixel out
/// of one, and the noise has little power at low frequencies, as with a blue-noise mask, but without a table.
///
/// The first coordinate is Roberts' dither mask (2018), pixel_x / g + pixel_y / g^2 mod 1. The two factors of the
/// second were the best of 40000 pairs by the least distance between rotations: for pixels d <= 12 apart the distance
/// on the torus is at least 0.35 / d, and in either coordinate alone at least 0.17 / d^2 (random factors: 0.1 and
/// 0.05).
constexpr UnitPoint pixel_rotation(std::uint32_t pixel_x, std::uint32_t pixel_y) {
    constexpr std::uint32_t a = unit_fixed(0.7548776662466927), b = unit_fixed(0.5698402909980532);
    constexpr std::uint32_t c = unit_fixed(0.52152512), d = unit_fixed(0.3089682);
    return {pixel_x * a + pixel_y * b, pixel_x * c + pixel_y * d};
}

}  // namespace domelight
