#include "domelight/sampling/environment_sampler.h"

#include "domelight/base/parallel.h"
#include "domelight/projection/projection.h"

#include "sampling/distribution/texel_float.h"
#include "sampling/light_samples.h"
#include "sampling/radiance_check.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace domelight {
namespace {

/// The least value used for the sine of the colatitude, so that densities stay finite at the poles.
constexpr float k_least_sine = 1e-7f;
constexpr float k_uniform_density = float(1 / (4 * k_pi));

struct Grayscale {
    float r, g, b;
    float operator()(const float* p) const { return r * p[0] + g * p[1] + b * p[2]; }
};

Grayscale grayscale(LightWeight weight) {
    if (weight == LightWeight::grayscale) return {0.2989f, 0.5866f, 0.1145f};
    return {0.2126f, 0.7152f, 0.0722f};
}

/// The weight of texels: max(luminance - delta, 0) sin theta, or the plain grayscale. A row's solid angles are (2 pi /
/// W) 2 sin(pi / 2H) sin theta, so sin theta at its centre is exact for texels.
Weights weights_of(ImageView<const float> image, LightWeight weight, double delta) {
    return {image.width, image.height, [=](int y, std::span<float> room) -> std::span<const float> {
                const Grayscale gray = grayscale(weight);
                const float sine =
                    weight == LightWeight::grayscale ? 1.f : float(std::sin(k_pi * (y + 0.5) / image.height));
                const float* p = image.row(y);
                for (int x = 0; x < image.width; ++x) room[x] = std::max(gray(p + 3 * x) - float(delta), 0.f) * sine;
                return room;
            }};
}

/// Mean over the sphere, and the largest value, of the luminance.
struct Luminance {
    double mean = 0, largest = 0;
};
Luminance survey(ImageView<const float> image, LightWeight weight, int threads) {
    std::vector<Luminance> rows(image.height);
    parallel_ranges(image.height, 16, threads, [&](int begin, int end) {
        const Grayscale gray = grayscale(weight);
        for (int y = begin; y < end; ++y) {
            const float* p = image.row(y);
            for (int x = 0; x < image.width; ++x) {
                const double value = gray(p + 3 * x);
                rows[y].mean += value;
                rows[y].largest = std::max(rows[y].largest, value);
            }
        }
    });
    Luminance all;
    for (int y = 0; y < image.height; ++y) {
        all.mean += rows[y].mean * latlong_solid_angle(y, image.width, image.height) / (4 * k_pi);
        all.largest = std::max(all.largest, rows[y].largest);
    }
    return all;
}

std::array<float, 9> floats_of(const Mat3& m) {
    std::array<float, 9> out;
    for (int i = 0; i < 3; ++i)
        out[3 * i] = float(m.row[i].x), out[3 * i + 1] = float(m.row[i].y), out[3 * i + 2] = float(m.row[i].z);
    return out;
}

}  // namespace

Result<EnvironmentSampler> EnvironmentSampler::build(EnvironmentSampler sampler) {
    const ImageView<const float> image = sampler.image_;
    EnvironmentSamplerOptions& o = sampler.options_;
    o.uniform_share = std::clamp(o.uniform_share, 0.0, 1.0);
    if (o.compensate) {
        const Luminance luminance = survey(image, o.weight, o.threads);
        // Nothing is brighter than the mean of a constant environment: only rounding errors would be sampled.
        if (luminance.largest > luminance.mean * 1.0001) sampler.compensation_ = luminance.mean;
    }
    auto distribution = make_distribution(weights_of(image, o.weight, sampler.compensation_), o.method, o.threads);
    if (!distribution) return distribution.error();
    sampler.distribution_ = std::move(*distribution);
    return sampler;
}

Result<EnvironmentSampler> EnvironmentSampler::build(ImageView<const float> latlong,
                                                     const EnvironmentSamplerOptions& options,
                                                     const Mat3& world_to_source) {
    if (auto fine = check_radiance(latlong, options.threads); !fine) return fine.error();
    EnvironmentSampler sampler;
    sampler.options_ = options;
    sampler.image_ = latlong;
    sampler.world_to_source_ = world_to_source;
    return build(std::move(sampler));
}

Result<EnvironmentSampler> EnvironmentSampler::build(const Environment& environment,
                                                     const EnvironmentSamplerOptions& options) {
    EnvironmentSampler sampler;
    sampler.options_ = options;
    auto image = environment.latlong();
    if (!image) return image.error();
    sampler.owned_ = *std::move(image);
    sampler.image_ = sampler.owned_->view();
    sampler.world_to_source_ = environment.world_to_source;
    if (auto fine = check_radiance(sampler.image_, options.threads); !fine) return fine.error();
    return build(std::move(sampler));
}

/// The radiance at a point: bilinear (u wraps, v clamps) where the density is, else the texel's.
Vec3f EnvironmentSampler::texel(float u, float v) const {
    const int w = image_.width, h = image_.height;
    if (!distribution_->continuous()) {
        const float* p = image_.at(std::min(int(double(u) * w), w - 1), std::min(int(double(v) * h), h - 1));
        return {p[0], p[1], p[2]};
    }
    const float x = u * float(w) - 0.5f, y = v * float(h) - 0.5f, fx = std::floor(x), fy = std::floor(y), s = x - fx,
                t = y - fy;
    const int x0 = fx < 0 ? w - 1 : std::min(int(fx), w - 1), x1 = fx < 0 ? 0 : int(fx) + 1 < w ? int(fx) + 1 : 0;
    const int y0 = std::clamp(int(fy), 0, h - 1), y1 = std::clamp(int(fy) + 1, 0, h - 1);
    const float *a = image_.at(x0, y0), *b = image_.at(x1, y0), *c = image_.at(x0, y1), *d = image_.at(x1, y1);
    const auto mix = [&](int k) {
        const float upper = a[k] + s * (b[k] - a[k]), lower = c[k] + s * (d[k] - c[k]);
        return std::max(upper + t * (lower - upper), 0.f);
    };
    return {mix(0), mix(1), mix(2)};
}

/// Per steradian: dω = 2 pi^2 sin(theta) du dv.
float EnvironmentSampler::density(double pdf_uv, float sin_theta) const {
    const float p = float(pdf_uv) / (float(2 * k_pi * k_pi) * std::max(sin_theta, k_least_sine)),
                share = float(options_.uniform_share);
    return share > 0 ? p + share * (k_uniform_density - p) : p;
}

LightSample EnvironmentSampler::at(float u, float v, float pdf_uv) const {
    const double phi = (double(u) - 0.5) * 2 * k_pi, theta = double(v) * k_pi, s = std::sin(theta);
    const Vec3d source{s * std::cos(phi), std::cos(theta), s * std::sin(phi)};
    return {u, v, Vec3f(world_to_source_.transposed() * source), texel(u, v), density(pdf_uv, float(s))};
}

LightSample EnvironmentSampler::uniform(UnitPoint point) const {
    const double y = 1 - 2 * unit_double(point.x), s = std::sqrt(std::max(0.0, 1 - y * y)),
                 phi = 2 * k_pi * unit_double(point.y);
    const Vec3d source{s * std::cos(phi), y, s * std::sin(phi)};
    return look_up(Vec3f(world_to_source_.transposed() * source));
}

LightSample EnvironmentSampler::sample(UnitPoint point) const {
    if (const double share = options_.uniform_share; share > 0) {
        // One number serves both: the lower part of its range chooses the uniform density, and either part is then
        // rescaled to [0, 1).
        const double x = unit_double(point.x);
        if (x < share || share >= 1) return uniform({unit_fixed(x / share), point.y});
        point.x = unit_fixed((x - share) / (1 - share));
    }
    const DistributionSample s = distribution_->sample(point);
    const auto [u, v] = float_point(s, image_.width, image_.height, distribution_->continuous());
    return at(u, v, float(s.pdf_uv));
}

void EnvironmentSampler::sample(std::span<const UnitPoint> points, const LightSampleSpans& out) const {
    if (options_.uniform_share > 0) {
        for (std::size_t i = 0; i < points.size(); ++i) {
            const LightSample s = sample(points[i]);
            out.u[i] = s.u, out.v[i] = s.v, out.x[i] = s.direction.x, out.y[i] = s.direction.y,
            out.z[i] = s.direction.z;
            out.r[i] = s.radiance.x, out.g[i] = s.radiance.y, out.b[i] = s.radiance.z,
            out.pdf_solid_angle[i] = s.pdf_solid_angle;
        }
        return;
    }
    const simd::LightImage image{image_.data, image_.stride, image_.width, image_.height, distribution_->continuous()};
    const auto turn = floats_of(world_to_source_.transposed());
    constexpr std::size_t block = 512;  // the data between the two steps stays in the first-level cache
    for (std::size_t i = 0; i < points.size(); i += block) {
        const std::size_t n = std::min(block, points.size() - i);
        const auto part = [&](std::span<float> s) { return s.subspan(i, n); };
        distribution_->sample(points.subspan(i, n), part(out.u), part(out.v), part(out.pdf_solid_angle));
        simd::complete_light_samples(image, turn, int(n), k_least_sine, out.u.data() + i, out.v.data() + i,
                                     out.pdf_solid_angle.data() + i,
                                     {out.x.data() + i, out.y.data() + i, out.z.data() + i},
                                     {out.r.data() + i, out.g.data() + i, out.b.data() + i});
    }
}

LightSample EnvironmentSampler::look_up(const Vec3f& direction) const {
    const Vec3d d = world_to_source_ * Vec3d(direction);
    const UV uv = latlong_uv(d);
    const auto inside = [](double x) { return std::min(float(x), 0x1.fffffep-1f); };
    const float u = uv.u >= 1 ? 0 : inside(uv.u), v = inside(uv.v);
    const double length = std::sqrt(dot(d, d)), sine = std::hypot(d.x, d.z) / length;
    const double pdf_uv = options_.uniform_share < 1 ? distribution_->pdf_uv(u, v) : 0;
    return {u, v, Vec3f(Vec3d(direction) / length), texel(u, v), density(pdf_uv, float(sine))};
}

void EnvironmentSampler::look_up(const LightSampleSpans& out) const {
    const simd::LightImage image{image_.data, image_.stride, image_.width, image_.height, distribution_->continuous()};
    const auto turn = floats_of(world_to_source_);
    constexpr std::size_t block = 256;
    float sines[block];
    for (std::size_t i = 0; i < out.x.size(); i += block) {
        const std::size_t n = std::min(block, out.x.size() - i);
        simd::look_up_light_samples(image, turn, int(n), {out.x.data() + i, out.y.data() + i, out.z.data() + i},
                                    out.u.data() + i, out.v.data() + i, sines,
                                    {out.r.data() + i, out.g.data() + i, out.b.data() + i});
        if (out.pdf_solid_angle.empty()) continue;
        const std::span<float> pdf = out.pdf_solid_angle.subspan(i, n);
        distribution_->pdfs_uv(out.u.subspan(i, n), out.v.subspan(i, n), pdf);
        for (std::size_t k = 0; k < n; ++k) pdf[k] = density(pdf[k], sines[k]);
    }
}

float EnvironmentSampler::pdf_solid_angle(const Vec3f& direction) const {
    const Vec3d d = world_to_source_ * Vec3d(direction);
    const UV uv = latlong_uv(d);
    const double sine = std::hypot(d.x, d.z) / std::sqrt(dot(d, d));
    return density(options_.uniform_share < 1 ? distribution_->pdf_uv(uv.u >= 1 ? 0 : uv.u, uv.v) : 0, float(sine));
}

Vec3f EnvironmentSampler::radiance(const Vec3f& direction) const {
    const UV uv = latlong_uv(world_to_source_ * Vec3d(direction));
    return texel(uv.u >= 1 ? 0 : std::min(float(uv.u), 0x1.fffffep-1f), std::min(float(uv.v), 0x1.fffffep-1f));
}

std::optional<UnitPoint> EnvironmentSampler::invert(const Vec3f& direction) const {
    if (options_.uniform_share > 0) return std::nullopt;
    const UV uv = latlong_uv(world_to_source_ * Vec3d(direction));
    return distribution_->invert(uv.u >= 1 ? 0 : uv.u, uv.v);
}

SamplingTextures sampling_textures(const EnvironmentSampler& sampler) {
    const auto image = sampler.image();
    const Weights weights = weights_of(image, sampler.options().weight, sampler.compensation());
    SamplingTextures out{ImageF(1, image.height, 2), ImageF(image.width, image.height, 2), ImageF(1, image.height, 1)};
    std::vector<double> sums(image.height);
    // A cumulative row and the density beside it; all zero: uniform.
    const auto fill = [](int n, double total, const auto& weight, const auto& texel) {
        double sum = 0;
        for (int i = 0; i < n; ++i) {
            const double w = total > 0 ? weight(i) / total : 1.0 / n;
            sum += w;
            texel(i)[0] = i == n - 1 ? 1.f : float(sum);
            texel(i)[1] = float(w * n);
        }
    };
    parallel_ranges(image.height, 16, sampler.options().threads, [&](int begin, int end) {
        std::vector<float> room(image.width);
        for (int y = begin; y < end; ++y) {
            const auto row = weights.row(y, room);
            for (const float w : row) sums[y] += w;
            out.row_averages.at(0, y)[0] = float(sums[y] / image.width);
            fill(
                image.width, sums[y], [&](int x) { return double(row[x]); },
                [&](int x) { return out.columns.at(x, y); });
        }
    });
    double total = 0;
    for (const double s : sums) total += s;
    out.total_average = total / (double(image.width) * image.height);
    fill(
        image.height, total, [&](int y) { return sums[y]; }, [&](int y) { return out.rows.at(0, y); });
    return out;
}

}  // namespace domelight
