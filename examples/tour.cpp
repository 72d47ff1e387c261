// The tour of domelight/domelight.h as a program: opens an environment, filters it, writes what an engine loads, draws
// light directions from it, and path-traces a picture under it.
//
//     tour studio.hdr helmet.glb FOLDER

#include <domelight/domelight.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

using namespace domelight;

namespace {

/// Steps 2 and 3: the levels, one texture written by hand, and the folder that an engine loads.
Result<void> write_levels(const Environment& environment, const std::filesystem::path& folder) {
    FilterOptions options;
    options.irradiance_size = 32;
    for (int level = 0; level < 5; ++level)
        options.specular.push_back({256 >> level, level == 0, ZonalKernel::ggx(level / 4.0)});
    const auto filtered = prefilter(environment, options);
    if (!filtered) return filtered.error();
    const Texture specular = encode_texture(filtered->specular, Encoding::rgba16f, 0);
    if (auto written = write_ktx2(folder / "specular.ktx2", specular); !written) return written;

    BakeOptions for_engine;
    for_engine.engines = {"filament"};
    const auto baked = bake(environment, for_engine, folder / "filament");
    if (!baked) return baked.error();
    return {};
}

/// Step 4: the light that a white matte surface facing up sends back.
Vec3f light_from_above(const EnvironmentSampler& sampler) {
    constexpr int count = 4096;
    Vec3f sum;
    for (int i = 0; i < count; ++i) {
        const LightSample light = sampler.sample(unit_point(Sequence::sobol, 1, i, count));
        sum += light.radiance * (std::max(light.direction.y, 0.f) / light.pdf_solid_angle);
    }
    return sum / float(k_pi * count);  // f = 1 / pi
}

/// Step 5: the path-traced picture as OpenEXR.
Result<void> trace(const char* model, const EnvironmentSampler& sampler, const std::filesystem::path& picture) {
    auto scene = load_scene(model);
    if (!scene) return scene.error();
    const auto traced = RayScene::build(*std::move(scene));
    if (!traced) return traced.error();
    RenderOptions options;
    options.width = options.height = 64;
    options.samples = 16;
    options.camera = default_camera(traced->scene(), 1);
    const auto rendered = render_reference(*traced, sampler, options);
    if (!rendered) return rendered.error();
    return write_exr(picture, rendered->radiance);
}

Result<void> tour(const char* photograph, const char* model, const std::filesystem::path& folder) {
    const auto environment = open_environment({photograph});
    if (!environment) return environment.error();
    const auto up = environment->radiance({0, 1, 0});
    if (!up) return up.error();
    std::printf("from above comes %g %g %g\n", up->x, up->y, up->z);
    std::filesystem::create_directories(folder);
    if (auto written = write_levels(*environment, folder); !written) return written;
    const auto sampler = EnvironmentSampler::build(*environment);
    if (!sampler) return sampler.error();
    const Vec3f matte = light_from_above(*sampler);
    std::printf("a white surface that faces up sends back %g %g %g\n", matte.x, matte.y, matte.z);
    return trace(model, *sampler, folder / "picture.exr");
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 4) return 2;
    const auto done = tour(argv[1], argv[2], argv[3]);
    if (!done) std::fprintf(stderr, "error: %s\n", done.error().format().c_str());
    return done ? 0 : 1;
}
