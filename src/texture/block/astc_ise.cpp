#include "texture/block/astc_ise.h"

#include "base/sort.h"

#include <algorithm>
#include <cassert>
#include <cstdlib>

namespace domelight {

void Bits128::put(int at, int count, std::uint32_t value) {
    const std::uint64_t v = value;
    if (at < 64) {
        low |= v << at;
        if (at + count > 64) high |= v >> (64 - at);
    } else {
        high |= v << (at - 64);
    }
}

std::uint32_t Bits128::get(int at, int count) const {
    const std::uint64_t mask = (std::uint64_t(1) << count) - 1;
    if (at >= 64) return std::uint32_t(high >> (at - 64) & mask);
    std::uint64_t v = low >> at;
    if (at + count > 64) v |= high << (64 - at);
    return std::uint32_t(v & mask);
}

namespace {

std::uint64_t reverse(std::uint64_t v) {
    v = (v >> 1 & 0x5555555555555555u) | (v & 0x5555555555555555u) << 1;
    v = (v >> 2 & 0x3333333333333333u) | (v & 0x3333333333333333u) << 2;
    v = (v >> 4 & 0x0f0f0f0f0f0f0f0fu) | (v & 0x0f0f0f0f0f0f0f0fu) << 4;
    v = (v >> 8 & 0x00ff00ff00ff00ffu) | (v & 0x00ff00ff00ff00ffu) << 8;
    v = (v >> 16 & 0x0000ffff0000ffffu) | (v & 0x0000ffff0000ffffu) << 16;
    return v >> 32 | v << 32;
}

constexpr unsigned bit(unsigned v, int i) {
    return v >> i & 1;
}

constexpr unsigned field(unsigned v, int high, int low) {
    return v >> low & ((1u << (high - low + 1)) - 1);
}

/// Five trits of a byte.
constexpr std::array<std::uint8_t, 5> trits_of(unsigned t) {
    unsigned c = 0, t0 = 0, t1 = 0, t2 = 0, t3 = 0, t4 = 0;
    if (field(t, 4, 2) == 7) {
        c = field(t, 7, 5) << 2 | field(t, 1, 0);
        t4 = t3 = 2;
    } else {
        c = field(t, 4, 0);
        if (field(t, 6, 5) == 3) {
            t4 = 2;
            t3 = bit(t, 7);
        } else {
            t4 = bit(t, 7);
            t3 = field(t, 6, 5);
        }
    }
    if (field(c, 1, 0) == 3) {
        t2 = 2;
        t1 = bit(c, 4);
        t0 = bit(c, 3) << 1 | (bit(c, 2) & ~bit(c, 3));
    } else if (field(c, 3, 2) == 3) {
        t2 = 2;
        t1 = 2;
        t0 = field(c, 1, 0);
    } else {
        t2 = bit(c, 4);
        t1 = field(c, 3, 2);
        t0 = bit(c, 1) << 1 | (bit(c, 0) & ~bit(c, 1));
    }
    return {std::uint8_t(t0), std::uint8_t(t1), std::uint8_t(t2), std::uint8_t(t3), std::uint8_t(t4)};
}

/// Three quints of seven bits.
constexpr std::array<std::uint8_t, 3> quints_of(unsigned q) {
    unsigned c = 0, q0 = 0, q1 = 0, q2 = 0;
    if (field(q, 2, 1) == 3 && field(q, 6, 5) == 0) {
        q2 = bit(q, 0) << 2 | (bit(q, 4) & ~bit(q, 0)) << 1 | (bit(q, 3) & ~bit(q, 0));
        q1 = q0 = 4;
    } else {
        if (field(q, 2, 1) == 3) {
            q2 = 4;
            c = field(q, 4, 3) << 3 | (~field(q, 6, 5) & 3) << 1 | bit(q, 0);
        } else {
            q2 = field(q, 6, 5);
            c = field(q, 4, 0);
        }
        if (field(c, 2, 0) == 5) {
            q1 = 4;
            q0 = field(c, 4, 3);
        } else {
            q1 = field(c, 4, 3);
            q0 = field(c, 2, 0);
        }
    }
    return {std::uint8_t(q0), std::uint8_t(q1), std::uint8_t(q2)};
}

/// Packed bits of five trits t0 + 3 t1 + ..., and of three quints: the smallest that decode to them, so that the bits
/// past the end of a sequence (whose trits and quints are 0) are 0.
struct Packed {
    std::array<std::uint8_t, 243> trits{};
    std::array<std::uint8_t, 125> quints{};
};
constexpr Packed make_packed() {
    Packed packed;
    for (int t = 255; t >= 0; --t) {
        const auto v = trits_of(unsigned(t));
        packed.trits[v[0] + 3 * (v[1] + 3 * (v[2] + 3 * (v[3] + 3 * v[4])))] = std::uint8_t(t);
    }
    for (int q = 127; q >= 0; --q) {
        const auto v = quints_of(unsigned(q));
        if (v[0] > 4 || v[1] > 4 || v[2] > 4) continue;
        packed.quints[v[0] + 5 * (v[1] + 5 * v[2])] = std::uint8_t(q);
    }
    return packed;
}
constexpr Packed k_packed = make_packed();

/// How the bits of a group's packed trits or quints are distributed: this many follow the low bits of each number.
constexpr int k_trit_bits[5] = {2, 2, 1, 2, 1}, k_quint_bits[3] = {3, 2, 2};

}  // namespace

Bits128 Bits128::reversed() const {
    return {reverse(high), reverse(low)};
}

void ise_encode(const IseRange& range, std::span<const std::uint8_t> numbers, Bits128& out, int at) {
    const int n = range.bits, count = int(numbers.size());
    const std::uint32_t mask = (1u << n) - 1;
    if (!range.trit && !range.quint) {
        for (int i = 0; i < count; ++i, at += n) out.put(at, n, numbers[std::size_t(i)]);
        return;
    }
    const int group = range.trit ? 5 : 3, base = range.trit ? 3 : 5;
    const int* share = range.trit ? k_trit_bits : k_quint_bits;
    for (int first = 0; first < count; first += group) {
        const int here = std::min(group, count - first);
        unsigned index = 0;
        for (int i = here; i-- > 0;) index = index * unsigned(base) + (unsigned(numbers[std::size_t(first + i)]) >> n);
        unsigned packed = range.trit ? k_packed.trits[index] : k_packed.quints[index];
        for (int i = 0; i < here; ++i) {
            out.put(at, n + share[i],
                    (numbers[std::size_t(first + i)] & mask) | (packed & ((1u << share[i]) - 1)) << n);
            at += n + share[i];
            packed >>= share[i];
        }
        assert(here == group || packed == 0);
    }
}

void ise_decode(const IseRange& range, const Bits128& in, int at, std::span<std::uint8_t> numbers) {
    const int n = range.bits, count = int(numbers.size());
    if (!range.trit && !range.quint) {
        for (int i = 0; i < count; ++i, at += n) numbers[std::size_t(i)] = std::uint8_t(in.get(at, n));
        return;
    }
    const int group = range.trit ? 5 : 3, end = at + range.size(count);
    const int* share = range.trit ? k_trit_bits : k_quint_bits;
    for (int first = 0; first < count; first += group) {
        std::uint32_t low[5] = {}, packed = 0;
        for (int i = 0, shift = 0; i < group; shift += share[i++]) {
            // Bits past the end of the sequence count as 0.
            const auto take = [&](int bits) {
                const int there = std::clamp(end - at, 0, bits);
                const std::uint32_t v = there > 0 ? in.get(at, there) : 0;
                at += bits;
                return v;
            };
            low[i] = take(n);
            packed |= take(share[i]) << shift;
        }
        for (int i = 0; i < std::min(group, count - first); ++i) {
            const unsigned high = range.trit ? trits_of(packed)[std::size_t(i)] : quints_of(packed)[std::size_t(i)];
            numbers[std::size_t(first + i)] = std::uint8_t(high << n | low[i]);
        }
    }
}

namespace {

/// The bits of `number`'s low part that its value repeats at given places: `places` has the value's bits from the
/// highest to the lowest, each '0' or the letter of a low bit, a = bit 0.
constexpr int spread(int number, const char* places) {
    int v = 0;
    for (; *places; ++places) v = v << 1 | (*places == '0' ? 0 : number >> (*places - 'a') & 1);
    return v;
}

/// "Weight Unquantization".
int weight_of(const IseRange& range, int number) {
    if (range.levels == 3) return number * 32;
    if (range.levels == 5) return number * 16;
    int t = 0;
    if (!range.trit && !range.quint) {
        for (int shift = 6 - range.bits; shift > -range.bits; shift -= range.bits)
            t |= shift >= 0 ? number << shift : number >> -shift;
        t &= 63;
    } else {
        const int high = number >> range.bits, a = number & 1 ? 0x7f : 0;
        const int b = range.levels == 12   ? spread(number, "b000b0b")
                      : range.levels == 24 ? spread(number, "cb000cb")
                      : range.levels == 20 ? spread(number, "b0000b0")
                                           : 0;
        const int c = range.trit ? (range.bits == 1 ? 50 : range.bits == 2 ? 23 : 11) : (range.bits == 1 ? 28 : 13);
        t = (high * c + b) ^ a;
        t = (a & 0x20) | t >> 2;
    }
    return t > 32 ? t + 1 : t;
}

/// "Endpoint Unquantization".
int colour_of(const IseRange& range, int number) {
    if (!range.trit && !range.quint) {
        int v = 0;
        for (int shift = 8 - range.bits; shift > -range.bits; shift -= range.bits)
            v |= shift >= 0 ? number << shift : number >> -shift;
        return v & 255;
    }
    static constexpr int k_trit_c[7] = {0, 204, 93, 44, 22, 11, 5}, k_quint_c[6] = {0, 113, 54, 26, 13, 6};
    static constexpr const char *k_trit_b[7] = {"",          "0",         "b000b0bb0", "cb000cbcb",
                                                "dcb000dcb", "edcb000ed", "fedcb000f"},
                                *k_quint_b[6] = {"", "0", "b0000bb00", "cb0000cbc", "dcb0000dc", "edcb0000e"};
    const int high = number >> range.bits, a = number & 1 ? 0x1ff : 0;
    const int t = (high * (range.trit ? k_trit_c : k_quint_c)[range.bits] +
                   spread(number, (range.trit ? k_trit_b : k_quint_b)[range.bits])) ^
                  a;
    return (a & 0x80) | t >> 2;
}

struct Tables {
    std::array<std::array<std::uint8_t, 32>, 12> weight{}, weight_number{}, weight_rank{};
    std::array<std::array<std::uint8_t, 256>, 21> colour{}, colour_number{};
    Tables() {
        for (std::size_t r = 0; r < weight.size(); ++r) {
            const int levels = k_ise_ranges[r].levels;
            for (int i = 0; i < levels; ++i) {
                weight[r][std::size_t(i)] = std::uint8_t(weight_of(k_ise_ranges[r], i));
                weight_number[r][std::size_t(i)] = std::uint8_t(i);
            }
            sort_items(std::span(weight_number[r]).first(std::size_t(levels)),
                       [&](int i, int j) { return weight[r][std::size_t(i)] < weight[r][std::size_t(j)]; });
            for (int i = 0; i < levels; ++i) weight_rank[r][weight_number[r][std::size_t(i)]] = std::uint8_t(i);
        }
        for (std::size_t r = 4; r < colour.size(); ++r) {
            const int levels = k_ise_ranges[r].levels;
            for (int i = 0; i < levels; ++i) colour[r][std::size_t(i)] = std::uint8_t(colour_of(k_ise_ranges[r], i));
            for (int v = 0; v < 256; ++v) {
                int best = 0;
                for (int i = 1; i < levels; ++i)
                    if (std::abs(colour[r][std::size_t(i)] - v) < std::abs(colour[r][std::size_t(best)] - v)) best = i;
                colour_number[r][std::size_t(v)] = std::uint8_t(best);
            }
        }
    }
};

const Tables& tables() {
    static const Tables made;
    return made;
}

}  // namespace

int ise_weight(int range, int number) {
    return tables().weight[std::size_t(range)][std::size_t(number)];
}

int ise_weight_number(int range, int rank) {
    return tables().weight_number[std::size_t(range)][std::size_t(rank)];
}

int ise_weight_rank(int range, int number) {
    return tables().weight_rank[std::size_t(range)][std::size_t(number)];
}

int ise_colour(int range, int number) {
    return tables().colour[std::size_t(range)][std::size_t(number)];
}

int ise_colour_number(int range, int value) {
    return tables().colour_number[std::size_t(range)][std::size_t(value)];
}

}  // namespace domelight
