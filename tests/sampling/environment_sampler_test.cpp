#include "domelight/sampling/environment_sampler.h"

#include "domelight/environment/sky/sky.h"
#include "domelight/image/colour.h"
#include "domelight/projection/projection.h"
#include "domelight/sampling/sequences.h"

#include "sampling/distribution/chi_square.h"
#include "test.h"

#include <algorithm>
#include <random>

using namespace domelight;
using namespace domelight::test;

namespace {

constexpr DistributionMethod k_methods[] = {DistributionMethod::linear,   DistributionMethod::walk,
                                            DistributionMethod::binary,   DistributionMethod::guided,
                                            DistributionMethod::alias,    DistributionMethod::hierarchical,
                                            DistributionMethod::bilinear, DistributionMethod::bilinear_plain};

ImageF one_hot(int width, int height, int x, int y, float rest) {
    ImageF image(width, height, 3, rest);
    float* p = image.at(x, y);
    p[0] = 3e4f, p[1] = 2e4f, p[2] = 1e4f;
    return image;
}

ImageF noise(int width, int height, unsigned seed) {
    ImageF image(width, height, 3);
    std::mt19937 engine(seed);
    // Zeros among them.
    for (float& p : image.pixels()) p = std::max(0.f, float(engine() % 1024) / 512 - 0.5f);
    return image;
}

ImageF small_sky() {
    SkyOptions options;
    options.height = 24;
    options.sun_elevation_deg = 35;
    ImageF image(48, 24, 3);
    REQUIRE(make_sky(options)->read(image.view()));
    return image;
}

std::vector<std::pair<std::string, ImageF>> environments() {
    std::vector<std::pair<std::string, ImageF>> list;
    list.emplace_back("hot", one_hot(16, 8, 5, 3, 0.5f));
    list.emplace_back("hot at a pole", one_hot(16, 8, 9, 0, 0.1f));
    list.emplace_back("hot on the seam, black elsewhere", one_hot(16, 8, 15, 5, 0));
    list.emplace_back("constant", ImageF(16, 8, 3, 2.f));
    list.emplace_back("3 x 2", noise(3, 2, 7));
    list.emplace_back("one row", noise(8, 1, 3));
    list.emplace_back("noise", noise(16, 8, 5));
    list.emplace_back("sky", small_sky());
    return list;
}

/// ∫ of the density over each cell of a grid over the image, with `fine` x `fine` cells in a texel, by midpoints.
std::vector<double> integrals(const EnvironmentSampler& sampler, int columns, int rows) {
    const int w = sampler.image().width, h = sampler.image().height, fine_x = 24 * std::max(1, columns / w),
              fine_y = 24 * std::max(1, rows / h);
    std::vector<double> out(std::size_t(columns) * rows);
    const int nx = w * fine_x, ny = h * fine_y;
    for (int y = 0; y < ny; ++y)
        for (int x = 0; x < nx; ++x) {
            const UV uv{(x + 0.5) / nx, (y + 0.5) / ny};
            const double density = sampler.pdf_solid_angle(Vec3f(latlong_direction(uv)));
            out[std::size_t(int(uv.v * rows)) * columns + int(uv.u * columns)] +=
                density * latlong_solid_angle(y, nx, ny);
        }
    return out;
}

EnvironmentSampler make(const ImageF& image, const EnvironmentSamplerOptions& options,
                        const Mat3& world_to_source = {}) {
    auto sampler = EnvironmentSampler::build(image, options, world_to_source);
    REQUIRE(sampler);
    return std::move(*sampler);
}

struct Batch {
    explicit Batch(std::size_t n) : values(9 * n), n_(n) {}
    std::span<float> part(int k) { return {values.data() + k * n_, n_}; }
    LightSampleSpans spans() {
        return {part(0), part(1), part(2), part(3), part(4), part(5), part(6), part(7), part(8)};
    }
    std::vector<float> values;
    std::size_t n_;
};

}  // namespace

TEST_CASE(
    "environment_sampler: directions follow the density, which integrates to 1, for every method and environment") {
    int tests = 0;
    double least = 1;
    for (const auto& [name, image] : environments())
        for (const DistributionMethod method : k_methods)
            for (const int variant : {0, 1, 2}) {
                EnvironmentSamplerOptions options;
                options.method = method;
                if (variant == 1) options.uniform_share = 0.3;
                if (variant == 2) options.compensate = true;
                const EnvironmentSampler sampler = make(image, options);
                const int columns = std::min(16, image.width() * 2), rows = std::min(8, image.height() * 2);
                std::vector<double> expected = integrals(sampler, columns, rows);
                double sum = 0;
                for (const double e : expected) sum += e;
                INFO(name << ", " << name_of(method) << ", variant " << variant);
                CHECK(sum == doctest::Approx(1).epsilon(4e-3));  // the midpoint sum's error beside a pole
                constexpr int samples = 20000;
                std::vector<double> observed(expected.size());
                for (int i = 0; i < samples; ++i) {
                    const LightSample s = sampler.sample(random_point(99, i));
                    REQUIRE(s.pdf_solid_angle > 0);
                    const UV uv = latlong_uv(Vec3d(s.direction));
                    observed[std::size_t(std::min(rows - 1, int(uv.v * rows))) * columns +
                             std::min(columns - 1, int(uv.u * columns))] += 1;
                }
                for (double& e : expected) e *= samples / sum;
                const double p = chi_square_p_value(observed, expected);
                least = std::min(least, p);
                ++tests;
                CHECK(p > 1e-6);
            }
    CHECK(least * tests > 1e-3);  // Bonferroni
}

TEST_CASE(
    "environment_sampler: a sample's radiance and density are those of its direction, in a turned and mirrored world "
    "too") {
    const Mat3 mirrored{{Vec3d{0, 0, 1}, Vec3d{0, 1, 0}, Vec3d{1, 0, 0}}};
    for (const Mat3& world_to_source :
         {Mat3{}, rotation_y(1.1), mirrored, Mat3{{Vec3d{1, 0, 0}, Vec3d{0, 0, 1}, Vec3d{0, -1, 0}}}})
        for (const auto& [name, image] : environments())
            for (const DistributionMethod method : {DistributionMethod::guided, DistributionMethod::bilinear}) {
                EnvironmentSamplerOptions options;
                options.method = method;
                const EnvironmentSampler sampler = make(image, options, world_to_source);
                int apart = 0;
                for (int i = 0; i < 500; ++i) {
                    const LightSample s = sampler.sample(random_point(3, i));
                    CHECK(length(s.direction) == doctest::Approx(1).epsilon(1e-6));
                    const Vec3d source = world_to_source * Vec3d(s.direction);
                    CHECK(length(source - latlong_direction({s.u, s.v})) < 1e-6);
                    // On the border of a texel, rounding may give its neighbour; nowhere else.
                    const LightSample back = sampler.look_up(s.direction);
                    const double tolerance = 1e-4 * s.pdf_solid_angle;
                    apart += std::abs(back.pdf_solid_angle - s.pdf_solid_angle) > tolerance ||
                             length(back.radiance - s.radiance) > 1e-4 * length(s.radiance) + 0.02;
                    CHECK(back.pdf_solid_angle == doctest::Approx(sampler.pdf_solid_angle(s.direction)).epsilon(1e-4));
                }
                INFO(name << ", " << name_of(method));
                CHECK(apart <= 10);
            }
}

TEST_CASE(
    "environment_sampler: a constant environment is drawn evenly over the sphere, the courses' form too much at the "
    "poles") {
    const ImageF image(64, 32, 3, 0.7f);
    for (const DistributionMethod method : {DistributionMethod::guided, DistributionMethod::bilinear}) {
        EnvironmentSamplerOptions options;
        options.method = method;
        const EnvironmentSampler even = make(image, options);
        options.weight = LightWeight::grayscale;
        const EnvironmentSampler courses = make(image, options);
        for (int y = 0; y < 32; ++y) {
            const double theta = k_pi * (y + 0.5) / 32;
            const Vec3f d(latlong_direction({0.3, (y + 0.5) / 32}));
            CHECK(even.pdf_solid_angle(d) * 4 * k_pi ==
                  doctest::Approx(1).epsilon(2e-3));  // sin θ in steps, compared with its integral
            CHECK(courses.pdf_solid_angle(d) * 2 * k_pi * k_pi * std::sin(theta) == doctest::Approx(1).epsilon(1e-4));
        }
    }
}

TEST_CASE("environment_sampler: batches give the same samples") {
    constexpr int n = 1000;
    std::vector<UnitPoint> points(n);
    for (int i = 0; i < n; ++i) points[i] = random_point(11, i);
    points[0] = {0, 0};
    points[1] = {0xffffffffu, 0xffffffffu};
    points[2] = {0, 0xffffffffu};
    for (const auto& [name, image] : environments())
        for (const DistributionMethod method : k_methods)
            for (const double share : {0.0, 0.25}) {
                EnvironmentSamplerOptions options;
                options.method = method;
                options.uniform_share = share;
                const EnvironmentSampler sampler = make(image, options, rotation_y(0.4));
                Batch batch(n);
                sampler.sample(points, batch.spans());
                CHECK(std::ranges::all_of(batch.values, [](float v) { return std::isfinite(v); }));
                double worst = 0, direction = 0;
                for (int i = 0; i < n; ++i) {
                    const LightSample s = sampler.sample(points[i]);
                    worst = std::max(worst, std::abs(double(batch.part(8)[i]) / s.pdf_solid_angle - 1));
                    const Vec3f d{batch.part(2)[i], batch.part(3)[i], batch.part(4)[i]},
                        L{batch.part(5)[i], batch.part(6)[i], batch.part(7)[i]};
                    direction = std::max(direction, double(length(d - s.direction)));
                    CHECK(length(L - s.radiance) <= 2e-3 * length(s.radiance) + 0.02);
                }
                INFO(name << ", " << name_of(method) << ", share " << share);
                CHECK(worst < 3e-6);
                CHECK(direction < 1e-6);
            }
}

TEST_CASE("environment_sampler: the density is the Jacobian of the map from the unit square to the sphere") {
    const ImageF image = small_sky();
    for (const DistributionMethod method : {DistributionMethod::guided, DistributionMethod::bilinear}) {
        EnvironmentSamplerOptions options;
        options.method = method;
        const EnvironmentSampler sampler = make(image, options);
        std::vector<double> ratio;
        for (int i = 0; i < 400; ++i) {
            UnitPoint p = random_point(21, i);
            // A step long enough for float directions.
            const std::uint32_t step = 1u << 20;
            p = {std::min(p.x, ~step), std::min(p.y, ~step)};
            const Vec3d a(sampler.sample(p).direction), b(sampler.sample({p.x + step, p.y}).direction),
                c(sampler.sample({p.x, p.y + step}).direction);
            const LightSample middle = sampler.sample({p.x + step / 2, p.y + step / 2});
            ratio.push_back(length(cross(b - a, c - a)) / (double(step) * step * 0x1p-64) * middle.pdf_solid_angle);
        }
        std::sort(ratio.begin(), ratio.end());
        INFO(name_of(method));
        CHECK(ratio[ratio.size() / 2] == doctest::Approx(1).epsilon(5e-3));
        CHECK(ratio[ratio.size() / 5] == doctest::Approx(1).epsilon(0.05));
        CHECK(ratio[ratio.size() * 4 / 5] == doctest::Approx(1).epsilon(0.05));
    }
}

TEST_CASE("environment_sampler: invert goes back as far as float directions allow") {
    const ImageF image = noise(16, 8, 12);
    for (const DistributionMethod method :
         {DistributionMethod::guided, DistributionMethod::bilinear, DistributionMethod::hierarchical}) {
        EnvironmentSamplerOptions options;
        options.method = method;
        const EnvironmentSampler sampler = make(image, options);
        double worst = 0;
        for (int i = 0; i < 300; ++i) {
            const UnitPoint p = random_point(5, i);
            const LightSample s = sampler.sample(p);
            const auto back = sampler.invert(s.direction);
            REQUIRE(back);
            // A direction is accurate to 1e-7; a point of the square to the same, times the density over the image (and
            // 1 / sin θ).
            const double scale = 1e-6 * std::max(1.0, 20.0 * s.pdf_solid_angle);
            worst = std::max(worst, std::max(std::abs(unit_double(back->x) - unit_double(p.x)),
                                             std::abs(unit_double(back->y) - unit_double(p.y))) /
                                        scale);
        }
        INFO(name_of(method));
        CHECK(worst < 5);
    }
    EnvironmentSamplerOptions options;
    options.method = DistributionMethod::alias;
    CHECK(!make(image, options).invert({1, 0, 0}));
}

TEST_CASE("environment_sampler: compensation leaves the dim half out, and a constant environment alone") {
    ImageF image(16, 8, 3, 1.f);
    for (int x = 0; x < 4; ++x)
        for (int c = 0; c < 3; ++c) image.at(x, 4)[c] = 11.f;
    EnvironmentSamplerOptions options;
    options.compensate = true;
    options.method = DistributionMethod::guided;
    const EnvironmentSampler sampler = make(image, options);
    CHECK(sampler.compensation() ==
          doctest::Approx(1 + 10 * 4 * latlong_solid_angle(4, 16, 8) / (4 * k_pi)).epsilon(1e-6));
    CHECK(sampler.pdf_solid_angle(Vec3f(latlong_direction({10.5 / 16, 4.5 / 8}))) == 0);
    for (int i = 0; i < 100; ++i) CHECK(sampler.sample(random_point(1, i)).radiance.x == 11);
    const EnvironmentSampler constant = make(ImageF(16, 8, 3, 0.3f), options);
    CHECK(constant.compensation() == 0);
    CHECK(constant.pdf_solid_angle({0.3f, 0.2f, 0.9f}) == doctest::Approx(1 / (4 * k_pi)).epsilon(0.06));
}

TEST_CASE("environment_sampler: without light, with one texel, with bad texels") {
    for (const DistributionMethod method : k_methods) {
        EnvironmentSamplerOptions options;
        options.method = method;
        for (const ImageF& image : {ImageF(8, 4, 3), ImageF(1, 1, 3, 1.f), ImageF(1, 1, 3)}) {
            const EnvironmentSampler sampler = make(image, options);
            for (const UnitPoint p :
                 {UnitPoint{0, 0}, {0xffffffffu, 0xffffffffu}, {0x80000000u, 0}, {0, 0xffffffffu}}) {
                const LightSample s = sampler.sample(p);
                CHECK(std::isfinite(s.pdf_solid_angle));
                CHECK(s.pdf_solid_angle > 0);
                CHECK(length(s.direction) == doctest::Approx(1).epsilon(1e-6));
                CHECK(s.u < 1);
                CHECK(s.v < 1);
            }
        }
    }
    ImageF bad(8, 4, 3, 1.f);
    bad.at(5, 2)[1] = -1;
    auto error = EnvironmentSampler::build(bad);
    REQUIRE(!error);
    CHECK(error.error().format().find("texel (5, 2)") != std::string::npos);
    bad.at(5, 2)[1] = std::nanf("");
    CHECK(!EnvironmentSampler::build(bad));
    CHECK(!EnvironmentSampler::build(ImageF()));
}

TEST_CASE("environment_sampler: of a cube it draws what the cube holds") {
    Cubemap cube(8);
    std::ranges::fill(cube.pixels(), 0.1f);
    cube.face(4).at(2, 3)[1] = 500;  // on +Z
    auto sampler = EnvironmentSampler::build(Environment::from_cube(std::move(cube)));
    REQUIRE(sampler);
    const Vec3f sun(normalize(cube_direction(4, {2.5 / 8, 3.5 / 8})));
    int near = 0;
    for (int i = 0; i < 1000; ++i) near += dot(sampler->sample(random_point(4, i)).direction, sun) > 0.95f;
    CHECK(near > 800);
}

TEST_CASE("environment_sampler: looking up many directions at once is looking up each, at poles and seam too") {
    std::vector<Vec3f> directions = {{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},         {0, -1, 0},         {0, 0, 1},
                                     {0, 0, -1}, {-1, 0, 0}, {-1, 0.3f, 1e-7f}, {-1, 0.3f, -1e-7f}, {1e-6f, 1, 0}};
    const auto images = environments();
    const EnvironmentSampler first = make(images.front().second, {});
    for (int i = 0; i < 500; ++i) {
        const LightSample s = first.sample(random_point(5, i));
        directions.push_back(s.direction * (i % 3 ? 1.f : 7.f));
    }
    for (const auto& [name, image] : images)
        for (const DistributionMethod method : {DistributionMethod::bilinear, DistributionMethod::guided})
            for (const double share : {0.0, 0.3}) {
                EnvironmentSamplerOptions options;
                options.method = method;
                options.uniform_share = share;
                const EnvironmentSampler sampler = make(image, options);
                Batch batch(directions.size());
                const LightSampleSpans out = batch.spans();
                for (std::size_t i = 0; i < directions.size(); ++i)
                    out.x[i] = directions[i].x, out.y[i] = directions[i].y, out.z[i] = directions[i].z;
                sampler.look_up(out);
                INFO(name << ", " << name_of(method));
                int far = 0;
                for (std::size_t i = 0; i < directions.size(); ++i) {
                    const LightSample one = sampler.look_up(directions[i]);
                    const float du = std::abs(out.u[i] - one.u);
                    const bool pole = one.v < 1e-5f || one.v > 1 - 1e-5f;
                    CHECK((pole || std::min(du, 1 - du) < 3e-7f));
                    CHECK(std::abs(out.v[i] - one.v) < 3e-7f);
                    CHECK((out.u[i] >= 0 && out.u[i] < 1 && out.v[i] >= 0 && out.v[i] < 1));
                    // At the edge of a texel the result may be that of the other side.
                    far += !(std::abs(out.r[i] - one.radiance.x) <= 1e-4f * (1 + one.radiance.x)) ||
                           !(std::abs(out.pdf_solid_angle[i] - one.pdf_solid_angle) <= 1e-4f * one.pdf_solid_angle);
                }
                CHECK(far <= 12);
            }
}

TEST_CASE("environment_sampler: the textures give a shader the same texels") {
    const ImageF image = noise(16, 8, 30);
    EnvironmentSamplerOptions options;
    options.method = DistributionMethod::guided;
    const EnvironmentSampler sampler = make(image, options);
    const SamplingTextures t = sampling_textures(sampler);
    double sum = 0;
    for (int y = 0; y < 8; ++y) {
        double row = 0;
        for (int x = 0; x < 16; ++x) row += luminance(image.at(x, y)) * std::sin(k_pi * (y + 0.5) / 8);
        CHECK(t.row_averages.at(0, y)[0] == doctest::Approx(row / 16).epsilon(1e-5));
        sum += row / 16;
    }
    CHECK(t.total_average == doctest::Approx(sum / 8).epsilon(1e-5));
    for (int i = 0; i < 500; ++i) {
        const UnitPoint p = random_point(8, i);
        const double xi_u = unit_double(p.x), xi_v = unit_double(p.y);
        int y = 0, x = 0;
        while (t.rows.at(0, y)[0] <= xi_v) ++y;
        while (t.columns.at(x, y)[0] <= xi_u) ++x;
        const LightSample s = sampler.sample(p);
        CHECK(int(s.u * 16) == x);
        CHECK(int(s.v * 8) == y);
        const double pdf_uv = double(t.rows.at(0, y)[1]) * t.columns.at(x, y)[1];
        CHECK(pdf_uv == doctest::Approx(sampler.distribution().pdf_uv(s.u, s.v)).epsilon(1e-5));
    }
}
