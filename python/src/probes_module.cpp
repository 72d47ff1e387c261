// domelight._probes: the light at many points of a scene. A module of its own, which is loaded when probes are asked for.

#include "domelight/capture/probe_bake.h"
#include "domelight/capture/probe_plan.h"
#include "domelight/io/environment/open_environment.h"
#include "domelight/probe/probe_blend.h"
#include "domelight/probe/scene_hash.h"
#include "domelight/scene/scene.h"

#include "array_input.h"
#include "base/field_place.h"
#include "errors.h"
#include "keywords.h"
#include "work.h"

#include <fmt/format.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>

namespace domelight::python {
namespace {

namespace fs = std::filesystem;

/// Vectors, one a row, as domelight.probes makes them.
using Vectors = nb::ndarray<const float, nb::shape<-1, 3>, nb::device::cpu, nb::c_contig>;

Vec3f vector_at(const Vectors& vectors, std::size_t i) {
    const float* p = vectors.data() + 3 * i;
    return {p[0], p[1], p[2]};
}

std::vector<double> numbers_of(const Keywords& words, const char* name, std::size_t count) {
    std::vector<double> numbers;
    words.read(name, numbers);
    if (!numbers.empty() && numbers.size() != count)
        throw Failure({fmt::format("{} numbers, expected {}", numbers.size(), count), field_place(name), ""});
    return numbers;
}

std::optional<ProbeBox> box_of(const Keywords& words, const char* name) {
    const auto v = numbers_of(words, name, 6);
    if (v.empty()) return std::nullopt;
    return ProbeBox{Vec3f(Vec3d{v[0], v[1], v[2]}), Vec3f(Vec3d{v[3], v[4], v[5]})};
}

ProbePlanOptions plan_options(const Keywords& words) {
    ProbePlanOptions o;
    std::vector<double> places;
    words.read("at", places);
    for (std::size_t i = 0; i + 2 < places.size(); i += 3)
        o.at.push_back(Vec3f(Vec3d{places[i], places[i + 1], places[i + 2]}));
    const auto grid = numbers_of(words, "grid", 3);
    for (std::size_t i = 0; i < grid.size(); ++i) o.grid[i] = int(std::clamp(grid[i], -1.0, 1e9));
    words.read("density", o.density);
    words.read("auto", o.auto_count);
    o.region = box_of(words, "region");
    words.read("walls", o.walls);
    o.proxy = box_of(words, "proxy");
    words.read("seed", o.seed);
    words.read("threads", o.threads);
    return o;
}

ProbeBakeOptions bake_options(const Keywords& words) {
    ProbeBakeOptions o;
    words.read("size", o.capture.size);
    words.read("spp", o.capture.samples);
    words.read("noise", o.capture.noise);
    words.read("bounces", o.capture.bounces);
    words.read("seed", o.capture.seed);
    words.read("threads", o.capture.threads);
    words.read("encoding", o.encoding);
    o.capture.most_samples = std::max(1024, 16 * o.capture.samples);
    return o;
}

/// Captures in memory, or into a folder, which is then read.
ProbeSet capture_set(const std::string& name, const Environment& environment, const std::optional<fs::path>& folder,
                     ProbePlanOptions plan, ProbeBakeOptions bake) {
    Scene scene = value_of(open_scene(name, {.threads = plan.threads}));
    value_of(set_sources(bake, name, scene, environment));
    const RayScene traced = value_of(RayScene::build(std::move(scene)));
    const EnvironmentSampler light =
        value_of(EnvironmentSampler::build(environment, reference_sampler_options(LightStrategy::mis, plan.threads)));
    const ProbePlan probes = value_of(plan_probes(traced, light, plan));
    bake.placement = probes.how;
    if (!folder) return value_of(bake_probes(traced, light, probes.probes, probes.grid, bake));
    value_of(bake_probes(traced, light, probes.probes, probes.grid, bake, *folder));
    return value_of(ProbeSet::load(*folder));
}

ProbeSet probes(const std::string& scene, const Environment& environment, const std::optional<fs::path>& folder,
                const nb::dict& dictionary, const nb::object& progress) {
    const Keywords words(dictionary);
    ProbePlanOptions plan = plan_options(words);
    ProbeBakeOptions bake = bake_options(words);
    return run_work_for(progress, [&](const Progress& report) {
        plan.progress = bake.capture.progress = report;
        return capture_set(scene, environment, folder, plan, bake);
    });
}

ProbeSet load(const fs::path& folder) {
    return run_work_for(nb::none(), [&](const Progress&) { return value_of(ProbeSet::load(folder)); });
}

/// An array of one row for each probe.
template <typename RowOf>
nb::object rows(const ProbeSet& set, int columns, const RowOf& row_of) {
    ImageF image(columns, int(set.probes().size()), 1);
    for (std::size_t i = 0; i < set.probes().size(); ++i) row_of(i, image.row(int(i)));
    return numpy_of(std::move(image));
}

nb::object positions(const ProbeSet& set) {
    return rows(set, 3, [&](std::size_t i, float* p) {
        const Vec3f& v = set.probes()[i].position;
        p[0] = v.x, p[1] = v.y, p[2] = v.z;
    });
}

nb::object harmonics(const ProbeSet& set) {
    return rows(set, 27, [&](std::size_t i, float* p) {
        for (const Vec3d& c : set.harmonics(int(i))) *p++ = float(c.x), *p++ = float(c.y), *p++ = float(c.z);
    });
}

nb::list flags(const ProbeSet& set, bool Probe::*member) {
    nb::list values;
    for (const Probe& probe : set.probes()) values.append(probe.*member);
    return values;
}

void check_probe(const ProbeSet& set, int probe) {
    const int count = int(set.probes().size());
    if (probe < 0 || probe >= count)
        throw Failure({fmt::format("{} is not from 0 to {}", probe, count - 1), field_place("probe"), ""});
}

/// A colour for each row of `directions`.
template <typename LookUp>
nb::object colours(std::size_t count, const LookUp& look_up) {
    ImageF image(3, int(count), 1);
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3f v = look_up(i);
        float* p = image.row(int(i));
        p[0] = v.x, p[1] = v.y, p[2] = v.z;
    }
    return numpy_of(std::move(image));
}

nb::object radiance(const ProbeSet& set, int probe, const Vectors& directions, float roughness) {
    check_probe(set, probe);
    return colours(directions.shape(0),
                   [&](std::size_t i) { return set.radiance(probe, vector_at(directions, i), roughness); });
}

nb::object irradiance(const ProbeSet& set, int probe, const Vectors& normals) {
    check_probe(set, probe);
    return colours(normals.shape(0),
                   [&](std::size_t i) { return set.irradiance_over_pi(probe, vector_at(normals, i)); });
}

nb::object blended_irradiance(const ProbeSet& set, const Vectors& points, const Vectors& normals, bool visibility) {
    BlendOptions options;
    options.visibility = visibility;
    const ProbeBlender blender(set, options);
    return colours(points.shape(0), [&](std::size_t i) {
        const Vec3f normal = normalize(vector_at(normals, i));
        return blender.irradiance_over_pi(blender.at(vector_at(points, i), normal), normal);
    });
}

}  // namespace
}  // namespace domelight::python

NB_MODULE(_probes, module) {
    using namespace domelight;
    using namespace domelight::python;
    nb::set_leak_warnings(false);
    register_errors();
    nb::class_<ProbeSet>(module, "ProbeSet")
        .def_prop_ro("count", [](const ProbeSet& set) { return set.probes().size(); })
        .def_prop_ro("scene", [](const ProbeSet& set) { return set.scene().file; })
        .def_prop_ro(
            "roughness",
            [](const ProbeSet& set) { return std::vector<float>(set.roughness().begin(), set.roughness().end()); })
        .def_prop_ro("size", &ProbeSet::specular_size)
        .def_prop_ro("grid",
                     [](const ProbeSet& set) -> nb::object {
                         if (!set.grid()) return nb::none();
                         return nb::make_tuple(set.grid()->nx, set.grid()->ny, set.grid()->nz);
                     })
        .def("positions", &positions)
        .def("harmonics", &harmonics)
        .def("valid", [](const ProbeSet& set) { return flags(set, &Probe::valid); })
        .def("moved", [](const ProbeSet& set) { return flags(set, &Probe::moved); })
        .def("radiance", &radiance, nb::arg("probe"), nb::arg("directions"), nb::arg("roughness"))
        .def("irradiance", &irradiance, nb::arg("probe"), nb::arg("normals"))
        .def("blended_irradiance", &blended_irradiance, nb::arg("points"), nb::arg("normals"), nb::arg("visibility"));
    module.def("probes", &probes, nb::arg("scene"), nb::arg("environment"), nb::arg("folder").none(),
               nb::arg("options"), nb::arg("progress") = nb::none());
    module.def("load", &load, nb::arg("folder"));
}
