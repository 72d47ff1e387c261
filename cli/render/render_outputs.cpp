#include "cli/render/render_outputs.h"

#include "domelight/io/file/atomic_file.h"
#include "domelight/io/file/file_extension.h"
#include "domelight/io/write_image.h"

#include "preview/screen_picture.h"
#include "preview/tonemap.h"
#include "render/render_layers.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace domelight::cli {

std::string exposure_text(const RenderWords& w, double ev) {
    return std::ranges::any_of(w.outputs, is_screen_picture) ? fmt::format(", exposure {:+.2f} EV", ev) : "";
}

namespace {

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

/// The picture as a display shows it, before a background colour that exposure and tone map do not change.
Image<std::uint8_t> over_display_colour(const RenderResult& r, const Vec3f& colour, const Display& display) {
    Image<std::uint8_t> pixels(r.radiance.width(), r.radiance.height(), 3);
    for (int y = 0; y < pixels.height(); ++y)
        for (int x = 0; x < pixels.width(); ++x) {
            const float *p = r.radiance.at(x, y), opacity = std::clamp(*r.opacity.at(x, y), 0.f, 1.f);
            // The radiance comes only from the covered part of the pixel.
            Vec3f c{p[0], p[1], p[2]};
            if (opacity > 0) c = c / opacity;
            const Vec3f shown = tonemap(c * display.exposure, display.method) * opacity + colour * (1 - opacity);
            const float channels[] = {shown.x, shown.y, shown.z};
            for (int i = 0; i < 3; ++i) pixels.at(x, y)[i] = to_byte(display.curve(std::clamp(channels[i], 0.f, 1.f)));
        }
    return pixels;
}

}  // namespace

Image<std::uint8_t> display_picture(const RenderResult& r, const RenderWords& w, double ev) {
    const Display display{w.tonemap, float(std::exp2(ev))};
    if (w.backdrop == Background::colour) return over_display_colour(r, w.backdrop_colour, display);
    const bool transparent = w.backdrop == Background::transparent;
    return screen_picture(r.radiance, transparent ? r.opacity.view() : ImageView<const float>(), display, w.threads());
}

Result<void> write_picture(const std::string& file, const FinishedPicture& picture, const Scene& scene,
                           const RenderWords& w) {
    const RenderResult& r = picture.result;
    if (is_screen_picture(file)) return write_screen_picture(file, display_picture(r, w, picture.ev).view());
    const bool colour = w.backdrop == Background::colour;
    const ImageF over = colour ? over_colour(r, w.backdrop_colour) : ImageF();
    const ImageView<const float> radiance = colour ? over.view() : r.radiance.view();
    if (lower_case_extension(file) == ".hdr") return write_hdr(file, radiance, w.threads());
    return write_render_layers(file, r, radiance, scene);
}

Result<void> write_pictures(const std::vector<std::string>& files, const FinishedPicture& picture, const Scene& scene,
                            const RenderWords& w) {
    FileGroup group;
    for (const std::string& file : files) {
        const auto write = [&](const std::filesystem::path& place) {
            return write_picture(place.string(), picture, scene, w);
        };
        if (auto ok = group.write(file, write); !ok) return ok;
    }
    return group.commit();
}

}  // namespace domelight::cli
