#include "filtering/harmonic/sh_synthesis.h"

#include "domelight/base/parallel.h"

#include "filtering/harmonic/row_kernels.h"

#include <algorithm>
#include <array>

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
template <typename Walk>
void sum_degrees(const Spectrum& a, const Spectrum* b, std::span<const SynthesisFactors> factors,
                 const NorthernRings& north, Walk& walk, int m, std::vector<RingSpectra>& out) {
    const int band_limit = int(factors[0].k.size()) - 1;
    const std::size_t half = 6 * std::size_t(north.padded);
    for (auto& spectra : out) std::fill_n(spectra.order(m), 2 * half, 0.f);
    std::vector<float> scaled;
    for (int parity = 0; parity < 2; ++parity) {
        const int count = LegendreWalk::padded_count(band_limit, m, parity);
        scaled.assign(factors.size() * 6 * count, 0.f);
        const auto add = [&](const Spectrum& spectrum, const std::vector<double>& k, float* to) {
            const int last = int(k.size()) - 1;
            if (m + parity > last) return;
            const float* from = spectrum.block(m, parity);
            for (int i = 0; m + parity + 2 * i <= last; ++i)
                for (int c = 0; c < 6; ++c) to[6 * i + c] += float(k[m + parity + 2 * i]) * from[6 * i + c];
        };
        for (std::size_t f = 0; f < factors.size(); ++f) {
            add(a, factors[f].k, scaled.data() + 6 * f * count);
            if (!factors[f].r.empty()) add(*b, factors[f].r, scaled.data() + 6 * f * count);
        }
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

/// Rings first .. first + 15 of the north and their mirrors. The values of the north are transformed as the real part,
/// those of the south as the imaginary part: Z_m = N_m + i S_m, Z_-m = conj N_m + i conj S_m.
///
/// work   one array a channel
void transform_rings(const RingSpectra& spectra, int band_limit, const simd::BatchFft& fft, int first, int north_count,
                     std::array<AlignedArray<float>, 3>& work, SphereGrid& grid) {
    constexpr int lanes = simd::k_fft_lanes;
    const int width = fft.size();
    for (int channel = 0; channel < 3; ++channel) {
        float* data = work[channel].data();
        for (int f = band_limit + 1; f < width - band_limit; ++f)
            std::fill_n(data + std::size_t(fft.position(f)) * 2 * lanes, 2 * lanes, 0.f);
        for (int m = 0; m <= band_limit; ++m) {
            const float* north = spectra.order(m) + 2 * channel * spectra.stride + first;
            simd::pack_orders(north, north + 6 * spectra.stride, spectra.stride, m == 0,
                              data + std::size_t(fft.position(m)) * 2 * lanes,
                              data + std::size_t(fft.position((width - m) % width)) * 2 * lanes);
        }
        fft.inverse(data);
    }
    const int count = std::min(lanes, north_count - first), rings = grid.grid().rings;
    std::array<float*, lanes> north{}, south{};
    for (int i = 0; i < count; ++i) north[i] = grid.ring(first + i), south[i] = grid.ring(rings - 1 - first - i);
    simd::interleave_rings(work[0].data(), work[1].data(), work[2].data(), width, count, north.data(), south.data());
}

}  // namespace

std::vector<SphereGrid> sh_synthesis(const Spectrum& a, const Spectrum* b, std::span<const SynthesisFactors> factors,
                                     const RingTransform& with, int threads) {
    const int band_limit = int(factors[0].k.size()) - 1;
    const NorthernRings& north = with.north;
    std::vector<RingSpectra> spectra;
    for (std::size_t f = 0; f < factors.size(); ++f) spectra.emplace_back(band_limit, north);
    constexpr int orders_at_once = 4;
    parallel_ranges(band_limit + 1, orders_at_once, threads, [&](int begin, int end) {
        with.with_legendre(begin, end, [&](auto& walk, int first, int last) {
            for (int m = first; m < last; ++m) sum_degrees(a, b, factors, north, walk, m, spectra);
        });
    });

    const simd::BatchFft& fft = with.fft;
    const int groups = north.padded / simd::k_fft_lanes;
    std::vector<SphereGrid> grids;
    for (std::size_t f = 0; f < factors.size(); ++f) grids.emplace_back(with.grid, false);
    parallel_ranges(int(factors.size()) * groups, 4, threads, [&](int begin, int end) {
        std::array<AlignedArray<float>, 3> work;
        for (auto& data : work) data = AlignedArray<float>(std::size_t(fft.size()) * 2 * simd::k_fft_lanes, false);
        for (int task = begin; task < end; ++task)
            transform_rings(spectra[task / groups], band_limit, fft, task % groups * simd::k_fft_lanes, north.count,
                            work, grids[task / groups]);
    });
    for (SphereGrid& g : grids) g.wrap();
    return grids;
}

}  // namespace domelight
