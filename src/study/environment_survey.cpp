#include "domelight/study/environment_survey.h"

#include "domelight/filtering/prefilter.h"
#include "domelight/filtering/resample/area_resample.h"
#include "domelight/image/colour.h"
#include "domelight/projection/projections.h"

#include "bake/tap.h"

#include <algorithm>
#include <cmath>

namespace domelight {
namespace {

void note_range(EnvironmentSurvey& survey, std::span<const float> values) {
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    survey.least = std::min(survey.least, *low);
    survey.largest = std::max(survey.largest, *high);
}

/// A connected part of a lat-long image that is much brighter than the mean.
struct Blob {
    Vec3d sum;  ///< sum of the directions, each weighted by its power
    double power = 0, peak = 0;
    double core = 0;  ///< solid angle of the texels at least half as bright as the peak
};

/// The texels whose luminance exceeds `threshold` and that are connected to `start`, also across the seam. They are
/// marked as taken.
Blob grow_blob(const ImageF& image, int start, double threshold, std::vector<char>& taken) {
    const int width = image.width(), height = image.height();
    const auto texel_luminance = [&](int i) { return luminance(image.at(i % width, i / width)); };
    Blob blob;
    blob.peak = texel_luminance(start);
    std::vector<int> front{start};
    taken[start] = 1;
    while (!front.empty()) {
        const int i = front.back(), x = i % width, y = i / width;
        front.pop_back();
        const double omega = latlong_solid_angle(y, width, height), power = omega * texel_luminance(i);
        blob.sum += latlong_direction({(x + 0.5) / width, (y + 0.5) / height}) * power;
        blob.power += power;
        if (texel_luminance(i) >= 0.5 * blob.peak) blob.core += omega;
        for (const auto& [dx, dy] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
            if (y + dy < 0 || y + dy >= height) continue;
            const int j = (y + dy) * width + (x + dx + width) % width;
            if (taken[j] || texel_luminance(j) <= threshold) continue;
            taken[j] = 1;
            front.push_back(j);
        }
    }
    return blob;
}

BrightLight describe(const Blob& blob, double total) {
    BrightLight light;
    light.direction = normalize(blob.sum);
    light.azimuth_deg = std::atan2(light.direction.z, light.direction.x) * 180 / k_pi;
    light.elevation_deg = std::atan2(light.direction.y, std::hypot(light.direction.x, light.direction.z)) * 180 / k_pi;
    light.share = blob.power / total;
    light.radius_deg = std::acos(std::max(-1.0, 1 - blob.core / (2 * k_pi))) * 180 / k_pi;
    return light;
}

/// The bright sources of a lat-long image in world directions: connected parts brighter than ten times the mean
/// radiance, with at least a thousandth of all power. Parts within 5 degrees of a brighter one are counted as one with
/// it (for example the sun behind twigs). At most five, the strongest first.
std::vector<BrightLight> find_lights(const ImageF& image) {
    const int width = image.width(), height = image.height();
    double total = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) total += luminance(image.at(x, y)) * latlong_solid_angle(y, width, height);
    const double threshold = 10 * total / (4 * k_pi);
    std::vector<int> bright;
    for (int i = 0; i < width * height; ++i)
        if (luminance(image.at(i % width, i / width)) > threshold) bright.push_back(i);
    std::stable_sort(bright.begin(), bright.end(), [&](int i, int j) {
        return luminance(image.at(i % width, i / width)) > luminance(image.at(j % width, j / width));
    });
    std::vector<char> taken(std::size_t(width) * height, 0);
    std::vector<Blob> blobs;  // brightest peak first
    for (const int i : bright) {
        if (taken[i]) continue;
        const Blob blob = grow_blob(image, i, threshold, taken);
        const auto close = std::find_if(blobs.begin(), blobs.end(), [&](const Blob& b) {
            return dot(b.sum, blob.sum) > std::cos(5 * k_pi / 180) * length(b.sum) * length(blob.sum);
        });
        if (close == blobs.end()) {
            blobs.push_back(blob);
        } else {
            close->sum += blob.sum;
            close->power += blob.power;
        }
    }
    std::vector<BrightLight> lights;
    for (const Blob& blob : blobs)
        if (blob.power >= 1e-3 * total && length(blob.sum) > 0) lights.push_back(describe(blob, total));
    std::stable_sort(lights.begin(), lights.end(), [](const auto& a, const auto& b) { return a.share > b.share; });
    if (lights.size() > 5) lights.resize(5);
    return lights;
}

}  // namespace

Result<EnvironmentSurvey> survey_environment(const Environment& environment, int threads, const Progress& progress) {
    EnvironmentSurvey survey;
    survey.least = INFINITY;
    FilterOptions filter;
    filter.irradiance_size = 1;  // the middle of each face of a 1^2 cube is its axis
    filter.sh_bands = 1;
    filter.world_to_source = environment.world_to_source;
    filter.threads = threads;
    filter.progress = progress;
    Result<FilterResult> result = Error{};
    ImageF world;
    if (const Cubemap* cube = environment.cube()) {
        note_range(survey, cube->pixels());
        result = prefilter(*cube, filter);
        if (result)
            world = area_resample_cube_to_latlong(*cube, std::min(2 * cube->size(), 512), environment.world_to_source,
                                                  threads);
    } else {
        const auto rows = environment.rows();
        if (!rows) return rows.error();
        const int width = (*rows)->width(), height = (*rows)->height();
        const auto resampler =
            area_resample_to_latlong(width, height, std::min(height, 512), environment.world_to_source, threads);
        TapRowSource tap(**rows, [&](ImageView<const float> block) {
            resampler->add_rows(block);
            for (int y = 0; y < block.height; ++y)
                note_range(survey, {block.row(y), std::size_t(block.width) * block.channels});
        });
        result = prefilter(tap, filter);
        if (result) world = resampler->finish();
    }
    if (!result) return result.error();
    survey.mean_radiance = result->mean;
    for (int f = 0; f < 6; ++f) {
        const float* e = result->irradiance_over_pi.face(f).at(0, 0);
        survey.irradiance[f] = Vec3d(e[0], e[1], e[2]) * k_pi;
    }
    survey.lights = find_lights(world);
    return survey;
}

}  // namespace domelight
