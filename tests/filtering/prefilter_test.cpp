#include "domelight/filtering/prefilter.h"

#include "domelight/filtering/harmonic/spherical_harmonics.h"
#include "domelight/image/row_source.h"
#include "domelight/io/environment/open_environment.h"

#include "accuracy.h"
#include "filtering/harmonic/ring_grid.h"
#include "filtering/harmonic/sh_analysis.h"
#include "filtering/harmonic/sh_synthesis.h"
#include "filtering/harmonic/spectrum_evaluate.h"
#include "filtering/lights/tent_nodes.h"
#include "filtering/prefilter_checks.h"
#include "test.h"

using namespace domelight;
using namespace domelight::test;

namespace {

FilterOptions generic_options(int size = 512, int count = 7) {
    FilterOptions options;
    options.specular = ggx_chain(size, count, [count](int l) { return double(l) / (count - 1); });
    options.irradiance_size = 16;
    return options;
}

void check_rows(const std::vector<Accuracy>& rows, double most_rmse, double most) {
    REQUIRE(!rows.empty());
    for (const Accuracy& row : rows) {
        CAPTURE(row.name);
        CAPTURE(row.where.y);
        CHECK_MESSAGE(row.rmse <= most_rmse, row.name << " (width " << row.width << "): RMSE " << row.rmse);
        CHECK_MESSAGE(row.largest <= (row.name == "irradiance" ? 1e-3 : most),
                      row.name << " (width " << row.width << "): max " << row.largest);
    }
}

ImageF load(const std::filesystem::path& file) {
    auto environment = open_environment({file});
    REQUIRE(environment);
    auto image = read_latlong(**environment->rows());
    REQUIRE(image);
    return std::move(*image);
}

bool same_bits(const FilterResult& a, const FilterResult& b) {
    for (std::size_t l = 0; l < a.specular.size(); ++l)
        if (!std::equal(a.specular[l].pixels().begin(), a.specular[l].pixels().end(), b.specular[l].pixels().begin()))
            return false;
    return std::equal(a.irradiance_over_pi.pixels().begin(), a.irradiance_over_pi.pixels().end(),
                      b.irradiance_over_pi.pixels().begin()) &&
           std::equal(a.sh.begin(), a.sh.end(), b.sh.begin());
}

}  // namespace

TEST_CASE("prefilter: a constant environment stays constant to 1e-6, in every size and both layouts") {
    for (auto [width, height] : {std::pair{512, 256}, {1, 1}, {2, 1}, {3, 2}, {126, 63}, {1000, 500}})
        for (Layout layout : {Layout::cube, Layout::latlong}) {
            ImageF image(width, height, 3, 0.7f);
            FilterOptions options = generic_options(32, 6);
            options.layout = layout;
            ImageRowSource source(image);
            const auto result = prefilter(source, options);
            REQUIRE(result);
            double worst = 0;
            for (const auto& level : result->specular)
                for (float p : level.pixels()) worst = std::max(worst, std::abs(p / 0.7f - 1.0));
            for (float p : result->irradiance_over_pi.pixels()) worst = std::max(worst, std::abs(p / 0.7f - 1.0));
            CHECK_MESSAGE(worst <= 1e-6, width << " x " << height << ": off by " << worst);
            CHECK(std::abs(result->mean.y / 0.7f - 1) < 1e-6);
        }
}

TEST_CASE("prefilter: the generic chain is the integral to 1e-4 RMS and 2e-3 at most, under a 100000:1 sun") {
    check_rows(measure_levels(sun_image(256, 1e5, 0.4, 1.0), generic_options(), 60), 1e-4, 2e-3);
}

TEST_CASE("prefilter: images of any size, smaller and larger than the maps") {
    for (auto [width, height] : {std::pair{1, 1}, {2, 1}, {3, 2}, {7, 5}, {62, 31}, {250, 125}, {506, 253}}) {
        CAPTURE(width);
        check_rows(measure_levels(noise_image(width, height, 3, 50), generic_options(64, 4), 30), 1e-4, 2e-3);
    }
}

TEST_CASE("prefilter: Charlie and modified Phong are the integral") {
    FilterOptions options;
    for (double roughness : {0.25, 0.5, 1.0}) options.specular.push_back({64, false, ZonalKernel::charlie(roughness)});
    check_rows(measure_levels(sun_image(256, 1e4, 0.1, 2.0), options, 60), 1e-4, 2e-3);
    options.specular = {{64, false, ZonalKernel::charlie(0.15)}};
    check_rows(measure_levels(sun_image(256, 1e4, 0.1, 2.0), options, 60), 1e-3, 2e-2);
    options.specular.clear();
    for (double exponent : {1.0, 2.0, 5.0, 20.0, 100.0, 2048.0})
        options.specular.push_back({64, false, {Lobe::phong_brdf, exponent}});
    check_rows(measure_levels(sun_image(256, 1e4, 0.4, 2.0), options, 60), 1e-4, 2e-3);
}

TEST_CASE("prefilter: narrow lobes, with what outshines the rest taken out first") {
    FilterOptions options;
    options.specular = {{256, false, {Lobe::ggx, 0.0076}}, {64, false, ZonalKernel::ggx(0.5)}};
    options.irradiance_size = 8;
    check_rows(measure_levels(sun_image(256, 1e5, 0.4, 1.0), options, 60), 3e-4, 1e-2);
}

TEST_CASE("prefilter: real environments, every level of generic and khronos") {
    for (const char* name : {"env_highres/spruit_sunrise_1k.hdr", "env_latlong/potsdamer_platz_1k.hdr",
                             "env_latlong/vestibule_1k.hdr", "env_latlong/noon_grass_1k.hdr"}) {
        const auto folder = data_folder();
        if (!folder || !std::filesystem::exists(*folder / name))
            return note_skip("DOMELIGHT_DATA has no real environments");
        const ImageF image = load(*folder / name);
        CAPTURE(name);
        check_rows(measure_levels(image, generic_options(), 100), 1e-4, 2e-3);
        check_rows(measure_levels(image, generic_options(256, 5), 60), 1e-4, 2e-3);
    }
}

TEST_CASE("prefilter: the same bits on any number of threads and for rows handed over in any way") {
    const ImageF image = noise_image(200, 100, 5, 3000);
    FilterOptions options = generic_options(64, 5);
    options.specular.push_back({32, false, {Lobe::ggx, 0.005}});
    options.sh_bands = 4;
    std::optional<FilterResult> first;
    for (int threads : {1, 2, 3, 8}) {
        options.threads = threads;
        ImageRowSource source(image);
        auto result = prefilter(source, options);
        REQUIRE(result);
        if (!first)
            first = std::move(*result);
        else
            CHECK_MESSAGE(same_bits(*first, *result), threads << " threads");
    }
}

TEST_CASE("prefilter: instruction sets agree to 1e-6") {
    const ImageF image = noise_image(256, 128, 5, 1000);
    const FilterOptions options = generic_options(64, 4);
    check_instruction_sets_agree(image, options);
}

TEST_CASE("prefilter: a turn of the world turns the maps") {
    const ImageF image = noise_image(128, 64, 9, 500);
    FilterOptions options = generic_options(16, 3);
    ImageRowSource source(image);
    const auto plain = prefilter(source, options);
    // A quarter turn about +Y takes texels of side faces to texels: +X's content is seen at +Z.
    options.world_to_source = rotation_y(k_pi / 2).transposed();
    ImageRowSource again(image);
    const auto turned = prefilter(again, options);
    REQUIRE(plain);
    REQUIRE(turned);
    for (std::size_t l = 1; l < 3; ++l) {
        const auto a = plain->specular[l].face(0), b = turned->specular[l].face(4);
        for (int y = 0; y < a.height; ++y)
            for (int i = 0; i < a.width * 3; ++i) CHECK(std::abs(a.row(y)[i] - b.row(y)[i]) < 2e-6 * (1 + a.row(y)[i]));
    }
}

TEST_CASE("prefilter: SH coefficients are the integrals over the reconstruction, to 1e-5 of their norm") {
    // Against Gauss-Legendre over each texel's tent, in double; with suns, one at a pole and one on the seam, and a
    // turned world.
    constexpr int height = 48, width = 2 * height, bands = 6;
    ImageF image = noise_image(width, height, 3, 1e5f);
    image.at(0, 30)[1] = 3e4f;
    image.at(20, 0)[2] = 1e6f;
    const double angle = 0.7, c = std::cos(angle), s = std::sin(angle);
    for (const Mat3& world_to_source :
         {Mat3{}, rotation_y(1), Mat3{{Vec3d{1, 0, 0}, Vec3d{0, c, -s}, Vec3d{0, s, c}}} * rotation_y(0.3)}) {
        std::vector<Vec3d> truth(bands * bands);
        std::vector<double> basis(bands * bands);
        PointLights nodes;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) add_tent_nodes(nodes, width, height, x, y, image.at(x, y), 3);
        for (int i = 0; i < nodes.count(); ++i) {
            sh_basis(world_to_source.transposed() * normalize(nodes.place(i)), bands, basis);
            for (int k = 0; k < bands * bands; ++k) truth[k] += Vec3d{nodes.r[i], nodes.g[i], nodes.b[i]} * basis[k];
        }
        // Wide lobes alone, and with a narrow one, for which the suns are removed.
        for (const double narrowest : {0.2, 0.05}) {
            FilterOptions options;
            options.specular.push_back({16, false, ZonalKernel::ggx(narrowest)});
            options.sh_bands = bands;
            options.world_to_source = world_to_source;
            ImageRowSource source(image);
            const auto result = prefilter(source, options);
            REQUIRE(result);
            double norm = 0, error = 0;
            for (int k = 0; k < bands * bands; ++k) {
                norm += dot(truth[k], truth[k]);
                error += dot(result->sh[k] - truth[k], result->sh[k] - truth[k]);
            }
            CHECK(std::sqrt(error / norm) < 1e-6);  // 1e-5 is the aim
        }
    }
}

TEST_CASE("prefilter: no edge shows: steps across a cube's edges are the truth's, errors there as elsewhere") {
    const ImageF image = noise_image(64, 32, 11, 300);
    FilterOptions options;
    options.specular = {{16, false, ZonalKernel::ggx(0.4)}, {8, false, ZonalKernel::ggx(0.8)}};
    ImageRowSource source(image);
    const auto result = prefilter(source, options);
    REQUIRE(result);
    for (std::size_t l = 0; l < 2; ++l) {
        const Cubemap map = result->specular[l].cube();
        const int n = map.size();
        std::vector<Vec3d> directions;
        for (int f = 0; f < 6; ++f)
            for (int y = 0; y < n; ++y)
                for (int x = 0; x < n; ++x)
                    directions.push_back(normalize(cube_direction(f, {(x + 0.5) / n, (y + 0.5) / n})));
        const auto truth = convolve_exactly(image, options.specular[l].kernel, directions);
        const auto value = [&](int f, int x, int y) { return double(map.face(f).at(x, y)[0]); };
        const auto expected = [&](int f, int x, int y) { return truth[(std::size_t(f) * n + y) * n + x].x; };
        // +X's left column borders +Z's right one.
        double across = 0, across_truth = 0, inside = 0, inside_truth = 0, edge2 = 0, inner2 = 0;
        int edges = 0, inners = 0;
        for (int y = 0; y < n; ++y) {
            across += std::abs(value(0, 0, y) - value(4, n - 1, y));
            across_truth += std::abs(expected(0, 0, y) - expected(4, n - 1, y));
            inside += std::abs(value(0, n / 2, y) - value(0, n / 2 - 1, y));
            inside_truth += std::abs(expected(0, n / 2, y) - expected(0, n / 2 - 1, y));
        }
        CHECK(std::abs(across / inside / (across_truth / inside_truth) - 1) < 0.01);
        for (int f = 0; f < 6; ++f)
            for (int y = 0; y < n; ++y)
                for (int x = 0; x < n; ++x) {
                    const bool edge = x == 0 || y == 0 || x == n - 1 || y == n - 1;
                    const double e = value(f, x, y) - expected(f, x, y);
                    (edge ? edge2 : inner2) += e * e;
                    ++(edge ? edges : inners);
                }
        CHECK(std::sqrt(edge2 / edges) <= 1.5 * std::sqrt(inner2 / inners) + 1e-7);
    }
}

TEST_CASE("prefilter: lat-long levels agree with the cube's at the same directions, poles and seam included") {
    const ImageF image = noise_image(128, 64, 13, 200);
    FilterOptions options;
    options.specular = {{16, false, ZonalKernel::ggx(0.5)}};
    options.layout = Layout::latlong;
    ImageRowSource source(image);
    const auto result = prefilter(source, options);
    REQUIRE(result);
    const ImageF& map = result->specular[0].image;
    REQUIRE(map.width() == 32);
    std::vector<Vec3d> directions;
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 32; ++x) directions.push_back(latlong_direction({(x + 0.5) / 32, (y + 0.5) / 16}));
    const auto truth = convolve_exactly(image, options.specular[0].kernel, directions);
    for (std::size_t i = 0; i < directions.size(); ++i) CHECK(std::abs(map.pixels()[3 * i] / truth[i].x - 1) < 1e-4);
}

TEST_CASE("prefilter: spherical harmonics of a known function, and turned with the world") {
    // g = 1 + x + 0.5 y z. The error of its bilinear image is 1e-4 at 512 x 256.
    ImageF image(512, 256, 3);
    for (int y = 0; y < 256; ++y)
        for (int x = 0; x < 512; ++x) {
            const Vec3d d = latlong_direction({(x + 0.5) / 512, (y + 0.5) / 256});
            for (int c = 0; c < 3; ++c) image.at(x, y)[c] = float(1 + d.x + 0.5 * d.y * d.z);
        }
    FilterOptions options;
    for (double angle : {0.0, 0.7}) {
        options.world_to_source = rotation_y(angle);
        ImageRowSource source(image);
        const auto result = prefilter(source, options);
        REQUIRE(result);
        for (const Vec3d& d : {Vec3d{1, 0, 0}, Vec3d{0.6, 0, 0.8}, Vec3d{0, 0.6, -0.8}, Vec3d{-0.48, 0.6, 0.64}}) {
            const Vec3d s = options.world_to_source * d;
            CHECK(std::abs(sh_evaluate(result->sh, d).x - (1 + s.x + 0.5 * s.y * s.z)) < 3e-4);
        }
    }
}

TEST_CASE("analysis and synthesis agree with the plain sums in double") {
    const ImageF image = noise_image(40, 20, 17);
    const int band_limit = 40;
    ShAnalysis analysis(40, 20, band_limit, 1);
    analysis.add_rows(image.view());
    const Spectrum spectrum = analysis.finish();
    const std::vector<double> factors = ZonalKernel::ggx(0.6).coefficients(band_limit);
    const RingGrid grid = ring_grid_for(band_limit);
    const auto grids = sh_synthesis(spectrum, nullptr, std::vector<SynthesisFactors>{{factors, {}}}, *grid_transform(band_limit), 1);
    for (int k : {0, 1, grid.rings / 2, grid.rings - 1})
        for (int i : {0, 3, grid.width / 2, grid.width - 1}) {
            const double theta = k_pi * (k + 0.5) / grid.rings, phi = 2 * k_pi * i / grid.width;
            const Vec3d d{std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)};
            const Vec3d expected = evaluate_spectrum(spectrum, d, band_limit, factors);
            CHECK(std::abs(grids[0].ring(k)[4 * i] - expected.x) < 1e-5 * std::abs(expected.x));
        }
}

TEST_CASE("prefilter: progress can stop it") {
    const ImageF image = noise_image(64, 32, 1);
    FilterOptions options = generic_options(16, 3);
    options.progress = [](std::string_view, double) { return false; };
    ImageRowSource source(image);
    const auto result = prefilter(source, options);
    REQUIRE(!result);
    CHECK(result.error().what == "cancelled");
}
