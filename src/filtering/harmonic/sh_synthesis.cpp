#include "filtering/harmonic/sh_synthesis.h"

#include "domelight/base/parallel.h"

#include "filtering/harmonic/batch_fft.h"

namespace domelight {
namespace {

/// Fourier coefficients of the rings of one function: [m][north | south][channel, re | im][ring], rings counted from
/// the poles.
struct RingSpectra {
    RingSpectra(int band_limit, const NorthernRings& north)
        : stride(north.padded), values(std::size_t(band_limit + 1) * 12 * north.padded, false) {}
    float* order(int m) { return values.data() + std::size_t(m) * 12 * stride; }
    const float* order(int m) const { return values.data() + std::size_t(m) * 12 * stride; }
    std::ptrdiff_t stride;
    AlignedArray<float> values;
};

/// sum_l k_l a_lm P_lm on the northern rings by parity; on the southern rings the odd part has the opposite sign.
void sum_degrees(const Spectrum& spectrum, std::span<const std::vector<double>> factors, const NorthernRings& north,
                 LegendreWalk& walk, int m, std::vector<RingSpectra>& out) {
    const int band_limit = int(factors[0].size()) - 1;
    const std::size_t half = 6 * std::size_t(north.padded);
    for (auto& spectra : out) std::fill_n(spectra.order(m), 2 * half, 0.f);
    std::vector<float> scaled;
    for (int parity = 0; parity < 2; ++parity) {
        const int count = LegendreWalk::padded_count(band_limit, m, parity);
        const float* a = spectrum.block(m, parity);
        scaled.assign(factors.size() * 6 * count, 0.f);
        for (std::size_t f = 0; f < factors.size(); ++f)
            for (int i = 0; i < count && m + parity + 2 * i <= band_limit; ++i)
                for (int c = 0; c < 6; ++c)
                    scaled[(f * count + i) * 6 + c] = float(factors[f][m + parity + 2 * i]) * a[6 * i + c];
        walk.walk(m, parity, [&](int first, int n, int first_ring, const float* p) {
            for (std::size_t f = 0; f < factors.size(); ++f)
                simd::expand_rows(p + first_ring, north.padded, n, scaled.data() + (f * count + first) * 6,
                                  north.padded - first_ring, out[f].order(m) + parity * half + first_ring,
                                  north.padded);
        });
    }
    for (auto& spectra : out) {
        float *even = spectra.order(m), *odd = even + half;
        for (std::size_t i = 0; i < half; ++i) {
            const float e = even[i], o = odd[i];
            even[i] = e + o;
            odd[i] = e - o;
        }
    }
}

/// Rings first .. first + 15 of the north and their mirrors: one channel's inverse transform. The values of the north
/// are transformed as the real part, those of the south as the imaginary part: Z_m = N_m + i S_m, Z_-m = conj N_m + i
/// conj S_m.
void transform_rings(const RingSpectra& spectra, int band_limit, const simd::BatchFft& fft, int first, int channel,
                     int north_count, AlignedArray<float>& data, SphereGrid& grid) {
    constexpr int lanes = simd::k_fft_lanes;
    const int width = fft.size();
    data.fill_zero();
    for (int m = 0; m <= band_limit; ++m) {
        const float* nr = spectra.order(m) + 2 * channel * spectra.stride + first;
        const float *ni = nr + spectra.stride, *sr = nr + 6 * spectra.stride, *si = ni + 6 * spectra.stride;
        float* plus = data.data() + std::size_t(fft.position(m)) * 2 * lanes;
        float* minus = data.data() + std::size_t(fft.position((width - m) % width)) * 2 * lanes;
        for (int i = 0; i < lanes; ++i) {
            const float a = nr[i], b = m ? ni[i] : 0, c = sr[i], d = m ? si[i] : 0;
            plus[i] = a - d;
            plus[i + lanes] = b + c;
            minus[i] = a + d;
            minus[i + lanes] = c - b;
        }
    }
    fft.inverse(data.data());
    const int count = std::min(lanes, north_count - first), rings = grid.grid().rings;
    constexpr int tile = 16;
    for (int x0 = 0; x0 < width; x0 += tile)
        for (int i = 0; i < count; ++i) {
            float *north = grid.ring(first + i) + channel, *south = grid.ring(rings - 1 - first - i) + channel;
            for (int x = x0; x < std::min(x0 + tile, width); ++x) {
                north[4 * x] = data[std::size_t(x) * 2 * lanes + i];
                south[4 * x] = data[std::size_t(x) * 2 * lanes + lanes + i];
            }
        }
}

}  // namespace

std::vector<SphereGrid> sh_synthesis(const Spectrum& spectrum, std::span<const std::vector<double>> factors,
                                     RingGrid grid, int threads) {
    const int band_limit = int(factors[0].size()) - 1;
    const NorthernRings north(grid.rings);
    std::vector<RingSpectra> spectra;
    for (std::size_t f = 0; f < factors.size(); ++f) spectra.emplace_back(band_limit, north);
    constexpr int orders_at_once = 4;
    parallel_ranges(band_limit + 1, orders_at_once, threads, [&](int begin, int end) {
        LegendreWalk walk(north, band_limit);
        for (int m = begin; m < end; ++m) sum_degrees(spectrum, factors, north, walk, m, spectra);
    });

    const simd::BatchFft fft(grid.width);
    const int groups = north.padded / simd::k_fft_lanes;
    std::vector<SphereGrid> grids;
    for (std::size_t f = 0; f < factors.size(); ++f) grids.emplace_back(grid);
    parallel_for(int(factors.size()) * groups, threads, [&](int task) {
        const int f = task / groups, first = task % groups * simd::k_fft_lanes;
        AlignedArray<float> data(std::size_t(grid.width) * 2 * simd::k_fft_lanes, false);
        for (int channel = 0; channel < 3; ++channel)
            transform_rings(spectra[f], band_limit, fft, first, channel, north.count, data, grids[f]);
    });
    for (SphereGrid& g : grids) g.wrap();
    return grids;
}

}  // namespace domelight
