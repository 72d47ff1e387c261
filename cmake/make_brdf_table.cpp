// Writes the default BRDF table as a C++ source: make_brdf_table OUT.cpp. Runs once, while the library is being built.
#include "filtering/brdf/brdf_embedded.h"
#include "filtering/brdf/brdf_quadrature.h"

#include <bit>
#include <cstdio>

int main(int argc, char** argv) {
    using namespace domelight;
    std::FILE* out = argc == 2 ? std::fopen(argv[1], "w") : nullptr;
    if (!out) {
        std::fprintf(stderr, "usage: make_brdf_table OUT.cpp\n");
        return 2;
    }
    std::fprintf(out,
                 "#include \"filtering/brdf/brdf_embedded.h\"\n\nconst std::uint32_t domelight::k_brdf_embedded[] = {\n");
    for (int y = 0; y < k_brdf_embedded_size; ++y)
        for (int x = 0; x < k_brdf_embedded_size; ++x) {
            const double NdotV = (x + 0.5) / k_brdf_embedded_size, roughness = (y + 0.5) / k_brdf_embedded_size,
                         alpha = roughness * roughness;
            const BrdfTerms terms = integrate_brdf(NdotV, alpha, BrdfG::correlated);
            for (const double value : {terms.scale, terms.bias, integrate_sheen(NdotV, alpha)})
                std::fprintf(out, "0x%08xu,", std::bit_cast<std::uint32_t>(float(value)));
            std::fputc('\n', out);
        }
    std::fprintf(out, "};\n");
    return std::fclose(out) == 0 ? 0 : 1;
}
