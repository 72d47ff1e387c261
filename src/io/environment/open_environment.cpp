#include "domelight/io/environment/open_environment.h"

#include "domelight/image/row_source.h"

#include "base/field_place.h"
#include "base/mutex.h"
#include "io/environment/cube_face_names.h"
#include "io/environment/cube_input.h"
#include "io/environment/cube_texture_reader.h"
#include "io/file/sha256.h"
#include "io/hdr/radiance_reader.h"
#include "io/image_reader.h"
#include "projection/latlong_convention.h"
#include "projection/latlong_regrid.h"
#include "scene/gltf/gltf_document.h"
#include "scene/gltf/gltf_image_light.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string_view>
#include <utility>

namespace domelight {

namespace {

/// The turn about +Y by an angle in degrees. Quarter turns have exact entries.
Mat3 rotation_y_deg(double angle_deg) {
    const double turn = std::remainder(angle_deg, 360.0);
    const double quarters = turn / 90;
    if (quarters != std::round(quarters)) return rotation_y(turn * k_pi / 180);
    constexpr int cosines[4] = {1, 0, -1, 0};
    const int k = (int(quarters) + 4) % 4;
    const double c = cosines[k], s = cosines[(k + 3) % 4];
    return {{Vec3d{c, 0, -s}, Vec3d{0, 1, 0}, Vec3d{s, 0, c}}};
}

/// The shortest turn that takes the axis `up`, which the image's top shows, to +Y (for -Y: half a turn about X).
Mat3 up_to_y(const Vec3d& up) {
    if (up == Vec3d{0, 1, 0}) return {};
    if (up == Vec3d{0, -1, 0}) return {{Vec3d{1, 0, 0}, Vec3d{0, -1, 0}, Vec3d{0, 0, -1}}};
    // The turn leaves a = up × Y where it is, and takes up to Y and a × up to a × Y.
    const Vec3d y{0, 1, 0}, a = cross(up, y), b = cross(a, up), image = cross(a, y);
    const auto row = [&](double Vec3d::*i) { return a * (a.*i) + up * (y.*i) + b * (image.*i); };
    return {{row(&Vec3d::x), row(&Vec3d::y), row(&Vec3d::z)}};
}

/// The options after they have been checked.
struct Request {
    EnvironmentOptions options;
    Mat3 turn;  ///< from the world to the file's frame, without its lat-long convention
    float scale = 1;
    std::optional<Projection> other;          ///< neither lat-long nor a cube
    Mat3 cube_axes;                           ///< the turned light to the frame of a cube's faces
    std::optional<std::array<int, 6>> faces;  ///< EnvironmentOptions::faces
};

/// The names of lat-long maps and cubes that a request knows; "cube" is one in any layout.
constexpr std::string_view k_own_projections[] = {"auto",       "latlong",    "cube",      "cube/openexr",
                                                  "cube-cross", "cube-strip", "cube-faces"};

/// A projection that pictures are read in by name only.
Result<Projection> other_projection(const std::string& text) {
    Result<Projection> projection = projection_from_name(text);
    if (projection || !projection.error().what.starts_with("unknown projection")) return projection;
    std::string accepted = "Accepted: ";
    for (const std::string_view own : k_own_projections)
        if (own != "cube/openexr") accepted += (own == k_own_projections[0] ? "" : ", ") + std::string(own);
    for (const ProjectionInfo& info : projections())
        if (std::string_view(info.name) != "latlong" && std::string_view(info.name) != "cube")
            accepted += std::string(", ") + info.name;
    return Error{projection.error().what, "", accepted + "."};
}

/// Takes the convention of a lat-long map or a cube ("latlong/usd", "cube/openexr") out of the projection's name.
Result<Request> read_convention(Request request) {
    std::string& name = request.options.projection;
    const std::size_t slash = std::min(name.find('/'), name.size());
    const std::string kind = name.substr(0, slash), convention = name.substr(std::min(slash + 1, name.size()));
    if (kind == "cube") {
        const auto cube = projection_from_name(name);
        if (!cube) return cube.error().at(field_place("projection"));
        request.cube_axes = cube->world_to_picture();
        name = cube->grid() == SampleGrid::both_on_edges ? "cube/openexr" : "cube";
    } else if (kind == "latlong" || kind == "equirectangular") {
        name = "latlong";
        if (convention.empty()) return request;
        if (const auto known = latlong_convention(convention); !known)
            return known.error().at(field_place("projection"));
        if (const std::string& other = request.options.latlong; !other.empty() && other != convention)
            return Error{other + " contradicts `projection` latlong/" + convention, field_place("latlong"), ""};
        request.options.latlong = convention;
    }
    return request;
}

/// Where what lies in directions of the world is in the world of Direct3D, whose +Z is our -Z.
constexpr Mat3 k_to_left_handed{{Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, -1}}};

/// Makes the orientation of faces and the projection agree.
Result<void> take_face_orientation(Request& request) {
    std::optional<FaceOrientation>& orientation = request.options.face_orientation;
    std::string& projection = request.options.projection;
    if (projection == "cube/openexr") {
        if (orientation && *orientation != FaceOrientation::openexr)
            return Error{name_of(*orientation) + " contradicts `projection` cube/openexr",
                         field_place("face_orientation"), ""};
        orientation = FaceOrientation::openexr;
        projection = "cube";
    }
    if (orientation == FaceOrientation::directx) request.cube_axes = k_to_left_handed * request.cube_axes;
    return {};
}

/// An error if options about the faces of a cube were given for what is none.
Result<void> check_no_faces(const EnvironmentOptions& options, const char* what) {
    for (const auto& [given, name] :
         {std::pair{!options.faces.empty(), "faces"}, {options.face_orientation.has_value(), "face_orientation"}})
        if (given) return Error{fmt::format("is about the faces of a cube, not about {}", what), field_place(name), ""};
    return {};
}

Result<Request> check_options(const EnvironmentOptions& options) {
    auto asked = read_convention({options, {}, 1, {}, {}, {}});
    if (!asked) return asked;
    Request request = *std::move(asked);
    const auto one_of = [](const std::string& value, std::span<const std::string_view> accepted) {
        return std::find(accepted.begin(), accepted.end(), value) != accepted.end();
    };
    if (request.options.latlong == "pbrt") {
        if (request.options.projection != "auto" && request.options.projection != "latlong")
            return Error{"pbrt names the equal-area octahedral square, which is not a " + options.projection,
                         field_place("latlong"), ""};
        request.options.latlong.clear();
        request.options.projection = "pbrt";
    }
    if (!one_of(request.options.projection, k_own_projections)) {
        auto other = other_projection(request.options.projection);
        if (!other) return other.error().at(field_place("projection"));
        request.other = *std::move(other);
    }
    if (!options.faces.empty()) {
        const auto faces = cube_face_order(options.faces);
        if (!faces) return faces.error();
        request.faces = *faces;
    }
    if (auto ok = take_face_orientation(request); !ok) return ok.error();
    if (!std::isfinite(options.rotate_y_deg)) return Error{"angle is not a number", field_place("rotate_y_deg"), ""};
    if (!(std::abs(options.exposure) <= 64))
        return Error{"exposure must lie between -64 and 64 stops", field_place("exposure"), ""};
    const Result<Vec3d> up = signed_axis(options.up);
    if (!up) return up.error().at(field_place("up"));
    if (!request.options.latlong.empty())
        if (const auto convention = latlong_convention(request.options.latlong); !convention) {
            Error error = convention.error().at(field_place("latlong"));
            if (error.hint.starts_with("Accepted")) error.hint += " Also pbrt, which is an octahedral square.";
            return error;
        }
    // When the light is turned by R, what arrives from d came from Rᵀ d before.
    request.turn = up_to_y(*up) * rotation_y_deg(options.rotate_y_deg).transposed();
    request.scale = float(std::exp2(options.exposure));
    return request;
}

/// Twice as wide as high. One texel more or less is accepted, because a resize may have rounded.
bool has_latlong_shape(int width, int height) {
    return std::abs(std::int64_t(width) - 2 * std::int64_t(height)) <= 1;
}

}  // namespace

bool has_environment_shape(int width, int height) {
    return has_latlong_shape(width, height) || cube_layout_of_shape(width, height);
}

namespace {

/// The layout of a cube in a picture, as `projection` and the orientation of its faces ask.
Result<CubeLayout> choose_cube_layout(const ImageFacts& facts, const EnvironmentOptions& options) {
    const std::string& projection = options.projection;
    const std::string is = fmt::format("image is {} x {}", facts.width, facts.height);
    const std::optional<CubeLayout> layout = cube_layout_of_shape(facts.width, facts.height);
    const bool strip = layout == CubeLayout::horizontal_strip || layout == CubeLayout::vertical_strip;
    if (projection == "cube-cross" && (!layout || strip))
        return Error{is + ", but a cube cross must be 4:3 (horizontal) or 3:4 (vertical)", "", ""};
    if (projection == "cube-strip" && !strip)
        return Error{is + ", but a strip of cube faces must be 6:1 or 1:6", "", ""};
    if (projection == "cube-faces") return Error{"six files are needed for the faces of a cube", "", ""};
    const bool stated = facts.envmap == ImageFacts::Envmap::cube;
    const auto orientation =
        options.face_orientation.value_or(stated ? FaceOrientation::openexr : FaceOrientation::opengl);
    if (orientation == FaceOrientation::openexr && (options.face_orientation || layout == CubeLayout::vertical_strip)) {
        if (layout != CubeLayout::vertical_strip) return Error{is + ", but OpenEXR's cube must be 1:6", "", ""};
        return CubeLayout::openexr_strip;
    }
    if (!layout)
        return Error{is + ", but a cube must be a cross (4:3 or 3:4), a strip of its faces (6:1 or 1:6) or six files",
                     "", ""};
    if (!options.faces.empty() && !strip)
        return Error{"a cross has its faces in their places", field_place("faces"), ""};
    return *layout;
}

/// Whether a picture is read as lat-long rather than as a cube.
Result<bool> is_latlong(const ImageFacts& facts, const EnvironmentOptions& options) {
    if (options.projection == "latlong") return true;
    if (options.projection != "auto" || cube_layout_of_shape(facts.width, facts.height)) return false;
    if (has_latlong_shape(facts.width, facts.height) || !options.latlong.empty()) return true;
    return Error{
        fmt::format("image is {} x {}, but a lat-long map is twice as wide as high", facts.width, facts.height), "",
        facts.width == facts.height ? "If this is one face of a cube, give all six; if it is a mirror ball or another "
                                      "round or octahedral map, say which: `projection` sphere-map, "
                                      "mirror-ball/fov=DEGREES, angular, octahedral, ..."
                                    : "If it is one all the same, stretched, pass `projection` latlong."};
}

/// The warning about a lat-long map of another shape than 2:1; empty for one of that shape.
std::string stretched_warning(const ImageFacts& facts) {
    if (has_latlong_shape(facts.width, facts.height)) return "";
    return fmt::format(
        "image is {} x {}, not twice as wide as high: it is taken for the whole sphere, stretched to that shape",
        facts.width, facts.height);
}

/// Sets what is known about the file as a whole.
Environment with_facts(Environment environment, std::vector<std::filesystem::path> files, const std::string& format,
                       int width, int height) {
    environment.file = files.front();
    environment.files = std::move(files);
    environment.format = format;
    environment.width = width;
    environment.height = height;
    return environment;
}

Environment with_facts(Environment environment, std::vector<std::filesystem::path> files, const ImageFacts& facts) {
    environment.layer = facts.layer;
    return with_facts(std::move(environment), std::move(files), facts.format, facts.width, facts.height);
}

ReaderOptions reader_options(const EnvironmentOptions& options) {
    ReaderOptions reader{options.decode, options.max_bytes, options.threads, options.layer};
    reader.max_black = k_most_black_in_memory;
    return reader;
}

/// One of several files.
Result<std::unique_ptr<ImageReader>> open_file(const std::filesystem::path& file, const EnvironmentOptions& options) {
    auto bytes = FileBytes::open(file, options.max_bytes, FileKinds::regular);
    if (!bytes) return bytes.error();
    auto image = open_image_reader(std::move(*bytes), reader_options(options));
    if (!image) return image.error().at(file.string());
    return image;
}

RepairOptions repair_options(const Request& request, bool wraps) {
    RepairOptions repair;
    repair.scale = request.scale;
    repair.wraps = wraps;
    repair.negatives = request.options.negatives;
    repair.threads = request.options.threads;
    return repair;
}

std::unique_ptr<RowSource> radiance_of(const std::filesystem::path& file, std::unique_ptr<ImageReader> image,
                                       const Request& request, bool wraps, std::shared_ptr<RepairReport> report) {
    return std::make_unique<RadianceReader>(file, std::move(image), repair_options(request, wraps), std::move(report));
}

/// Adds the report of one more file. A warning that several files share is kept once.
void add_report(RepairReport& sum, const RepairReport& part) {
    add_repairs(sum, part);
    for (const std::string& warning : part.warnings)
        if (std::find(sum.warnings.begin(), sum.warnings.end(), warning) == sum.warnings.end())
            sum.warnings.push_back(warning);
}

/// Radiance of a picture that is read at once, together with its report.
struct PictureRows {
    std::shared_ptr<RepairReport> report = std::make_shared<RepairReport>();
    std::unique_ptr<RowSource> rows;
    PictureRows(const std::filesystem::path& file, std::unique_ptr<ImageReader> image, const Request& request)
        : rows(radiance_of(file, std::move(image), request, false, report)) {}
};

/// A lat-long file whose rows can be read again and again. The bytes stay open, so that every reading sees the same
/// file, even if another program replaces it meanwhile.
class LatlongFile {
  public:
    LatlongFile(std::filesystem::path file, std::shared_ptr<const FileBytes> bytes, std::unique_ptr<ImageReader> first,
                Request request, LatlongConvention::Grid grid)
        : file_(std::move(file)),
          bytes_(std::move(bytes)),
          first_(std::move(first)),
          request_(std::move(request)),
          grid_(grid) {}

    Result<std::unique_ptr<RowSource>> open(std::shared_ptr<RepairReport> report) {
        auto image = reader();
        if (!image) return image.error().at(file_.string());
        if (const std::string warning = stretched_warning((*image)->facts()); !warning.empty())
            report->warnings.push_back(warning);
        return regrid_latlong(radiance_of(file_, *std::move(image), request_, true, std::move(report)), grid_);
    }

  private:
    /// The reader that opening the environment made, and new ones after that.
    Result<std::unique_ptr<ImageReader>> reader() {
        {
            const Lock lock(mutex_);
            if (first_) return std::exchange(first_, nullptr);
        }
        return open_image_reader(bytes_, reader_options(request_.options));
    }

    std::filesystem::path file_;
    std::shared_ptr<const FileBytes> bytes_;
    Mutex mutex_;
    std::unique_ptr<ImageReader> first_;
    Request request_;
    LatlongConvention::Grid grid_;
};

Result<Environment> open_latlong(const std::filesystem::path& file, std::shared_ptr<const FileBytes> bytes,
                                 std::unique_ptr<ImageReader> image, const Request& request) {
    if (auto ok = check_no_faces(request.options, "a lat-long map"); !ok) return ok.error();
    ImageFacts facts = image->facts();
    if (const std::string warning = stretched_warning(facts); !warning.empty()) facts.warnings.push_back(warning);
    std::string name = request.options.latlong;
    if (name.empty()) name = facts.envmap == ImageFacts::Envmap::latlong ? "openexr" : "default";
    const Result<LatlongConvention> convention = latlong_convention(name);
    if (!convention) return convention.error();
    const auto source =
        std::make_shared<LatlongFile>(file, std::move(bytes), std::move(image), request, convention->grid);
    Environment environment = Environment::from_rows(
        facts.width, facts.height,
        [source](std::shared_ptr<RepairReport> report) { return source->open(std::move(report)); }, facts.warnings);
    environment.world_to_source = convention->world_to_default() * request.turn;
    environment.convention = name;
    return with_facts(std::move(environment), {file}, facts);
}

Result<void> check_cube_memory(std::int64_t size, std::int64_t max_bytes) {
    const std::int64_t bytes = 6 * size * size * 3 * std::int64_t(sizeof(float));
    if (bytes <= max_bytes) return {};
    return Error{
        fmt::format("a cube of {} x {} faces needs {} bytes, more than the limit of {}", size, size, bytes, max_bytes),
        "", ""};
}

/// A cube has no lat-long convention, only the turn.
Environment finish_cube(Cubemap cube, RepairReport report, const Request& request) {
    if (!request.options.latlong.empty())
        report.warnings.push_back("a lat-long convention means nothing for a cube: ignored");
    return Environment::from_cube(std::move(cube), request.cube_axes * request.turn, std::move(report),
                                  request.options.threads);
}

/// The faces of one file in the order that was asked for, and in OpenGL's orientation.
Cubemap in_order(Cubemap cube, const Request& request, bool openexr) {
    if (request.faces) cube = cube_with_faces(cube, *request.faces);
    return openexr ? cube_from_openexr(std::move(cube)) : cube;
}

/// A picture in any other projection.
Environment finish_other(ProjectedImage picture, RepairReport report, const Request& request) {
    const ProjectionShape& shape = picture.projection.shape();
    if (!picture.projection.full())
        report.warnings.push_back(
            fmt::format("the projection {} shows {:.0f} % of all directions: {}", picture.projection.name(),
                        25 * shape.coverage() / k_pi,
                        shape.coverage() < 3 * k_pi ? "the rest is black" : "the rest repeats its rim"));
    return Environment::from_picture(std::move(picture), request.turn, std::move(report), request.options.max_bytes,
                                     request.options.threads);
}

/// Reads one picture of a projection: its only chart, or the two halves of a dual paraboloid side by side.
Result<ProjectedImage> read_other(RowSource& rows, const Projection& projection) {
    const int charts = projection.charts(), width = rows.width() / charts, height = rows.height();
    if (rows.width() != charts * height)
        return Error{fmt::format("image is {} x {}, but {} must be {}", rows.width(), height, projection.name(),
                                 charts == 2 ? "two squares side by side" : "square"),
                     "", charts == 2 ? "Front and back may also be two files." : ""};
    Result<ImageF> picture = read_latlong(rows);
    if (!picture) return picture.error();
    if (charts == 1) return ProjectedImage{projection, *std::move(picture)};
    ImageF stacked(width, height * charts, 3);
    for (int c = 0; c < charts; ++c)
        for (int y = 0; y < height; ++y) std::copy_n(picture->at(c * width, y), 3 * width, stacked.row(c * height + y));
    return ProjectedImage{projection, std::move(stacked)};
}

/// Front and back of a dual paraboloid.
Result<Environment> open_halves(const std::vector<std::filesystem::path>& files, const Request& request) {
    ImageFacts first;
    RepairReport report;
    ImageF stacked;
    for (int c = 0; c < 2; ++c) {
        const std::filesystem::path& file = files[std::size_t(c)];
        auto image = open_file(file, request.options);
        if (!image) return image.error();
        const ImageFacts facts = (*image)->facts();
        if (facts.width != facts.height)
            return Error{
                fmt::format("image is {} x {}, but half a dual paraboloid must be square", facts.width, facts.height),
                file.string(), ""};
        if (c == 0) {
            first = facts;
            stacked = ImageF(facts.width, 2 * facts.width, 3);
        } else if (facts.width != stacked.width()) {
            return Error{fmt::format("image is {} x {}, but {} is {} x {}", facts.width, facts.height,
                                     files[0].filename().string(), stacked.width(), stacked.width()),
                         file.string(), "Both halves must have one size."};
        }
        const int size = stacked.width();
        PictureRows picture(file, std::move(*image), request);
        if (const auto read = picture.rows->read(stacked.view().rows(c * size, size)); !read) return read.error();
        add_report(report, *picture.report);
    }
    return with_facts(finish_other({*request.other, std::move(stacked)}, std::move(report), request), files, first);
}

/// Opens a KTX2, KTX, DDS or .env file, which holds a cube as engines load it.
Result<Environment> open_texture(const std::filesystem::path& file, const FileBytes& bytes,
                                 const std::string& container, const Request& request) {
    if (const std::string& projection = request.options.projection; projection != "auto" && projection != "cube")
        return Error{"a texture's projection is known: leave " + projection + " out", field_place("projection"), ""};
    const bool babylon = container.starts_with("Babylon");
    if (babylon)
        if (auto ok = check_no_faces(request.options, "a .env file, which states them"); !ok) return ok.error();
    RepairReport report;
    Result<Cubemap> cube = read_cube_texture(bytes.bytes(), request.options.max_bytes, repair_options(request, false),
                                             report, request.options.decode);
    if (!cube) return cube.error();
    const auto orientation = request.options.face_orientation;
    if (!orientation && !babylon)
        report.warnings.push_back(
            "the faces are taken to be in OpenGL's orientation; some tools write them mirrored (`face_orientation`)");
    cube = in_order(*std::move(cube), request, orientation == FaceOrientation::openexr);
    const int size = cube->size();
    return with_facts(finish_cube(*std::move(cube), std::move(report), request), {file}, container, size, size);
}

/// The rotation matrix of the unit quaternion x, y, z, w.
Mat3 turn_of(const std::array<float, 4>& q) {
    const Affine turn = affine_of_trs({}, q, {1, 1, 1});
    return Mat3{{Vec3d(turn.x), Vec3d(turn.y), Vec3d(turn.z)}}.transposed();
}

/// Opens the image-based light of a glTF file (EXT_lights_image_based).
Result<Environment> open_gltf_light(const std::filesystem::path& file, std::shared_ptr<const FileBytes> bytes,
                                    const Request& request) {
    if (const std::string& projection = request.options.projection; projection != "auto" && projection != "cube")
        return Error{"a glTF file's light is a cube: leave " + projection + " out", field_place("projection"), ""};
    if (auto ok = check_no_faces(request.options, "a glTF file, which states them"); !ok) return ok.error();
    RepairReport report;
    // What comes from a pipe or from memory lies in no folder.
    const auto folder = bytes->regular() ? std::optional(file.parent_path()) : std::nullopt;
    auto light = read_gltf_environment(std::move(bytes), folder, request.options.max_bytes,
                                       repair_options(request, false), report);
    if (!light) return light.error();
    const int size = light->cube.size();
    Environment environment = with_facts(finish_cube(std::move(light->cube), std::move(report), request), {file},
                                         "glTF EXT_lights_image_based", size, size);
    // When the light is turned by R, what arrives from d came from Rᵀ d before.
    environment.world_to_source = turn_of(light->rotation).transposed() * environment.world_to_source;
    return environment;
}

Result<Environment> open_picture(const std::filesystem::path& file, std::shared_ptr<const FileBytes> bytes,
                                 const Request& request) {
    const std::string container = texture_container(bytes->bytes());
    const bool gltf = container.empty() && may_be_gltf_image_light(bytes->bytes());
    if (!container.empty() && !request.options.layer.empty()) return no_layers();
    if (!container.empty()) return open_texture(file, *bytes, container, request);
    if (gltf) return open_gltf_light(file, std::move(bytes), request);
    auto image = open_image_reader(bytes, reader_options(request.options));
    if (!image) return image.error();
    const ImageFacts facts = (*image)->facts();
    if (request.other) {
        if (auto ok = check_no_faces(request.options, "this projection"); !ok) return ok.error();
        const PictureRows source(file, *std::move(image), request);
        Result<ProjectedImage> picture = read_other(*source.rows, *request.other);
        if (!picture) return picture.error();
        return with_facts(finish_other(*std::move(picture), *source.report, request), {file}, facts);
    }
    const auto latlong = is_latlong(facts, request.options);
    if (!latlong) return latlong.error();
    if (*latlong) return open_latlong(file, std::move(bytes), *std::move(image), request);
    const auto layout = choose_cube_layout(facts, request.options);
    if (!layout) return layout.error();
    const bool strip = *layout != CubeLayout::horizontal_cross && *layout != CubeLayout::vertical_cross;
    const int size = strip ? std::min(facts.width, facts.height) : std::max(facts.width, facts.height) / 4;
    if (const auto fits = check_cube_memory(size, request.options.max_bytes); !fits) return fits.error();
    const PictureRows source(file, *std::move(image), request);
    const bool openexr = *layout == CubeLayout::openexr_strip;
    Result<Cubemap> cube = read_cube_picture(*source.rows, openexr ? CubeLayout::vertical_strip : *layout);
    if (!cube) return cube.error();
    cube = in_order(*std::move(cube), request, openexr);
    return with_facts(finish_cube(*std::move(cube), *source.report, request), {file}, facts);
}

/// The six files of a cube in the order of its faces.
Result<CubeFaceFiles> sorted_faces(const std::vector<std::filesystem::path>& files, const std::string& order) {
    return order.empty() ? cube_faces_by_name(files) : cube_faces_in_order(files, order);
}

/// Turns faces into OpenGL's orientation, and adds to the report what was assumed.
Cubemap oriented(Cubemap cube, const CubeFaceFiles& faces, bool stated_openexr, const Request& request,
                 RepairReport& report) {
    const auto asked = request.options.face_orientation;
    if (asked == FaceOrientation::openexr || (!asked && stated_openexr)) return cube_from_openexr(std::move(cube));
    if (asked) return cube;
    if (meets_as_openexr(cube)) {
        report.warnings.push_back(
            "the faces fit together as OpenEXR's exrenvmap writes them, and are read in its orientation "
            "(`face_orientation` says another)");
        return cube_from_openexr(std::move(cube));
    }
    if (!faces.axes_named)
        report.warnings.push_back(
            "the names of the faces say no convention: right is taken to be +X, front +Z, each in OpenGL's "
            "orientation (`face_orientation` directx: front is -Z, each as a viewer sees it)");
    return cube;
}

Result<Environment> open_faces(const std::vector<std::filesystem::path>& files, const Request& request) {
    if (const std::string& projection = request.options.projection;
        projection != "auto" && projection != "cube" && projection != "cube-faces")
        return Error{"six files are the faces of a cube, not " + projection, field_place("projection"), ""};
    const auto faces = sorted_faces(files, request.options.faces);
    if (!faces) return faces.error();
    bool stated_openexr = false;
    ImageFacts first;
    RepairReport report;
    Cubemap cube;
    for (int f = 0; f < 6; ++f) {
        const std::filesystem::path& file = faces->files[std::size_t(f)];
        auto image = open_file(file, request.options);
        if (!image) return image.error();
        const ImageFacts facts = (*image)->facts();
        if (facts.width != facts.height)
            return Error{
                fmt::format("image is {} x {}, but a face of a cube must be square", facts.width, facts.height),
                file.string(), ""};
        if (f == 0) {
            if (const auto fits = check_cube_memory(facts.width, request.options.max_bytes); !fits) return fits.error();
            first = facts;
            cube = Cubemap(facts.width);
        } else if (facts.width != cube.size()) {
            return Error{fmt::format("image is {} x {}, but {} is {} x {}", facts.width, facts.height,
                                     faces->files[0].filename().string(), cube.size(), cube.size()),
                         file.string(), "The faces of a cube must have one size."};
        }
        PictureRows picture(file, *std::move(image), request);
        if (const auto read = picture.rows->read(cube.face(f)); !read) return read.error();
        add_report(report, *picture.report);
        stated_openexr = stated_openexr || facts.envmap == ImageFacts::Envmap::cube;
    }
    cube = oriented(std::move(cube), *faces, stated_openexr, request, report);
    return with_facts(finish_cube(std::move(cube), std::move(report), request),
                      {faces->files.begin(), faces->files.end()}, first);
}

/// One file that has been read.
Result<Environment> open_bytes(const std::filesystem::path& file, std::shared_ptr<const FileBytes> bytes,
                               const Request& request) {
    Result<Environment> environment = open_picture(file, bytes, request);
    if (!environment) return environment.error().at(file.string());
    // The rows of a lat-long image are decoded from these bytes again and again, so they are kept in any case.
    if (!bytes->regular() || environment->storage() == Environment::Storage::rows)
        environment->sha256 = [bytes] { return sha256(bytes->bytes()); };
    return environment;
}

/// What a folder without the faces of a cube may be instead.
std::string hint_for_folder(const std::filesystem::path& folder) {
    std::error_code ignored;
    if (std::filesystem::exists(folder / "lights.json", ignored))
        return "It holds the lights of an environment (lights.json): name the remainder in it.";
    if (std::filesystem::exists(folder / "manifest.json", ignored))
        return "It holds a bake (manifest.json): name one of the files in it.";
    return "Name an image, or six files px, nx, py, ny, pz, nz. A folder of environments is a batch.";
}

}  // namespace

Result<Environment> open_environment(const std::vector<std::filesystem::path>& files,
                                     const EnvironmentOptions& options) {
    const Result<Request> request = check_options(options);
    if (!request) return request.error();
    if (files.size() == 6) return open_faces(files, *request);
    if (files.size() == 2 && request->other && request->other->charts() == 2) return open_halves(files, *request);
    if (files.size() != 1)
        return Error{fmt::format("{} files: an environment is one image or the six faces of a cube", files.size()), "",
                     ""};
    if (std::error_code ignored; std::filesystem::is_directory(files[0], ignored)) {
        const auto faces = cube_faces_in_folder(files[0]);
        if (faces.size() != 6)
            return Error{fmt::format("is a folder with {} files named as faces of a cube, not 6", faces.size()),
                         files[0].string(), hint_for_folder(files[0])};
        return open_faces(faces, *request);
    }
    const auto bytes = FileBytes::open(files[0], options.max_bytes);
    if (!bytes) return bytes.error();
    return open_bytes(files[0], *bytes, *request);
}

Result<Environment> open_environment_bytes(std::span<const std::uint8_t> bytes, const std::string& name,
                                           const EnvironmentOptions& options) {
    const Result<Request> request = check_options(options);
    if (!request) return request.error();
    if (bytes.empty()) return Error{"there are no bytes", name, ""};
    return open_bytes(name, FileBytes::from_memory({bytes.begin(), bytes.end()}), *request);
}

Result<std::string> environment_sha256(const Environment& environment) {
    if (environment.sha256) return environment.sha256();
    return environment.files.empty() ? Result<std::string>(std::string()) : sha256_files(environment.files);
}

}  // namespace domelight
