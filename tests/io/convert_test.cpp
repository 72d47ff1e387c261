#include "domelight/io/environment/convert.h"

#include "domelight/environment/sky/sky.h"
#include "domelight/image/cube_layout.h"
#include "domelight/image/row_source.h"
#include "domelight/io/environment/open_environment.h"
#include "domelight/io/write_image.h"

#include "io/reader_samples.h"
#include "test.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>

using namespace domelight;
using namespace domelight::test;

namespace {

Projection get(const std::string& name) {
    auto p = projection_from_name(name);
    REQUIRE_MESSAGE(p, p.error().format());
    return *p;
}

Environment open(const std::filesystem::path& file, EnvironmentOptions options = {}) {
    auto environment = open_environment({file}, options);
    REQUIRE_MESSAGE(environment, environment.error().format());
    return *std::move(environment);
}

Conversion made(Environment& environment, const std::string& name, int height, const Mat3& turn = {},
                bool sharp = false) {
    const Projection target = get(name);
    auto result =
        convert(environment, target, {turn, int(std::lround(height * target.shape().aspect())), height, sharp, 2, {}});
    REQUIRE_MESSAGE(result, result.error().format());
    return *std::move(result);
}

ImageF direction_latlong(int height) {
    ImageF image(2 * height, height, 3);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < 2 * height; ++x) {
            const Vec3d d = latlong_direction({(x + 0.5) / (2 * height), (y + 0.5) / height});
            image.at(x, y)[0] = float(2 + d.x), image.at(x, y)[1] = float(2 + d.y), image.at(x, y)[2] = float(2 + d.z);
        }
    return image;
}

/// The light of the nearest texel in a direction, minus 2: for direction_latlong() this is the direction itself.
Vec3d seen(const ProjectedImage& image, const Vec3d& world) {
    const ProjectionPoint p = image.projection.locate(world);
    const float* v =
        image.pixels.at(std::clamp(int(p.uv.u * image.width()), 0, image.width() - 1),
                        p.chart * image.height() + std::clamp(int(p.uv.v * image.height()), 0, image.height() - 1));
    return Vec3d{v[0], v[1], v[2]} - Vec3d{2, 2, 2};
}

/// PSNR (dB) of log2(L + 1e-4 mean), the peak being a's own range. Lat-long images.
double log_psnr(const ImageF& a, const ImageF& b) {
    double mean = 0, weight = 0;
    for (int y = 0; y < a.height(); ++y) {
        const double w = std::sin(k_pi * (y + 0.5) / a.height());
        for (int x = 0; x < 3 * a.width(); ++x) mean += w * a.row(y)[x], weight += w;
    }
    mean /= weight;
    double low = 1e300, high = -1e300, sum = 0;
    for (std::size_t i = 0; i < a.pixels().size(); ++i) {
        const double p = std::log2(a.pixels()[i] + 1e-4 * mean), q = std::log2(b.pixels()[i] + 1e-4 * mean);
        low = std::min(low, p), high = std::max(high, p), sum += (p - q) * (p - q);
    }
    return 20 * std::log10((high - low) / std::sqrt(sum / double(a.pixels().size())));
}

/// The mean step of log2(L + floor) between a lat-long image's neighbours that a cube's edge parts, over that of the
/// neighbours two and three texels beside them: 1 where no edge can be seen.
double seam_ratio(const ImageF& image, double floor) {
    double across = 0, beside = 0;
    const int w = image.width(), h = image.height();
    const auto level = [&](int x, int y, int c) { return std::log2(image.at((x + w) % w, y)[c] + floor); };
    const auto step = [&](int x, int y, int dx, int dy) {
        double sum = 0;
        for (int c = 0; c < 3; ++c) sum += std::abs(level(x, y, c) - level(x + dx, y + dy, c));
        return sum;
    };
    const auto face = [&](int x, int y) { return cube_point(latlong_direction({(x + 0.5) / w, (y + 0.5) / h})).face; };
    for (int y = 4; y + 5 < h; ++y)
        for (int x = 0; x < w; ++x)
            for (const auto& [dx, dy] : {std::pair{1, 0}, std::pair{0, 1}}) {
                if (face(x, y) == face(x + dx, y + dy)) continue;
                across += step(x, y, dx, dy);
                for (const int k : {-3, -2, 2, 3}) beside += 0.25 * step(x + k * dx, y + k * dy, dx, dy);
            }
    return across / beside;
}

}  // namespace

TEST_CASE("convert: rotation, mirror, up and convention together put the light where they say") {
    TemporaryFolder folder;
    REQUIRE(write_exr(folder / "d.exr", direction_latlong(64), {.half = false}));
    // x to y, y to z, z to x, then z mirrored.
    const Mat3 turn{{Vec3d{0, 0, 1}, Vec3d{1, 0, 0}, Vec3d{0, -1, 0}}};
    Environment first = open(folder / "d.exr", {.latlong = "usd", .rotate_y_deg = 30, .up = "+Z"});
    auto plain = open(folder / "d.exr");
    const Mat3 world_to_source = first.world_to_source * turn.transposed();
    for (const char* name : {"cube", "latlong", "latlong/materialx", "latlong/centre=+Y,right=+X,up=+Z", "octahedral",
                             "cube/centre=+Z,right=-X", "angular"}) {
        INFO(name);
        Environment environment = open(folder / "d.exr", {.latlong = "usd", .rotate_y_deg = 30, .up = "+Z"});
        const Conversion c = made(environment, name, 64, turn);
        for (const Vec3d& d : {Vec3d{1, 0.2, 0.1}, Vec3d{-0.3, 1, 0.4}, Vec3d{0.2, -0.5, -1}, Vec3d{-1, -1, 0.3}}) {
            const Vec3d u = normalize(d);
            CHECK(length(seen(c.image, u) - world_to_source * u) < 0.08);
        }
        CHECK(std::abs(c.power_after.x / c.power_before.x - 1) < 1e-4);
        CHECK(std::abs(c.power_after.y / c.power_before.y - 1) < 1e-4);
    }
}

TEST_CASE("convert: texels that only change places keep their bits") {
    TemporaryFolder folder;
    const ImageF image = direction_latlong(16);
    REQUIRE(write_exr(folder / "d.exr", image, {.half = false}));
    Environment same = open(folder / "d.exr");
    const Conversion copy = made(same, "latlong", 16);
    CHECK(copy.method == "copy");
    CHECK(std::ranges::equal(copy.image.pixels.pixels(), image.pixels()));
    Environment turned = open(folder / "d.exr");
    const Conversion usd = made(turned, "latlong/usd", 16);
    CHECK(usd.method == "copy");
    // usd's centre column looks along +Z, which the default has a quarter of the width further right.
    CHECK(usd.image.pixels.at(16, 8)[2] == image.at(24, 8)[2]);
    Environment cube = open(folder / "d.exr");
    Conversion faces = made(cube, "cube", 8);
    CHECK(faces.method == "exact");
    REQUIRE(write_exr(folder / "c.exr", faces.image.pixels, {.half = false}));
    Environment strip = open(folder / "c.exr");
    const Conversion again = made(strip, "cube", 8);
    CHECK(again.method == "copy");
    CHECK(std::ranges::equal(again.image.pixels.pixels(), faces.image.pixels.pixels()));
}

TEST_CASE("convert: every projection, written and read again, shows the same light") {
    TemporaryFolder folder;
    REQUIRE(write_exr(folder / "d.exr", direction_latlong(64), {.half = false}));
    for (const std::string name : {"sphere-map", "mirror-ball/fov=25", "angular", "angular/centre=+X,right=+Z",
                                   "dual-paraboloid", "octahedral", "equal-area-octahedral"}) {
        INFO(name);
        Environment environment = open(folder / "d.exr");
        const Conversion c = made(environment, name, 96);
        // The halves of a dual paraboloid side by side.
        const int charts = c.image.projection.charts();
        ImageF sheet(96 * charts, 96, 3);
        for (int k = 0; k < charts; ++k)
            for (int y = 0; y < 96; ++y) std::copy_n(c.image.pixels.row(k * 96 + y), 3 * 96, sheet.at(96 * k, y));
        REQUIRE(write_exr(folder / "p.exr", sheet, {.half = false}));
        // Opened as by bake, sample and render.
        auto back = open_environment({folder / "p.exr"}, {.projection = name});
        REQUIRE_MESSAGE(back, back.error().format());
        REQUIRE_FALSE(back->cube());
        CHECK(back->projection == name.substr(0, name.find('/')));
        const auto latlong = read_latlong(**back->rows());
        REQUIRE(latlong);
        double sum = 0;
        int count = 0;
        for (int k = 0; k < 500; ++k) {
            const double z = 1 - (2 * k + 1) / 500.0, r = std::sqrt(1 - z * z), phi = 2.399963229728653 * k;
            const Vec3d d{r * std::cos(phi), r * std::sin(phi), z};
            if (name[0] == 'm' && d.z < -0.95) continue;  // behind the ball
            const double off = length(seen({get("latlong"), *latlong}, d) - d);
            sum += off, ++count;
            if (d.z > -0.8 && std::abs(d.z) > 0.05 && name.find("+X") == std::string::npos) CHECK(off < 0.2);
        }
        CHECK(sum / count < 0.05);
    }
}

TEST_CASE("convert: the OpenEXR library's own cube and lat-long of one scene agree") {
    DOMELIGHT_DATA_FILE(wavy_cube, "env_projections/WavyLinesCube.exr");
    DOMELIGHT_DATA_FILE(wavy_latlong, "env_projections/WavyLinesLatLong.exr");
    DOMELIGHT_DATA_FILE(orientation_cube, "env_projections/OrientationCube.exr");
    DOMELIGHT_DATA_FILE(orientation_latlong, "env_projections/OrientationLatLong.exr");
    const auto load = [](const std::filesystem::path& file) {
        Environment environment = open(file);
        return made(environment, "cube", 64).image;
    };
    const auto off = [&](const std::filesystem::path& a, const std::filesystem::path& b) {
        const ProjectedImage one = load(a), other = load(b);
        double sum = 0, level = 0;
        for (std::size_t i = 0; i < one.pixels.pixels().size(); ++i) {
            sum += std::abs(one.pixels.pixels()[i] - other.pixels.pixels()[i]);
            level += other.pixels.pixels()[i];
        }
        return sum / level;
    };
    const double wavy = off(wavy_cube, wavy_latlong), orientation = off(orientation_cube, orientation_latlong);
    MESSAGE("cube against lat-long: wavy lines ", wavy, ", orientation ", orientation);
    CHECK(wavy < 0.05);
    CHECK(orientation < 0.05);
}

TEST_CASE("convert: lat-long to cube and back, a real environment at matched size") {
    DOMELIGHT_DATA_FILE(file, "env_latlong/kloppenheim_05_1k.hdr");
    TemporaryFolder folder;
    Environment source = open(file);
    const ImageF truth = *read_latlong(**open(file).rows());
    // The size of face at whose centre texels are as wide as at the equator: π / H = 2 / n.
    const int size = int(std::lround(2 * truth.height() / k_pi));
    Conversion cube = made(source, "cube", size);
    REQUIRE(write_exr(folder / "cube.exr", cube.image.pixels, {.half = false}));
    Environment middle = open(folder / "cube.exr");
    const Conversion back = made(middle, "latlong", truth.height());
    const double psnr = log_psnr(truth, back.image.pixels);
    MESSAGE("round trip ", psnr, " dB, power ", cube.power_after.y / cube.power_before.y - 1, " and ",
            back.power_after.y / cube.power_before.y - 1);
    CHECK(psnr >= 45);
    Environment again = open(file);
    const Conversion sharp = made(again, "cube", size, {}, true);
    CHECK(sharp.method == "conservative");
    REQUIRE(write_exr(folder / "cube.exr", sharp.image.pixels, {.half = false}));
    Environment sharp_middle = open(folder / "cube.exr");
    const Conversion sharp_back = made(sharp_middle, "latlong", truth.height());
    MESSAGE("sharp: ", log_psnr(truth, sharp_back.image.pixels), " dB, power ",
            sharp_back.power_after.y / cube.power_before.y - 1);
    CHECK(log_psnr(truth, sharp_back.image.pixels) >= psnr + 1);
    CHECK(std::abs(sharp_back.power_after.y / cube.power_before.y - 1) < 1e-4);
    double mean = 0;
    for (const float v : truth.pixels()) mean += v;
    const double floor = 1e-4 * mean / double(truth.pixels().size());
    const double seams = seam_ratio(back.image.pixels, floor), true_seams = seam_ratio(truth, floor);
    MESSAGE("steps across the cube's edges over those beside: ", seams, ", in the source ", true_seams);
    CHECK(std::abs(seams / true_seams - 1) < 0.01);
    for (const auto& channel : {&Vec3d::x, &Vec3d::y, &Vec3d::z})
        CHECK(std::abs(back.power_after.*channel / (cube.power_before.*channel) - 1) < 1e-4);
}

TEST_CASE("convert: lat-long to cube and back, steps across the cube's edges are the source's within 1 %") {
    // A smooth sky, whose steps are not blurred by resampling, so that any difference at a seam is caused by the seam.
    SkyOptions options;
    options.height = 256;
    options.sun_disc = false;
    const auto rows = make_sky(options);
    const ImageF truth = *read_latlong(*rows);
    TemporaryFolder folder;
    REQUIRE(write_exr(folder / "sky.exr", truth, {.half = false}));
    for (const char* name : {"cube", "octahedral"}) {
        INFO(name);
        Environment source = open(folder / "sky.exr");
        const Conversion there = made(source, name, name[0] == 'c' ? 163 : 300);
        REQUIRE(write_exr(folder / "there.exr", there.image.pixels, {.half = false}));
        Environment middle = open(folder / "there.exr", {.projection = name[0] == 'c' ? "auto" : name});
        const Conversion back = made(middle, "latlong", 256);
        double mean = 0;
        for (const float v : truth.pixels()) mean += v;
        const double floor = 1e-4 * mean / double(truth.pixels().size());
        const double seams = seam_ratio(back.image.pixels, floor), true_seams = seam_ratio(truth, floor);
        MESSAGE(name, ": steps across a cube's edges over those beside ", seams, ", in the source ", true_seams);
        CHECK(std::abs(seams / true_seams - 1) < 0.01);
        CHECK(log_psnr(truth, back.image.pixels) > 55);
    }
}

namespace {

/// The names in the first column of the table of docs/projections.md, with a number in place of a parameter's letter.
std::vector<std::string> documented_projections() {
    std::ifstream page(DOMELIGHT_DOCS "/projections.md");
    std::vector<std::string> names;
    for (std::string line; std::getline(page, line);) {
        if (!line.starts_with("| `")) continue;
        const std::string cell = line.substr(1, line.find('|', 1) - 1);
        for (std::size_t at = 0; (at = cell.find('`', at)) != std::string::npos;) {
            const std::size_t end = cell.find('`', at + 1);
            std::string name = cell.substr(at + 1, end - at - 1);
            if (name.ends_with("=F")) name.replace(name.size() - 1, 1, "30");
            names.push_back(name);
            at = end + 1;
        }
    }
    return names;
}

/// The picture in one file: a cube as a cross or as OpenEXR's strip, the halves of a dual paraboloid side by side.
ImageF in_one_picture(const ProjectedImage& image) {
    const int charts = image.projection.charts(), w = image.width(), h = image.height();
    if (charts == 1) return image.pixels;
    if (charts == 6 && image.projection.grid() == SampleGrid::centres)
        return cube_layout(Cubemap(image.pixels), "cross");
    const bool strip = charts == 6;
    ImageF out(strip ? w : charts * w, strip ? charts * h : h, 3);
    for (int c = 0; c < charts; ++c)
        for (int y = 0; y < h; ++y)
            for (int x = 0; x < w; ++x) {
                // As drawn in ImfEnvmap.h: the sides are mirrored from left to right, and top and bottom are upside
                // down.
                const int sx = strip && c / 2 != 1 ? w - 1 - x : x, sy = strip && c / 2 == 1 ? h - 1 - y : y;
                std::copy_n(image.pixels.at(sx, c * h + sy), 3, strip ? out.at(x, c * h + y) : out.at(c * w + x, y));
            }
    return out;
}

/// By how much directions change if a picture is written in a projection and read again by the projection's name.
double error_read_back(const std::string& name) {
    const TemporaryFolder folder;
    REQUIRE(write_exr(folder / "e.exr", direction_latlong(128).view()));
    Environment environment = open(folder / "e.exr");
    const Conversion there = made(environment, name, 96);
    REQUIRE(write_exr(folder / "there.exr", in_one_picture(there.image).view()));
    Environment again = open(folder / "there.exr", {.projection = name});
    CHECK(again.projection == there.image.projection.name());
    const Conversion back = made(again, "latlong", 64);
    double largest = 0;
    for (const Vec3d d : {Vec3d{1, 0.2, 0.1}, Vec3d{-0.9, 0.3, 0.2}, Vec3d{0.1, 1, 0.2}, Vec3d{0.2, -1, 0.1},
                          Vec3d{0.2, 0.1, 1}, Vec3d{0.3, 0.2, -0.7}}) {
        const ProjectionPoint shown = there.image.projection.locate(normalize(d));
        if (shown.shown) largest = std::max(largest, length(seen(back.image, normalize(d)) - normalize(d)));
    }
    return largest;
}

}  // namespace

TEST_CASE("convert: every projection of docs/projections.md is written and read by its name") {
    std::set<std::string> documented;
    for (const std::string& name : documented_projections()) {
        documented.insert(get(name).name());
        CAPTURE(name);
        CHECK(error_read_back(name) < 0.1);  // a texel of 64 rows is 0.05 wide; a wrong axis is off by 1 or more
    }
    for (const ProjectionInfo& info : projections()) CHECK_MESSAGE(documented.contains(info.name), info.name);
}

TEST_CASE("convert: conventions are read by the names that write them") {
    for (const char* name :
         {"latlong/usd", "latlong/openexr", "latlong/centre=+Y,right=-Z,up=+X", "equirectangular", "cube/openexr",
          "cube/centre=+Z,right=-X", "angular/centre=+Z", "octahedral/centre=+Z,up=+Y"}) {
        CAPTURE(name);
        CHECK(error_read_back(name) < 0.1);
    }
    const TemporaryFolder folder;
    REQUIRE(write_exr(folder / "e.exr", direction_latlong(8).view()));
    const auto error_of = [&](const EnvironmentOptions& options) {
        const auto environment = open_environment({folder / "e.exr"}, options);
        REQUIRE(!environment);
        return environment.error();
    };
    CHECK(error_of({.projection = "latlong/usd", .latlong = "mitsuba"}).where == "`latlong`");
    CHECK(error_of({.projection = "latlong/sideways"}).where == "`projection`");
    CHECK(error_of({.projection = "cube/sideways"}).where == "`projection`");
    CHECK(error_of({.projection = "cube"}).what.find("4:3") != std::string::npos);
    CHECK(error_of({.projection = "cube/openexr"}).what.find("1:6") != std::string::npos);
}
