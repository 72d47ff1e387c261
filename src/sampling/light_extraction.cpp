#include "domelight/sampling/light_extraction.h"

#include "domelight/base/parallel.h"
#include "domelight/image/colour.h"

#include "base/field_place.h"
#include "base/sort.h"
#include "base/text.h"
#include "sampling/bright_regions.h"
#include "sampling/harmonic_fill.h"
#include "sampling/radiance_check.h"
#include "sampling/texel_sphere.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace domelight {
namespace {

Vec3d rgb(const float* p) {
    return {p[0], p[1], p[2]};
}
double largest(const Vec3d& v) {
    return std::max({v.x, v.y, v.z});
}

ImageF copy(ImageView<const float> image) {
    ImageF out = ImageF::uninitialized(image.width, image.height, 3);
    for (int y = 0; y < image.height; ++y) std::copy_n(image.row(y), 3 * image.width, out.row(y));
    return out;
}

/// Radiance times solid angle over all texels, summed by rows so that the result does not depend on threads.
Vec3d power_of(ImageView<const float> image, int threads) {
    std::vector<Vec3d> rows(image.height);
    parallel_ranges(image.height, 16, threads, [&](int begin, int end) {
        for (int y = begin; y < end; ++y)
            for (int x = 0; x < image.width; ++x) rows[y] += rgb(image.at(x, y));
    });
    Vec3d sum;
    for (int y = 0; y < image.height; ++y) sum += rows[y] * latlong_solid_angle(y, image.width, image.height);
    return sum;
}

/// The light taken from one texel.
struct Piece {
    Vec3d direction;      ///< source frame
    Vec3d power;          ///< radiance times solid angle
    double weight;        ///< its luminance
    double own_variance;  ///< of the texel's area about its centre, on one axis (the mean of both), radians^2
};

std::vector<Piece> taken_from(ImageView<const float> before, ImageView<const float> after, const TexelSphere& sphere,
                              const BrightRegion& region) {
    std::vector<Piece> pieces;
    for (const std::int64_t t : region.texels) {
        const int x = sphere.column(t), y = sphere.row(t);
        const Vec3d power = (rgb(before.at(x, y)) - rgb(after.at(x, y))) * sphere.solid_angle(t);
        const double high = k_pi / sphere.height(), wide = 2 * k_pi / sphere.width() * sphere.sine(y);
        pieces.push_back(
            {sphere.direction(t), power, std::max(0.0, luminance(power)), (high * high + wide * wide) / 24});
    }
    return pieces;
}

Vec3d middle(const std::vector<Piece>& pieces, const Vec3d& axis, double cosine) {
    Vec3d sum;
    for (const Piece& p : pieces)
        if (dot(p.direction, axis) >= cosine) sum += p.direction * p.weight;
    return length(sum) > 0 ? normalize(sum) : axis;
}

/// Diameter (radians) of the uniform disc with the pieces' second moment.
///
/// A disc of radius R has the mean square distance R^2 / 2 from its centre, so D = 2 R = 2 sqrt(2 m2). Sheppard's
/// correction: texels' centres spread by the variance of a texel more than the light itself, and both axes count. Only
/// what lies within one and a half radii (and a texel) counts, found by iteration: a skirt of glare that holds a few
/// percent of the light far out would else decide.
double disc_diameter(const std::vector<Piece>& pieces, Vec3d axis, double texel) {
    double diameter = 0, reach = k_pi;
    for (int step = 0; step < 30; ++step) {
        const double cosine = std::cos(reach) - 1e-15;
        axis = middle(pieces, axis, cosine);
        double weight = 0, moment = 0;
        for (const Piece& p : pieces) {
            if (dot(p.direction, axis) < cosine) continue;
            const Vec3d off = p.direction - axis;  // its length squared is the angle's to the fourth order
            weight += p.weight;
            moment += p.weight * (dot(off, off) - 2 * p.own_variance);
        }
        if (!(weight > 0)) break;
        diameter = 2 * std::sqrt(2 * std::max(0.0, moment / weight));
        const double next = 0.75 * diameter + texel;
        if (next >= reach) break;
        reach = next;
    }
    return diameter;
}

void put_back(const TexelSphere& sphere, const BrightRegion& region, ImageView<const float> before,
              ImageView<float> remainder) {
    for (const std::int64_t t : region.texels)
        std::copy_n(before.at(sphere.column(t), sphere.row(t)), 3, remainder.at(sphere.column(t), sphere.row(t)));
}

/// Luminance of the brightest texel around a region, as it is filled.
double brightest_filled(const TexelSphere& sphere, const BrightRegion& region, ImageView<const float> filled) {
    double most = 0;
    for (const std::int64_t t : region.texels)
        most = std::max(most, luminance(rgb(filled.at(sphere.column(t), sphere.row(t)))));
    return most;
}

/// The lights are replaced by their continued surroundings. If a light would be negative in a channel (a red lamp on a
/// blue wall), each texel of that channel keeps the lower of the two values.
void take_out(const TexelSphere& sphere, const std::vector<BrightRegion>& regions, ImageView<const float> before,
              ImageView<float> remainder) {
    std::vector<std::int64_t> all;
    for (const BrightRegion& region : regions) all.insert(all.end(), region.texels.begin(), region.texels.end());
    harmonic_fill(sphere, all, remainder);
    for (const BrightRegion& region : regions)
        for (int c = 0; c < 3; ++c) {
            double power = 0;
            for (const std::int64_t t : region.texels) {
                const int x = sphere.column(t), y = sphere.row(t);
                power += (double(before.at(x, y)[c]) - remainder.at(x, y)[c]) * sphere.solid_angle(t);
            }
            if (power >= 0) continue;
            for (const std::int64_t t : region.texels) {
                float& value = remainder.at(sphere.column(t), sphere.row(t))[c];
                value = std::min(value, before.at(sphere.column(t), sphere.row(t))[c]);
            }
        }
}

ExtractedLight describe(ImageView<const float> before, ImageView<const float> after, const TexelSphere& sphere,
                        const BrightRegion& region, double total_luminance, double texel, const Mat3& world_to_source) {
    const std::vector<Piece> pieces = taken_from(before, after, sphere, region);
    ExtractedLight light;
    for (const Piece& p : pieces) {
        light.irradiance += p.power;
        light.texels += p.weight > 0;
    }
    light.share = luminance(light.irradiance) / total_luminance;
    if (!(light.share > 0)) return light;
    const Vec3d axis = middle(pieces, pieces[0].direction, -2);
    const UV uv = latlong_uv(axis);
    light.direction = normalize(world_to_source.transposed() * axis);
    light.u = uv.u;
    light.v = uv.v;
    const double diameter = disc_diameter(pieces, axis, texel);
    light.resolved = diameter > texel;
    light.angular_diameter_deg = std::max(diameter, texel) * 180 / k_pi;
    const double quarter = std::sin(std::max(diameter, texel) / 4);
    light.mean_radiance = light.irradiance / (4 * k_pi * quarter * quarter);  // over 2 pi (1 - cos(D / 2))
    light.colour = light.irradiance / largest(light.irradiance);
    const double rim = brightest_filled(sphere, region, after);
    light.contrast = rim > 0 ? region.peak / rim : std::numeric_limits<double>::infinity();
    return light;
}

/// Selects the lights that satisfy the options, and of those the strongest, as many as are wanted.
std::vector<char> which_hold(const std::vector<ExtractedLight>& lights, const LightExtractionOptions& options) {
    std::vector<std::size_t> fine;
    for (std::size_t i = 0; i < lights.size(); ++i)
        if (lights[i].share > 0 && lights[i].share >= options.least_share &&
            lights[i].contrast >= options.least_contrast)
            fine.push_back(i);
    sort_stably(fine, [&](auto a, auto b) { return lights[a].share > lights[b].share; });
    if (fine.size() > std::size_t(options.max_lights)) fine.resize(std::size_t(options.max_lights));
    std::vector<char> holds(lights.size(), 0);
    for (const std::size_t i : fine) holds[i] = 1;
    return holds;
}

double unaccounted(const LightExtractionReport& r) {
    const Vec3d rest = r.original_power - r.light_power - r.remainder_power;
    const auto relative = [](double difference, double whole) { return whole > 0 ? std::abs(difference) / whole : 0; };
    return std::max({relative(rest.x, r.original_power.x), relative(rest.y, r.original_power.y),
                     relative(rest.z, r.original_power.z)});
}

}  // namespace

Result<void> check_light_extraction_options(const LightExtractionOptions& o) {
    const auto within = [](const char* field, double value, double low, double high) -> Result<void> {
        if (value >= low && value <= high) return {};
        return Error{text(value, " is not from ", low, " to ", high), field_place(field), ""};
    };
    if (auto ok = within("max_lights", o.max_lights, 0, 1024); !ok) return ok;
    if (auto ok = within("least_share", o.least_share, 0, 1); !ok) return ok;
    if (auto ok = within("least_contrast", o.least_contrast, 1.5, 1e6); !ok) return ok;
    if (auto ok = within("largest_diameter_deg", o.largest_diameter_deg, 1e-3, 30); !ok) return ok;
    return within("merge_deg", o.merge_deg, 0, 30);
}

Result<LightExtraction> extract_lights(ImageView<const float> image, const LightExtractionOptions& options,
                                       const Mat3& world_to_source) {
    if (auto ok = check_light_extraction_options(options); !ok) return ok.error();
    if (auto ok = check_radiance(image, options.threads); !ok) return ok.error();
    const TexelSphere sphere(image.width, image.height);
    LightExtraction out;
    out.remainder = copy(image);
    LightExtractionReport& report = out.report;
    report.original_power = power_of(image, options.threads);
    const double total = luminance(report.original_power);
    const double texel = std::max(k_pi / image.height, 2 * k_pi / image.width);
    report.texel_deg = texel * 180 / k_pi;

    std::vector<BrightRegion> kept;
    if (total > 0 && report.texel_deg <= options.largest_diameter_deg) {
        std::vector<float> grey(std::size_t(sphere.size()));
        parallel_ranges(image.height, 16, options.threads, [&](int begin, int end) {
            for (int y = begin; y < end; ++y)
                for (int x = 0; x < image.width; ++x)
                    grey[std::size_t(y) * image.width + x] = float(luminance(rgb(image.at(x, y))));
        });
        BrightRegions found = find_bright_regions(sphere, grey, total / (4 * k_pi), options);
        report.candidates = found.sources;
        for (BrightRegion& region : found.regions)
            // With a margin, because the surroundings may be darker than the level down to which the source was
            // followed.
            if (region.stands_out && region.power >= 0.25 * options.least_share * total &&
                kept.size() < 2 * std::size_t(options.max_lights) + 8)
                kept.push_back(std::move(region));
            else
                ++report.left_out;
    }
    // The final rim decides: a source beside brighter ones may have less light than its level suggested, or too little
    // contrast. A source that is put back may be part of another one's rim, so this is repeated.
    for (bool all_hold = false; !all_hold;) {
        take_out(sphere, kept, image, out.remainder.view());
        std::vector<ExtractedLight> lights;
        for (const BrightRegion& region : kept)
            lights.push_back(describe(image, out.remainder.view(), sphere, region, total, texel, world_to_source));
        const std::vector<char> holds = which_hold(lights, options);
        all_hold = true;
        std::vector<BrightRegion> holding;
        out.lights.clear();
        for (std::size_t i = 0; i < kept.size(); ++i) {
            if (holds[i]) {
                out.lights.push_back(lights[i]);
                holding.push_back(std::move(kept[i]));
                continue;
            }
            all_hold = false;
            ++report.left_out;
            put_back(sphere, kept[i], image, out.remainder.view());
        }
        kept = std::move(holding);
    }
    for (const ExtractedLight& light : out.lights) report.light_power += light.irradiance;
    sort_stably(out.lights, [](const auto& a, const auto& b) { return a.share > b.share; });
    report.remainder_power = power_of(out.remainder.view(), options.threads);
    report.unaccounted = unaccounted(report);
    return out;
}

}  // namespace domelight
