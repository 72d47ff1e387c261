#include "preview/lights_sheet.h"

#include "domelight/base/parallel.h"
#include "domelight/projection/projection.h"

#include "image/draw.h"
#include "preview/agx_display.h"
#include "preview/dark_page.h"
#include "preview/preview_map.h"
#include "preview/tonemap.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace domelight {
namespace {

constexpr Colour8 k_mark{255, 96, 64};
constexpr int k_table_line = 22;  // pixels, from one line to the next

void draw_environment(ImageView<std::uint8_t> sheet, Rect where, PreviewMap map, const AgxDisplay& look, int threads) {
    map.transform([&](const Texel4& radiance) { return look.primaries(radiance); });
    parallel_for(where.height, threads, [&](int y) {
        for (int x = 0; x < where.width; ++x) {
            const Vec3d d = latlong_direction({(x + 0.5) / where.width, (y + 0.5) / where.height});
            const std::uint32_t code = look.code(map.at(map.place(Vec3f(d))));
            std::uint8_t* p = sheet.at(where.x + x, where.y + y);
            for (int c = 0; c < 3; ++c) p[c] = std::uint8_t(code >> 8 * c);
        }
    });
}

/// The points at `away` radians from a direction, on the picture: a line two pixels wide, stretched with the picture
/// near the poles and cut at its edges.
///
/// The distance of every pixel from the line is computed: the distance from the ring over its slope on the picture.
void draw_ring(ImageView<std::uint8_t> sheet, Rect where, const Vec3d& direction, double away) {
    const auto angle = [&](double x, double y) {
        const Vec3d d = latlong_direction({x / where.width, y / where.height});
        return 2 * std::asin(std::min(1.0, length(d - direction) / 2));
    };
    const double pixel = k_pi / where.height;
    for (int y = 0; y < where.height; ++y)
        for (int x = 0; x < where.width; ++x) {
            const double here = angle(x + 0.5, y + 0.5);
            if (std::abs(here - away) > 4 * pixel) continue;
            const double slope =
                std::hypot(angle(x + 1, y + 0.5) - angle(x, y + 0.5), angle(x + 0.5, y + 1) - angle(x + 0.5, y));
            const double off = std::abs(here - away) / std::max(slope, 0.05 * pixel);
            if (off < 2.4)
                blend(sheet, where.x + x, where.y + y, {0, 0, 0}, float(std::clamp(2.4 - off, 0.0, 1.0)) * 0.6f);
            if (off < 1.4) blend(sheet, where.x + x, where.y + y, k_mark, float(std::clamp(1.4 - off, 0.0, 1.0)));
        }
}

/// A light's number beside its ring, within the picture, dark all around so that it can be read on any background.
void draw_number(ImageView<std::uint8_t> sheet, Rect where, const Vec3d& direction, double away, int number) {
    const std::string text = std::to_string(number);
    const UV uv = latlong_uv(direction);
    const double radius = away / k_pi * where.height;
    const int width = text_width(text, FontSize::large);
    int x = where.x + int(uv.u * where.width + 0.8 * radius) + 4, y = where.y + int(uv.v * where.height - 0.7 * radius);
    if (x + width > where.x + where.width - 2) x -= int(1.6 * radius) + 8 + width;
    y = std::clamp(y, where.y + 22, where.y + where.height - 6);
    for (const auto& [dx, dy] : {std::pair{-2, 0}, {2, 0}, {0, -2}, {0, 2}, {-1, -1}, {1, -1}, {-1, 1}, {1, 1}})
        draw_text(sheet, x + dx, y + dy, text, FontSize::large, {0, 0, 0});
    draw_text(sheet, x, y, text, FontSize::large, k_mark);
}

std::string describe(const ExtractedLight& light, int number) {
    const Vec3d& d = light.direction;
    return fmt::format(
        "{}   {:.1f} % of the light   azimuth {:.1f}°, elevation {:.1f}°   {}{:.2g}° across   irradiance {:.4g} {:.4g} "
        "{:.4g}",
        number, 100 * light.share, std::atan2(d.z, d.x) * 180 / k_pi,
        std::atan2(d.y, std::hypot(d.x, d.z)) * 180 / k_pi, light.resolved ? "" : "under ", light.angular_diameter_deg,
        light.irradiance.x, light.irradiance.y, light.irradiance.z);
}

}  // namespace

Image<std::uint8_t> lights_sheet(const LightsSheetInput& in) {
    const int width = std::max(in.width, 800), picture = (width - 2 * k_margin - k_gap) / 4 * 2, height = picture / 2;
    const int listed = std::min(int(in.lights.size()), 32);
    const int top = k_margin + 44, list = top + height + 46,
              total = list + std::max(listed, 1) * k_table_line + k_margin - 8;
    Image<std::uint8_t> sheet(width, total, 3);
    fill(sheet.view(), {0, 0, width, total}, k_background);

    // The exposure is chosen for the remainder, because the sun does not determine how bright the rest should look.
    const double average = log_average_luminance(in.remainder);
    const AgxDisplay look(float(average > 0 ? std::clamp(0.18 / average, 1e-18, 1e18) : 1));
    const Rect left{k_margin, top, picture, height}, right{width - k_margin - picture, top, picture, height};
    draw_environment(sheet.view(), left, PreviewMap(in.environment, height, in.world_to_source), look, in.threads);
    draw_environment(sheet.view(), right, PreviewMap(in.remainder, height, in.world_to_source), look, in.threads);
    for (int i = 0; i < int(in.lights.size()); ++i) {
        const ExtractedLight& light = in.lights[i];
        const double away = std::max(0.5 * light.angular_diameter_deg, 0.0) * k_pi / 180 + 9 * k_pi / height;
        draw_ring(sheet.view(), left, light.direction, away);
        draw_number(sheet.view(), left, light.direction, away, i + 1);
    }

    draw_text(sheet.view(), k_margin, k_margin + 20, fit_text(in.title, FontSize::large, width - 2 * k_margin - 300),
              FontSize::large, k_bright);
    draw_text(sheet.view(), width - k_margin, k_margin + 20,
              fmt::format("exposure {:+.2f} EV, AgX", std::log2(look.exposure())), FontSize::small, k_quiet,
              Align::right);
    draw_text(sheet.view(), left.x, top + height + 20, "environment and its lights", FontSize::small, k_quiet);
    draw_text(sheet.view(), right.x, top + height + 20, "remainder", FontSize::small, k_quiet);
    for (int i = 0; i < listed; ++i)
        draw_text(sheet.view(), k_margin, list + i * k_table_line + 14,
                  fit_text(describe(in.lights[i], i + 1), FontSize::small, width - 2 * k_margin), FontSize::small,
                  k_text);
    if (listed == 0) draw_text(sheet.view(), k_margin, list + 14, "no light stands out", FontSize::small, k_text);
    return sheet;
}

}  // namespace domelight
