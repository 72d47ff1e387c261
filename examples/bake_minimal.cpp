// The smallest bake: a specular cube map of five levels from an HDR photograph.
//
//     bake_minimal studio.hdr specular.ktx2

#include <domelight/domelight.h>

#include <cstdio>

using namespace domelight;

Result<void> bake(const char* photograph, const char* texture) {
    auto environment = open_environment({photograph});
    if (!environment) return environment.error();

    FilterOptions options;
    for (int level = 0; level < 5; ++level)  // 256^2, the environment itself, to 16^2, fully rough
        options.specular.push_back({256 >> level, level == 0, ZonalKernel::ggx(level / 4.0)});

    auto filtered = prefilter(*environment, options);
    if (!filtered) return filtered.error();
    return write_ktx2(texture, encode_texture(filtered->specular, Encoding::rgba16f, 0));
}

int main(int argc, char** argv) {
    if (argc != 3) return 2;
    const auto done = bake(argv[1], argv[2]);
    if (!done) std::fprintf(stderr, "error: %s\n", done.error().format().c_str());
    return done ? 0 : 1;
}
