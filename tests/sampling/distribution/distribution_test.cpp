// Requirements of every method of sampling a distribution, tested on all of them.
#include "domelight/sampling/distribution/distribution.h"

#include "domelight/image/row_source.h"
#include "domelight/io/environment/open_environment.h"

#include "sampling/distribution/bilinear_place.h"
#include "sampling/distribution/chi_square.h"
#include "sampling/distribution/distribution_samples.h"
#include "test.h"

#include <algorithm>
#include <map>

using namespace domelight;
using namespace domelight::test;

namespace {

constexpr int k_draws = 60'000;

/// The largest relative difference between densities and weights.
double density_tolerance(DistributionMethod method) {
    switch (method) {
        // The checks below apply to texels of at least 1e-3 of the mean, in rows of 300 texels: the resolution of a
        // float, 2^-24, is 2 % of such a texel, and 2^-32 is 7e-5.
        case DistributionMethod::binary:
            return 5e-2;
        case DistributionMethod::guided:
        case DistributionMethod::alias:
            return 2e-4;
        case DistributionMethod::bilinear:
            return 2e-5;  // 16-bit shapes: 2^-17 of the brightest neighbour's density
        default:
            return 1e-6;  // hierarchical: sums of floats, level by level
    }
}

/// Probability of each texel by the density: its own value, or the integral of the bilinear form (2 x 2 midpoints a
/// quarter are exact for it).
std::vector<double> texel_probabilities(const Distribution2D& d) {
    const int w = d.width(), h = d.height();
    std::vector<double> p(std::size_t(w) * h);
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x) {
            double& sum = p[std::size_t(y) * w + x];
            if (!d.continuous())
                sum = d.pdf_uv((x + 0.5) / w, (y + 0.5) / h);
            else
                for (double a : {0.25, 0.75})
                    for (double b : {0.25, 0.75}) sum += d.pdf_uv((x + a) / w, (y + b) / h) / 4;
            sum /= double(w) * h;
        }
    return p;
}

double total(const std::vector<double>& v) {
    double s = 0;
    for (double x : v) s += x;
    return s;
}

/// p-value of draws over the quarters of every texel, which also tests the positions in it.
double sampling_p_value(const Distribution2D& d, int draws, std::uint64_t seed) {
    const int w = 2 * d.width(), h = 2 * d.height();
    std::vector<double> observed(std::size_t(w) * h), expected(observed.size());
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x)
            expected[std::size_t(y) * w + x] = d.pdf_uv((x + 0.5) / w, (y + 0.5) / h) * draws / (double(w) * h);
    std::mt19937_64 random(seed);
    for (int i = 0; i < draws; ++i) {
        const std::uint64_t bits = random();
        const auto s = d.sample({std::uint32_t(bits), std::uint32_t(bits >> 32)});
        observed[std::size_t(int(s.v * h)) * w + int(s.u * w)] += 1;
    }
    return chi_square_p_value(observed, expected);
}

/// |a - b| over the larger.
double apart(double a, double b) {
    return a == b ? 0 : std::abs(a - b) / std::max(std::abs(a), std::abs(b));
}

/// The map's Jacobian |d(u, v) / d(x, y)| at a point, by central differences of `step` quanta; 0 if a border lies
/// within.
double jacobian(const Distribution2D& d, UnitPoint p, std::uint32_t step) {
    const auto at = [&](std::int64_t dx, std::int64_t dy) {
        return d.sample({std::uint32_t(p.x + dx), std::uint32_t(p.y + dy)});
    };
    const auto l = at(-std::int64_t(step), 0), r = at(step, 0), t = at(0, -std::int64_t(step)), b = at(0, step),
               c = d.sample(p);
    const double scale = 1 / (2.0 * step * 0x1p-32);
    const double ux = (r.u - l.u) * scale, vx = (r.v - l.v) * scale, uy = (b.u - t.u) * scale, vy = (b.v - t.v) * scale;
    // In one cell of what the density is smooth in, whose borders lie at texels' borders or (continuous) centres.
    const double shift = d.continuous() ? 0.5 : 0;
    const auto cell = [&](const DistributionSample& s) {
        return std::pair{int(std::floor(s.u * d.width() + shift)), int(std::floor(s.v * d.height() + shift))};
    };
    for (const auto& s : {l, r, t, b})
        if (cell(s) != cell(c)) return 0;
    return std::abs(ux * vy - uy * vx);
}

}  // namespace

TEST_CASE("distribution: chi-square over the quarters of every texel, all methods, hard weights") {
    const auto all = hard_weights();
    const double significance = corrected_significance(int(all.size() * std::size(k_all_methods)));
    for (const NamedWeights& weights : all)
        for (DistributionMethod method : k_all_methods) {
            CAPTURE(weights.name);
            CAPTURE(name_of(method));
            const auto d = made(weights, method);
            REQUIRE(d);
            // A bilinear density is not constant in a quarter, but its integral there is the midpoint's value.
            const bool slow = method == DistributionMethod::bilinear_plain;
            CHECK(sampling_p_value(*d, slow ? k_draws / 6 : k_draws, 11) > significance);
        }
}

TEST_CASE("distribution: the density is the weights', and integrates to 1") {
    for (const NamedWeights& weights : hard_weights())
        for (DistributionMethod method : k_all_methods) {
            CAPTURE(weights.name);
            CAPTURE(name_of(method));
            const auto d = made(weights, method);
            const auto p = texel_probabilities(*d);
            CHECK(total(p) == doctest::Approx(1).epsilon(method == DistributionMethod::binary ? 1e-6 : 1e-9));
            const double sum = weights.sum();
            double worst = 0;
            for (int y = 0; y < d->height(); ++y)
                for (int x = 0; x < d->width(); ++x) {
                    const double weight = sum > 0 ? *weights.image.at(x, y) / sum : 1.0 / double(p.size());
                    const double density =
                        d->pdf_uv((x + 0.5) / d->width(), (y + 0.5) / d->height()) / double(p.size());
                    double around = weight;
                    if (d->continuous() && sum > 0)
                        for (int j = std::max(0, y - 1); j <= std::min(y + 1, d->height() - 1); ++j)
                            for (int i : {x - 1, x + 1})
                                around =
                                    std::max<double>(around, *weights.image.at((i + d->width()) % d->width(), j) / sum);
                    worst = std::max(worst, std::abs(density - weight) / (around + 1e-3 / double(p.size())));
                }
            CHECK(worst < density_tolerance(method));
        }
}

TEST_CASE("distribution: what sample says of the density is what pdf_uv says there") {
    const auto points = random_points(2000, 3);
    for (const NamedWeights& weights : hard_weights())
        for (DistributionMethod method : k_all_methods) {
            CAPTURE(weights.name);
            CAPTURE(name_of(method));
            const auto d = made(weights, method);
            bool inside = true;
            double worst = 0;
            for (UnitPoint p : points) {
                const auto s = d->sample(p);
                inside &= s.u >= 0 && s.u < 1 && s.v >= 0 && s.v < 1 && s.pdf_uv > 0 && std::isfinite(s.pdf_uv);
                // Where a continuous density falls to zero, the rounding of the position changes it by a large relative
                // amount, which is small relative to the peak.
                const double scale = d->continuous() ? s.pdf_uv + 1e-3 : s.pdf_uv;
                worst = std::max(worst, std::abs(d->pdf_uv(s.u, s.v) - s.pdf_uv) / scale);
            }
            CHECK(inside);
            CHECK(worst < 1e-9);
        }
}

TEST_CASE("distribution: the numerical Jacobian of the map is one over the density") {
    const auto points = random_points(400, 5);
    for (const NamedWeights& weights : hard_weights())
        for (DistributionMethod method : k_all_methods) {
            CAPTURE(weights.name);
            CAPTURE(name_of(method));
            // In an alias table several pieces lie over each texel and their densities add up, so the Jacobian of one
            // piece is not the density. The chi-square test and the count of quanta cover them.
            if (method == DistributionMethod::alias) continue;
            const auto d = made(weights, method);
            int seen = 0, wrong = 0;
            for (std::size_t i = 25; i < points.size(); ++i) {
                // The binary form's inputs are floats, 256 quanta apart, and its positions come from differences of
                // floats.
                const bool coarse = method == DistributionMethod::binary;
                const std::uint32_t step = coarse ? 1u << 18 : d->continuous() ? 1u << 10 : 1u << 14;
                const double j = jacobian(*d, points[i], step);
                if (j == 0) continue;
                const double pdf = d->sample(points[i]).pdf_uv;
                ++seen;
                // Second-order error of the difference where the density changes, see below; rounding of u, v at 1e-16
                // over a step of 2^-18.
                const double tolerance = coarse ? 5e-3 : d->continuous() ? 1e-3 : 1e-6;
                wrong += apart(j, 1 / pdf) > tolerance && !(d->continuous() && pdf < 0.05);
            }
            CHECK(seen > 0);
            CHECK(wrong == 0);
        }
}

TEST_CASE("distribution: invert takes a sample back to its point") {
    const auto points = random_points(3000, 7);
    // In quanta of 2^-32. Exact where half a quantum is more than double's rounding takes; the plain forms round down
    // from a sum in double; floats have 24 bits of the 32, and two of them are subtracted.
    const std::map<DistributionMethod, double> quanta = {
        {DistributionMethod::linear, 1},         {DistributionMethod::walk, 1},
        {DistributionMethod::binary, 1024},      {DistributionMethod::guided, 0},
        {DistributionMethod::hierarchical, 1},   {DistributionMethod::bilinear, 0},
        {DistributionMethod::bilinear_plain, 1},
    };
    for (const NamedWeights& weights : hard_weights())
        for (auto [method, most] : quanta) {
            CAPTURE(weights.name);
            CAPTURE(name_of(method));
            const auto d = made(weights, method);
            double worst = 0;
            bool all = true;
            for (UnitPoint p : points) {
                const auto s = d->sample(p);
                const auto back = d->invert(s.u, s.v);
                all &= back.has_value();
                if (!back) continue;
                worst = std::max({worst, std::abs(double(back->x) - p.x), std::abs(double(back->y) - p.y)});
            }
            CHECK(all);
            CHECK(worst <= most);
        }
    const auto alias = made(hard_weights()[0], DistributionMethod::alias);
    CHECK(!alias->invert(0.5, 0.5));
}

TEST_CASE("distribution: many points at once give the bits of one at a time") {
    // Lengths around 64, the size of a batch.
    for (const NamedWeights& weights : hard_weights())
        for (DistributionMethod method : k_all_methods)
            for (int count : {0, 1, 63, 64, 65, 1000}) {
                CAPTURE(weights.name);
                CAPTURE(name_of(method));
                CAPTURE(count);
                const auto d = made(weights, method);
                const auto points = random_points(count, 13);
                std::vector<float> u(count), v(count), pdf(count), u1(count), v1(count), pdf1(count);
                d->sample(points, u, v, pdf);
                d->Distribution2D::sample(points, u1, v1, pdf1);
                const bool same = u == u1 && v == v1 && pdf == pdf1;
                CHECK(same);
                bool inside = true;
                for (int i = 0; i < count; ++i) {
                    const auto s = d->sample(points[i]);
                    inside &= u[i] >= 0 && u[i] < 1 && v[i] >= 0 && v[i] < 1 && pdf[i] > 0;
                    if (d->continuous()) continue;
                    inside &= int(double(u[i]) * d->width()) == int(s.u * d->width()) &&
                              int(double(v[i]) * d->height()) == int(s.v * d->height());
                }
                CHECK(inside);
            }
}

TEST_CASE("distribution: the fast methods draw what the plain ones draw") {
    const auto points = random_points(3000, 17);
    for (const NamedWeights& weights : hard_weights()) {
        CAPTURE(weights.name);
        const auto linear = made(weights, DistributionMethod::linear), walk = made(weights, DistributionMethod::walk);
        const auto guided = made(weights, DistributionMethod::guided),
                   binary = made(weights, DistributionMethod::binary);
        const auto bilinear = made(weights, DistributionMethod::bilinear),
                   bilinear_plain = made(weights, DistributionMethod::bilinear_plain);
        double walk_off = 0, guided_off = 0, binary_off = 0, bilinear_off = 0;
        for (UnitPoint p : points) {
            const auto s = linear->sample(p);
            // Compares the points of the square to which the plain map takes both, because the error of a position is
            // large where the density is small.
            const auto off = [&](const Distribution2D& plain, const DistributionSample& other) {
                const auto back = plain.invert(other.u, other.v);
                if (!back) return 0.0;
                return std::max(std::abs(double(back->x) - p.x), std::abs(double(back->y) - p.y)) * 0x1p-32;
            };
            walk_off = std::max({walk_off, std::abs(walk->sample(p).u - s.u), std::abs(walk->sample(p).v - s.v)});
            guided_off = std::max(guided_off, off(*linear, guided->sample(p)));
            binary_off = std::max(binary_off, off(*linear, binary->sample(p)));
            bilinear_off = std::max(bilinear_off, off(*bilinear_plain, bilinear->sample(p)));
        }
        CHECK(walk_off < 1e-9);
        CHECK(guided_off < 1e-6);    // a quantum for each texel of the row at most: 64 2^-32, at a border twice
        CHECK(binary_off < 1e-5);    // 2^-24 a sum
        CHECK(bilinear_off < 1e-4);  // 16-bit shapes
    }
}

TEST_CASE("distribution: a texel of no weight is never drawn by the piecewise-constant methods") {
    for (const NamedWeights& weights : {patched_weights(40, 20, 5), patched_weights(33, 17, 6),
                                        hot_texel(37, 11, 36, 10), hot_texel(37, 11, 0, 0), hot_texel(64, 32, 63, 31)})
        for (DistributionMethod method : k_all_methods) {
            const auto d = made(weights, method);
            if (d->continuous()) continue;
            CAPTURE(weights.name);
            CAPTURE(name_of(method));
            const int count = 100'000;
            const auto points = random_points(count, 19);
            std::vector<float> u(count), v(count), pdf(count);
            d->sample(points, u, v, pdf);
            int black = 0;
            for (int i = 0; i < count; ++i)
                black += *weights.image.at(int(double(u[i]) * d->width()), int(double(v[i]) * d->height())) == 0;
            CHECK(black == 0);
            for (int y = 0; y < d->height(); ++y)
                for (int x = 0; x < d->width(); ++x) {
                    const bool zero = d->pdf_uv((x + 0.5) / d->width(), (y + 0.5) / d->height()) == 0;
                    if (zero != (*weights.image.at(x, y) == 0)) FAIL_CHECK("density is wrong at " << x << ", " << y);
                }
        }
}

TEST_CASE("distribution: no texel of positive weight is lost beside a sun") {
    const NamedWeights weights = sun_and_background();
    for (DistributionMethod method :
         {DistributionMethod::guided, DistributionMethod::alias, DistributionMethod::bilinear,
          DistributionMethod::linear, DistributionMethod::hierarchical}) {
        CAPTURE(name_of(method));
        const auto d = made(weights, method);
        int lost = 0;
        for (double p : texel_probabilities(*d)) lost += !(p > 0);
        CHECK(lost == 0);
        CHECK(total(texel_probabilities(*d)) == doctest::Approx(1).epsilon(1e-9));
        if (method == DistributionMethod::alias) continue;
        // There is a point for which it is drawn.
        int missed = 0;
        for (int y = 0; y < d->height(); ++y)
            for (int x = 0; x < d->width(); ++x) {
                // Any quarter of the texel is accepted: where the density rises towards the row of the sun within the
                // texel, nearly all quanta fall near that row.
                bool drawn = false;
                for (double du : {0.25, 0.75})
                    for (double dv : {0.25, 0.75}) {
                        const auto s =
                            d->sample(d->invert((x + du) / d->width(), (y + dv) / d->height()).value_or(UnitPoint{}));
                        drawn |= int(s.u * d->width()) == x && int(s.v * d->height()) == y;
                    }
                missed += !drawn;
            }
        CHECK(missed == 0);
    }
}

TEST_CASE("distribution: the built-in sky and a photograph pass the chi-square test") {
    std::vector<NamedWeights> all = {sky_weights(128)};
    if (const auto data = data_folder()) {
        auto environment = open_environment({*data / "env_highres" / "spruit_sunrise_1k.hdr"});
        if (environment) {
            auto image = read_latlong(**environment->rows());
            REQUIRE(bool(image));
            all.push_back(light_weights("spruit_sunrise_1k.hdr", *image, 256));
        }
    } else {
        MESSAGE("DOMELIGHT_DATA is not set: the built-in sky only");
    }
    const DistributionMethod methods[] = {DistributionMethod::guided, DistributionMethod::alias,
                                          DistributionMethod::hierarchical, DistributionMethod::bilinear,
                                          DistributionMethod::binary};
    for (const NamedWeights& weights : all)
        for (DistributionMethod method : methods) {
            CAPTURE(weights.name);
            CAPTURE(name_of(method));
            CHECK(sampling_p_value(*made(weights, method), 1'000'000, 23) >
                  corrected_significance(int(all.size() * std::size(methods))));
        }
}

TEST_CASE("distribution: bad weights are errors that name the texel") {
    for (auto [value, word] : {std::pair{-1.0f, "negative"},
                               {std::nanf(""), "not a number"},
                               {INFINITY, "infinite"},
                               {-INFINITY, "negative"}})
        for (DistributionMethod method : k_all_methods) {
            NamedWeights weights = constant_weights("bad", 6, 4, 1);
            *weights.image.at(5, 2) = value;
            const auto d = make_distribution(weights.weights(), method);
            REQUIRE(!d);
            CHECK(d.error().what == std::string("the weight of the texel in column 5, row 2 is ") + word);
        }
    for (DistributionMethod method : k_all_methods) {
        CHECK(!make_distribution({0, 0, {}}, method));
        CHECK(!make_distribution({-4, 2, {}}, method));
        CHECK(!make_distribution({5, 0, {}}, method));
        CHECK(!make_distribution({65536, 1, {}}, method));
    }
}

TEST_CASE("distribution: floats at the ends of their range") {
    for (float scale : {1e-45f, 1e-40f, 1e-30f, 1e30f, 3e38f})
        for (DistributionMethod method : k_all_methods) {
            CAPTURE(scale);
            CAPTURE(name_of(method));
            NamedWeights weights{"extreme", ImageF(4, 3, 1, scale)};
            *weights.image.at(1, 1) = 0;
            const auto d = made(weights, method);
            REQUIRE(d);
            const auto p = texel_probabilities(*d);
            CHECK(total(p) == doctest::Approx(1).epsilon(1e-6));
            if (!d->continuous()) CHECK(p[0] == doctest::Approx(1.0 / 11).epsilon(1e-5));
        }
}

TEST_CASE("distribution: negative zero is zero, and all black is uniform") {
    NamedWeights weights = constant_weights("black", 7, 5, -0.0f);
    for (DistributionMethod method : k_all_methods) {
        CAPTURE(name_of(method));
        const auto d = made(weights, method);
        REQUIRE(d);
        const auto s = d->sample({0x40000000u, 0xc0000000u});
        CHECK(s.pdf_uv == doctest::Approx(1).epsilon(1e-5));
        if (method != DistributionMethod::alias && !d->continuous()) {
            CHECK(s.u == doctest::Approx(0.25).epsilon(1e-5));
            CHECK(s.v == doctest::Approx(0.75).epsilon(1e-5));
        }
    }
}
