// Rendering: speed to a given error, rays a second beside Embree's bare rate, and agreement with another renderer.
//
//   render_bench converge [SCENE...]   CPU seconds to a tone-mapped RMSE of 0.01, one thread, against its own converged
//                                      picture; one JSON line a sample count
//   render_bench rays [SCENE...]       rays a second of the render loop, and of the same rays traced by Embree alone;
//                                      two threads beside one
//   render_bench agree [SCENE...] --theirs A.exr B.exr ...
//                                      object means and z-test per pixel against pictures of one scene, each with a
//                                      seed of its own; as many of ours are made, of --samples each
//
//   [SCENE...]: --scene MODEL.glb, --env ENVIRONMENT, --material lambert:A|metal:R (of every object but the one named
//   floor), --size N (96), --bounces N (0), --separable-masking (Smith's G1 G1, as Cycles had it up to 3.4). Without: a
//   sphere under the built-in sky. The view is the one of all comparisons: eye (0, 0.8, 4.2), target the origin, 35
//   degrees.

#include "domelight/base/random.h"
#include "domelight/compare/metrics.h"
#include "domelight/environment/sky/sky.h"
#include "domelight/image/row_source.h"
#include "domelight/io/environment/open_environment.h"
#include "domelight/render/render.h"
#include "domelight/sampling/sequences.h"

#include "io/exr/exr_layers.h"
#include "io/file/file_reader.h"
#include "measure.h"
#include "render/camera.h"
#include "render/shapes.h"
#include "render/surface/surface.h"

#include <fmt/core.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <map>
#include <optional>

using namespace domelight;

namespace {

struct Words {
    std::string mode = "converge", scene, environment, material;
    int size = 96, bounces = 0, samples = 64;
    bool separable = false;
    std::vector<std::string> theirs;
};

std::optional<Words> parse(int argc, char** argv) {
    Words w;
    int i = 1;
    if (i < argc && argv[i][0] != '-') w.mode = argv[i++];
    const std::map<std::string, std::string*> texts = {
        {"--scene", &w.scene}, {"--env", &w.environment}, {"--material", &w.material}};
    const std::map<std::string, int*> numbers = {
        {"--size", &w.size}, {"--bounces", &w.bounces}, {"--samples", &w.samples}};
    while (i < argc) {
        const std::string option = argv[i++];
        if (option == "--separable-masking") {
            w.separable = true;
        } else if (option == "--theirs") {
            while (i < argc && argv[i][0] != '-') w.theirs.push_back(argv[i++]);
        } else if (i < argc && texts.contains(option)) {
            *texts.at(option) = argv[i++];
        } else if (i < argc && numbers.contains(option)) {
            *numbers.at(option) = std::atoi(argv[i++]);
        } else {
            return std::nullopt;
        }
    }
    return w;
}

[[noreturn]] void fail(const Error& error) {
    fmt::print(stderr, "{}\n", error.format());
    std::exit(1);
}

Scene make_scene(const Words& w) {
    Scene scene;
    if (w.scene.empty()) {
        test::add(scene, test::sphere_mesh(256), test::lambert_material(0.8f));
    } else {
        auto loaded = load_scene(w.scene);
        if (!loaded) fail(loaded.error());
        scene = std::move(*loaded);
    }
    if (!w.material.empty()) {
        const float value = float(std::atof(w.material.c_str() + w.material.find(':') + 1));
        for (const Instance& instance : scene.instances)
            if (instance.name != "floor")
                scene.materials[std::size_t(scene.meshes[std::size_t(instance.mesh)].material)] =
                    w.material[0] == 'l' ? test::lambert_material(value) : test::metal_material(value);
        for (Material& m : scene.materials) m.separable_masking = w.separable;
    }
    return scene;
}

ImageF make_environment(const Words& w) {
    if (w.environment.empty()) {
        SkyOptions sky;
        sky.height = 1024;
        ImageF image(2048, 1024, 3);
        (void)make_sky(sky)->read(image.view());
        return image;
    }
    auto environment = open_environment({w.environment});
    if (!environment) fail(environment.error());
    if (environment->cube()) fail(Error{"is not a lat-long", w.environment, ""});
    auto image = read_latlong(**environment->rows());
    if (!image) fail(image.error());
    return std::move(*image);
}

/// What the three measurements have in common.
struct Bench {
    explicit Bench(const Words& w)
        : image(make_environment(w)),
          scene([&] {
              auto built = RayScene::build(make_scene(w));
              if (!built) fail(built.error());
              return std::move(*built);
          }()),
          sampler(std::move(*EnvironmentSampler::build(image, reference_sampler_options(LightStrategy::mis, 1)))) {
        options.width = options.height = w.size;
        options.camera = look_at({0, 0.8f, 4.2f}, {0, 0, 0}, float(35 * k_pi / 180));
        options.bounces = w.bounces;
        options.threads = 1;
    }
    RenderResult render() const { return std::move(*render_reference(scene, sampler, options)); }

    ImageF image;
    RayScene scene;
    EnvironmentSampler sampler;
    RenderOptions options;
};

void converge(const Words& w) {
    Bench b(w);
    b.options.seed = 77;
    b.options.samples = 4096;
    const RenderResult truth = b.render();
    b.options.seed = 1;
    for (int n = 1; n <= 64; n *= 2) {
        b.options.samples = n;
        std::vector<double> times;
        RenderResult last;
        for (int repeat = 0; repeat < 7; ++repeat) {
            const double start = cpu_seconds();
            last = b.render();
            times.push_back(cpu_seconds() - start);
        }
        const double error = compare_images(last.radiance.view(), truth.radiance.view()).tone_mapped_rmse;
        fmt::print("{{\"spp\": {}, \"cpu_seconds\": {:.5f}, \"mrays_per_second\": {:.2f}, \"rmse\": {:.5f}}}\n", n,
                   median(times), double(last.rays) / median(times) * 1e-6, error);
    }
}

/// The rays of a picture with direct light: those of the camera, and from each point that they hit one ray to the
/// environment and one by the BRDF.
struct Rays {
    std::vector<Ray> camera, shadow;
};
Rays rays_of(const Bench& b) {
    Rays rays;
    const CameraRays camera(b.options.camera, b.options.width, b.options.height);
    for (int y = 0; y < b.options.height; ++y)
        for (int x = 0; x < b.options.width; ++x)
            for (int k = 0; k < b.options.samples; ++k) {
                const std::uint64_t key = derive_key(3, std::uint64_t(y) * std::uint64_t(b.options.width) + x);
                const auto point = [&](int pair) {
                    return sobol_owen(derive_key(key, std::uint64_t(pair)), std::uint32_t(k));
                };
                const Ray ray = camera.through(x, y, point(0));
                rays.camera.push_back(ray);
                const Hit hit = b.scene.impl().intersect(ray, true);
                if (hit.instance < 0) continue;
                const SurfacePoint s = surface_at(b.scene.scene(), hit, ray.origin, ray.direction, false);
                const Frame<float> frame(s.normal);
                const Vec3f V = frame.to_local(-ray.direction), origin = s.position + s.geometric_normal * s.error;
                const Vec3f light = b.sampler.sample(point(1)).direction,
                            other = frame.to_world(s.bsdf.sample(V, point(2)).L);
                for (const Vec3f& d : {light, other})
                    if (dot(d, s.geometric_normal) > 0 && dot(d, s.normal) > 0) rays.shadow.push_back({origin, d, 0});
            }
    return rays;
}

void measure_rays(const Words& w) {
    Bench b(w);
    b.options.samples = 16;
    const Rays rays = rays_of(b);
    std::vector<double> bare_camera, bare_shadow, loop, shares, speedups;
    std::int64_t traced = 0;
    std::size_t hits = 0;
    for (int repeat = 0; repeat < 9; ++repeat) {
        double start = cpu_seconds();
        for (const Ray& r : rays.camera) hits += b.scene.impl().intersect(r, true).instance >= 0;
        bare_camera.push_back(cpu_seconds() - start);
        start = cpu_seconds();
        for (const Ray& r : rays.shadow) hits += b.scene.impl().occluded(r);
        bare_shadow.push_back(cpu_seconds() - start);
        start = cpu_seconds();
        traced = b.render().rays;
        loop.push_back(cpu_seconds() - start);
        const double bare = double(rays.camera.size() + rays.shadow.size()) / (bare_camera.back() + bare_shadow.back());
        shares.push_back(double(traced) / loop.back() / bare);
        // By the wall clock, because several threads take the same CPU time as one.
        RenderOptions more = b.options;
        more.width = more.height = 2 * more.width;
        double wall[2];
        for (const int threads : {1, 2}) {
            more.threads = threads;
            start = wall_seconds();
            (void)render_reference(b.scene, b.sampler, more);
            wall[threads - 1] = wall_seconds() - start;
        }
        speedups.push_back(wall[0] / wall[1]);
    }
    fmt::print(
        "bare: camera {:.2f}, shadow {:.2f} Mrays/s; render loop {:.2f} Mrays/s, {:.0f} % of the bare rate; two "
        "threads {:.2f} x one\n",
        double(rays.camera.size()) / median(bare_camera) * 1e-6,
        double(rays.shadow.size()) / median(bare_shadow) * 1e-6, double(traced) / median(loop) * 1e-6,
        100 * median(shares), median(speedups));
    if (hits == 0) fmt::print("(nothing was hit)\n");
}

/// Mean and variance of the mean of a pixel's channel, over pictures.
struct Estimate {
    double mean = 0, variance = 0;
};
Estimate estimate(std::span<const ImageF> pictures, int x, int y, int c) {
    Estimate e;
    double squares = 0;
    const double n = double(pictures.size());
    for (const ImageF& p : pictures) e.mean += p.at(x, y)[c] / n;
    for (const ImageF& p : pictures) squares += (p.at(x, y)[c] - e.mean) * (p.at(x, y)[c] - e.mean);
    e.variance = squares / (n - 1) / n;
    return e;
}

void agree(const Words& w) {
    Bench b(w);
    std::vector<ImageF> theirs, ours;
    for (const std::string& file : w.theirs) {
        auto bytes = FileBytes::open(file, std::int64_t(1) << 30);
        if (!bytes) fail(bytes.error());
        auto layers = open_exr_layers(*bytes);
        if (!layers) fail(layers.error().at(file));
        const auto names = (*layers)->colour_of("");
        auto picture = names ? (*layers)->read(*names) : Result<ImageF>(names.error());
        if (!picture) fail(picture.error().at(file));
        theirs.push_back(std::move(*picture));
    }
    if (theirs.size() < 2) fail(Error{"wants two pictures or more", "--theirs", ""});
    b.options.samples = w.samples;
    b.options.threads = 0;
    ImageF object;
    for (std::size_t i = 0; i < theirs.size(); ++i) {
        b.options.seed = 100 + i;
        RenderResult r = b.render();
        ours.push_back(std::move(r.radiance));
        object = ImageF(w.size, w.size, 1);
        for (int y = 0; y < w.size; ++y)
            for (int x = 0; x < w.size; ++x) *object.at(x, y) = *r.opacity.at(x, y) >= 1 ? *r.object.at(x, y) : 0;
    }
    const double dof = 2 * (double(theirs.size()) - 1);
    for (int instance = 1; instance <= int(b.scene.scene().instances.size()); ++instance) {
        double sum_ours = 0, sum_theirs = 0, variance = 0, z1 = 0, z2 = 0;
        int count = 0, far = 0;
        for (int y = 0; y < w.size; ++y)
            for (int x = 0; x < w.size; ++x)
                for (int c = 0; c < 3; ++c) {
                    if (*object.at(x, y) != float(instance)) continue;
                    const Estimate a = estimate(ours, x, y, c), t = estimate(theirs, x, y, c);
                    sum_ours += a.mean, sum_theirs += t.mean, variance += a.variance + t.variance;
                    if (a.variance + t.variance <= 0) continue;
                    const double z = (a.mean - t.mean) / std::sqrt(a.variance + t.variance);
                    z1 += z, z2 += z * z, ++count, far += std::abs(z) > 4;
                }
        if (count == 0) continue;
        fmt::print(
            "{{\"object\": \"{}\", \"mean_ratio\": {:.5f}, \"ratio_error\": {:.5f}, \"z_mean\": {:.3f}, "
            "\"z_variance\": {:.3f}, \"expected_variance\": {:.3f}, \"beyond_4\": {:.5f}, \"values\": {}}}\n",
            b.scene.scene().instances[std::size_t(instance - 1)].name, sum_ours / sum_theirs,
            std::sqrt(variance) / sum_theirs, z1 / count, z2 / count, dof / (dof - 2), double(far) / count, count);
    }
}

}  // namespace

int main(int argc, char** argv) {
    const auto words = parse(argc, argv);
    if (!words || (words->mode != "converge" && words->mode != "rays" && words->mode != "agree")) {
        fmt::print(stderr, "usage: render_bench converge|rays|agree [--scene MODEL] [--env ENV] [--material X] ...\n");
        return 2;
    }
    if (words->mode == "converge") converge(*words);
    if (words->mode == "rays") measure_rays(*words);
    if (words->mode == "agree") agree(*words);
}
