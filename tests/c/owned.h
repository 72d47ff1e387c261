#pragma once
// What the tests of the C interface share: handles that free themselves, errors as text, a small environment.

#include "domelight/domelight_c.h"
#include "domelight/image/image.h"

#include "test.h"

#include <algorithm>
#include <cstring>
#include <span>
#include <string>
#include <vector>

namespace domelight::test {

/// A picture with structure at every scale and a small sun; the same numbers on every machine.
inline ImageF test_latlong(int height) {
    ImageF image(2 * height, height, 3);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < 2 * height; ++x)
            for (int c = 0; c < 3; ++c)
                image.at(x, y)[c] = float((x * 7 + y * 13 + c * 5) % 17) / 16 + float(y == height / 3);
    std::fill_n(image.at(height / 2, height / 4), 3, 900.f);
    return image;
}

inline domelight_pixels pixels_of(const ImageF& image) {
    domelight_pixels pixels;
    domelight_pixels_init(&pixels);
    pixels.data = image.pixels().data();
    pixels.width = image.width();
    pixels.height = image.height();
    return pixels;
}

/// The error's text, which is freed; empty where there was none.
inline std::string said(domelight_error* error) {
    const std::string text = error ? domelight_error_text(error) : "";
    CHECK((error == nullptr) == text.empty());
    domelight_error_free(error);
    return text;
}
#define CHECK_DONE(call) CHECK(said(call) == "")

/// A handle that is freed at the end of the scope.
template <typename Handle, void (*Free)(Handle*)>
struct Owned {
    Handle* handle = nullptr;
    Owned() = default;
    Owned(const Owned&) = delete;
    Owned& operator=(const Owned&) = delete;
    ~Owned() { Free(handle); }
    Handle** place() { return &handle; }
    operator Handle*() const { return handle; }
};
using OwnedEnvironment = Owned<domelight_environment, domelight_environment_free>;
using OwnedFiltered = Owned<domelight_filtered, domelight_filtered_free>;
using OwnedProbeFilter = Owned<domelight_probe_filter, domelight_probe_filter_free>;
using OwnedImage = Owned<domelight_image, domelight_image_free>;
using OwnedSampler = Owned<domelight_sampler, domelight_sampler_free>;
using OwnedLights = Owned<domelight_lights, domelight_lights_free>;
using OwnedTexture = Owned<domelight_texture, domelight_texture_free>;

struct TestEnvironment : OwnedEnvironment {
    explicit TestEnvironment(int height = 32) {
        const ImageF image = test_latlong(height);
        const domelight_pixels pixels = pixels_of(image);
        CHECK_DONE(domelight_environment_from_pixels(&pixels, nullptr, place()));
    }
};

inline std::span<const float> floats_of(const domelight_pixels& p) {
    return {static_cast<const float*>(p.data), std::size_t(p.width) * p.height * p.faces * p.channels};
}

inline bool same_bits(std::span<const float> a, std::span<const float> b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size_bytes()) == 0;
}

inline std::vector<domelight_level> chain(int size, int count, const char* lobe = nullptr) {
    std::vector<domelight_level> levels(count);
    for (int l = 0; l < count; ++l) {
        domelight_level_init(&levels[l]);
        levels[l].lobe = lobe;
        levels[l].size = size >> l;
        levels[l].roughness = double(l) / (count - 1);
    }
    return levels;
}

}  // namespace domelight::test
