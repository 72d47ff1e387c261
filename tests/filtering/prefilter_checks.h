#pragma once

#include "domelight/filtering/prefilter.h"

#include "base/instruction_set.h"
#include "test.h"

#include <cmath>
#include <optional>
#include <random>

namespace domelight::test {

/// White noise from 0.1 to 1.1, with one texel of radiance `hot` where that is above 0.
inline ImageF noise_image(int width, int height, unsigned seed, float hot = 0) {
    ImageF image(width, height, 3);
    std::mt19937 engine(seed);
    for (float& p : image.pixels()) p = 0.1f + float(engine() % 1024) / 1024;
    if (hot > 0)
        for (int c = 0; c < 3; ++c) image.at(width / 3, height / 3)[c] = hot;
    return image;
}

/// Every instruction set gives the same levels, to 1e-6 RMS.
inline void check_instruction_sets_agree(ImageView<const float> image, const FilterOptions& options) {
    std::optional<FilterResult> first;
    for (const char* set : {"SCALAR", "SSE4", "AVX2", "AVX3"}) {
        simd::limit_instruction_set(set);
        ImageRowSource source(image);
        auto result = prefilter(source, options);
        REQUIRE(result);
        if (!first) {
            first = std::move(*result);
            continue;
        }
        for (std::size_t l = 0; l < options.specular.size(); ++l) {
            double error2 = 0, sum2 = 0;
            const auto a = first->specular[l].pixels(), b = result->specular[l].pixels();
            for (std::size_t i = 0; i < a.size(); ++i)
                error2 += (a[i] - double(b[i])) * (a[i] - double(b[i])), sum2 += double(a[i]) * a[i];
            CHECK_MESSAGE(std::sqrt(error2 / sum2) <= 1e-6, set << ", level " << l << ": " << std::sqrt(error2 / sum2));
        }
    }
    simd::limit_instruction_set("");
}

}  // namespace domelight::test
