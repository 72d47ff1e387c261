#include "domelight/sampling/distribution/guided.h"

#include "domelight/sampling/distribution/plain.h"

#include "base/instruction_set.h"
#include "sampling/distribution/chi_square.h"
#include "sampling/distribution/distribution_samples.h"
#include "test.h"

#include <cstring>

using namespace domelight;
using namespace domelight::test;

namespace {

std::vector<std::vector<float>> hard_rows() {
    std::vector<std::vector<float>> rows = {
        {1}, {0, 3}, {3, 0}, {0, 0, 5, 0, 0}, {1, 2, 3}, {0, 0, 0}, {1e-30f, 1e8f, 1e-30f}};
    std::mt19937 random(3);
    std::exponential_distribution<float> value(1);
    for (int n : {7, 64, 100, 1000}) {
        auto& row = rows.emplace_back(n);
        for (float& w : row) w = random() % 3 ? value(random) : 0.0f;
    }
    return rows;
}

}  // namespace

TEST_CASE("GuidedDistribution1D: draws what the plain form draws, and goes back exactly") {
    for (const auto& row : hard_rows()) {
        CAPTURE(row.size());
        const auto guided = GuidedDistribution1D::build(row);
        REQUIRE(bool(guided));
        const PlainDistribution1D plain(std::vector<double>(row.begin(), row.end()));
        for (UnitPoint p : random_points(2000, 5)) {
            const auto s = guided->sample(p.x);
            CHECK(s.x >= 0);
            CHECK(s.x < 1);
            CHECK(s.pdf > 0);
            CHECK(plain.value(s.index) > 0);
            CHECK(int(s.x * guided->size()) == s.index);
            CHECK(guided->pdf(s.x) == s.pdf);
            CHECK(guided->invert(s.x).value() == p.x);
            // Each item gets one quantum first, which takes a share of a quantum from every other item.
            CHECK(std::abs(plain.invert(s.x) - p.x * 0x1p-32) < (row.size() + 1) * 0x1p-32);
        }
    }
    CHECK(!GuidedDistribution1D::build({}));
    CHECK(!GuidedDistribution1D::build(std::vector<float>{1, -1}));
}

TEST_CASE("PlainDistribution1D: linear search and the shader's walk give the same place") {
    for (const auto& row : hard_rows()) {
        const PlainDistribution1D plain(std::vector<double>(row.begin(), row.end()));
        for (UnitPoint p : random_points(500, 6)) {
            const double xi = (p.x + 0.5) * 0x1p-32;
            const auto a = plain.sample_linear(xi), b = plain.sample_walk(xi);
            CHECK(std::abs(a.x - b.x) < 1e-9);
            if (a.index == b.index) CHECK(a.pdf == b.pdf);
            CHECK(plain.pdf(a.x) == a.pdf);
            CHECK(std::abs(plain.invert(a.x) - xi) < 1e-12);
        }
        CHECK(plain.sample_linear(0).x >= 0);
        CHECK(plain.sample_walk(std::nextafter(1.0, 0.0)).x < 1);
        CHECK(plain.sample_linear(std::nextafter(1.0, 0.0)).x < 1);
    }
}

TEST_CASE("PlainDistribution1D: rounding leads the shader's walk past no last value") {
    std::mt19937 random(12);
    std::uniform_real_distribution<double> value;
    int black = 0;
    for (int repeat = 0; repeat < 2000; ++repeat) {
        std::vector<double> row(20);
        for (int i = 0; i < 17; ++i) row[i] = value(random);
        const auto s = PlainDistribution1D(row).sample_walk(std::nextafter(1.0, 0.0));
        black += !(s.pdf > 0) || !(s.x < 17.0 / 20);
    }
    CHECK(black == 0);
}

TEST_CASE("PlainDistribution1D: the average, and a known map") {
    const PlainDistribution1D d(std::vector<double>{1, 0, 3});
    CHECK(d.mean() == doctest::Approx(4.0 / 3));
    CHECK(d.sample_linear(0.125).x == doctest::Approx(0.5 / 3));  // half of the first quarter: half of the first third
    CHECK(d.sample_linear(0.625).x ==
          doctest::Approx(2.5 / 3));  // half of the last three quarters: half of the last third
    CHECK(d.sample_linear(0.125).pdf == doctest::Approx(0.75));  // 1 / (4/3)
    CHECK(d.sample_linear(0.625).pdf == doctest::Approx(2.25));
}

TEST_CASE("GuidedRows: every item owns as many quanta as the table says, the guide begins no later than it must") {
    for (const auto& row : hard_rows()) {
        std::vector<double> sums(row.size());
        double sum = 0;
        for (std::size_t i = 0; i < row.size(); ++i) sums[i] = sum += row[i];
        if (sum == 0) continue;
        GuidedRows table(1, int(row.size()));
        table.fill(0, row, sums);
        std::uint64_t total = 0;
        for (int i = 0; i < table.items; ++i) {
            const std::uint64_t quanta = table.quanta_or_none(0, i);
            CHECK((quanta > 0) == (row[i] > 0));
            total += quanta;
            if (quanta == 0) continue;
            const std::uint32_t first = table.first_quantum(0, i), last = table.last_of(0)[i];
            for (std::uint32_t xi : {first, last, std::uint32_t(first + (last - first) / 2)})
                CHECK(table.find(0, xi) == i);
            CHECK(std::abs(double(quanta) - row[i] / sum * 0x1p32) <= row.size() + 2);
        }
        CHECK(total == std::uint64_t(1) << 32);
    }
}

TEST_CASE("GuidedDistribution: a stratified set stays stratified") {
    // With 64 x 64 strata, each sample lies in the image of its own stratum, so the counts of rows differ from the
    // marginal by less than one row of strata.
    const NamedWeights weights = sky_weights(32);
    const auto d = made(weights, DistributionMethod::guided);
    double last_v = 0;
    for (std::uint32_t y = 0; y < 64; ++y) {
        double last_u = -1;
        for (std::uint32_t x = 0; x < 64; ++x) {
            const auto s = d->sample({x << 26 | 12345, y << 26 | 54321});
            CHECK(s.v >= last_v);
            CHECK(s.u > last_u);
            last_u = s.u;
            if (x == 63) last_v = s.v;
        }
    }
}

TEST_CASE("distribution: the same bits with every instruction set and number of threads") {
    const NamedWeights weights = patched_weights(333, 77, 8);
    const auto points = random_points(5000, 31);
    for (DistributionMethod method :
         {DistributionMethod::guided, DistributionMethod::alias, DistributionMethod::bilinear,
          DistributionMethod::binary, DistributionMethod::hierarchical}) {
        CAPTURE(name_of(method));
        std::vector<float> first;
        for (const char* set : {"", "AVX2", "SSE4", "SCALAR"})
            for (int threads : {1, 3}) {
                simd::limit_instruction_set(set);
                auto d = make_distribution(weights.weights(), method, threads);
                REQUIRE(bool(d));
                std::vector<float> out(3 * points.size());
                const std::span<float> all(out);
                (*d)->sample(points, all.first(points.size()), all.subspan(points.size(), points.size()),
                             all.last(points.size()));
                if (first.empty()) first = out;
                CHECK(std::memcmp(first.data(), out.data(), out.size() * sizeof(float)) == 0);
            }
        simd::limit_instruction_set("");
    }
}

TEST_CASE("distribution: weights that are computed row by row give the tables of an image's") {
    const NamedWeights weights = random_weights(70, 40, 9);
    const Weights computed{70, 40, [&](int y, std::span<float> room) {
                               for (int x = 0; x < 70; ++x) room[x] = *weights.image.at(x, y);
                               return std::span<const float>(room);
                           }};
    for (DistributionMethod method : k_all_methods) {
        auto d = make_distribution(computed, method);
        REQUIRE(bool(d));
        const auto other = made(weights, method);
        for (UnitPoint p : random_points(200, 4)) {
            CHECK((*d)->sample(p).u == other->sample(p).u);
            CHECK((*d)->sample(p).pdf_uv == other->sample(p).pdf_uv);
        }
    }
}

TEST_CASE("distribution: tables take the memory that is promised") {
    // Per texel: guided 4 + 2, alias 8, bilinear 4 + 2 + 2; 4096 x 2048 then takes 50, 67 and 67 MB.
    const NamedWeights weights = random_weights(512, 256, 10);
    const double texels = 512 * 256;
    CHECK(made(weights, DistributionMethod::guided)->memory_bytes() < 6.2 * texels);
    CHECK(made(weights, DistributionMethod::alias)->memory_bytes() < 8.1 * texels);
    CHECK(made(weights, DistributionMethod::bilinear)->memory_bytes() < 8.3 * texels);
}
