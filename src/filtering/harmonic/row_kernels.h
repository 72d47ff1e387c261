#pragma once

#include <cstddef>

namespace domelight::simd {

/// sum[i] += weights[0] rows[i] + weights[1] rows[i + stride] + ..., `count` rows, i < n. The sum is in the order of
/// the rows, so its bits do not depend on how many rows are added at a time.
void add_weighted_rows(const float* rows, std::ptrdiff_t stride, const float* weights, int count, float* sum, int n);

/// One channel of 32 rows into the layout of BatchFft: out[x * 32 + i] = rows[i * stride + x * texel].
void gather_fft_rows(const float* rows, std::ptrdiff_t stride, int texel, int width, float* out);

/// Order m of 16 pairs of rings, as BatchFft takes them for an inverse transform of north + i south: plus = N_m + i S_m
/// and minus = conj N_m + i conj S_m, each 16 real and 16 imaginary parts.
///
/// north, south   real parts; the imaginary parts, which count as 0 if `real`, are `stride` floats further
void pack_orders(const float* north, const float* south, std::ptrdiff_t stride, bool real, float* plus, float* minus);

/// The reverse for a forward transform of two times 16 real rows, a + i b: with 2 A = plus + conj minus and 2 B = (plus -
/// conj minus) / i, (c + i s) 2 A goes to re[0..15] + i im[0..15] and (c + i s) 2 B to re[16..31] + i im[16..31].
void unpack_orders(const float* plus, const float* minus, float c, float s, float* re, float* im);

/// The rows north[i] and south[i], i < count <= 16, of RGBX pixels (X is 0) from the real and imaginary parts of lane i
/// of one transform a channel.
void interleave_rings(const float* r, const float* g, const float* b, int width, int count, float* const* north,
                      float* const* south);

/// Of each channel, the least of `width` RGBX pixels and of `among`.
struct Texel {
    float r, g, b;
};
Texel least(const float* rgbx, int width, Texel among);

/// The largest of n values (at least 0).
float largest(const float* values, int n);

/// The largest (at least 0) and the sum of n values, the same bits on every instruction set.
struct Summary {
    float largest, sum;
};
Summary summarize(const float* values, int n);

/// Sets negative values of n to 0; returns whether there was one.
bool clamp_negative(float* values, int n);

}  // namespace domelight::simd
