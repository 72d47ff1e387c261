#include "domelight/filtering/brdf/brdf_table.h"

#include "c/pixels.h"

using namespace domelight;

extern "C" {

domelight_error* domelight_brdf_table(int32_t size, const char* masking, int32_t threads, domelight_image** image) {
    return c::guarded([&]() -> Result<void> {
        if (auto ok = c::check_given({{image, "image"}}); !ok) return ok;
        if (size < 1 || size > 4096) return Error{text(size, " is not from 1 to 4096"), field_place("size"), ""};
        const auto g = c::read_word(masking, BrdfG::correlated, "masking");
        if (!g) return g.error();
        if (auto ok = c::check_threads(threads); !ok) return ok;
        return c::hand_out(image, std::make_shared<const ImageF>(brdf_table({size, *g, threads})), 1);
    });
}

}  // extern "C"
