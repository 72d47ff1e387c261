#include "domelight/base/parallel.h"
#include "domelight/environment/sky/sky.h"
#include "domelight/projection/projection.h"

#include "image/font.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace domelight {
namespace {

/// One of the six axes: its direction, right and up for a viewer who looks along it from the inside, its colour and its
/// name.
struct Axis {
    Vec3d forward, right, up;
    Vec3f colour;
    const char* name;
};

// Right is forward x up. Around the horizon up is +Y; overhead and below, up is that of a viewer who faces +X and tilts
// the head.
constexpr std::array<Axis, 6> k_axes{{
    {{1, 0, 0}, {0, 0, 1}, {0, 1, 0}, {0.80f, 0.06f, 0.05f}, "+X"},
    {{-1, 0, 0}, {0, 0, -1}, {0, 1, 0}, {0.05f, 0.55f, 0.60f}, "-X"},
    {{0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0.10f, 0.60f, 0.08f}, "+Y"},
    {{0, -1, 0}, {0, 0, 1}, {1, 0, 0}, {0.50f, 0.08f, 0.45f}, "-Y"},
    {{0, 0, 1}, {-1, 0, 0}, {0, 1, 0}, {0.07f, 0.16f, 0.85f}, "+Z"},
    {{0, 0, -1}, {1, 0, 0}, {0, 1, 0}, {0.75f, 0.60f, 0.04f}, "-Z"},
}};

constexpr double k_disc = 0.56;        // radius of an axis's disc on the plane at distance 1 (29 degrees)
constexpr double k_rim = 0.035;        // width of its white rim
constexpr double k_em = 0.52;          // size of the letters on that plane
constexpr double k_cap_height = 0.73;  // of an em

/// Coverage of a shape whose signed distance (positive inside) is `d`, by a texel of angular size `texel`.
float coverage(double d, double texel) {
    return float(std::clamp(d / texel + 0.5, 0.0, 1.0));
}

Vec3f mix(const Vec3f& a, const Vec3f& b, float t) {
    return a * (1 - t) + b * t;
}

/// Coverage of a line of half-width `half` at distance `d`; thin ones fade instead of breaking up.
float line(double d, double half, double texel) {
    const double wide = std::max(half, 0.5 * texel);
    return coverage(wide - std::abs(d), texel) * float(half / wide);
}

/// The ground that the discs lie on: grey, lighter above the horizon, with the meridians and parallels of every 15
/// degrees.
Vec3f graticule(const Vec3d& d, double texel) {
    const double elevation = std::asin(std::clamp(d.y, -1.0, 1.0)), azimuth = std::atan2(d.z, d.x), spacing = k_pi / 12;
    const auto nearest = [&](double angle) { return angle - spacing * std::round(angle / spacing); };
    Vec3f v = d.y > 0 ? Vec3f{0.24f, 0.25f, 0.27f} : Vec3f{0.11f, 0.10f, 0.09f};
    // Slightly warmer towards +X and cooler towards -X, brighter towards +Z than -Z, so that no two quarters are alike
    // even between the discs.
    v = v + Vec3f{0.05f, 0.0f, -0.05f} * float(d.x) + Vec3f{0.04f, 0.04f, 0.04f} * float(d.z);
    const Vec3f light{0.62f, 0.62f, 0.62f};
    v = mix(v, light, 0.8f * line(nearest(elevation), 0.0028, texel));
    v = mix(v, light, 0.8f * line(nearest(azimuth) * std::cos(elevation), 0.0028, texel));
    return mix(v, {0.95f, 0.95f, 0.95f}, line(elevation, 0.006, texel));  // the horizon
}

/// Signed distance (on the tangent plane, positive inside) to an axis's name, centred at the origin.
double name_distance(const char* name, double x, double y) {
    float width = 0;
    for (const char* c = name; *c; ++c) width += font_field_advance(*c);
    float pen = -width / 2, best = -1;
    for (const char* c = name; *c; ++c) {
        best = std::max(best, font_field(*c, float(x / k_em) - pen, float(y / k_em + k_cap_height / 2)));
        pen += font_field_advance(*c);
    }
    return best * k_em;
}

Vec3f axes_radiance(const Vec3d& d, double texel) {
    Vec3f v = graticule(d, texel);
    for (const Axis& axis : k_axes) {
        const double along = dot(d, axis.forward);
        if (along < 0.72) continue;  // within 44 degrees: one axis at most
        // The plane at distance 1 (the gnomonic view); lengths on it are longer than angles by up to 1 / cos^2.
        const double x = dot(d, axis.right) / along, y = dot(d, axis.up) / along, pixel = texel / (along * along);
        const double inside = k_disc - std::hypot(x, y);
        v = mix(v, {1, 1, 1}, coverage(inside, pixel));
        v = mix(v, axis.colour, coverage(inside - k_rim, pixel));
        // An arrow that points up, and a dot at the upper right, by which a turn or a reflection can be recognised.
        const double arrow = std::min(y - 0.37, (0.50 - y - 1.1 * std::abs(x)) / std::hypot(1.0, 1.1));
        v = mix(v, {1, 1, 1}, coverage(arrow, pixel));
        v = mix(v, {1, 1, 1}, coverage(0.045 - std::hypot(x - 0.30, y - 0.32), pixel));
        v = mix(v, {1, 1, 1}, coverage(name_distance(axis.name, x, y + 0.03), pixel));
        break;
    }
    return v;
}

}  // namespace

ImageF make_axes_environment(int height) {
    ImageF image(2 * height, height, 3);
    const double texel = k_pi / height;
    parallel_for(height, 0, [&](int y) {
        float* row = image.row(y);
        for (int x = 0; x < 2 * height; ++x) {
            const Vec3f v = axes_radiance(latlong_direction({(x + 0.5) / (2 * height), (y + 0.5) / height}), texel);
            row[3 * x] = v.x;
            row[3 * x + 1] = v.y;
            row[3 * x + 2] = v.z;
        }
    });
    return image;
}

}  // namespace domelight
