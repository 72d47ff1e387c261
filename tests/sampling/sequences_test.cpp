#include "domelight/sampling/sequences.h"

#include "domelight/base/vec.h"

#include "sampling/distribution/chi_square.h"
#include "test.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <vector>

using namespace domelight;
using test::chi_square_p_value;

namespace {

constexpr double k_quarter_disk = k_pi / 4;

constexpr Sequence k_all[]{Sequence::random, Sequence::stratified, Sequence::hammersley,
                           Sequence::halton, Sequence::sobol,      Sequence::r2};

std::vector<UnitPoint> points(Sequence sequence, std::uint64_t seed, std::uint32_t count, std::uint32_t pair = 0) {
    std::vector<UnitPoint> out;
    for (std::uint32_t i = 0; i < count; ++i) out.push_back(unit_point(sequence, seed, i, count, pair));
    return out;
}

/// Largest number of points in any elementary interval of area 2^-m, of every shape.
int fullest_interval(const std::vector<UnitPoint>& set, int m) {
    int most = 0;
    for (int k = 0; k <= m; ++k) {
        std::vector<int> count(std::size_t(1) << m);
        for (const UnitPoint& p : set) {
            const std::uint64_t x = std::uint64_t(p.x) >> (32 - k), y = std::uint64_t(p.y) >> (32 - (m - k));
            most = std::max(most, ++count[(x << (m - k)) | y]);
        }
    }
    return most;
}

double mean_square_error(Sequence sequence, std::uint32_t count, double (*f)(double, double), double truth) {
    double sum = 0;
    constexpr int seeds = 64;
    for (int seed = 1; seed <= seeds; ++seed) {
        double mean = 0;
        for (std::uint32_t i = 0; i < count; ++i) {
            const UnitPoint p = unit_point(sequence, std::uint64_t(seed), i, count);
            mean += f(unit_double(p.x), unit_double(p.y));
        }
        sum += std::pow(mean / count - truth, 2);
    }
    return sum / seeds;
}

}  // namespace

TEST_CASE("sequences: Philox gives the published words") {
    using Words = std::array<std::uint32_t, 4>;
    // Random123's known answers (kat_vectors, philox4x32, 10 rounds)
    CHECK(philox4x32({0, 0, 0, 0}, {0, 0}) == Words{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8});
    constexpr std::uint32_t f = 0xffffffff;
    CHECK(philox4x32({f, f, f, f}, {f, f}) == Words{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd});
    CHECK(philox4x32({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}) ==
          Words{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1});
    // SplitMix64's first outputs from state 0 and 1234567
    CHECK(mix_bits(0) == 0xe220a8397b1dcdafull);
    CHECK(mix_bits(1234567) == 6457827717110365317ull);
}

TEST_CASE("sequences: permute is a permutation, and any is as likely") {
    for (std::uint32_t n : {1u, 2u, 3u, 5u, 8u, 17u, 100u, 1000u}) {
        std::set<std::uint32_t> seen;
        for (std::uint32_t i = 0; i < n; ++i) seen.insert(permute(i, n, derive_key(7, n)));
        CHECK(seen.size() == n);
        CHECK(*seen.rbegin() == n - 1);
    }
    CHECK(permute(0xfffffffeu, 0xffffffffu, 3) < 0xffffffffu);
    // All orders of 2 to 4 things
    for (std::uint32_t n : {2u, 3u, 4u}) {
        std::map<std::uint32_t, double> orders;
        const int trials = 24000;
        for (int t = 0; t < trials; ++t) {
            std::uint32_t order = 0;
            for (std::uint32_t i = 0; i < n; ++i) order = order * n + permute(i, n, derive_key(1, std::uint64_t(t)));
            ++orders[order];
        }
        const std::size_t all = n == 2 ? 2 : n == 3 ? 6 : 24;
        CHECK(orders.size() == all);
        std::vector<double> observed;
        for (const auto& [order, count] : orders) observed.push_back(count);
        const std::vector<double> expected(all, double(trials) / double(all));
        CHECK(chi_square_p_value(observed, expected) > 1e-4);
    }
    // The positions of pairs of neighbours among 11 elements
    std::vector<double> observed(121);
    for (int t = 0; t < 110000; ++t) {
        const std::uint64_t key = derive_key(2, std::uint64_t(t));
        ++observed[permute(4, 11, key) * 11 + permute(5, 11, key)];
    }
    std::vector<double> off_diagonal;
    for (int i = 0; i < 121; ++i) {
        if (i % 12 != 0)
            off_diagonal.push_back(observed[i]);
        else
            CHECK(observed[i] == 0);
    }
    CHECK(chi_square_p_value(off_diagonal, std::vector<double>(110, 1000.0)) > 1e-4);
}

TEST_CASE("sequences: Hammersley, Halton, Sobol and R2 points by hand") {
    static_assert(reverse_bits(1) == 0x80000000u);
    static_assert(radical_inverse(6) == 0.375);  // 110 -> .011
    CHECK(hammersley(3, 8) == UnitPoint{0x60000000u, 0xc0000000u});
    CHECK(hammersley(2, 3) == UnitPoint{0xaaaaaaaau, 0x40000000u});
    for (std::uint32_t i = 0; i < 8; ++i) CHECK(unit_point(Sequence::hammersley, 0, i, 8) == hammersley(i, 8));
    // 5 = 12 in base 3 -> .21 = 7/9; in base 5 10 -> .01 = 1/25
    CHECK(halton(5, 1) == unit_fixed(7.0 / 9));
    CHECK(halton(5, 2) == unit_fixed(1.0 / 25));
    CHECK(halton(0xffffffffu, 0) == 0xffffffffu);
    CHECK(unit_point(Sequence::halton, 0, 11, 100) == UnitPoint{0xd0000000u, unit_fixed(19.0 / 27)});  // 1011, 102
    CHECK(unit_point(Sequence::halton, 0, 40, 100, 1) ==
          UnitPoint{unit_fixed(16.0 / 125), unit_fixed(40.0 / 49)});  // 130, 55
    for (int d = 0; d < k_halton_dimensions; ++d) {                   // the largest index stays below 1
        const double x = unit_double(halton(0xffffffffu, d));
        CHECK(x < 1);
        double by_hand = 0, scale = 1;
        for (std::uint32_t i = 0xffffffffu; i != 0; i /= k_primes[d])
            by_hand += (i % k_primes[d]) * (scale /= k_primes[d]);
        CHECK(x == doctest::Approx(by_hand).epsilon(1e-9));
    }
    // Sobol's first points, in sixteenths; direction numbers 1, 3, 5, 15
    const int first[8][2]{{0, 0}, {8, 8}, {4, 12}, {12, 4}, {2, 10}, {10, 2}, {6, 6}, {14, 14}};
    for (std::uint32_t i = 0; i < 8; ++i) {
        const UnitPoint p = unit_point(Sequence::sobol, 0, i, 8);
        CHECK(p == UnitPoint{std::uint32_t(first[i][0]) << 28, std::uint32_t(first[i][1]) << 28});
    }
    const double g = 1.32471795724474602596;
    for (std::uint32_t i : {0u, 1u, 2u, 1000u}) {
        CHECK(unit_double(r2(i).x) == doctest::Approx(std::fmod(0.5 + i / g, 1)).epsilon(1e-6));
        CHECK(unit_double(r2(i).y) == doctest::Approx(std::fmod(0.5 + i / (g * g), 1)).epsilon(1e-6));
    }
}

TEST_CASE("sequences: Sobol points are (0, m, 2)-nets, scrambled or not") {
    for (int m : {1, 2, 3, 6, 10}) {
        const std::uint32_t count = 1u << m;
        for (std::uint64_t seed : {0, 1, 2, 3, 77})
            for (std::uint32_t pair : {0, 1, 5})
                for (std::uint32_t block : {0, 3, 1000}) {
                    std::vector<UnitPoint> set;
                    for (std::uint32_t i = 0; i < count; ++i)
                        set.push_back(unit_point(Sequence::sobol, seed, block * count + i, count, pair));
                    CHECK(fullest_interval(set, m) == 1);
                }
    }
    // random points are not, which shows that the test can fail
    CHECK(fullest_interval(points(Sequence::random, 1, 1024), 10) > 1);
}

TEST_CASE("sequences: Owen scrambling keeps common prefixes and spreads what follows") {
    for (int bit = 0; bit < 32; ++bit) {
        const std::uint32_t a = 0x9d2c5680u, b = a ^ (0x80000000u >> bit);  // they agree on `bit` bits
        std::vector<double> flips(2);
        for (std::uint32_t seed = 0; seed < 2000; ++seed) {
            const std::uint32_t key = std::uint32_t(mix_bits(seed)), s = owen_scramble(a, key),
                                t = owen_scramble(b, key);
            const std::uint32_t differ = s ^ t;
            CHECK((bit == 0 || differ >> (32 - bit) == 0));
            CHECK(((differ >> (31 - bit)) & 1) == 1);
            if (bit < 31) ++flips[(differ >> (30 - bit)) & 1];  // the next bit is flipped alike in half of the cases
        }
        if (bit < 31) CHECK(chi_square_p_value(flips, std::vector<double>{1000, 1000}) > 1e-5);
    }
    // Whether a bit is flipped is nearly independent for different values of the bits above it: 2 x 2 cells over seeds,
    // 24 x 8 tests
    double least = 1;
    for (int bit = 1; bit <= 24; ++bit)
        for (std::uint32_t trial = 0; trial < 8; ++trial) {
            const auto a = std::uint32_t(mix_bits(trial)), b = a ^ (0x80000000u >> (trial * std::uint32_t(bit) / 8));
            std::vector<double> cells(4);
            for (std::uint32_t seed = 0; seed < 2000; ++seed) {
                const std::uint32_t key = std::uint32_t(mix_bits(seed + 7));
                const std::uint32_t s = (owen_scramble(a, key) ^ a) >> (31 - bit),
                                    t = (owen_scramble(b, key) ^ b) >> (31 - bit);
                ++cells[(s & 1) * 2 + (t & 1)];
            }
            least = std::min(least, chi_square_p_value(cells, std::vector<double>(4, 500.0)));
        }
    CHECK(least > 1e-7);
}

TEST_CASE("sequences: scrambled Halton keeps its elementary intervals") {
    for (std::uint64_t key : {1, 2, 3})
        for (int d : {0, 1, 2, 5}) {
            const std::uint32_t base = k_primes[d], count = base * base * base;
            std::vector<int> seen(count);
            for (std::uint32_t i = 0; i < count; ++i)
                ++seen[std::size_t(double(count) * unit_double(halton_scrambled(key, 7 * count + i, d)) + 1e-6)];
            CHECK(*std::max_element(seen.begin(), seen.end()) == 1);
        }
}

TEST_CASE("sequences: Halton's digits are permuted by permutations of their own, and random after the last") {
    // Base 3: the second digits of 0.00.. and 0.10.., and the digits after the 16 that are scrambled
    std::vector<double> digits(9), rest(16);
    for (std::uint64_t key = 0; key < 9000; ++key) {
        const auto second = [&](std::uint32_t index) {
            return int(unit_double(halton_scrambled(key, index, 1)) * 9) % 3;
        };
        ++digits[second(0) * 3 + second(1)];
        const double cell = unit_double(halton_scrambled(key, 5, 1)) * std::pow(3.0, 16);
        ++rest[int((cell - std::floor(cell)) * 16)];
    }
    CHECK(chi_square_p_value(digits, std::vector<double>(9, 1000.0)) > 1e-4);
    CHECK(chi_square_p_value(rest, std::vector<double>(16, 562.5)) > 1e-4);
}

TEST_CASE("sequences: stratified has one point a cell and a row") {
    for (std::uint32_t count : {1u, 2u, 7u, 16u, 60u, 64u, 101u, 1024u}) {
        const auto m = std::uint32_t(std::sqrt(count)), n = (count + m - 1) / m;
        std::set<std::uint32_t> rows, columns;
        std::set<std::pair<std::uint32_t, std::uint32_t>> cells;
        for (const UnitPoint& p : points(Sequence::stratified, 5, count)) {
            const double x = unit_double(p.x), y = unit_double(p.y);
            rows.insert(std::uint32_t(y * count));
            columns.insert(std::uint32_t(x * (m * n)));
            cells.insert({std::uint32_t(x * m), std::uint32_t(y * count) / m});
        }
        CHECK(rows.size() == count);
        CHECK(columns.size() == count);
        CHECK(cells.size() == count);
    }
}

TEST_CASE("sequences: every point is uniform in the square over the seeds") {
    // 6 sequences x 5 points x 2 pairs = 60 tests at 1e-6 each
    for (Sequence sequence : k_all)
        for (std::uint32_t index : {0u, 1u, 6u, 12u, 1000000u})
            for (std::uint32_t pair : {0u, 3u}) {
                std::vector<double> observed(256);
                const int seeds = 12800;
                for (int seed = 1; seed <= seeds; ++seed) {
                    const UnitPoint p = unit_point(sequence, std::uint64_t(seed), index, 13, pair);
                    ++observed[(p.x >> 28) * 16 + (p.y >> 28)];
                }
                CHECK_MESSAGE(chi_square_p_value(observed, std::vector<double>(256, seeds / 256.0)) > 1e-6,
                              name_of(sequence), " ", index, " ", pair);
            }
}

TEST_CASE("sequences: pairs of dimensions are independent") {
    // One coordinate of one pair against one of another, along the sequence: 4096 points in 16 x 16 cells. The cells of
    // low-discrepancy points may be more even than those of random points, but not less.
    for (Sequence sequence : k_all)
        for (std::uint32_t other : {1u, 2u, 17u}) {
            std::vector<double> observed(256), same_axis(256);
            double correlation = 0;
            const std::uint32_t count = 4096;
            for (std::uint32_t i = 0; i < count; ++i) {
                const UnitPoint p = unit_point(sequence, 99, i, count, 0),
                                q = unit_point(sequence, 99, i, count, other);
                ++observed[(p.x >> 28) * 16 + (q.y >> 28)];
                ++same_axis[(p.x >> 28) * 16 + (q.x >> 28)];
                correlation += (unit_double(p.x) - 0.5) * (unit_double(q.y) - 0.5) * 12 / count;
            }
            CHECK_MESSAGE(chi_square_p_value(observed, std::vector<double>(256, count / 256.0)) > 1e-5,
                          name_of(sequence), " ", other);
            CHECK_MESSAGE(chi_square_p_value(same_axis, std::vector<double>(256, count / 256.0)) > 1e-5,
                          name_of(sequence), " ", other);
            CHECK(std::abs(correlation) < 4.5 / std::sqrt(count));
        }
    // The same for different seeds of one pair, except for the sequences that are only rotated
    for (Sequence sequence : {Sequence::random, Sequence::stratified, Sequence::sobol}) {
        std::vector<double> observed(256);
        for (std::uint32_t i = 0; i < 4096; ++i)
            ++observed[(unit_point(sequence, 1, i, 4096).x >> 28) * 16 + (unit_point(sequence, 2, i, 4096).x >> 28)];
        CHECK(chi_square_p_value(observed, std::vector<double>(256, 16.0)) > 1e-5);
    }
}

TEST_CASE("sequences: low discrepancy converges faster than random points") {
    const auto smooth = [](double x, double y) { return std::exp(x * y) * (1 + y); };
    double truth = 0;  // midpoint rule
    for (int j = 0; j < 1000; ++j)
        for (int i = 0; i < 1000; ++i) truth += smooth((i + 0.5) / 1000, (j + 0.5) / 1000) * 1e-6;
    const double random_coarse = mean_square_error(Sequence::random, 64, smooth, truth),
                 random_fine = mean_square_error(Sequence::random, 4096, smooth, truth);
    const double random_slope = std::log(random_fine / random_coarse) / std::log(64.0) / 2;
    CHECK(random_slope == doctest::Approx(-0.5).epsilon(0.2));
    // Root mean square error falls like N^-1 or better: N^-1.5 for Owen scrambling of smooth integrands
    const std::map<Sequence, double> slopes{{Sequence::stratified, -0.9},
                                            {Sequence::hammersley, -0.8},
                                            {Sequence::halton, -0.85},
                                            {Sequence::sobol, -1.3},
                                            {Sequence::r2, -0.8}};
    for (const auto& [sequence, least] : slopes) {
        const double coarse = mean_square_error(sequence, 64, smooth, truth),
                     fine = mean_square_error(sequence, 4096, smooth, truth);
        const double slope = std::log(fine / coarse) / std::log(64.0) / 2;
        CHECK_MESSAGE(slope < least, name_of(sequence), " ", slope);
        CHECK_MESSAGE(fine < random_fine / 100, name_of(sequence));
    }
}

TEST_CASE("sequences: pixel rotations of neighbours lie far apart, and their errors cancel") {
    const auto torus = [](std::uint32_t d) { return std::abs(double(std::int32_t(d))) * 0x1p-32; };
    for (int y = -12; y <= 12; ++y)
        for (int x = 0; x <= 12; ++x) {
            const int d2 = x * x + y * y;
            if (d2 == 0 || d2 > 144) continue;
            const UnitPoint shift = pixel_rotation(std::uint32_t(x), std::uint32_t(y));
            CHECK(std::hypot(torus(shift.x), torus(shift.y)) >= 0.35 / std::sqrt(d2));
            CHECK(std::min(torus(shift.x), torus(shift.y)) >= 0.17 / d2);
        }
    // One sample a pixel of the area of a quarter disk, averaged over blocks of 8 x 8 pixels
    const auto block_error = [](auto&& point) {
        double sum = 0;
        for (std::uint32_t block = 0; block < 256; ++block) {
            int inside = 0;
            for (std::uint32_t i = 0; i < 64; ++i) {
                const UnitPoint p = point(block % 16 * 8 + i % 8, block / 16 * 8 + i / 8);
                inside += std::hypot(unit_double(p.x), unit_double(p.y)) < 1;
            }
            sum += std::pow(inside / 64.0 - k_quarter_disk, 2);
        }
        return std::sqrt(sum / 256);
    };
    const double random = block_error([](std::uint32_t x, std::uint32_t y) { return random_point(5, x, y); });
    const double rotated =
        block_error([](std::uint32_t x, std::uint32_t y) { return rotate(r2(0), pixel_rotation(x, y)); });
    CHECK(random == doctest::Approx(std::sqrt(k_quarter_disk * (1 - k_quarter_disk) / 64)).epsilon(0.2));
    CHECK(rotated < random / 1.8);
}

TEST_CASE("sequences: low discrepancy points fill boxes evenly") {
    // Largest |share of points in [0, x) x [0, y) - x y| over the corners that the points make: the star discrepancy,
    // but for the corners' own points, which 1 / N bounds.
    const auto discrepancy = [](const std::vector<UnitPoint>& set) {
        double worst = 0;
        for (const UnitPoint& a : set)
            for (const UnitPoint& b : set) {
                int inside = 0;
                for (const UnitPoint& p : set) inside += p.x < a.x && p.y < b.y;
                worst = std::max(worst,
                                 std::abs(double(inside) / double(set.size()) - unit_double(a.x) * unit_double(b.y)));
            }
        return worst;
    };
    const double random = discrepancy(points(Sequence::random, 1, 256));
    CHECK(random > 0.03);
    for (Sequence sequence : {Sequence::hammersley, Sequence::halton, Sequence::sobol, Sequence::r2})
        for (std::uint64_t seed : {0, 1}) {
            const double d = discrepancy(points(sequence, seed, 256));
            CHECK_MESSAGE(d < 0.026, name_of(sequence), " ", d, ", random ", random);
        }
    CHECK(discrepancy(points(Sequence::stratified, 1, 256)) < random / 1.5);
}

TEST_CASE("sequences: any argument is valid") {
    for (Sequence sequence : k_all) {
        for (std::uint32_t index : {0u, 5u, 0xffffffffu})
            for (std::uint32_t count : {1u, 7u, 0x80000000u})
                for (std::uint32_t pair : {0u, 31u, 32u, 0x80000000u, 0xffffffffu})
                    CHECK(unit_point(sequence, 3, index, count, pair) == unit_point(sequence, 3, index, count, pair));
    }
    // Beyond its count a set continues with another randomisation of itself
    CHECK(unit_point(Sequence::stratified, 3, 16, 16) != unit_point(Sequence::stratified, 3, 0, 16));
    CHECK(unit_point(Sequence::hammersley, 3, 16, 16) != unit_point(Sequence::hammersley, 3, 0, 16));
    CHECK(unit_point(Sequence::sobol, 3, 16, 16) == unit_point(Sequence::sobol, 3, 16, 99));
}
