#include "cli/render/render_outputs.h"

#include "domelight/image/colour.h"
#include "domelight/io/file/file_extension.h"
#include "domelight/io/write_image.h"

#include "preview/tonemap.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace domelight::cli {

void ExposureMeter::add(const RenderResult& r, bool background_shows) {
    for (int y = 0; y < r.radiance.height(); ++y)
        for (int x = 0; x < r.radiance.width(); ++x) {
            const double opacity = *r.opacity.at(x, y), shown = luminance(r.radiance.at(x, y));
            if (!std::isfinite(shown)) continue;
            // Behind a part of the pixel nothing shows, so the rest of it shone the brighter.
            if (opacity > 0)
                surfaces_.push_back({background_shows ? shown : shown / opacity, opacity});
            else
                background_.push_back({shown, 1});
        }
    pixels_ += double(r.radiance.width()) * r.radiance.height();
}

double ExposureMeter::mean(const std::vector<Shown>& shown) {
    double sum = 0, weights = 0;
    for (const Shown& s : shown) sum += s.weight * s.luminance, weights += s.weight;
    return weights > 0 ? sum / weights : 0;
}

/// The luminance that `part` of what is brighter than `darkest` lies below; 0 where nothing is brighter.
double ExposureMeter::quantile(std::vector<Shown> shown, double part, double darkest) {
    std::erase_if(shown, [&](const Shown& s) { return !(s.luminance > darkest); });
    if (shown.empty()) return 0;
    std::ranges::sort(shown, {}, &Shown::luminance);
    double weights = 0, below = 0;
    for (const Shown& s : shown) weights += s.weight;
    for (const Shown& s : shown)
        if ((below += s.weight) >= part * weights) return s.luminance;
    return shown.back().luminance;
}

double ExposureMeter::ev() const {
    double covered = 0;
    for (const Shown& s : surfaces_) covered += s.weight;
    const bool any = covered > 1e-4 * pixels_;
    const std::vector<Shown>& shown = any ? surfaces_ : background_;
    const double average = mean(shown);
    if (!(average > 0)) return 0;
    const double floor = 1e-3 * average;
    double sum = 0, weights = 0;
    for (const Shown& s : shown) sum += s.weight * std::log(std::max(floor, s.luminance)), weights += s.weight;
    double exposure = 0.18 / std::exp(sum / weights);
    constexpr double most_shown = 4;
    if (const double bright = quantile(shown, 0.95, floor); bright > 0)
        exposure = std::min(exposure, most_shown / bright);
    if (const double behind = quantile(background_, 0.5, 0); any && behind > 0)
        exposure = std::min(exposure, most_shown / behind);
    return std::log2(exposure);
}

std::string exposure_text(const RenderWords& w, double ev) {
    return std::ranges::any_of(w.outputs, is_screen_picture) ? fmt::format(", exposure {:+.2f} EV", ev) : "";
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
