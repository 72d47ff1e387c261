#include "pictures.h"

#include "domelight/preview/preview.h"
#include "domelight/sampling/environment_sampler.h"

#include "base/field_place.h"
#include "environment.h"
#include "io/picture/png_memory.h"
#include "keywords.h"
#include "maps.h"
#include "preview/sample_picture.h"
#include "preview/screen_picture.h"
#include "work.h"


#include <algorithm>
#include <cmath>

namespace domelight::python {
namespace {

nb::bytes png_of(const Image<std::uint8_t>& picture) {
    const PngBytes bytes = value_of(encode_png(picture.view()));
    return nb::bytes(bytes.data(), bytes.size());
}

/// The picture that a function draws without the interpreter's lock.
template <typename F>
nb::bytes drawn(const F& draw) {
    return png_of(run_work_for(nb::none(), [&](const Progress&) { return draw(); }));
}

nb::bytes environment_picture(const Environment& environment, int height) {
    return drawn([&] {
        const ImageF image = value_of(world_latlong(environment, std::clamp(environment.latlong_height(), 1, height), 0));
        return screen_picture(image, {}, {Tonemap::agx, float(std::exp2(automatic_ev(image)))});
    });
}

/// The contact sheet of a chain.
nb::bytes levels_picture(nb::handle levels, const nb::dict& dictionary) {
    const Keywords words(dictionary);
    const std::vector<FilteredMap> maps = maps_of(levels, "levels");
    std::vector<double> roughness, exponents;
    PreviewInput input;
    words.read("roughness", roughness);
    words.read("exponents", exponents);
    words.read("title", input.title);
    words.read("subtitle", input.subtitle);
    for (std::size_t l = 0; l < maps.size(); ++l) {
        PreviewLevel& level = input.specular.emplace_back();
        level.map = &maps[l];
        if (l < roughness.size()) level.roughness = roughness[l], level.alpha = roughness[l] * roughness[l];
        if (l < exponents.size() && exponents[l] > 0)
            level.detail = std::isinf(exponents[l]) ? "the environment" : "exponent " + std::to_string(int(exponents[l]));
    }
    return drawn([&] { return contact_sheet(input); });
}

/// Samples on the environment; `array` as Samples.array.
nb::bytes samples_picture(const EnvironmentSampler& sampler, nb::handle array, const nb::dict& dictionary) {
    nb::ndarray<const float, nb::ndim<2>, nb::c_contig, nb::device::cpu> rows;
    if (!nb::try_cast(array, rows, false) || rows.shape(0) != 9)
        throw Failure({"expected float32 of shape (9, n)", field_place("array"), ""});
    const Keywords words(dictionary);
    SamplePictureOptions options;
    words.read("title", options.title);
    words.read("subtitle", options.subtitle);
    words.read("width", options.width);
    std::vector<LightSample> samples(rows.shape(1));
    for (std::size_t i = 0; i < samples.size(); ++i) samples[i].u = rows(0, i), samples[i].v = rows(1, i);
    return drawn([&] { return sample_picture(sampler, samples, options); });
}

nb::bytes density(const EnvironmentSampler& sampler, const nb::dict& dictionary) {
    const Keywords words(dictionary);
    SamplePictureOptions options;
    DensityMeasure measure = DensityMeasure::solid_angle;
    words.read("title", options.title);
    words.read("subtitle", options.subtitle);
    words.read("width", options.width);
    words.read("measure", measure);
    return drawn([&] { return density_picture(sampler, measure, options); });
}

/// Radiance as a display shows it: bytes of the same shape.
nb::object for_screen(nb::handle array, const nb::dict& dictionary) {
    const Keywords words(dictionary);
    const ArrayImage image(ArrayPixels::borrow(array, 3, "image"));
    Display display;
    std::optional<double> ev;
    words.read("tonemap", display.method);
    words.read("ev", ev);
    return numpy_of(run_work_for(nb::none(), [&](const Progress&) {
        display.exposure = float(std::exp2(ev ? *ev : automatic_ev(image.view())));
        return screen_picture(image.view(), {}, display);
    }));
}

nb::bytes png(nb::handle array) {
    nb::ndarray<const std::uint8_t, nb::c_contig, nb::device::cpu> bytes;
    if (!nb::try_cast(array, bytes, false) || bytes.ndim() < 2 || bytes.ndim() > 3)
        throw Failure({"expected bytes of shape (height, width) or (height, width, 3)", field_place("image"), ""});
    const int channels = bytes.ndim() == 2 ? 1 : int(bytes.shape(2));
    if (channels != 1 && channels != 3 && channels != 4)
        throw Failure({"a PNG has 1, 3 or 4 channels", field_place("image"), ""});
    const ImageView<const std::uint8_t> view(bytes.data(), int(bytes.shape(1)), int(bytes.shape(0)), channels);
    const PngBytes file = run_work_for(nb::none(), [&](const Progress&) { return value_of(encode_png(view)); });
    return nb::bytes(file.data(), file.size());
}

}  // namespace

void declare_pictures(nb::module_& module) {
    module.def("environment_picture", &environment_picture, nb::arg("environment"), nb::arg("height"));
    module.def("levels_picture", &levels_picture, nb::arg("levels"), nb::arg("options"));
    module.def("samples_picture", &samples_picture, nb::arg("sampler"), nb::arg("array"), nb::arg("options"));
    module.def("density_picture", &density, nb::arg("sampler"), nb::arg("options"));
    module.def("for_screen", &for_screen, nb::arg("image"), nb::arg("options"));
    module.def("png", &png, nb::arg("image"));
}

}  // namespace domelight::python
