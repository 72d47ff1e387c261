// Rendering speed: CPU time, rays a second beside Embree's bare rate, and the tone-mapped error against a converged
// picture.
//
//   render_bench [SCENE.glb|sphere ENVIRONMENT [MATERIAL]]      MATERIAL: keep | lambert:A | metal:R, given to every
//   object but the one named floor
//
// One thread. Without arguments a sphere under the built-in sky.

#include "domelight/environment.h"
#include "domelight/render.h"
#include "domelight/sky.h"

#include "render/shapes.h"

#include <fmt/core.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <ctime>

using namespace domelight;

namespace {

double cpu_seconds() {
    timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

/// Of L / (1 + L), all channels.
double tone_mapped_rmse(const ImageF& a, const ImageF& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.pixels().size(); ++i) {
        const double x = a.pixels()[i], y = b.pixels()[i], d = x / (1 + x) - y / (1 + y);
        sum += d * d;
    }
    return std::sqrt(sum / double(a.pixels().size()));
}

}  // namespace

int main(int argc, char** argv) {
    Scene scene;
    ImageF image;
    if (argc >= 3) {
        auto loaded = std::strcmp(argv[1], "sphere") ? load_scene(argv[1]) : [] {
            Scene sphere;
            test::add(sphere, test::sphere_mesh(256), test::lambert_material(0.8f));
            return Result<Scene>(std::move(sphere));
        }();
        auto environment = open_environment({argv[2]});
        auto rows = environment && environment->latlong ? read_latlong(*environment->latlong)
                                                        : Result<ImageF>(Error{"not a lat-long", argv[2], ""});
        if (!loaded || !rows) {
            fmt::print(stderr, "{}\n", !loaded ? loaded.error().format() : rows.error().format());
            return 1;
        }
        scene = std::move(*loaded);
        image = std::move(*rows);
    } else {
        test::add(scene, test::sphere_mesh(256), test::lambert_material(0.8f));
        SkyOptions sky;
        sky.height = 1024;
        image = ImageF(2048, 1024, 3);
        (void)make_sky(sky)->read(image.view());
    }
    if (argc >= 4 && std::strcmp(argv[3], "keep") != 0) {
        const float value = float(std::atof(std::strchr(argv[3], ':') + 1));
        for (const Instance& instance : scene.instances)
            if (instance.name != "floor")
                scene.materials[std::size_t(scene.meshes[std::size_t(instance.mesh)].material)] =
                    argv[3][0] == 'l' ? test::lambert_material(value) : test::metal_material(value);
    }
    double start = cpu_seconds();
    auto traced = RayScene::build(std::move(scene));
    fmt::print("build {:.3f} s CPU, {:.1f} MB\n", cpu_seconds() - start, double(traced->memory_bytes()) * 1e-6);
    start = cpu_seconds();
    auto sampler = EnvironmentSampler::build(image, reference_sampler_options(LightStrategy::mis, 1));
    fmt::print("sampler {:.3f} s CPU\n", cpu_seconds() - start);
    RenderOptions o;
    o.width = o.height = 96;
    o.camera = look_at({0, 0.8f, 4.2f}, {0, 0, 0}, float(35 * k_pi / 180));
    o.threads = 1;
    o.seed = 77;
    o.samples = 4096;
    const auto truth = render_reference(*traced, *sampler, o);
    o.seed = 1;
    for (int n = 1; n <= 64; n *= 2) {
        o.samples = n;
        double best = 1e9, error = 0;
        RenderResult last;
        for (int repeat = 0; repeat < 5; ++repeat) {
            start = cpu_seconds();
            auto r = render_reference(*traced, *sampler, o);
            best = std::min(best, cpu_seconds() - start);
            last = std::move(*r);
        }
        error = tone_mapped_rmse(last.radiance, truth->radiance);
        fmt::print("{:>4} spp  {:.4f} s CPU  {:.2f} Mrays/s  RMSE {:.5f}   to 0.01: {:.3f} s\n", n, best,
                   double(last.rays) / best * 1e-6, error, best * std::pow(error / 0.01, 2));
    }
}
