#include "domelight/sampling/distribution/alias.h"

#include "domelight/sampling/distribution/guided.h"

#include "sampling/distribution/distribution_samples.h"
#include "test.h"

using namespace domelight;
using namespace domelight::test;

TEST_CASE("AliasRows: the pieces of every item add up to its quanta exactly, and all to 2^32") {
    for (const NamedWeights& weights : hard_weights()) {
        CAPTURE(weights.name);
        const int w = weights.image.width();
        std::vector<double> sums(w);
        for (int y = 0; y < weights.image.height(); ++y) {
            const std::span<const float> row(weights.image.row(y), std::size_t(w));
            double sum = 0;
            for (int x = 0; x < w; ++x) sums[x] = sum += row[x];
            if (sum == 0) continue;
            AliasRows table(1, w);
            table.fill(0, row, sums);
            std::vector<std::uint64_t> pieces(w);
            const int split_bits = 32 - table.bits;
            const std::uint64_t room = std::uint64_t(1) << split_bits;
            for (int cell = 0; cell < 1 << table.bits; ++cell) {
                const auto& e = table.row(0)[cell];
                const std::uint64_t split = e.alias_and_split & (room - 1);
                if (split > 0) pieces[cell] += split;
                pieces[e.alias_and_split >> split_bits] += room - split;
            }
            std::uint64_t total = 0;
            bool same = true;
            for (int x = 0; x < w; ++x) {
                total += pieces[x];
                same &= double(pieces[x]) == table.quanta_or_none(0, x);
            }
            CHECK(same);
            CHECK(total == std::uint64_t(1) << 32);
        }
    }
}

TEST_CASE("AliasDistribution: the density is GuidedDistribution's, to the bit") {
    for (const NamedWeights& weights : hard_weights()) {
        CAPTURE(weights.name);
        const auto alias = made(weights, DistributionMethod::alias), guided = made(weights, DistributionMethod::guided);
        bool same = true;
        for (int y = 0; y < alias->height(); ++y)
            for (int x = 0; x < alias->width(); ++x) {
                const double u = (x + 0.5) / alias->width(), v = (y + 0.5) / alias->height();
                same &= alias->pdf_uv(u, v) == guided->pdf_uv(u, v);
            }
        CHECK(same);
    }
}

TEST_CASE("AliasRows: 4096 items leave 20 bits of position in each") {
    const std::vector<float> row(4096, 1.0f);
    std::vector<double> sums(4096);
    for (int x = 0; x < 4096; ++x) sums[x] = x + 1;
    AliasRows table(1, 4096);
    table.fill(0, row, sums);
    double last = 0;
    bool rises = true;
    for (std::uint32_t k = 0; k < 1u << 20; k += 1001) {
        const auto draw = table.draw(0, 1234u << 20 | k);
        rises &= draw.item == 1234 && draw.t > last;
        last = draw.t;
    }
    CHECK(rises);
    CHECK(table.draw(0, 1234u << 20).t < 0x1p-20);
    CHECK(table.draw(0, (1235u << 20) - 1).t > 1 - 0x1p-20);
}
