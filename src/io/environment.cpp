#include "domelight/environment.h"

#include "io/image_reader.h"
#include "io/radiance_reader.h"
#include "projection/latlong_convention.h"
#include "projection/latlong_regrid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace domelight {

namespace {

/// Turns directions about +Y, exactly at quarter turns.
Mat3 rotation_y_deg(double angle_deg) {
    const double turn = std::remainder(angle_deg, 360.0);
    const double quarters = turn / 90;
    if (quarters != std::round(quarters)) return rotation_y(turn * k_pi / 180);
    constexpr int cosines[4] = {1, 0, -1, 0};
    const int k = (int(quarters) + 4) % 4;
    const double c = cosines[k], s = cosines[(k + 3) % 4];
    return {{Vec3d{c, 0, -s}, Vec3d{0, 1, 0}, Vec3d{s, 0, c}}};
}

/// Directions of a world whose axis `up` the image's top shows, to the frame where that is +Y: by the shortest turn
/// (for -Y, half a turn about X).
Mat3 up_to_y(const Vec3d& up) {
    if (up == Vec3d{0, 1, 0}) return {};
    if (up == Vec3d{0, -1, 0}) return {{Vec3d{1, 0, 0}, Vec3d{0, -1, 0}, Vec3d{0, 0, -1}}};
    // The axis a = up x Y stays, up goes to Y, a x up goes to a x Y.
    const Vec3d y{0, 1, 0}, a = cross(up, y), b = cross(a, up), image = cross(a, y);
    const auto row = [&](double Vec3d::* i) { return a * (a.*i) + up * (y.*i) + b * (image.*i); };
    return {{row(&Vec3d::x), row(&Vec3d::y), row(&Vec3d::z)}};
}

/// What the options ask for, checked.
struct Request {
    EnvironmentOptions options;
    Mat3 turn;  ///< world to the file's frame, apart from its lat-long convention
    float scale = 1;
};

Result<Request> check_options(const EnvironmentOptions& options) {
    Request request{options, {}, 1};
    const auto one_of = [](const std::string& value, std::initializer_list<const char*> accepted) {
        return std::find(accepted.begin(), accepted.end(), value) != accepted.end();
    };
    if (!one_of(options.projection, {"auto", "latlong", "cube-cross", "cube-strip", "cube-faces"}))
        return Error{"unknown projection \"" + options.projection + "\"", "--projection",
                     "Accepted: auto, latlong, cube-cross, cube-strip, cube-faces."};
    if (!one_of(options.decode, {"auto", "srgb", "gamma22", "linear"}))
        return Error{"unknown decoding \"" + options.decode + "\"", "--decode",
                     "Accepted: auto, srgb, gamma22, linear."};
    if (!std::isfinite(options.rotate_y_deg)) return Error{"angle is not a number", "--rotate-y-deg", ""};
    if (!(std::abs(options.exposure) <= 64))
        return Error{"exposure must lie between -64 and 64 stops", "--exposure", ""};
    const Result<Vec3d> up = signed_axis(options.up);
    if (!up) return up.error().at("--up");
    if (!options.latlong.empty())
        if (const auto convention = latlong_convention(options.latlong); !convention)
            return convention.error().at("--latlong");
    // Light turned by R arrives from d if it came from R^T d before.
    request.turn = up_to_y(*up) * rotation_y_deg(options.rotate_y_deg).transposed();
    request.scale = float(std::exp2(options.exposure));
    return request;
}

/// Twice as wide as high; one texel more or less is a rounding of someone's resize.
bool has_latlong_shape(int width, int height) {
    return std::abs(std::int64_t(width) - 2 * std::int64_t(height)) <= 1;
}

Error shape_error(const ImageFacts& facts) {
    return {
        fmt::format("image is {} x {}, but a lat-long map must be twice as wide as high", facts.width, facts.height),
        "", "If this is a cube cross, pass --projection cube-cross."};
}

Result<Environment> open_latlong(Environment environment, std::unique_ptr<ImageReader> image, const Request& request) {
    const ImageFacts& facts = image->facts();
    if (!has_latlong_shape(facts.width, facts.height)) return shape_error(facts);
    std::string name = request.options.latlong;
    if (name.empty()) name = facts.envmap == ImageFacts::Envmap::latlong ? "openexr" : "default";
    const Result<LatlongConvention> convention = latlong_convention(name);
    if (!convention) return convention.error();
    environment.projection = "latlong";
    environment.world_to_source = convention->world_to_default() * request.turn;
    environment.latlong =
        regrid_latlong(std::make_unique<RadianceReader>(environment.file, std::move(image), request.scale, true,
                                                        request.options.threads, environment.report),
                       convention->grid);
    return environment;
}

Result<Environment> open_image(const std::filesystem::path& file, const Request& request) {
    const EnvironmentOptions& options = request.options;
    auto bytes = FileBytes::open(file, options.max_bytes);
    if (!bytes) return bytes.error();
    auto image = open_image_reader(std::move(*bytes), {options.decode, options.max_bytes, options.threads});
    if (!image) return image.error();
    const ImageFacts& facts = (*image)->facts();
    Environment environment;
    environment.file = file;
    environment.format = facts.format;
    environment.width = facts.width;
    environment.height = facts.height;
    environment.report = std::make_shared<RepairReport>();
    return open_latlong(std::move(environment), std::move(*image), request);
}

}  // namespace

Result<Environment> open_environment(const std::vector<std::filesystem::path>& files,
                                     const EnvironmentOptions& options) {
    const Result<Request> request = check_options(options);
    if (!request) return request.error();
    if (files.size() != 1) return Error{"an environment is one image or the six faces of a cube", "", ""};
    Result<Environment> environment = open_image(files[0], *request);
    if (!environment) return environment.error().at(files[0].string());
    return environment;
}

Result<ImageF> read_latlong(RowSource& source) {
    ImageF image(source.width(), source.height(), 3);
    constexpr int rows_a_read = 64;
    for (int y = 0; y < image.height(); y += rows_a_read) {
        const int count = std::min(rows_a_read, image.height() - y);
        if (const auto read = source.read(image.view().rows(y, count)); !read) return read.error();
    }
    return image;
}

}  // namespace domelight
