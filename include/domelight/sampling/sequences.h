#pragma once

#include "domelight/base/names.h"
#include "domelight/sampling/low_discrepancy.h"

#include <cmath>

namespace domelight {

/// Where the points of a Monte Carlo estimate come from.
enum class Sequence {
    random,      ///< independent points, counter-based (Philox4x32-10)
    stratified,  ///< jittered in cells, rows and columns (Chiu et al. 1994)
    hammersley,  ///< (index / count, radical inverses)
    halton,      ///< radical inverses in prime bases, Owen-scrambled
    sobol,       ///< (0, 2)-sequences, shuffled and Owen-scrambled (Burley 2020)
    r2,          ///< Roberts' R2 sequence with a random rotation
};
template <>
struct EnumNames<Sequence> {
    static constexpr const char* kind = "a sequence";
    static constexpr NamedValue<Sequence> table[] = {
        {Sequence::random, "random"}, {Sequence::stratified, "stratified"}, {Sequence::hammersley, "hammersley"},
        {Sequence::halton, "halton"}, {Sequence::sobol, "sobol"},           {Sequence::r2, "r2"},
    };
};

/// Point `index` (< count) of `count` jittered points in random order, for every count from 1 to 2^31.
///
/// The square is divided into m = floor(sqrt(count)) columns and n = ceil(count / m) rows; each cell holds one point.
/// If count < m n, the last row is lower than the others and has fewer points than columns. Each of `count` equal
/// strata of y also holds one point, and so does each of x if count = m n. Over random keys every point is uniformly
/// distributed.
///
/// Chiu, Shirley and Wang 1994, "Multi-jittered sampling", by hashed permutations as in Kensler 2013. Each row and each
/// column has a permutation of its own: with Kensler's shared permutations the error of smooth integrands falls like
/// N^-3/4 instead of N^-1.
inline UnitPoint stratified(std::uint64_t key, std::uint32_t index, std::uint32_t count) {
    const std::uint64_t m = std::uint64_t(std::sqrt(double(count))), n = (count + m - 1) / m;
    const std::uint64_t s = permute(index, count, key), row = s / m;
    const std::uint64_t column = permute(std::uint32_t(s % m), std::uint32_t(m), derive_key(key, 2 * row));
    const std::uint64_t within = permute(std::uint32_t(row), std::uint32_t(n), derive_key(key, 2 * column + 1));
    const std::uint64_t jitter = mix_bits(~derive_key(key, s));
    return {std::uint32_t((((column * n + within) << 32) | (jitter >> 32)) / (m * n)),
            std::uint32_t(((s << 32) | (jitter & 0xffffffffu)) / count)};
}

/// Point `index` of a sequence, in the pair of dimensions `pair` (0: the first two): a pure function of its arguments.
///
/// seed    selects the randomisation. With seed 0, hammersley, halton, r2 (pair 0) and sobol (pair 0) are not
///         randomised; for random and stratified, 0 is a seed like any other
/// index   any; stratified and hammersley are sets, so that from `count` on they start anew with another randomisation
/// count   how many points will be drawn, 1..2^31; only stratified and hammersley look at it
/// pair    any; pairs are independent of each other. halton and hammersley run out of prime bases at pair 32 and are
///         random from there on
/// returns coordinates in 32-bit fixed point, in [0, 1)
inline UnitPoint unit_point(Sequence sequence, std::uint64_t seed, std::uint32_t index, std::uint32_t count,
                            std::uint32_t pair = 0);

/// Point `index` of independent random points: Philox with the seed as key.
constexpr UnitPoint random_point(std::uint64_t seed, std::uint32_t index, std::uint32_t pair = 0) {
    const auto words = philox4x32({index, pair, 0, 0}, {std::uint32_t(seed), std::uint32_t(seed >> 32)});
    return {words[0], words[1]};
}

/// A random rotation of the torus for a seed and a pair of dimensions; no rotation for seed 0.
constexpr UnitPoint seed_rotation(std::uint64_t seed, std::uint32_t pair) {
    const std::uint64_t key = seed == 0 ? 0 : derive_key(seed, pair);
    return {std::uint32_t(key >> 32), std::uint32_t(key)};
}

inline UnitPoint unit_point(Sequence sequence, std::uint64_t seed, std::uint32_t index, std::uint32_t count,
                            std::uint32_t pair) {
    switch (sequence) {
        case Sequence::random:
            break;
        case Sequence::stratified:
            return stratified(derive_key(derive_key(seed, index / count), pair), index % count, count);
        case Sequence::hammersley: {
            if (pair >= k_halton_dimensions / 2) break;
            const std::uint32_t round = index / count, i = index % count;
            const UnitPoint rotation = seed_rotation(round == 0 ? seed : derive_key(seed, round), pair);
            if (pair == 0) return rotate(hammersley(i, count), rotation);
            return rotate({halton(i, int(2 * pair - 1)), halton(i, int(2 * pair))}, rotation);
        }
        case Sequence::halton: {
            if (pair >= k_halton_dimensions / 2) break;
            const int x = int(2 * pair), y = x + 1;
            if (seed == 0) return {halton(index, x), halton(index, y)};
            return {halton_scrambled(derive_key(seed, std::uint64_t(x)), index, x),
                    halton_scrambled(derive_key(seed, std::uint64_t(y)), index, y)};
        }
        case Sequence::sobol:
            return seed == 0 && pair == 0 ? sobol(index) : sobol_owen(derive_key(seed, pair), index);
        case Sequence::r2:
            // Every pair uses the same lattice, but in another order: aligned blocks of 2^m points keep their points.
            return rotate(r2(pair == 0 ? index : owen_scramble(index, std::uint32_t(derive_key(seed, ~pair)))),
                          seed_rotation(seed, pair));
    }
    return random_point(seed, index, pair);
}

/// The points of a Monte Carlo sum: `count` of one sequence.
struct PointSet {
    Sequence sequence = Sequence::hammersley;
    std::uint64_t seed = 0;  ///< as in unit_point()
    int count = 1024;        ///< 1 or more
    /// Point i, 0 <= i < count.
    UnitPoint operator[](int i) const { return unit_point(sequence, seed, std::uint32_t(i), std::uint32_t(count)); }
};

}  // namespace domelight
