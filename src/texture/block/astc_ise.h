#pragma once
// ASTC's integer sequence encoding: numbers below 3 2^n or 5 2^n, whose trits (five in eight bits) or quints (three in
// seven) are packed between their low bits. Khronos Data Format Specification 1.3, section 23.12 and following
// ("Integer Sequence Encoding"), for the parts of ASTC that HDR blocks of 4 x 4 weights use.

#include <array>
#include <cstdint>
#include <span>

namespace domelight {

/// One range of the encoding: numbers 0 .. levels - 1.
struct IseRange {
    int levels;
    int bits;                    ///< low bits of each number
    int trit = 0;                ///< 1: the high part is a trit
    int quint = 0;               ///< 1: the high part is a quint
    int size(int count) const {  ///< bits that `count` numbers take
        return count * bits + (trit ? (8 * count + 4) / 5 : quint ? (7 * count + 2) / 3 : 0);
    }
};

/// All ranges, ascending, in the order of the specification's table.
inline constexpr std::array<IseRange, 21> k_ise_ranges{{
    {2, 1},     {3, 0, 1},     {4, 2},        {5, 0, 0, 1}, {6, 1, 1},      {8, 3},        {10, 1, 0, 1},
    {12, 2, 1}, {16, 4},       {20, 2, 0, 1}, {24, 3, 1},   {32, 5},        {40, 3, 0, 1}, {48, 4, 1},
    {64, 6},    {80, 4, 0, 1}, {96, 5, 1},    {128, 7},     {160, 5, 0, 1}, {192, 6, 1},   {256, 8},
}};
/// Indices into k_ise_ranges.
inline constexpr int k_ise_3 = 1, k_ise_4 = 2, k_ise_8 = 5, k_ise_12 = 7, k_ise_16 = 8, k_ise_256 = 20;

/// 128 bits, bit 0 the lowest of the first byte.
struct Bits128 {
    std::uint64_t low = 0, high = 0;
    void put(int at, int count, std::uint32_t value);  ///< count <= 32; the bits were 0
    std::uint32_t get(int at, int count) const;        ///< count <= 32
    Bits128 reversed() const;
};

/// Numbers written from bit `at` upwards; each below range.levels.
void ise_encode(const IseRange& range, std::span<const std::uint8_t> numbers, Bits128& out, int at);
void ise_decode(const IseRange& range, const Bits128& in, int at, std::span<std::uint8_t> numbers);

/// The weight, 0 .. 64, of a number; and the number of a range's i-th smallest weight (numbers are not in order of
/// weight where there are trits and quints). `range` up to 32 levels.
int ise_weight(int range, int number);
int ise_weight_number(int range, int rank);
int ise_weight_rank(int range, int number);

/// The colour value, 0 .. 255, of a number (`range` from 6 levels on), and the number of the value nearest to `value`.
int ise_colour(int range, int number);
int ise_colour_number(int range, int value);

}  // namespace domelight
