#include "domelight/study/render_study.h"

#include "domelight/base/random.h"
#include "domelight/compare/metrics.h"
#include "domelight/render/shading/shading.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace domelight {
namespace {

constexpr LightStrategy k_strategies[] = {LightStrategy::environment, LightStrategy::brdf, LightStrategy::mis};

/// The direction of the round lights: above, in front of and to the left of the scene.
Vec3d light_direction() {
    return normalize(Vec3d{-0.55, 0.9, 0.6});
}

/// A disc of the given diameter in the dark. Texels on its edge are weighted by the part that the disc covers, sampled
/// at 4 x 4 points.
ImageF round_light(double diameter_deg) {
    constexpr int width = 1024, height = 512, points = 4;
    const double radius = diameter_deg * k_pi / 360, cosine = std::cos(radius), s = std::sin(radius);
    // The irradiance from a disc of radiance L and angular radius ρ that faces the surface is π L sin² ρ.
    const double radiance = 1 / (s * s);
    const Vec3d towards = light_direction();
    ImageF image(width, height, 3);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            // For most texels, the distance of their centre from the edge decides.
            const auto direction = [&](double i, double j) {
                const double phi = 2 * k_pi * (i / width - 0.5), theta = k_pi * j / height;
                return Vec3d{std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)};
            };
            const double off = std::acos(std::clamp(dot(direction(x + 0.5, y + 0.5), towards), -1.0, 1.0)) - radius;
            if (off > k_pi / height) continue;
            int inside = points * points;
            if (off > -k_pi / height) {
                inside = 0;
                for (int k = 0; k < points * points; ++k)
                    inside += dot(direction(x + (k % points + 0.5) / points, y + (k / points + 0.5) / points),
                                  towards) >= cosine;
            }
            for (int c = 0; c < 3; ++c) image.at(x, y)[c] += float(radiance * inside / double(points * points));
        }
    return image;
}

Scene with_roughness(const Scene& scene, double roughness) {
    Scene out = scene;
    for (Material& m : out.materials) {
        m.roughness = float(roughness);
        // The texture's green channel would be multiplied with the roughness, and its metalness belongs to the scene's
        // own materials.
        if (m.metallic_roughness_texture) m.metallic_roughness_texture = {};
    }
    return out;
}

Result<EnvironmentSampler> sampler_for(const StudyLight& light, LightStrategy strategy, int threads) {
    return EnvironmentSampler::build(light.image, reference_sampler_options(strategy, threads), light.world_to_source);
}

RenderOptions base_options(const StudyScene& scene, const RenderStudyOptions& o) {
    RenderOptions r;
    r.width = r.height = o.size;
    r.camera = scene.camera;
    r.seed = o.seed;
    r.threads = o.threads;
    return r;
}

/// Reports the work of many renders as one progress.
class Work {
  public:
    Work(const Progress& progress, double total) : progress_(progress), total_(total) {}
    /// Begins a render that is `part` of the whole work; the render's progress is included in this one.
    Result<RenderResult> render(const RayScene& scene, const EnvironmentSampler& sampler, RenderOptions o,
                                double part) {
        o.progress = inner(part);
        auto result = render_reference(scene, sampler, o);
        done_ += part;
        return result;
    }
    Result<RenderResult> shade(const RayScene& scene, const LightMaps& maps, const EnvironmentSampler& sampler,
                               RenderOptions o, double part) {
        o.progress = inner(part);
        auto result = render_shaded(scene, maps, sampler, {}, o);
        done_ += part;
        return result;
    }

  private:
    Progress inner(double part) {
        if (!progress_) return {};
        return [this, part](std::string_view, double done) {
            return progress_("study", std::min(1.0, (done_ + part * done) / total_));
        };
    }
    const Progress& progress_;
    double total_, done_ = 0;
};

double slope_of(const std::vector<NoiseLine::Point>& points) {
    double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (const NoiseLine::Point& p : points) {
        if (!(p.error > 0)) continue;
        const double x = std::log(p.samples), y = std::log(p.error);
        n += 1, sx += x, sy += y, sxx += x * x, sxy += x * y;
    }
    return n >= 2 ? (n * sxy - sx * sy) / (n * sxx - sx * sx) : 0;
}

/// 1 where the picture shows the object that counts, 0 elsewhere; empty if every object counts.
ImageF mask_of(const RenderResult& truth, int object) {
    if (object <= 0) return {};
    ImageF mask(truth.object.width(), truth.object.height(), 1);
    for (std::size_t i = 0; i < mask.pixels().size(); ++i)
        mask.pixels()[i] = int(truth.object.pixels()[i]) == object && truth.opacity.pixels()[i] >= 1;
    return mask;
}

float tone(float l) {
    return l > 0 ? l / (1 + l) : 0;
}

}  // namespace

const char* strategy_label(LightStrategy s) {
    return s == LightStrategy::environment ? "environment" : s == LightStrategy::brdf ? "BRDF" : "MIS";
}

StudyScene study_ball() {
    StudyScene study;
    study.name = "ball on a floor";
    study.object = 1;
    Scene& scene = study.scene;
    Material metal, plastic;
    metal.name = "metal";
    metal.base_color = {0.93f, 0.9f, 0.86f};
    plastic.name = "plastic";
    plastic.metalness = 0;
    plastic.base_color = {0.32f, 0.36f, 0.42f};
    scene.materials = {metal, plastic};
    // The unit sphere of the scene "furnace", on a floor at y = −1.
    Scene furnace = std::move(*built_in_scene("furnace"));
    Mesh ball = std::move(furnace.meshes[0]);
    ball.material = 0;
    Mesh floor;
    floor.name = "floor";
    floor.material = 1;
    constexpr float half = 40;
    floor.positions = {{-half, -1, half}, {half, -1, half}, {half, -1, -half}, {-half, -1, -half}};
    floor.normals.assign(4, {0, 1, 0});
    floor.indices = {0, 1, 2, 0, 2, 3};
    scene.meshes = {std::move(ball), std::move(floor)};
    scene.instances = {{0, {}, "ball"}, {1, {}, "floor"}};
    study.camera = look_at({0, 1.3f, 6}, {0, -0.12f, 0}, 0.44f);
    return study;
}

std::vector<StudyLight> round_lights() {
    std::vector<StudyLight> lights;
    for (const int diameter : {2, 8, 30, 90}) {
        lights.push_back({double(diameter), fmt::format("{}°", diameter), round_light(diameter), {}});
    }
    return lights;
}

const StrategyCell& StrategyFigure::at(bool occlusion, double r, int light, LightStrategy strategy) const {
    return *std::find_if(cells.begin(), cells.end(), [&](const StrategyCell& c) {
        return c.occlusion == occlusion && c.roughness == r && c.light == light && c.strategy == strategy;
    });
}

Result<StrategyFigure> study_light_strategies(const StudyScene& study, StudyLight environment,
                                              const RenderStudyOptions& o) {
    StrategyFigure figure;
    figure.roughness = {0.05, 0.2, 0.45, 0.8};
    figure.lights = round_lights();
    figure.lights.push_back(std::move(environment));
    figure.one_object = study.object > 0;
    figure.samples = o.samples;
    figure.reference_samples = 16 * o.samples;
    const double cells = double(figure.roughness.size() * figure.lights.size()) * 2;
    Work work(o.progress, cells * (figure.reference_samples + 3.0 * o.samples));
    // Two samplers for each light: one with the full density, and one with the compensated density that suits MIS.
    std::vector<std::vector<EnvironmentSampler>> samplers;
    for (const StudyLight& light : figure.lights) {
        samplers.emplace_back();
        for (const LightStrategy s : {LightStrategy::environment, LightStrategy::mis}) {
            auto sampler = sampler_for(light, s, o.threads);
            if (!sampler) return sampler.error();
            samplers.back().push_back(std::move(*sampler));
        }
    }
    for (const double roughness : figure.roughness) {
        const auto scene = RayScene::build(with_roughness(study.scene, roughness));
        if (!scene) return scene.error();
        for (int l = 0; l < int(figure.lights.size()); ++l)
            for (const bool occlusion : {false, true}) {
                RenderOptions r = base_options(study, o);
                r.occlusion = occlusion;
                const auto draw = [&](LightStrategy strategy, int samples, std::uint64_t seed) -> Result<RenderResult> {
                    r.strategy = strategy;
                    r.samples = samples;
                    r.seed = seed;
                    return work.render(*scene, samplers[std::size_t(l)][strategy == LightStrategy::mis], r, samples);
                };
                // A different seed, because with the same points the errors would be the same.
                const auto truth = draw(LightStrategy::mis, figure.reference_samples, derive_key(o.seed, 0x54727574));
                if (!truth) return truth.error();
                const ImageF mask = mask_of(*truth, study.object);
                for (const LightStrategy s : k_strategies) {
                    auto picture = draw(s, o.samples, o.seed);
                    if (!picture) return picture.error();
                    const double error =
                        compare_images(picture->radiance, truth->radiance, mask, o.threads).tone_mapped_rmse;
                    figure.cells.push_back({occlusion, roughness, l, s, error, std::move(picture->radiance)});
                }
            }
    }
    return figure;
}

Result<NoiseFigure> study_noise(const StudyScene& study, const StudyLight& environment, const RenderStudyOptions& o) {
    NoiseFigure figure;
    figure.roughness = 0.3;
    figure.reference_samples = 128 * o.samples;
    std::vector<int> counts;
    for (int n = 1; n <= 16 * o.samples; n *= 4) counts.push_back(n);
    double each = 0;
    for (const int n : counts) each += n;
    Work work(o.progress, 2 * (figure.reference_samples + 3 * each));
    const auto scene = RayScene::build(with_roughness(study.scene, figure.roughness));
    if (!scene) return scene.error();
    for (const bool occlusion : {false, true}) {
        RenderOptions r = base_options(study, o);
        r.occlusion = occlusion;
        std::optional<RenderResult> truth;
        for (const LightStrategy s : {LightStrategy::mis, LightStrategy::environment, LightStrategy::brdf}) {
            const auto sampler = sampler_for(environment, s, o.threads);
            if (!sampler) return sampler.error();
            r.strategy = s;
            if (!truth) {
                r.samples = figure.reference_samples;
                r.seed = derive_key(o.seed, 0x54727574);
                auto drawn = work.render(*scene, *sampler, r, r.samples);
                if (!drawn) return drawn.error();
                truth = std::move(*drawn);
            }
            NoiseLine line{occlusion, s, {}, 0};
            r.seed = o.seed;
            for (const int n : counts) {
                r.samples = n;
                auto picture = work.render(*scene, *sampler, r, n);
                if (!picture) return picture.error();
                const double error = compare_images(picture->radiance, truth->radiance, {}, o.threads).tone_mapped_rmse;
                line.points.push_back({n, error, std::move(picture->radiance)});
            }
            line.slope = slope_of(line.points);
            figure.lines.push_back(std::move(line));
        }
    }
    return figure;
}

namespace {

/// Sums over the pixels of a bin.
struct Bin {
    double squares = 0, difference = 0;
    std::int64_t values = 0;
};

/// The direction to the eye from where the ray through the pixel's centre meets the scene.
Vec3f view_direction(const Camera& camera, int x, int y, int size) {
    const Affine& m = camera.to_world;
    if (camera.orthographic) return normalize(m.z);
    const float half = std::tan(0.5f * camera.fov_y);
    return -normalize(m.vector(
        {(2 * (float(x) + 0.5f) / float(size) - 1) * half, (1 - 2 * (float(y) + 0.5f) / float(size)) * half, -1}));
}

void add_to_bins(std::vector<Bin>& bins, const RenderResult& test, const RenderResult& truth, const Camera& camera,
                 int object) {
    const int size = truth.radiance.width();
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            // Only pixels that the object covers completely: the normals of edge pixels are mixed.
            if (*truth.opacity.at(x, y) < 1 || (object > 0 && int(*truth.object.at(x, y)) != object)) continue;
            const float* n = truth.normal.at(x, y);
            const Vec3f normal{n[0], n[1], n[2]};
            const float l = length(normal);
            if (!(l > 0.9f)) continue;  // a mean of the normals of two surfaces
            const float NdotV = std::clamp(dot(normal, view_direction(camera, x, y, size)) / l, 0.f, 1.f);
            Bin& bin = bins[std::size_t(std::min(int(NdotV * float(bins.size())), int(bins.size()) - 1))];
            for (int c = 0; c < 3; ++c) {
                const double d = tone(test.radiance.at(x, y)[c]) - tone(truth.radiance.at(x, y)[c]);
                bin.squares += d * d;
                bin.difference += d;
            }
            bin.values += 3;
        }
}

}  // namespace

Result<SplitSumFigure> study_split_sum(const StudyScene& study, const StudyLight& environment,
                                       const RenderStudyOptions& o) {
    SplitSumFigure figure;
    for (int i = 0; i <= 10; ++i) figure.roughness.push_back(i / 10.0);
    figure.samples = 4 * o.samples;
    figure.views = 3;
    const int rows = int(figure.roughness.size()), shaded_samples = std::max(4, o.samples / 2);
    // A path with bounces takes about three times as long as direct light.
    Work work(o.progress, double(rows) * figure.views * (4.0 * figure.samples + shaded_samples));
    const auto maps = LightMaps::bake(environment.image, environment.world_to_source, o.threads);
    if (!maps) return maps.error();
    const auto sampler = sampler_for(environment, LightStrategy::mis, o.threads);
    if (!sampler) return sampler.error();
    const auto [low, high] = study.scene.bounds();
    const Vec3f centre = study.object > 0 ? Vec3f{} : (low + high) * 0.5f;

    std::vector<Bin> all[2];
    double noise[2] = {};
    for (const bool occlusion : {false, true})
        figure.parts.push_back({occlusion, ImageF(figure.bins, rows, 1), ImageF(figure.bins, rows, 1), 0, 0, {}});
    for (int row = 0; row < rows; ++row) {
        const auto scene = RayScene::build(with_roughness(study.scene, figure.roughness[std::size_t(row)]));
        if (!scene) return scene.error();
        std::vector<Bin> bins[2] = {std::vector<Bin>(std::size_t(figure.bins)),
                                    std::vector<Bin>(std::size_t(figure.bins))};
        for (int view = 0; view < figure.views; ++view) {
            RenderOptions r = base_options(study, o);
            const Mat3 turn = rotation_y(2 * k_pi * view / figure.views);
            const auto turned = [&](const Vec3f& v) { return Vec3f(turn * Vec3d(v)); };
            Affine& m = r.camera.to_world;
            m = {turned(m.x), turned(m.y), turned(m.z), centre + turned(m.translation - centre)};
            r.samples = shaded_samples;
            auto shaded = work.shade(*scene, *maps, *sampler, r, r.samples);
            if (!shaded) return shaded.error();
            r.samples = figure.samples;
            for (const bool occlusion : {false, true}) {
                r.occlusion = occlusion;
                r.bounces = occlusion ? 4 : 0;
                auto truth = work.render(*scene, *sampler, r, (occlusion ? 3.0 : 1.0) * r.samples);
                if (!truth) return truth.error();
                add_to_bins(bins[occlusion], *shaded, *truth, r.camera, study.object);
                noise[occlusion] += truth->noise * truth->noise;
                if (view == 0) figure.parts[occlusion].pictures.push_back(std::move(truth->radiance));
            }
            if (view == 0) figure.pictures.push_back(std::move(shaded->radiance));
        }
        for (const bool occlusion : {false, true})
            for (int b = 0; b < figure.bins; ++b) {
                const Bin& bin = bins[occlusion][std::size_t(b)];
                const double n = double(bin.values);
                *figure.parts[occlusion].error.at(b, row) = n > 0 ? float(std::sqrt(bin.squares / n)) : NAN;
                *figure.parts[occlusion].difference.at(b, row) = n > 0 ? float(bin.difference / n) : NAN;
                all[occlusion].push_back(bin);
            }
    }
    for (const bool occlusion : {false, true}) {
        Bin sum;
        for (const Bin& b : all[occlusion]) sum.squares += b.squares, sum.values += b.values;
        figure.parts[occlusion].rmse = sum.values > 0 ? std::sqrt(sum.squares / double(sum.values)) : 0;
        figure.parts[occlusion].noise = std::sqrt(noise[occlusion] / (rows * figure.views));
    }
    return figure;
}

}  // namespace domelight
