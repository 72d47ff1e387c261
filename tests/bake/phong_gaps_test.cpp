#include "bake/phong_gaps.h"

#include "domelight/filtering/prefilter.h"
#include "domelight/image/row_source.h"
#include "domelight/io/environment/open_environment.h"

#include "test.h"

#include <algorithm>
#include <cmath>
#include <limits>

using namespace domelight;

namespace {

constexpr double k_infinity = std::numeric_limits<double>::infinity();

std::vector<LevelPlan> chain_of(const std::vector<double>& exponents) {
    std::vector<LevelPlan> chain;
    for (const double n : exponents)
        chain.push_back({.spec = {16, std::isinf(n), {Lobe::phong_brdf, std::isinf(n) ? 1 : n}}, .exponent = n});
    return chain;
}

/// The gaps of a chain under an environment.
std::vector<PhongGap> gaps_under(RowSource& rows, const std::vector<double>& exponents) {
    const auto probes = phong_gap_probes(chain_of(exponents));
    FilterOptions options;
    options.specular = probes;
    options.sh_bands = 0;
    const auto filtered = prefilter(rows, options);
    REQUIRE(filtered);
    return phong_gaps(probes, filtered->specular);
}

double largest(const std::vector<PhongGap>& gaps, double PhongGap::*error) {
    double most = 0;
    for (const PhongGap& gap : gaps) most = std::max(most, gap.*error);
    return most;
}

}  // namespace

TEST_CASE("phong_gaps: half way between two levels lies the exponent that the level formula has there") {
    const auto probes = phong_gap_probes(chain_of({k_infinity, 2048, 512, 128, 0}));
    REQUIRE(probes.size() == 7);
    CHECK(probes[0].kernel.width == 2048);
    CHECK(probes[6].kernel.width == 0);
    CHECK(probes[1].kernel.width == doctest::Approx(default_phong_exponent(1.5)));
    CHECK(probes[3].kernel.width == doctest::Approx(default_phong_exponent(2.5)));
    CHECK(probes[5].kernel.width > 0);
    CHECK(probes[5].kernel.width < 128);
    CHECK(phong_gap_probes(chain_of({k_infinity, 512})).empty());
}

TEST_CASE("phong_gaps: constant light is read exactly, and closer exponents are read better") {
    ImageF constant(32, 16, 3);
    std::fill(constant.pixels().begin(), constant.pixels().end(), 2.f);
    ImageRowSource even(constant);
    CHECK(largest(gaps_under(even, {k_infinity, 512, 128, 32}), &PhongGap::worst_error) < 1e-4);

    // A lamp of 20 degrees in a dim room.
    ImageF room(64, 32, 3);
    std::fill(room.pixels().begin(), room.pixels().end(), 0.1f);
    for (int y = 14; y < 18; ++y)
        for (int x = 30; x < 34; ++x) std::fill_n(room.at(x, y), 3, 100.f);
    ImageRowSource lamp(room), again(room);
    const auto wide = gaps_under(lamp, {512, 128, 32}), close = gaps_under(again, {512, 256, 128, 64, 32});
    CHECK(wide.size() == 2);
    CHECK(close.size() == 4);
    CHECK(largest(wide, &PhongGap::worst_error) > 0.5);
    CHECK(largest(close, &PhongGap::worst_error) < 0.5 * largest(wide, &PhongGap::worst_error));
}

TEST_CASE("phong_gaps: what the docs say of five photographs, for exponents a factor of four and of two apart") {
    DOMELIGHT_DATA_FILE(studio, "env_latlong/studio_small_03_1k.hdr");
    struct Row {
        const char* name;
        double median_4, median_2;
    };
    for (const Row& row :
         {Row{"studio_small_03_1k", 0.18, 0.05}, Row{"blocky_photo_studio_1k", 0.02, 0.01},
          Row{"lebombo_1k", 0.02, 0.01}, Row{"noon_grass_1k", 0.02, 0.01}, Row{"circus_arena_1k", 0.06, 0.02}}) {
        INFO(row.name);
        const auto gaps = [&](const std::vector<double>& exponents) {
            auto environment = open_environment({studio.parent_path() / (row.name + std::string(".hdr"))});
            REQUIRE(environment);
            const auto rows = environment->rows();
            REQUIRE(rows);
            return gaps_under(**rows, exponents);
        };
        const auto four = gaps({2048, 512, 128, 32, 8, 2}),
                   two = gaps({2048, 1024, 512, 256, 128, 64, 32, 16, 8, 4, 2});
        CHECK(largest(four, &PhongGap::median_error) < row.median_4);
        CHECK(largest(two, &PhongGap::median_error) < row.median_2);
        CHECK(largest(two, &PhongGap::worst_error) < largest(four, &PhongGap::worst_error));
    }
}
