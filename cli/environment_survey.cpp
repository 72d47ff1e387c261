#include "environment_survey.h"

#include "domelight/area_resample.h"
#include "domelight/prefilter.h"
#include "domelight/projection.h"

#include "bake/tap.h"

#include <algorithm>
#include <cmath>

namespace domelight::cli {
namespace {

/// Rec. 709 luminance.
double luminance(const float* rgb) {
    return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
}

void note_range(EnvironmentSurvey& survey, std::span<const float> values) {
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    survey.least = std::min(survey.least, *low);
    survey.largest = std::max(survey.largest, *high);
}

/// Small bright sources of a lat-long image in world directions: again and again the brightest texel left with what is
/// around it and at least a tenth as bright, as long as that is a thousandth of all power and ten times the mean.
std::vector<BrightLight> find_lights(const ImageF& image) {
    const int width = image.width(), height = image.height();
    std::vector<double> power(std::size_t(width) * height);
    double total = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            total += power[std::size_t(y) * width + x] =
                luminance(image.at(x, y)) * latlong_solid_angle(y, width, height);
    const double mean = total / (4 * k_pi);
    std::vector<char> taken(power.size(), 0);
    std::vector<BrightLight> lights;
    for (int attempt = 0; attempt < 16 && lights.size() < 5 && total > 0; ++attempt) {
        int peak = -1;
        double peak_luminance = 10 * mean;
        for (int i = 0; i < width * height; ++i)
            if (const double l = luminance(image.at(i % width, i / width)); !taken[i] && l > peak_luminance) {
                peak = i;
                peak_luminance = l;
            }
        if (peak < 0) break;
        Vec3d sum;
        double light_power = 0, solid_angle = 0;
        std::vector<int> front{peak};
        taken[peak] = 1;
        while (!front.empty()) {
            const int i = front.back(), x = i % width, y = i / width;
            front.pop_back();
            sum = sum + latlong_direction({(x + 0.5) / width, (y + 0.5) / height}) * power[i];
            light_power += power[i];
            solid_angle += latlong_solid_angle(y, width, height);
            for (const auto& [dx, dy] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
                if (y + dy < 0 || y + dy >= height) continue;
                const int j = (y + dy) * width + (x + dx + width) % width;
                if (taken[j] || luminance(image.at(j % width, j / width)) < 0.1 * peak_luminance) continue;
                taken[j] = 1;
                front.push_back(j);
            }
        }
        if (light_power < 1e-3 * total || length(sum) == 0) continue;
        BrightLight light;
        light.direction = normalize(sum);
        light.azimuth_deg = std::atan2(light.direction.z, light.direction.x) * 180 / k_pi;
        light.elevation_deg =
            std::atan2(light.direction.y, std::hypot(light.direction.x, light.direction.z)) * 180 / k_pi;
        light.share = light_power / total;
        light.radius_deg = std::acos(std::max(-1.0, 1 - solid_angle / (2 * k_pi))) * 180 / k_pi;
        lights.push_back(light);
    }
    std::sort(lights.begin(), lights.end(), [](const auto& a, const auto& b) { return a.share > b.share; });
    return lights;
}

}  // namespace

Result<EnvironmentSurvey> survey_environment(Environment& environment, int threads, const Progress& progress) {
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
    if (environment.latlong) {
        const int width = environment.latlong->width(), height = environment.latlong->height();
        const auto resampler =
            area_resample_to_latlong(width, height, std::min(height, 512), environment.world_to_source, threads);
        TapRowSource tap(*environment.latlong, [&](ImageView<const float> rows) {
            resampler->add_rows(rows);
            for (int y = 0; y < rows.height; ++y)
                note_range(survey, {rows.row(y), std::size_t(rows.width) * rows.channels});
        });
        result = prefilter(tap, filter);
        if (result) world = resampler->finish();
    } else {
        note_range(survey, environment.cube.pixels());
        result = prefilter(environment.cube, filter);
        if (result)
            world = area_resample_cube_to_latlong(environment.cube, std::min(2 * environment.cube.size(), 512),
                                                  environment.world_to_source, threads);
    }
    if (!result) return result.error();
    survey.mean_radiance = result->mean;
    for (int f = 0; f < 6; ++f) {
        const float* e = result->irradiance_over_pi.cube.face(f).at(0, 0);
        survey.irradiance[f] = Vec3d(e[0], e[1], e[2]) * k_pi;
    }
    survey.lights = find_lights(world);
    return survey;
}

}  // namespace domelight::cli
