// FLIP: Andersson, Nilsson, Akenine-Moeller, Oskarsson, Astrom, Fairchild 2020, "FLIP: A difference evaluator for
// alternating images". Section and equation numbers are that paper's. HDR-FLIP is in flip_hdr.cpp.
#include "domelight/base/parallel.h"
#include "domelight/compare/metrics.h"

#include "compare/flip_linear.h"
#include "compare/plane_filter.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <utility>

namespace domelight {
namespace {

// Section 4.3, and table 1.
constexpr float k_qc = 0.7f, k_pc = 0.4f, k_pt = 0.95f, k_qf = 0.5f;
constexpr double k_w = 0.082;  ///< width of a feature, degrees

// --- colour spaces ---

// Linear sRGB to CIE XYZ, and the white (1, 1, 1) that both opponent spaces are relative to.
constexpr double k_xyz[3][3] = {{10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794},
                                {2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897},
                                {1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382}};
constexpr double white(int i) {
    return k_xyz[i][0] + k_xyz[i][1] + k_xyz[i][2];
}

/// XYZ divided by the white's.
Vec3f relative_xyz(const Vec3f& rgb) {
    const auto row = [&](int i) {
        return (float(k_xyz[i][0] / white(i)) * rgb.x + float(k_xyz[i][1] / white(i)) * rgb.y) +
               float(k_xyz[i][2] / white(i)) * rgb.z;
    };
    return {row(0), row(1), row(2)};
}

/// Linear CIELAB: the opponent space in which sensitivity to contrast is modelled (section 4.1.1, eq. 1).
Vec3f ycxcz(const Vec3f& rgb) {
    const Vec3f n = relative_xyz(rgb);
    return {116 * n.y - 16, 500 * (n.x - n.y), 200 * (n.y - n.z)};
}

/// The inverse of k_xyz / white, by cofactors.
struct InverseXyz {
    float m[3][3];
    InverseXyz() {
        double a[3][3];
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) a[i][j] = k_xyz[i][j] / white(i);
        const auto cofactor = [&](int i, int j) {
            const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
            return a[i1][j1] * a[i2][j2] - a[i1][j2] * a[i2][j1];
        };
        const double determinant = a[0][0] * cofactor(0, 0) + a[0][1] * cofactor(0, 1) + a[0][2] * cofactor(0, 2);
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) m[j][i] = float(cofactor(i, j) / determinant);
    }
};

Vec3f rgb_of_ycxcz(const Vec3f& v) {
    static const InverseXyz inverse;
    const float y = (v.x + 16) / 116, x = y + v.y / 500, z = y - v.z / 200;
    const auto row = [&](int i) { return inverse.m[i][0] * x + inverse.m[i][1] * y + inverse.m[i][2] * z; };
    return {row(0), row(1), row(2)};
}

/// CIELAB's cube root, which is linear near 0.
float lab_curve(float t) {
    constexpr float delta = 6.0f / 29;
    return t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4.0f / 29;
}

/// CIELAB, its chroma scaled by lightness for the Hunt effect (section 4.1.2, eq. 3).
Vec3f hunt_lab(const Vec3f& rgb) {
    const Vec3f n = relative_xyz(rgb);
    const float fx = lab_curve(n.x), fy = lab_curve(n.y), fz = lab_curve(n.z);
    const float l = 116 * fy - 16;
    return {l, 0.01f * l * 500 * (fx - fy), 0.01f * l * 200 * (fy - fz)};
}

/// The HyAB distance: city block in lightness, Euclidean in chroma (eq. 4).
float hyab(const Vec3f& a, const Vec3f& b) {
    return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

/// Compresses differences to [0, 1] (eq. 5 and 6): those below k_pc of the largest are mapped to [0, k_pt].
float redistribute(float difference) {
    static const float largest = std::pow(hyab(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1})), k_qc);
    const float d = std::pow(difference, k_qc), knee = k_pc * largest;
    return d < knee ? k_pt / knee * d : k_pt + (d - knee) / (largest - knee) * (1 - k_pt);
}

// --- filters ---

/// The taps of a Gaussian, a √(π / b) exp(−π² x² / b) in the paper's notation (table 1). They are normalised, so only b
/// matters.
Taps gaussian(double pixels_per_degree, double b, int radius) {
    Taps taps;
    for (int i = -radius; i <= radius; ++i) {
        const double x = i / pixels_per_degree;
        taps.push_back(float(std::exp(-k_pi * k_pi * x * x / b)));
    }
    return taps;
}
double sum(const Taps& taps) {
    double total = 0;
    for (const float t : taps) total += t;
    return total;
}
Taps scaled(Taps taps, double factor) {
    for (float& t : taps) t = float(t * factor);
    return taps;
}

/// Sensitivity to contrast as a filter in each opponent channel (section 4.1.1): Gaussians, the blue-yellow one a sum
/// of two.
struct SensitivityFilters {
    Taps y, cx, cz1, cz2;
    explicit SensitivityFilters(double ppd) {
        const int radius = int(std::ceil(3 * std::sqrt(0.04 / (2 * k_pi * k_pi)) * ppd));
        y = gaussian(ppd, 0.0047, radius);
        cx = gaussian(ppd, 0.0053, radius);
        cz1 = gaussian(ppd, 0.04, radius);
        cz2 = gaussian(ppd, 0.025, radius);
        y = scaled(y, 1 / sum(y));
        cx = scaled(cx, 1 / sum(cx));
        // In two dimensions the Gaussians are weighted by a √(π / b); the sum of a 2D kernel is the square of the sum
        // of its taps.
        const double w1 = 34.1 * std::sqrt(k_pi / 0.04), w2 = 13.5 * std::sqrt(k_pi / 0.025);
        const double total = w1 * sum(cz1) * sum(cz1) + w2 * sum(cz2) * sum(cz2);
        cz1 = scaled(cz1, std::sqrt(w1 / total));
        cz2 = scaled(cz2, std::sqrt(w2 / total));
    }
};

/// First and second derivatives of a Gaussian, scaled so that the positive taps add up to 1 and the negative ones to −1
/// (section 4.2).
struct FeatureFilters {
    Taps smooth, edge, point;
    explicit FeatureFilters(double ppd) {
        const double sigma = 0.5 * k_w * ppd;
        const int radius = int(std::ceil(3 * sigma));
        for (int i = -radius; i <= radius; ++i) {
            const double g = std::exp(-i * i / (2 * sigma * sigma));
            smooth.push_back(float(g));
            edge.push_back(float(-i * g));
            point.push_back(float((i * i / (sigma * sigma) - 1) * g));
        }
        smooth = scaled(smooth, 1 / sum(smooth));
        edge = balanced(edge);
        point = balanced(point);
    }
    static Taps balanced(Taps taps) {
        double positive = 0, negative = 0;
        for (const float t : taps) (t > 0 ? positive : negative) += t;
        for (float& t : taps) t = float(t > 0 ? t / positive : -t / negative);
        return taps;
    }
};

// --- one image as input of the two pipelines ---

struct Seen {
    ImageF lab;          ///< filtered, Hunt-adjusted CIELAB, 3 channels
    ImageF edge, point;  ///< magnitudes of the feature filters, one channel
};

/// √(h^2 + v^2).
ImageF magnitude(const ImageF& h, const ImageF& v) {
    ImageF out(h.width(), h.height(), 1);
    for (std::size_t i = 0; i < out.pixels().size(); ++i)
        out.pixels()[i] = std::sqrt(h.pixels()[i] * h.pixels()[i] + v.pixels()[i] * v.pixels()[i]);
    return out;
}

Seen see(ImageView<const float> rgb, const SensitivityFilters& sensitivity, const FeatureFilters& features,
         int threads) {
    const int width = rgb.width, height = rgb.height;
    ImageF plane[3];
    for (ImageF& p : plane) p = ImageF(width, height, 1);
    parallel_for(height, threads, [&](int y) {
        for (int x = 0; x < width; ++x) {
            const float* p = rgb.at(x, y);
            const Vec3f v = ycxcz({p[0], p[1], p[2]});
            *plane[0].at(x, y) = v.x, *plane[1].at(x, y) = v.y, *plane[2].at(x, y) = v.z;
        }
    });
    const auto filter = [&](const ImageF& p, const Taps& along, const Taps& down) {
        return filter_plane(p.view(), along, down, threads);
    };
    const ImageF y_seen = filter(plane[0], sensitivity.y, sensitivity.y);
    const ImageF cx_seen = filter(plane[1], sensitivity.cx, sensitivity.cx);
    const ImageF cz1 = filter(plane[2], sensitivity.cz1, sensitivity.cz1);
    const ImageF cz2 = filter(plane[2], sensitivity.cz2, sensitivity.cz2);

    Seen seen;
    seen.lab = ImageF(width, height, 3);
    parallel_for(height, threads, [&](int y) {
        for (int x = 0; x < width; ++x) {
            const Vec3f c = rgb_of_ycxcz({*y_seen.at(x, y), *cx_seen.at(x, y), *cz1.at(x, y) + *cz2.at(x, y)});
            const auto unit = [](float v) { return std::clamp(v, 0.0f, 1.0f); };
            const Vec3f lab = hunt_lab({unit(c.x), unit(c.y), unit(c.z)});
            float* out = seen.lab.at(x, y);
            out[0] = lab.x, out[1] = lab.y, out[2] = lab.z;
        }
    });
    for (float& v : plane[0].pixels()) v = (v + 16) / 116;  // to [0, 1]
    seen.edge =
        magnitude(filter(plane[0], features.edge, features.smooth), filter(plane[0], features.smooth, features.edge));
    seen.point =
        magnitude(filter(plane[0], features.point, features.smooth), filter(plane[0], features.smooth, features.point));
    return seen;
}

float linear_of_srgb(float v) {
    v = std::clamp(v, 0.0f, 1.0f);
    return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
}

}  // namespace

ImageF flip_linear(ImageView<const float> test, ImageView<const float> reference, const FlipOptions& options,
                   int threads) {
    assert(options.pixels_per_degree > 0 && test.width == reference.width && test.height == reference.height);
    const SensitivityFilters sensitivity(options.pixels_per_degree);
    const FeatureFilters features(options.pixels_per_degree);
    const Seen a = see(reference, sensitivity, features, threads), b = see(test, sensitivity, features, threads);
    ImageF error(test.width, test.height, 1);
    parallel_for(test.height, threads, [&](int y) {
        for (int x = 0; x < test.width; ++x) {
            const float *p = a.lab.at(x, y), *q = b.lab.at(x, y);
            const float colour = redistribute(hyab({p[0], p[1], p[2]}, {q[0], q[1], q[2]}));
            const float feature = std::max(std::abs(*a.edge.at(x, y) - *b.edge.at(x, y)),
                                           std::abs(*a.point.at(x, y) - *b.point.at(x, y)));
            const float strength = std::pow(std::clamp(feature / std::sqrt(2.0f), 0.0f, 1.0f), k_qf);  // eq. 8
            *error.at(x, y) = std::clamp(std::pow(colour, 1 - strength), 0.0f, 1.0f);                  // eq. 9
        }
    });
    return error;
}

ImageF flip(ImageView<const float> test_srgb, ImageView<const float> reference_srgb, const FlipOptions& options,
            int threads) {
    const auto linear = [&](ImageView<const float> image) {
        ImageF out(image.width, image.height, 3);
        parallel_for(image.height, threads, [&](int y) {
            for (int i = 0; i < 3 * image.width; ++i) out.row(y)[i] = linear_of_srgb(image.row(y)[i]);
        });
        return out;
    };
    return flip_linear(linear(test_srgb).view(), linear(reference_srgb).view(), options, threads);
}

}  // namespace domelight
