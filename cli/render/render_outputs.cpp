#include "cli/render/render_outputs.h"

#include "domelight/image/colour.h"
#include "domelight/io/file/file_extension.h"
#include "domelight/io/write_image.h"

#include "preview/tonemap.h"

#include <algorithm>
#include <cmath>

namespace domelight::cli {

double automatic_ev(const RenderResult& r, bool background_shows) {
    double covered = 0;
    for (const float o : r.opacity.pixels()) covered += o;
    const bool any = covered > 1e-4 * double(r.opacity.pixels().size());
    const auto each = [&](const auto& use) {
        for (int y = 0; y < r.radiance.height(); ++y)
            for (int x = 0; x < r.radiance.width(); ++x) {
                const double opacity = *r.opacity.at(x, y), weight = any ? opacity : 1;
                if (weight <= 0) continue;
                // Behind a part of the pixel nothing shows, so the rest of it shone the brighter.
                use(luminance(r.radiance.at(x, y)) / (any && !background_shows ? opacity : 1), weight);
            }
    };
    double mean = 0, weights = 0, sum = 0;
    each([&](double l, double w) { mean += w * l, weights += w; });
    if (!(mean > 0)) return 0;
    const double floor = 1e-3 * mean / weights;
    each([&](double l, double w) { sum += w * std::log(std::max(floor, l)); });
    return std::log2(0.18 / std::exp(sum / weights));
}

namespace {

Tonemap tonemap_of(const std::string& name) {
    for (const TonemapName& t : tonemap_names())
        if (name == t.name) return t.method;
    return Tonemap::agx;
}

/// The radiance with the colour behind it, for files that hold radiance.
ImageF over_colour(const RenderResult& r, const Vec3f& colour) {
    ImageF out(r.radiance.width(), r.radiance.height(), 3);
    for (int y = 0; y < out.height(); ++y)
        for (int x = 0; x < out.width(); ++x) {
            const float rest = 1 - *r.opacity.at(x, y), *p = r.radiance.at(x, y);
            float* q = out.at(x, y);
            q[0] = p[0] + rest * colour.x, q[1] = p[1] + rest * colour.y, q[2] = p[2] + rest * colour.z;
        }
    return out;
}

Result<void> write_layers(const std::string& file, const RenderResult& r, ImageView<const float> radiance,
                          const Scene& scene) {
    const ExrLayer layers[] = {{"", radiance, ""},           {"", r.opacity, "A"},         {"direct", r.direct, ""},
                               {"indirect", r.indirect, ""}, {"diffuse", r.diffuse, ""},   {"specular", r.specular, ""},
                               {"albedo", r.albedo, ""},     {"normal", r.normal, ""},     {"depth", r.depth, "Z"},
                               {"object", r.object, "Y"},    {"variance", r.variance, ""}, {"samples", r.samples, "Y"}};
    // `compare` names the objects of its table by it: one a line, from object 1 on.
    ExrWriteOptions options;
    std::string& names = options.attributes["objects"];
    for (const Instance& instance : scene.instances) names += instance.name + "\n";
    return write_exr_layers(file, layers, options);
}

}  // namespace

Image<std::uint8_t> display_picture(const RenderResult& r, const RenderWords& w, double ev) {
    const int width = r.radiance.width(), height = r.radiance.height();
    const bool transparent = w.backdrop == Background::transparent, colour = w.backdrop == Background::colour;
    Image<std::uint8_t> pixels(width, height, transparent ? 4 : 3);
    const Display display{tonemap_of(w.tonemap), float(std::exp2(ev))};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const float *p = r.radiance.at(x, y), opacity = std::clamp(*r.opacity.at(x, y), 0.f, 1.f);
            Vec3f c{p[0], p[1], p[2]};
            // What is behind is not in the radiance, so a part of a pixel is taken for the whole: PNG's colours are not
            // multiplied with their opacity.
            if ((transparent || colour) && opacity > 0) c = c / opacity;
            std::uint8_t* q = pixels.at(x, y);
            if (colour) {
                const Vec3f shown =
                    tonemap(c * display.exposure, display.method) * opacity + w.backdrop_colour * (1 - opacity);
                const float channels[] = {shown.x, shown.y, shown.z};
                for (int i = 0; i < 3; ++i) q[i] = to_byte(display.curve(std::clamp(channels[i], 0.f, 1.f)));
                continue;
            }
            const auto rgb = display.rgb8(c);
            std::copy(rgb.begin(), rgb.end(), q);
            if (transparent) q[3] = to_byte(opacity);
        }
    return pixels;
}

Result<void> write_picture(const std::string& file, const FinishedPicture& picture, const Scene& scene,
                           const RenderWords& w) {
    const RenderResult& r = picture.result;
    if (is_screen_picture(file)) return write_screen_picture(file, display_picture(r, w, picture.ev).view());
    const bool colour = w.backdrop == Background::colour;
    const ImageF over = colour ? over_colour(r, w.backdrop_colour) : ImageF();
    const ImageView<const float> radiance = colour ? over.view() : r.radiance.view();
    if (lower_case_extension(file) == ".hdr") return write_hdr(file, radiance, w.threads());
    return write_layers(file, r, radiance, scene);
}

Result<void> write_pictures(const std::vector<std::string>& files, const FinishedPicture& picture, const Scene& scene,
                            const RenderWords& w) {
    for (const std::string& file : files)
        if (auto ok = write_picture(file, picture, scene, w); !ok) return ok.error().at(file);
    return {};
}

}  // namespace domelight::cli
