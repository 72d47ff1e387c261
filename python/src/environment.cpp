#include "environment.h"

#include "domelight/environment/sky/sky.h"
#include "domelight/filtering/resample/area_resample.h"
#include "domelight/io/environment/convert.h"
#include "domelight/io/environment/open_environment.h"
#include "domelight/projection/projections.h"

#include "base/field_place.h"
#include "environment_words.h"
#include "projection/latlong_convention.h"
#include "projection/latlong_regrid.h"
#include "work.h"

#include <fmt/format.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cmath>

namespace domelight::python {
namespace {

Environment open(const std::vector<std::filesystem::path>& files, const nb::dict& words) {
    const EnvironmentOptions options = environment_options(Keywords(words));
    return run_work_for(nb::none(), [&](const Progress&) { return value_of(open_environment(files, options)); });
}

/// From the contents of a file: any object with a buffer of bytes.
Environment open_bytes(const nb::bytes& bytes, const std::string& name, const nb::dict& words) {
    const EnvironmentOptions options = environment_options(Keywords(words));
    const std::span<const std::uint8_t> contents(static_cast<const std::uint8_t*>(bytes.data()), bytes.size());
    return run_work_for(nb::none(), [&](const Progress&) {
        return value_of(open_environment_bytes(contents, name, options));
    });
}

/// A lat-long array in one of the conventions.
Environment latlong_environment(ArrayPixels pixels, const LatlongConvention& convention, const std::string& keyword) {
    const int width = pixels.width(), height = pixels.height();
    Environment environment = Environment::from_rows(
        width, height,
        [pixels = std::move(pixels), keyword, grid = convention.grid](
            const std::shared_ptr<RepairReport>&) -> Result<std::unique_ptr<RowSource>> {
            auto rows = radiance_rows(pixels, keyword);
            return grid == SampleGrid::centres ? std::move(rows) : regrid_latlong(std::move(rows), grid);
        });
    environment.world_to_source = convention.world_to_default();
    return environment;
}

/// The projection that an array's shape suggests.
std::string projection_by_shape(const ArrayPixels& pixels, const std::string& keyword) {
    if (pixels.charts() == 6 && pixels.chart_height() == pixels.width()) return "cube";
    if (!pixels.has_charts() && pixels.width() == 2 * pixels.height()) return "latlong";
    throw Failure({fmt::format("the array is {} x {}{}, but a lat-long map is twice as wide as high, and a cube has the "
                               "shape (6, size, size, 3)",
                               pixels.width(), pixels.chart_height(),
                               pixels.has_charts() ? fmt::format(" x {}", pixels.charts()) : ""),
                   field_place(keyword), "Say which projection it has: projection=\"latlong\", \"mirror-ball\", ..."});
}

void check_charts(const ArrayPixels& pixels, const Projection& projection, const std::string& keyword) {
    if (pixels.charts() != projection.charts())
        throw Failure({fmt::format("the array has {} charts, but {} has {}", pixels.charts(), projection.name(),
                                   projection.charts()),
                       field_place(keyword),
                       projection.charts() > 1
                           ? fmt::format("Pass the shape ({}, height, width, 3).", projection.charts())
                           : "Pass the shape (height, width, 3)."});
    if (projection.charts() == 6 && pixels.width() != pixels.chart_height())
        throw Failure({fmt::format("faces are {} x {}, but a face of a cube is square", pixels.width(),
                                   pixels.chart_height()),
                       field_place(keyword), ""});
}

Environment picture_environment(const ArrayPixels& pixels, const Projection& projection, const std::string& keyword,
                                int threads) {
    check_charts(pixels, projection, keyword);
    ImageF image = pixels.copy();
    value_of(check_radiance(image.view(), 0, keyword));
    if (projection.name() == "cube" && projection.grid() == SampleGrid::centres)
        return Environment::from_cube(Cubemap(std::move(image)), projection.world_to_picture(), {}, threads);
    return Environment::from_picture({projection, std::move(image)}, {}, {}, std::int64_t(1) << 32, threads);
}

/// The turn about +Y by an angle in degrees. Quarter turns have exact entries.
Mat3 turn_y_deg(double angle_deg) {
    Mat3 turn = rotation_y(angle_deg * k_pi / 180);
    if (std::remainder(angle_deg, 90.0) == 0)
        for (Vec3d& row : turn.row) row = {std::round(row.x), std::round(row.y), std::round(row.z)};
    return turn;
}

Environment from_array(nb::handle array, const nb::dict& dictionary, const std::string& keyword) {
    const Keywords words(dictionary);
    std::string name = "auto";
    int threads = 0;
    words.read("projection", name);
    words.read("threads", threads);
    ArrayPixels pixels = ArrayPixels::borrow(array, 3, keyword.c_str());
    if (name == "auto") name = projection_by_shape(pixels, keyword);
    const auto projection = projection_from_name(name);
    if (!projection) throw Failure(projection.error().at(field_place("projection")));
    Environment environment;
    if (projection->name() == "latlong") {
        check_charts(pixels, *projection, keyword);
        const std::size_t slash = name.find('/');
        const auto convention = latlong_convention(slash == std::string::npos ? "default" : name.substr(slash + 1));
        environment = latlong_environment(std::move(pixels), value_of(convention), keyword);
    } else {
        environment = picture_environment(pixels, *projection, keyword, threads);
    }
    double rotate_y_deg = 0;
    words.read("rotate_y_deg", rotate_y_deg);
    if (!std::isfinite(rotate_y_deg)) throw Failure({"angle is not a number", field_place("rotate_y_deg"), ""});
    // When the light is turned by R, what arrives from d came from Rᵀ d before.
    environment.world_to_source = environment.world_to_source * turn_y_deg(rotate_y_deg).transposed();
    environment.projection = projection->name();
    environment.format = "array";
    return environment;
}

Environment sky(const nb::dict& dictionary) {
    const Keywords words(dictionary);
    SkyOptions options;
    words.read("height", options.height);
    words.read("sun_elevation_deg", options.sun_elevation_deg);
    words.read("sun_azimuth_deg", options.sun_azimuth_deg);
    words.read("turbidity", options.turbidity);
    words.read("ground_albedo", options.ground_albedo);
    words.read("sun_disc", options.sun_disc);
    words.read("threads", options.threads);
    check_within("height", options.height, 1, 32768);
    check_within("sun_elevation_deg", options.sun_elevation_deg, -18, 90);
    check_within("sun_azimuth_deg", options.sun_azimuth_deg, -3600, 3600);
    check_within("turbidity", options.turbidity, 1, 10);
    check_within("ground_albedo", options.ground_albedo, 0, 1);
    Environment environment = run_work_for(nb::none(), [&](const Progress&) {
        return Environment::from_latlong(value_of(read_latlong(*make_sky(options))));
    });
    environment.format = "sky";
    return environment;
}

Environment axes(int height) {
    check_within("height", height, 1, 32768);
    Environment environment = Environment::from_latlong(make_axes_environment(height));
    environment.format = "axes";
    return environment;
}

/// The image that rows() reads as an array that shares the environment's memory, read-only.
nb::object source_latlong(const Environment& environment) {
    auto image = run_work_for(nb::none(), [&](const Progress&) { return value_of(environment.latlong()); });
    const ImageF& pixels = *image;
    auto* const owner = new std::shared_ptr<const ImageF>(std::move(image));
    nb::capsule keep(owner, [](void* p) noexcept { delete static_cast<std::shared_ptr<const ImageF>*>(p); });
    const std::size_t shape[3] = {std::size_t(pixels.height()), std::size_t(pixels.width()), 3};
    return nb::cast(nb::ndarray<nb::numpy, const float>(pixels.pixels().data(), 3, shape, keep));
}

nb::object radiance(const Environment& environment, nb::handle directions) {
    const std::vector<Vec3d> asked = directions_of(directions, "directions");
    ImageF values = ImageF::uninitialized(3, int(asked.size()), 1);
    run_work(nb::none(), [&](const Progress&) {
        for (std::size_t i = 0; i < asked.size(); ++i) {
            const Vec3f v = value_of(environment.radiance(asked[i]));
            std::copy_n(&v.x, 3, values.row(int(i)));
        }
    });
    return numpy_of(std::move(values), {asked.size(), 3});
}

nb::dict report(const Environment& environment) {
    const RepairReport report = environment.report();
    nb::dict told;
    told["not_a_number"] = report.not_a_number;
    told["infinite"] = report.infinite;
    told["negative"] = report.negative;
    told["negative_radiance"] = report.negative_radiance;
    told["share_added"] = tuple_of(report.share_added());
    told["lines"] = report.lines();
    return told;
}

}  // namespace

EnvironmentOptions environment_options(const Keywords& words) {
    EnvironmentOptions options;
    words.read("projection", options.projection);
    words.read("latlong", options.latlong);
    words.read("layer", options.layer);
    words.read("faces", options.faces);
    words.read("face_orientation", options.face_orientation);
    words.read("decode", options.decode);
    words.read("rotate_y_deg", options.rotate_y_deg);
    words.read("up", options.up);
    words.read("exposure", options.exposure);
    words.read("negatives", options.negatives);
    words.read("threads", options.threads);
    if (options.negatives == Negatives::keep)
        throw Failure({"keep is for conversions of files", field_place("negatives"), "Accepted: balance, clamp."});
    return options;
}

nb::tuple tuple_of(const Vec3d& v) {
    return nb::make_tuple(v.x, v.y, v.z);
}
nb::tuple tuple_of(const Mat3& m) {
    return nb::make_tuple(tuple_of(m.row[0]), tuple_of(m.row[1]), tuple_of(m.row[2]));
}

std::vector<Vec3d> directions_of(nb::handle array, const char* keyword) {
    // As rows of one picture three wide, whatever axes stand in front.
    const nb::object numpy = nb::module_::import_("numpy");
    const nb::object rows = numpy.attr("ascontiguousarray")(array, "float64");
    nb::ndarray<const double, nb::c_contig, nb::device::cpu> values;
    if (!nb::try_cast(rows, values, false) || values.ndim() == 0 || values.shape(values.ndim() - 1) != 3)
        throw Failure({"expected directions of shape (..., 3)", field_place(keyword), ""});
    std::vector<Vec3d> directions(values.size() / 3);
    for (std::size_t i = 0; i < directions.size(); ++i) {
        const double* const d = values.data() + 3 * i;
        directions[i] = {d[0], d[1], d[2]};
        if (const double l = length(directions[i]); !(l > 0) || !std::isfinite(l))
            throw Failure({fmt::format("direction {} is ({:g}, {:g}, {:g}), which points nowhere", i, directions[i].x,
                                       directions[i].y, directions[i].z),
                           field_place(keyword), ""});
    }
    return directions;
}

Result<ImageF> world_latlong(const Environment& environment, int height, int threads) {
    if (const Cubemap* cube = environment.cube())
        return area_resample_cube_to_latlong(*cube, height, environment.world_to_source, threads);
    if (environment.world_to_source == Mat3() && environment.storage() == Environment::Storage::rows &&
        height == environment.latlong_height()) {
        const auto image = environment.latlong();
        if (!image) return image.error();
        return ImageF(**image);
    }
    ConvertOptions options;
    options.height = height;
    options.width = 2 * height;
    options.threads = threads;
    auto made = convert(environment, *projection_from_name("latlong"), options);
    if (!made) return made.error();
    return std::move(made->image.pixels);
}

void declare_environment(nb::module_& module) {
    nb::class_<Environment>(module, "Environment")
        .def_ro("file", &Environment::file)
        .def_ro("files", &Environment::files)
        .def_ro("format", &Environment::format)
        .def_ro("layer", &Environment::layer)
        .def_ro("projection", &Environment::projection)
        .def_ro("convention", &Environment::convention)
        .def_ro("width", &Environment::width)
        .def_ro("height", &Environment::height)
        .def_prop_ro("latlong_height", &Environment::latlong_height)
        .def_prop_ro("is_default", [](const Environment& e) {
            return e.storage() == Environment::Storage::rows && e.world_to_source == Mat3();
        })
        .def("source_latlong", &source_latlong)
        .def("world_latlong", [](const Environment& e, int height, int threads) {
            return numpy_of(run_work_for(nb::none(), [&](const Progress&) {
                return value_of(world_latlong(e, height, threads));
            }));
        }, nb::arg("height"), nb::arg("threads") = 0)
        .def("radiance", &radiance, nb::arg("directions"))
        .def("report", &report);
    module.def("open_environment", &open, nb::arg("files"), nb::arg("options"));
    module.def("open_environment_bytes", &open_bytes, nb::arg("bytes"), nb::arg("name"), nb::arg("options"));
    module.def("environment_from_array", &from_array, nb::arg("array").none(), nb::arg("options"), nb::arg("keyword") = "array");
    module.def("sky", &sky, nb::arg("options"));
    module.def("axes", &axes, nb::arg("height"));
}

}  // namespace domelight::python
