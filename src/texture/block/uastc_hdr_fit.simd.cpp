// Fits UASTC HDR blocks, a block a lane. The forms tried: one colour; two endpoints (endpoint mode 11) with 16 and with
// 12 weights; a base and a scale (mode 7) with 16 weights; two subsets of base and scale with 8 weights.
#include "texture/block/uastc_hdr_fit.h"

#include "texture/block/astc_ise.h"
#include "texture/texel/half.h"
#include "texture/block/uastc_hdr.h"
#include "texture/block/uastc_hdr_tables.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "texture/block/uastc_hdr_fit.simd.cpp"
// clang-format off: the order is Highway's
#include "base/simd_targets.h"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace domelight::simd {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Names of this file alone.
namespace {

using D = hn::CappedTag<float, k_uastc_batch>;
using DI = hn::RebindToSigned<D>;
using V = hn::Vec<D>;
using VI = hn::Vec<DI>;
using M = hn::Mask<D>;

V set(float v) {
    return hn::Set(D(), v);
}
VI set_int(int v) {
    return hn::Set(DI(), v);
}
V to_float(VI v) {
    return hn::ConvertTo(D(), v);
}
VI choose(M mask, VI yes, VI no) {
    return hn::IfThenElse(hn::RebindMask(DI(), mask), yes, no);
}
V choose(M mask, V yes, V no) {
    return hn::IfThenElse(mask, yes, no);
}
/// The nearest integer of a number >= 0, halves rounded up; the same on all instruction sets.
VI round_up(V v) {
    return hn::ConvertTo(DI(), hn::Add(v, set(0.5f)));
}
V clamp(V v, float low, float high) {
    return hn::Min(hn::Max(v, set(low)), set(high));
}
VI clamp(VI v, int low, int high) {
    return hn::Min(hn::Max(v, set_int(low)), set_int(high));
}
template <int bit>
VI bit_of(VI v) {
    return hn::And(hn::ShiftRight<bit>(v), set_int(1));
}

/// Three channels.
struct Colour {
    V c[3];
};

Colour select(M mask, const Colour& yes, const Colour& no) {
    return {{choose(mask, yes.c[0], no.c[0]), choose(mask, yes.c[1], no.c[1]), choose(mask, yes.c[2], no.c[2])}};
}
/// The weight of a channel's error: a compromise between equal weights and those of luminance, which would harm colours
/// more than they help.
constexpr float k_channel_weight[3] = {1, 1.5f, 0.75f};
constexpr float k_channel_weight_sum = k_channel_weight[0] + k_channel_weight[1] + k_channel_weight[2];
/// The product by which distances between colours are measured.
V product(const Colour& a, const Colour& b) {
    return hn::Add(hn::Add(hn::Mul(a.c[0], b.c[0]), hn::Mul(hn::Mul(set(k_channel_weight[1]), a.c[1]), b.c[1])),
                   hn::Mul(hn::Mul(set(k_channel_weight[2]), a.c[2]), b.c[2]));
}
/// The weighted sum, and mean, of the channels.
V weighted_sum(const Colour& a) {
    return hn::Add(hn::Add(a.c[0], hn::Mul(set(k_channel_weight[1]), a.c[1])),
                   hn::Mul(set(k_channel_weight[2]), a.c[2]));
}
V weighted_mean(const Colour& a) {
    return hn::Mul(weighted_sum(a), set(1 / k_channel_weight_sum));
}
Colour minus(const Colour& a, const Colour& b) {
    return {{hn::Sub(a.c[0], b.c[0]), hn::Sub(a.c[1], b.c[1]), hn::Sub(a.c[2], b.c[2])}};
}
V sum(const Colour& a) {
    return hn::Add(hn::Add(a.c[0], a.c[1]), a.c[2]);
}

/// 16 texels in steps of 1/128 octave on ASTC's scale.
struct Texels {
    Colour at[16];
};

/// A pair of endpoints.
struct Ends {
    Colour low, high;
};

/// The best block so far: its numbers and its error.
struct Found {
    V error;
    VI form;
    VI values[12];
    VI ranks[16];
    VI pattern;  ///< index of the partition
};

/// Forms, in the order of k_forms below.
enum : int { k_solid, k_rgb_16, k_rgb_12, k_scale_16, k_scale_two };

/// A linear value on ASTC's scale (the inverse of half_from_astc), in 1/128 octave.
V astc_scale(V v) {
    const DI di;
    const auto bits = hn::BitCast(di, v);
    const M small = hn::Lt(v, set(0x1p-14f));
    const V fraction =
        choose(small, hn::Mul(v, set(0x1p14f)),
               hn::Sub(hn::BitCast(D(), hn::Or(hn::And(bits, set_int(0x7fffff)), set_int(0x3f800000))), set(1)));
    const V exponent = choose(small, hn::Zero(D()), to_float(hn::Sub(hn::ShiftRight<23>(bits), set_int(112))));
    // The three pieces: mantissa 3 m; 4 m - 512; 5 m - 2048, on a scale of 8192 an octave and m of 2048.
    const V m = hn::Mul(fraction, set(8192));
    const V line = choose(hn::Lt(m, set(1536)), hn::Mul(m, set(1.0f / 3)),
                          choose(hn::Lt(m, set(5632)), hn::Mul(hn::Add(m, set(512)), set(0.25f)),
                                 hn::Mul(hn::Add(m, set(2048)), set(0.2f))));
    return hn::Add(hn::Mul(exponent, set(128)), hn::Mul(line, set(1.0f / 16)));
}

/// Weight, 0 to 64, of a rank among `levels`.
template <int levels>
V weight_of(V rank) {
    static_assert(levels == 16 || levels == 12 || levels == 8);
    if constexpr (levels == 8)
        return hn::Add(hn::Mul(rank, set(9)), hn::IfThenElseZero(hn::Gt(rank, set(3.5f)), set(1)));
    if constexpr (levels == 16)
        return hn::Add(hn::Add(hn::Mul(rank, set(4)), to_float(hn::ConvertTo(DI(), hn::Mul(rank, set(0.25f))))),
                       hn::IfThenElseZero(hn::Gt(rank, set(7.5f)), set(1)));
    const M upper = hn::Gt(rank, set(5.5f));
    const V near = choose(upper, hn::Sub(set(11), rank), rank);
    const V w = to_float(hn::ConvertTo(DI(), hn::Mul(near, set(5.75f))));
    return choose(upper, hn::Sub(set(64), w), w);
}

/// Sums over texels that give the error of any endpoints for fixed weights: with a = 1 - w, b = w.
struct Moments {
    V aa, ab, bb;
    Colour ap, bp;
};

/// The weights of all texels for a pair of ends, and their error and sums.
struct Weighted {
    VI ranks[16];
    V error;
    Moments moments;
};

/// Adds a texel of weight w.
void add_to(Moments& m, V w, const Colour& p) {
    const V a = hn::Sub(set(1), w);
    m.aa = hn::Add(m.aa, hn::Mul(a, a));
    m.ab = hn::Add(m.ab, hn::Mul(a, w));
    m.bb = hn::Add(m.bb, hn::Mul(w, w));
    for (int c = 0; c < 3; ++c) {
        m.ap.c[c] = hn::Add(m.ap.c[c], hn::Mul(a, p.c[c]));
        m.bp.c[c] = hn::Add(m.bp.c[c], hn::Mul(w, p.c[c]));
    }
}

Moments no_moments() {
    const V zero = hn::Zero(D());
    return {zero, zero, zero, {{zero, zero, zero}}, {{zero, zero, zero}}};
}

/// Texels to ends, each to the nearest of `levels` weights.
template <int levels>
void give_weights(const Texels& texels, const Ends& ends, Weighted& out) {
    const Colour direction = minus(ends.high, ends.low);
    const V length2 = product(direction, direction);
    const V scale = hn::Div(set(levels - 1), hn::Max(length2, set(1e-6f)));
    out.error = hn::Zero(D());
    out.moments = no_moments();
    for (int i = 0; i < 16; ++i) {
        const Colour from_low = minus(texels.at[i], ends.low);
        const V place = clamp(hn::Mul(product(from_low, direction), scale), 0, levels - 1);
        out.ranks[i] = round_up(place);
        const V w = hn::Mul(weight_of<levels>(to_float(out.ranks[i])), set(1.0f / 64));
        add_to(out.moments, w, texels.at[i]);
        Colour off;
        for (int c = 0; c < 3; ++c) off.c[c] = hn::Sub(from_low.c[c], hn::Mul(w, direction.c[c]));
        out.error = hn::Add(out.error, product(off, off));
    }
}

/// The ends of least error for the weights that gave the moments; `otherwise` if these do not determine them.
Ends best_ends(const Moments& m, const Ends& otherwise) {
    const V det = hn::Sub(hn::Mul(m.aa, m.bb), hn::Mul(m.ab, m.ab));
    const M good = hn::Gt(det, set(1e-3f));
    const V inverse = hn::Div(set(1), choose(good, det, set(1)));
    Ends ends;
    for (int c = 0; c < 3; ++c) {
        const V low = hn::Mul(hn::Sub(hn::Mul(m.ap.c[c], m.bb), hn::Mul(m.bp.c[c], m.ab)), inverse);
        const V high = hn::Mul(hn::Sub(hn::Mul(m.bp.c[c], m.aa), hn::Mul(m.ap.c[c], m.ab)), inverse);
        ends.low.c[c] = clamp(choose(good, low, otherwise.low.c[c]), 0, k_uastc_end_max);
        ends.high.c[c] = clamp(choose(good, high, otherwise.high.c[c]), 0, k_uastc_end_max);
    }
    return ends;
}

/// The additional error of `got` if `wanted` would be the best for the weights.
V cost_of(const Moments& m, const Ends& wanted, const Ends& got) {
    V cost = hn::Zero(D());
    for (int c = 0; c < 3; ++c) {
        const V low = hn::Sub(got.low.c[c], wanted.low.c[c]), high = hn::Sub(got.high.c[c], wanted.high.c[c]);
        const V here =
            hn::Add(hn::Mul(hn::Mul(m.aa, low), low),
                    hn::Add(hn::Mul(hn::Mul(hn::Mul(set(2), m.ab), low), high), hn::Mul(hn::Mul(m.bb, high), high)));
        cost = hn::Add(cost, hn::Mul(set(k_channel_weight[c]), here));
    }
    return cost;
}

/// Ends that a form can store, and the values that store them.
struct Stored {
    V cost;
    Ends ends;
    VI values[6];
};

void keep_if_better(Stored& best, const Stored& other, int values) {
    const M better = hn::Lt(other.cost, best.cost);
    best.cost = choose(better, other.cost, best.cost);
    best.ends.low = select(better, other.ends.low, best.ends.low);
    best.ends.high = select(better, other.ends.high, best.ends.high);
    for (int i = 0; i < values; ++i) best.values[i] = choose(better, other.values[i], best.values[i]);
}

/// The value nearest to `v` that the range has, among those which share its upper `shared` bits.
template <int levels, int shared>
VI storable(VI v) {
    if constexpr (levels == 256) return v;
    return hn::GatherIndex(DI(), storable_table(levels, shared), v);
}

/// Too bright an end, which would decode as infinite, must not be chosen.
V cost_of_brightness(const Ends& e) {
    const V brightest = hn::Max(hn::Max(hn::Max(e.low.c[0], e.low.c[1]), hn::Max(e.low.c[2], e.high.c[0])),
                                hn::Max(e.high.c[1], e.high.c[2]));
    return hn::IfThenElseZero(hn::Gt(brightest, set(k_uastc_end_max)), set(1e30f));
}

/// Puts the largest channel of the high end first, as both endpoint modes do by exchanging two; its own inverse.
Colour exchange(const Colour& c, VI major) {
    const M one = hn::RebindMask(D(), hn::Eq(major, set_int(1))), two = hn::RebindMask(D(), hn::Eq(major, set_int(2)));
    return {
        {choose(one, c.c[1], choose(two, c.c[2], c.c[0])), choose(one, c.c[0], c.c[1]), choose(two, c.c[0], c.c[2])}};
}

VI major_channel(const Colour& high) {
    const M green = hn::Gt(high.c[1], high.c[0]);
    const V largest = choose(green, high.c[1], high.c[0]);
    return choose(hn::Gt(high.c[2], largest), set_int(2), choose(green, set_int(1), set_int(0)));
}

/// Endpoint mode 11 in one of its eight forms: fields a, b0, b1, c, d0, d1 of these bits in units of `unit`, and where
/// their upper bits go; astc_block.cpp reads them.
template <int mode, int levels>
Stored store_rgb(const Moments& moments, const Ends& wanted, const Ends& turned, VI major) {
    constexpr int k_a_bits[8] = {9, 9, 10, 10, 11, 11, 12, 12}, k_b_bits[8] = {7, 8, 6, 7, 8, 6, 7, 6},
                  k_c_bits[8] = {6, 6, 7, 7, 6, 8, 7, 7}, k_d_bits[8] = {7, 6, 7, 6, 5, 6, 5, 6};
    constexpr int unit = 1 << (3 - mode / 2), a_bits = k_a_bits[mode], b_bits = k_b_bits[mode], c_bits = k_c_bits[mode],
                  d_bits = k_d_bits[mode], d_half = 1 << (d_bits - 1);
    constexpr int a_max = k_uastc_end_max / unit - (levels < 256 ? 1 : 0);
    static_assert(a_max < 1 << a_bits);
    const auto steps = [](V v) HWY_ATTR { return hn::Mul(v, set(1.0f / unit)); };
    Stored s;

    VI a = clamp(round_up(steps(turned.high.c[0])), 0, a_max);
    const VI a_low = storable<levels, 0>(hn::And(a, set_int(255)));
    a = hn::Or(hn::And(a, set_int(~255)), a_low);
    const V high0 = to_float(a);

    const VI wanted_c =
        clamp(round_up(hn::Max(hn::Sub(high0, steps(turned.low.c[0])), hn::Zero(D()))), 0, (1 << c_bits) - 1);
    s.values[1] = storable<levels, 2>(
        hn::Or(hn::Or(set_int((mode & 1) << 7), hn::ShiftLeft<6>(bit_of<8>(a))), hn::And(wanted_c, set_int(63))));
    const VI c = hn::Or(hn::And(wanted_c, set_int(~63)), hn::And(s.values[1], set_int(63)));
    const V low0 = hn::Sub(high0, to_float(c));

    VI b[2], d[2];
    V high[2], low[2];
    for (int k = 0; k < 2; ++k) {
        const VI wanted_b =
            clamp(round_up(hn::Max(hn::Sub(high0, steps(turned.high.c[k + 1])), hn::Zero(D()))), 0, (1 << b_bits) - 1);
        // Bit 6 of the value is the fields' x0 or x1.
        VI x;
        if constexpr (mode == 0 || mode == 1 || mode == 3 || mode == 4 || mode == 6)
            x = bit_of<6>(wanted_b);
        else if constexpr (mode == 2)
            x = k == 0 ? bit_of<9>(a) : bit_of<6>(c);
        else
            x = k == 0 ? bit_of<9>(a) : bit_of<10>(a);
        s.values[2 + k] = storable<levels, 2>(
            hn::Or(hn::Or(set_int((mode >> (1 + k) & 1) << 7), hn::ShiftLeft<6>(x)), hn::And(wanted_b, set_int(63))));
        b[k] = hn::Or(hn::And(wanted_b, set_int(~63)), hn::And(s.values[2 + k], set_int(63)));
        high[k] = hn::Sub(high0, to_float(b[k]));
        const V base = hn::Sub(high[k], to_float(c));
        const V wanted_d = clamp(hn::Sub(base, steps(turned.low.c[k + 1])), -d_half, d_half - 1);
        d[k] = hn::Sub(round_up(hn::Add(wanted_d, set(128))), set_int(128));
    }
    for (int k = 0; k < 2; ++k) {
        VI upper = hn::And(k == 0 ? major : hn::ShiftRight<1>(major), set_int(1));
        upper = hn::ShiftLeft<7>(upper);
        if constexpr (d_bits <= 6) {
            VI x;  // x2 or x3
            if constexpr (mode == 1 || mode == 4)
                x = bit_of<7>(b[k]);
            else if constexpr (mode == 3)
                x = k == 0 ? bit_of<9>(a) : bit_of<6>(c);
            else if constexpr (mode == 5)
                x = k == 0 ? bit_of<7>(c) : bit_of<6>(c);
            else
                x = k == 0 ? bit_of<11>(a) : bit_of<6>(c);
            upper = hn::Or(upper, hn::ShiftLeft<6>(x));
        }
        if constexpr (d_bits == 5) upper = hn::Or(upper, hn::ShiftLeft<5>(k == 0 ? bit_of<9>(a) : bit_of<10>(a)));
        // Of d, only the lower four bits may change with the range, because the bits above are its sign.
        s.values[4 + k] = storable<levels, 4>(hn::Or(upper, hn::And(d[k], set_int((1 << d_bits) - 1))));
        d[k] = hn::Or(hn::And(d[k], set_int(~15)), hn::And(s.values[4 + k], set_int(15)));
        low[k] = hn::Sub(hn::Sub(high[k], to_float(c)), to_float(d[k]));
    }
    s.values[0] = a_low;
    const auto value = [](V v) HWY_ATTR { return clamp(hn::Mul(v, set(unit)), 0, 4095); };
    s.ends.high = exchange({{value(high0), value(high[0]), value(high[1])}}, major);
    s.ends.low = exchange({{value(low0), value(low[0]), value(low[1])}}, major);
    s.cost = hn::Add(cost_of(moments, wanted, s.ends), cost_of_brightness(s.ends));
    return s;
}

/// Endpoint mode 11's plain form: eight bits a channel (blue seven), in any order.
template <int levels>
Stored store_rgb_direct(const Moments& moments, const Ends& wanted) {
    Stored s;
    for (int c = 0; c < 3; ++c) {
        const int unit = c == 2 ? 32 : 16, top = k_uastc_end_max / unit - (levels < 256 ? 1 : 0);
        for (int e = 0; e < 2; ++e) {
            const V v = e == 0 ? wanted.low.c[c] : wanted.high.c[c];
            VI code = clamp(round_up(hn::Mul(v, set(1.0f / float(unit)))), 0, top);
            if (c == 2) {
                code = storable<levels, 1>(hn::Or(code, set_int(128)));  // both upper bits 1: the plain form
                s.values[4 + e] = code;
                code = hn::And(code, set_int(127));
            } else {
                code = storable<levels, 0>(code);
                s.values[2 * c + e] = code;
            }
            (e == 0 ? s.ends.low : s.ends.high).c[c] = hn::Mul(to_float(code), set(float(unit)));
        }
    }
    s.cost = hn::Add(cost_of(moments, wanted, s.ends), cost_of_brightness(s.ends));
    return s;
}

template <int levels, int mode = 0>
void try_rgb_modes(Stored& best, const Moments& moments, const Ends& wanted, const Ends& turned, VI major) {
    keep_if_better(best, store_rgb<mode, levels>(moments, wanted, turned, major), 6);
    if constexpr (mode < 7) try_rgb_modes<levels, mode + 1>(best, moments, wanted, turned, major);
}

/// Endpoint mode 7 in one of its six forms: fields r, g, b and s.
template <int mode, int levels>
Stored store_scale(const Moments& moments, const Ends& wanted, const Ends& turned, VI major) {
    constexpr int k_shift[6] = {1, 1, 2, 3, 4, 5}, k_r_bits[6] = {11, 11, 10, 9, 8, 7},
                  k_g_bits[6] = {5, 6, 5, 6, 7, 7}, k_s_bits[6] = {7, 5, 8, 7, 6, 7};
    constexpr int unit = 1 << k_shift[mode], g_bits = k_g_bits[mode], s_bits = k_s_bits[mode];
    constexpr int r_max = k_uastc_end_max / unit - (levels < 256 ? 4 : 0);
    static_assert(r_max < 1 << k_r_bits[mode]);
    const auto steps = [](V v) HWY_ATTR { return hn::Mul(v, set(1.0f / unit)); };
    Stored s;
    const VI wanted_r = clamp(round_up(steps(turned.high.c[0])), 0, r_max);
    const VI mode_bits = mode < 4    ? hn::Or(set_int(mode), hn::ShiftLeft<2>(major))
                         : mode == 4 ? hn::Or(set_int(12), major)
                                     : set_int(15);
    s.values[0] =
        storable<levels, 2>(hn::Or(hn::ShiftLeft<6>(hn::And(mode_bits, set_int(3))), hn::And(wanted_r, set_int(63))));
    const VI r = hn::Or(hn::And(wanted_r, set_int(~63)), hn::And(s.values[0], set_int(63)));
    const V red = to_float(r);

    VI wanted_g[2];
    for (int k = 0; k < 2; ++k) {
        const V other = steps(turned.high.c[k + 1]);
        wanted_g[k] = clamp(round_up(mode == 5 ? other : hn::Max(hn::Sub(red, other), hn::Zero(D()))), 0,
                            mode == 5 ? k_uastc_end_max / unit : (1 << g_bits) - 1);
    }
    const VI wanted_s = clamp(round_up(hn::Max(steps(hn::Sub(turned.high.c[0], turned.low.c[0])), hn::Zero(D()))), 0,
                              (1 << s_bits) - 1);
    VI x[7];
    if constexpr (mode <= 3) {
        x[2] = bit_of<7>(r);
        x[4] = mode == 2 ? bit_of<7>(wanted_s) : bit_of<6>(r);
        x[5] = mode == 1 ? bit_of<10>(r) : bit_of<6>(wanted_s);
        x[6] = mode == 1 ? bit_of<9>(r) : bit_of<5>(wanted_s);
        x[0] = mode == 0 || mode == 2 ? bit_of<9>(r) : bit_of<8>(r);
        x[1] = mode == 0 || mode == 2 ? bit_of<8>(r) : bit_of<5>(wanted_g[0]);
        x[3] = mode == 0 ? bit_of<10>(r) : mode == 2 ? bit_of<6>(r) : bit_of<5>(wanted_g[1]);
    } else {
        x[0] = bit_of<6>(wanted_g[0]);
        x[1] = bit_of<5>(wanted_g[0]);
        x[2] = bit_of<6>(wanted_g[1]);
        x[3] = bit_of<5>(wanted_g[1]);
        x[4] = bit_of<6>(r);
        x[5] = mode == 4 ? bit_of<7>(r) : bit_of<6>(wanted_s);
        x[6] = bit_of<5>(wanted_s);
    }
    V high[3] = {red, red, red};
    for (int k = 0; k < 2; ++k) {
        const VI upper = hn::Or(
            hn::ShiftLeft<7>(hn::And(k == 0 ? hn::ShiftRight<2>(mode_bits) : hn::ShiftRight<3>(mode_bits), set_int(1))),
            hn::Or(hn::ShiftLeft<6>(x[2 * k]), hn::ShiftLeft<5>(x[2 * k + 1])));
        s.values[1 + k] = storable<levels, 3>(hn::Or(upper, hn::And(wanted_g[k], set_int(31))));
        const V g = to_float(hn::Or(hn::And(wanted_g[k], set_int(~31)), hn::And(s.values[1 + k], set_int(31))));
        high[k + 1] = mode == 5 ? g : hn::Sub(red, g);
    }
    s.values[3] = storable<levels, 3>(
        hn::Or(hn::Or(hn::ShiftLeft<7>(x[4]), hn::Or(hn::ShiftLeft<6>(x[5]), hn::ShiftLeft<5>(x[6]))),
               hn::And(wanted_s, set_int(31))));
    const V scale = to_float(hn::Or(hn::And(wanted_s, set_int(~31)), hn::And(s.values[3], set_int(31))));
    const auto value = [](V v) HWY_ATTR { return clamp(hn::Mul(v, set(unit)), 0, 4095); };
    const VI turn = mode == 5 ? set_int(0) : major;
    s.ends.high = exchange({{value(high[0]), value(high[1]), value(high[2])}}, turn);
    s.ends.low = exchange(
        {{value(hn::Sub(high[0], scale)), value(hn::Sub(high[1], scale)), value(hn::Sub(high[2], scale))}}, turn);
    s.cost = hn::Add(cost_of(moments, wanted, s.ends), cost_of_brightness(s.ends));
    return s;
}

template <int levels, int mode = 0>
void try_scale_modes(Stored& best, const Moments& moments, const Ends& wanted, const Ends& turned, VI major) {
    // The last form does not exchange channels.
    keep_if_better(best, store_scale<mode, levels>(moments, wanted, mode == 5 ? wanted : turned, major), 4);
    if constexpr (mode < 5) try_scale_modes<levels, mode + 1>(best, moments, wanted, turned, major);
}

/// The brighter end becomes the high one.
void order(Ends& ends, Moments& moments) {
    const M turned = hn::Lt(sum(ends.high), sum(ends.low));
    const Ends old = ends;
    ends.low = select(turned, old.high, old.low);
    ends.high = select(turned, old.low, old.high);
    const V aa = moments.aa;
    moments.aa = choose(turned, moments.bb, aa);
    moments.bb = choose(turned, aa, moments.bb);
}

template <int levels>
Stored store_best_rgb(Moments moments, Ends wanted) {
    order(wanted, moments);
    const VI major = major_channel(wanted.high);
    const Ends turned{exchange(wanted.low, major), exchange(wanted.high, major)};
    Stored best = store_rgb_direct<levels>(moments, wanted);
    try_rgb_modes<levels>(best, moments, wanted, turned, major);
    return best;
}

template <int levels>
Stored store_best_scale(const Moments& moments, const Ends& wanted) {
    const VI major = major_channel(wanted.high);
    const Ends turned{exchange(wanted.low, major), exchange(wanted.high, major)};
    Stored best;
    best.cost = set(1e35f);
    best.ends = wanted;
    for (VI& v : best.values) v = set_int(0);
    try_scale_modes<levels>(best, moments, wanted, turned, major);
    return best;
}

/// The ends of mode 7 for given weights: low = high - s in every channel. With a = 1 - w, p = high - a s: a straight
/// line through (a, mean channel), and each channel's own mean.
Ends best_scale_ends(const Moments& m, V count, const Ends& otherwise) {
    const V a = hn::Add(m.aa, m.ab);  // sum a, as a + b = 1
    const V inverse_count = hn::Div(set(1), hn::Max(count, set(1)));
    const V a_mean = hn::Mul(a, inverse_count);
    const V variance = hn::Sub(m.aa, hn::Mul(a, a_mean));
    const M good = hn::Gt(variance, set(1e-3f));
    const Colour total{{hn::Add(m.ap.c[0], m.bp.c[0]), hn::Add(m.ap.c[1], m.bp.c[1]), hn::Add(m.ap.c[2], m.bp.c[2])}};
    const V covariance = hn::Sub(weighted_mean(m.ap), hn::Mul(a_mean, weighted_mean(total)));
    V s = hn::Div(hn::Neg(covariance), choose(good, variance, set(1)));
    s = hn::Max(choose(good, s, hn::Sub(otherwise.high.c[0], otherwise.low.c[0])), hn::Zero(D()));
    Ends ends;
    for (int c = 0; c < 3; ++c) {
        const V high = hn::Add(hn::Mul(total.c[c], inverse_count), hn::Mul(s, a_mean));
        ends.high.c[c] = clamp(choose(good, high, otherwise.high.c[c]), 0, k_uastc_end_max);
        ends.low.c[c] = hn::Sub(ends.high.c[c], s);
    }
    return ends;
}

/// Sums over a block that all forms start from.
struct Spread {
    Colour mean;
    Texels off;  ///< texels less their mean
    V variance;  ///< sum of squares of these
};

Spread spread_of(const Texels& texels) {
    Spread s;
    for (int c = 0; c < 3; ++c) {
        V total = hn::Zero(D());
        for (int i = 0; i < 16; ++i) total = hn::Add(total, texels.at[i].c[c]);
        s.mean.c[c] = hn::Mul(total, set(1.0f / 16));
    }
    s.variance = hn::Zero(D());
    for (int i = 0; i < 16; ++i) {
        s.off.at[i] = minus(texels.at[i], s.mean);
        s.variance = hn::Add(s.variance, product(s.off.at[i], s.off.at[i]));
    }
    return s;
}

/// The ends of the line of largest variance, by power iteration on the covariance.
Ends principal_ends(const Spread& s) {
    V xx = hn::Zero(D()), xy = xx, xz = xx, yy = xx, yz = xx, zz = xx;
    for (int i = 0; i < 16; ++i) {
        const Colour& p = s.off.at[i];
        xx = hn::Add(xx, hn::Mul(p.c[0], p.c[0]));
        xy = hn::Add(xy, hn::Mul(p.c[0], p.c[1]));
        xz = hn::Add(xz, hn::Mul(p.c[0], p.c[2]));
        yy = hn::Add(yy, hn::Mul(p.c[1], p.c[1]));
        yz = hn::Add(yz, hn::Mul(p.c[1], p.c[2]));
        zz = hn::Add(zz, hn::Mul(p.c[2], p.c[2]));
    }
    // Starts from the row of the largest diagonal element, which no eigenvector of size is orthogonal to.
    const M green = hn::Gt(yy, xx);
    Colour axis = select(green, {{xy, yy, yz}}, {{xx, xy, xz}});
    axis = select(hn::Gt(zz, hn::Max(xx, yy)), {{xz, yz, zz}}, axis);
    for (int k = 0; k < 4; ++k) {
        const V largest = hn::Max(hn::Max(hn::Abs(axis.c[0]), hn::Abs(axis.c[1])), hn::Abs(axis.c[2]));
        const V inverse = hn::Div(set(1), hn::Max(largest, set(1e-10f)));
        for (V& v : axis.c) v = hn::Mul(v, inverse);
        if (k == 3) break;
        axis = {{product({{xx, xy, xz}}, axis), product({{xy, yy, yz}}, axis), product({{xz, yz, zz}}, axis)}};
    }
    const V inverse = hn::Div(set(1), hn::Max(product(axis, axis), set(1e-6f)));
    V least = set(1e30f), most = set(-1e30f);
    for (int i = 0; i < 16; ++i) {
        const V t = hn::Mul(product(s.off.at[i], axis), inverse);
        least = hn::Min(least, t);
        most = hn::Max(most, t);
    }
    Ends ends;
    for (int c = 0; c < 3; ++c) {
        ends.low.c[c] = clamp(hn::Add(s.mean.c[c], hn::Mul(least, axis.c[c])), 0, k_uastc_end_max);
        ends.high.c[c] = clamp(hn::Add(s.mean.c[c], hn::Mul(most, axis.c[c])), 0, k_uastc_end_max);
    }
    return ends;
}

/// Keeps a trial where it is better.
void keep(Found& found, const Weighted& weighted, const VI* values, int value_count, int form) {
    const M better = hn::Lt(weighted.error, found.error);
    found.error = choose(better, weighted.error, found.error);
    found.form = choose(better, set_int(form), found.form);
    for (int i = 0; i < value_count; ++i) found.values[i] = choose(better, values[i], found.values[i]);
    for (int i = 0; i < 16; ++i) found.ranks[i] = choose(better, weighted.ranks[i], found.ranks[i]);
}

/// Two ends: from the line of largest variance to the best ends for the weights, and back, and so on.
template <int weights, int levels>
void try_rgb(const Texels& texels, const Ends& line, int passes, Found& found, int form) {
    Weighted weighted;
    give_weights<weights>(texels, line, weighted);
    Ends ends = line;
    for (int pass = 0; pass < passes; ++pass) {
        ends = best_ends(weighted.moments, ends);
        const Stored stored = store_best_rgb<levels>(weighted.moments, ends);
        give_weights<weights>(texels, stored.ends, weighted);
        keep(found, weighted, stored.values, 6, form);
        ends = stored.ends;
    }
}

/// A base and a scale.
void try_scale(const Texels& texels, const Spread& s, int passes, Found& found) {
    V least = set(1e30f), most = set(-1e30f);
    for (int i = 0; i < 16; ++i) {
        const V t = weighted_mean(s.off.at[i]);
        least = hn::Min(least, t);
        most = hn::Max(most, t);
    }
    Ends ends;
    for (int c = 0; c < 3; ++c) {
        ends.low.c[c] = hn::Add(s.mean.c[c], least);
        ends.high.c[c] = hn::Add(s.mean.c[c], most);
    }
    Weighted weighted;
    give_weights<16>(texels, ends, weighted);
    for (int pass = 0; pass < passes; ++pass) {
        ends = best_scale_ends(weighted.moments, set(16), ends);
        const Stored stored = store_best_scale<256>(weighted.moments, ends);
        give_weights<16>(texels, stored.ends, weighted);
        keep(found, weighted, stored.values, 4, k_scale_16);
        ends = stored.ends;
    }
}

M in_second(VI pattern, int texel) {
    return hn::RebindMask(D(), hn::TestBit(pattern, set_int(1 << texel)));
}

/// The error that remains with each partition if a base and a scale are stored in each subset: of the variance along
/// (1, 1, 1), about 1/49 remains with eight weights.
struct PartitionGains {
    V gain[k_uastc_partitions];
};

PartitionGains partition_gains(const Spread& s) {
    PartitionGains gains;
    for (int k = 0; k < k_uastc_partitions; ++k) {
        const std::uint32_t bits = uastc_partition_bits(k);
        Colour in{{hn::Zero(D()), hn::Zero(D()), hn::Zero(D())}};
        int count = 0;
        for (int i = 0; i < 16; ++i) {
            if (!(bits >> i & 1)) continue;
            ++count;
            for (int c = 0; c < 3; ++c) in.c[c] = hn::Add(in.c[c], s.off.at[i].c[c]);
        }
        // The two subsets' sums are opposite, as the texels' mean is 0.
        const V total = weighted_sum(in);
        gains.gain[k] =
            hn::Mul(hn::Sub(product(in, in), hn::Mul(hn::Mul(total, total), set(48.0f / 49 / k_channel_weight_sum))),
                    set(1.0f / float(count) + 1.0f / float(16 - count)));
    }
    return gains;
}

/// Removes the best partition from the list; gives its index and the texels of its second subset.
VI take_partition(PartitionGains& gains, VI& index) {
    V best = gains.gain[0];
    VI pattern = set_int(int(uastc_partition_bits(0)));
    index = set_int(0);
    for (int k = 1; k < k_uastc_partitions; ++k) {
        const M better = hn::Gt(gains.gain[k], best);
        best = choose(better, gains.gain[k], best);
        pattern = choose(better, set_int(int(uastc_partition_bits(k))), pattern);
        index = choose(better, set_int(k), index);
    }
    for (int k = 0; k < k_uastc_partitions; ++k)
        gains.gain[k] = choose(hn::RebindMask(D(), hn::Eq(index, set_int(k))), set(-1e30f), gains.gain[k]);
    return pattern;
}

void add_masked(Moments& m, M mask, V w, const Colour& p) {
    const V a = hn::IfThenElseZero(mask, hn::Sub(set(1), w)), b = hn::IfThenElseZero(mask, w);
    m.aa = hn::Add(m.aa, hn::Mul(a, a));
    m.ab = hn::Add(m.ab, hn::Mul(a, b));
    m.bb = hn::Add(m.bb, hn::Mul(b, b));
    for (int c = 0; c < 3; ++c) {
        m.ap.c[c] = hn::Add(m.ap.c[c], hn::Mul(a, p.c[c]));
        m.bp.c[c] = hn::Add(m.bp.c[c], hn::Mul(b, p.c[c]));
    }
}

/// give_weights with eight weights, a pair of ends a subset.
void give_weights_two(const Texels& texels, VI pattern, const Ends (&ends)[2], Weighted& out, Moments (&moments)[2]) {
    Colour direction[2];
    V scale[2];
    for (int k = 0; k < 2; ++k) {
        direction[k] = minus(ends[k].high, ends[k].low);
        scale[k] = hn::Div(set(7), hn::Max(product(direction[k], direction[k]), set(1e-6f)));
        moments[k] = no_moments();
    }
    out.error = hn::Zero(D());
    for (int i = 0; i < 16; ++i) {
        const M second = in_second(pattern, i);
        const Colour along = select(second, direction[1], direction[0]);
        const Colour from_low = minus(texels.at[i], select(second, ends[1].low, ends[0].low));
        const V place = clamp(hn::Mul(product(from_low, along), choose(second, scale[1], scale[0])), 0, 7);
        out.ranks[i] = round_up(place);
        const V w = hn::Mul(weight_of<8>(to_float(out.ranks[i])), set(1.0f / 64));
        add_masked(moments[0], hn::Not(second), w, texels.at[i]);
        add_masked(moments[1], second, w, texels.at[i]);
        Colour off;
        for (int c = 0; c < 3; ++c) off.c[c] = hn::Sub(from_low.c[c], hn::Mul(w, along.c[c]));
        out.error = hn::Add(out.error, product(off, off));
    }
}

/// Two subsets, each with a base and a scale. Only if the best error so far is `worth` or more.
void try_scale_two(const Texels& texels, const Spread& s, VI pattern, VI index, int passes, V worth, Found& found) {
    Ends ends[2];
    V count[2] = {hn::Zero(D()), hn::Zero(D())}, least[2] = {set(1e30f), set(1e30f)},
      most[2] = {set(-1e30f), set(-1e30f)};
    Colour total[2];
    for (Colour& c : total) c = {{hn::Zero(D()), hn::Zero(D()), hn::Zero(D())}};
    for (int i = 0; i < 16; ++i) {
        const M second = in_second(pattern, i);
        const V t = weighted_mean(s.off.at[i]);
        for (int k = 0; k < 2; ++k) {
            const M here = k == 0 ? hn::Not(second) : second;
            count[k] = hn::Add(count[k], hn::IfThenElseZero(here, set(1)));
            least[k] = choose(here, hn::Min(least[k], t), least[k]);
            most[k] = choose(here, hn::Max(most[k], t), most[k]);
            for (int c = 0; c < 3; ++c)
                total[k].c[c] = hn::Add(total[k].c[c], hn::IfThenElseZero(here, s.off.at[i].c[c]));
        }
    }
    for (int k = 0; k < 2; ++k) {
        const V inverse = hn::Div(set(1), count[k]);
        const V t_mean = hn::Mul(weighted_mean(total[k]), inverse);
        for (int c = 0; c < 3; ++c) {
            const V mean = hn::Add(s.mean.c[c], hn::Mul(total[k].c[c], inverse));
            ends[k].low.c[c] = hn::Add(mean, hn::Sub(least[k], t_mean));
            ends[k].high.c[c] = hn::Add(mean, hn::Sub(most[k], t_mean));
        }
    }
    Weighted weighted;
    Moments moments[2];
    give_weights_two(texels, pattern, ends, weighted, moments);
    for (int pass = 0; pass < passes; ++pass) {
        VI values[8];
        for (int k = 0; k < 2; ++k) {
            ends[k] = best_scale_ends(moments[k], count[k], ends[k]);
            const Stored stored = store_best_scale<80>(moments[k], ends[k]);
            ends[k] = stored.ends;
            for (int i = 0; i < 4; ++i) values[4 * k + i] = stored.values[i];
        }
        give_weights_two(texels, pattern, ends, weighted, moments);
        // A lane below that limit never takes the result, so that the bytes of a block do not depend on its neighbours.
        weighted.error = choose(hn::Ge(worth, set(k_uastc_two_subsets_from)), weighted.error, set(1e35f));
        const M better = hn::Lt(weighted.error, found.error);
        found.pattern = choose(better, index, found.pattern);
        keep(found, weighted, values, 8, k_scale_two);
    }
}

struct Form {
    int weight_range, endpoint_mode, subsets;
};
constexpr Form k_forms[] = {
    {},
    {k_ise_16, k_cem_hdr_rgb, 1},
    {k_ise_12, k_cem_hdr_rgb, 1},
    {k_ise_16, k_cem_hdr_base_scale, 1},
    {k_ise_8, k_cem_hdr_base_scale, 2},
};

/// One colour for all texels: if they are all the same it keeps them to the last bit.
void try_solid(const Spread& s, Found& found) {
    found.error = s.variance;
    found.form = set_int(k_solid);
    found.pattern = set_int(0);
    for (VI& v : found.values) v = set_int(0);
    for (VI& v : found.ranks) v = set_int(0);
}

void fit_lanes(const float* rgb, int count, UastcEffort effort, AstcBlock* blocks) {
    const int lanes = int(hn::Lanes(D()));
    HWY_ALIGN float in[48 * k_uastc_batch];
    for (int i = 0; i < 48; ++i)
        for (int b = 0; b < lanes; ++b) in[i * lanes + b] = rgb[48 * (b < count ? b : 0) + i];
    Texels texels;
    for (int i = 0; i < 16; ++i)
        for (int c = 0; c < 3; ++c) texels.at[i].c[c] = astc_scale(hn::Load(D(), in + (3 * i + c) * lanes));

    const Spread spread = spread_of(texels);
    Found found;
    try_solid(spread, found);
    if (!hn::AllTrue(D(), hn::Le(found.error, hn::Zero(D())))) {
        const Ends line = principal_ends(spread);
        try_rgb<16, 192>(texels, line, effort.passes, found, k_rgb_16);
        try_rgb<12, 256>(texels, line, effort.passes, found, k_rgb_12);
        try_scale(texels, spread, effort.passes, found);
        const V worth = found.error;
        if (!hn::AllTrue(D(), hn::Lt(worth, set(k_uastc_two_subsets_from)))) {
            PartitionGains gains = partition_gains(spread);
            for (int k = 0; k < effort.partitions; ++k) {
                VI index;
                const VI pattern = take_partition(gains, index);
                try_scale_two(texels, spread, pattern, index, effort.passes, worth, found);
            }
        }
    }

    HWY_ALIGN std::int32_t form[k_uastc_batch], pattern[k_uastc_batch], values[12 * k_uastc_batch],
        ranks[16 * k_uastc_batch];
    HWY_ALIGN float mean[3 * k_uastc_batch];
    hn::Store(found.form, DI(), form);
    hn::Store(found.pattern, DI(), pattern);
    for (int i = 0; i < 12; ++i) hn::Store(found.values[i], DI(), values + i * lanes);
    for (int i = 0; i < 16; ++i) hn::Store(found.ranks[i], DI(), ranks + i * lanes);
    for (int c = 0; c < 3; ++c) hn::Store(spread.mean.c[c], D(), mean + c * lanes);
    for (int b = 0; b < count; ++b) {
        AstcBlock block;
        block.solid = form[b] == k_solid;
        if (block.solid) {
            bool same = true;
            for (int i = 3; i < 48; ++i) same &= rgb[48 * b + i] == rgb[48 * b + i % 3];
            for (int c = 0; c < 3; ++c)
                block.colour[std::size_t(c)] =
                    same ? half_from_float(rgb[48 * b + c]) : half_from_astc(int(mean[c * lanes + b] * 16 + 0.5f));
        } else {
            const Form& f = k_forms[form[b]];
            block.weight_range = f.weight_range;
            block.endpoint_mode = f.endpoint_mode;
            block.subsets = f.subsets;
            if (f.subsets == 2) block.seed = k_uastc_seeds[std::size_t(pattern[b])];
            for (int i = 0; i < f.subsets * endpoint_values(f.endpoint_mode); ++i)
                block.values[std::size_t(i)] = std::uint8_t(values[i * lanes + b]);
            for (int i = 0; i < 16; ++i) block.weights[std::size_t(i)] = std::uint8_t(ranks[i * lanes + b]);
        }
        blocks[b] = block;
    }
}

}  // namespace

void fit_uastc_here(const float* rgb, int count, UastcEffort effort, AstcBlock* blocks) {
    const int lanes = int(hn::Lanes(D()));
    for (int b = 0; b < count; b += lanes)
        fit_lanes(rgb + 48 * b, count - b < lanes ? count - b : lanes, effort, blocks + b);
}

}  // namespace HWY_NAMESPACE
}  // namespace domelight::simd
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace domelight::simd {

HWY_EXPORT(fit_uastc_here);

void fit_uastc_hdr(const float* rgb, int count, UastcEffort effort, AstcBlock* blocks) {
    HWY_DYNAMIC_DISPATCH(fit_uastc_here)(rgb, count, effort, blocks);
}

}  // namespace domelight::simd
#endif
