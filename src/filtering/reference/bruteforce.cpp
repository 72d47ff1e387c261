// The truth: ∫ K(d . l) g(l) dl over the bilinear reconstruction, in double, every patch of it
// (docs/math/prefilter.md).
//
// Most patches are small compared with the distance over which the kernel changes: for them 2 x 2 Gauss-Legendre nodes
// suffice, row by row. The others, near the lobe's peak and across its horizon, are halved until they are small too,
// and have 4 x 4 nodes.
#include "domelight/base/parallel.h"
#include "domelight/filtering/reference.h"

#include "base/gauss_legendre.h"
#include "filtering/kernel/kernel_density.h"
#include "filtering/reference/source.h"

#include <cassert>

namespace domelight {
namespace {

constexpr double k_far_ratio =
    16;  ///< 2 x 2 nodes where a patch is this much shorter than the kernel's scale: their relative error is at most
         ///< 3e-7
constexpr double k_near_ratio = 2;             ///< 4 x 4 nodes likewise: 5e-7
constexpr double k_horizon_tolerance = 3e-10;  ///< quadrature error of one cell on the horizon, of the mean radiance
constexpr double k_negligible =
    1e-18;  ///< densities below this part of the peak are ignored (the exponential tails of phong and charlie)
constexpr int k_deepest = 30;

/// The kernel, with what the quadrature needs to know about it.
class Profile {
  public:
    explicit Profile(const ZonalKernel& kernel) : density_(kernel), width_(kernel.angular_width()) {
        if (is_phong(density_.lobe()))
            if (density_.power() > 0) support_ = std::min(1.0, -std::log(k_negligible) / density_.power());
        if (density_.lobe() == Lobe::charlie) hole_ = std::pow(k_negligible, 1 / density_.power());
        if (density_.lobe() != Lobe::ggx) tabulate();
    }

    const KernelDensity& density() const { return density_; }
    /// The largest h = 1 - c that matters; 1 is the horizon, where the density has a kink.
    double support() const { return support_; }
    bool meets_horizon() const { return support_ == 1; }
    /// The least h that matters: charlie is 0 around its axis.
    double hole() const { return hole_; }

    /// The distance over which the density changes, `s` = |a - b| from the axis.
    double scale(double s) const {
        switch (density_.lobe()) {
            case Lobe::ggx:
                return std::min(std::sqrt(s * s + width_ * width_), 1.0);  // pole at s = i b
            case Lobe::charlie:
                return std::min({std::max(s, 1e-3), 4 / (density_.power() + 1), 1.0});  // a cone at s = 0
            default:
                return std::min(2 / std::sqrt(density_.power() + 1), 1.0);
        }
    }
    /// Radius (chord) within which patches of this length are not far.
    double near_radius(double patch) const {
        const double wanted = k_far_ratio * patch;
        // Coarse sources have 4 x 4 nodes throughout: with 2 x 2 nodes on one half of a tent only, an error of (h /
        // L)^3 would remain.
        if (wanted > std::min(scale(2), 0.5)) return 2;
        if (density_.lobe() == Lobe::ggx) return std::sqrt(std::max(0.0, wanted * wanted - width_ * width_));
        return density_.lobe() == Lobe::charlie ? wanted : 0;
    }

    double operator()(double h) const {
        return density_.lobe() == Lobe::ggx || h < k_cone ? density_(h, 1 - h) : tabulated(h);
    }

    /// The density by cubic Hermite interpolation, good to 1e-11 of the peak away from charlie's cone at h = 0; 0
    /// beyond the support.
    double tabulated(double h) const {
        const double x = std::max(h, 0.0) * inverse_step_;
        const int i = std::min(int(x), k_intervals);
        const double t = x - i;
        const auto& p = table_[i];
        return p[0] + t * (p[1] + t * (p[2] + t * p[3]));
    }

  private:
    static constexpr int k_intervals = 8192;
    static constexpr double k_cone = 0.01;  ///< the table is too coarse for charlie below
    void tabulate() {
        table_.resize(k_intervals + 1);  // the last one is 0
        const double step = support_ / k_intervals, p = density_.power();
        inverse_step_ = 1 / step;
        const auto slope = [&](double h) {  // times the step
            const double c = 1 - h;
            if (density_.lobe() == Lobe::charlie)
                return step * density_.scale() * std::pow(std::max(h, 1e-12), p - 1) * (p * c - h);
            return p == 0 ? 0
                          : -step * density_.scale() * p *
                                std::pow(std::max(c, step), p - 1);  // steep at c = 0 where p < 1
        };
        const auto value = [&](double h) { return density_(h, std::max(1 - h, 1e-300)); };
        for (int i = 0; i < k_intervals; ++i) {
            const double a = i * step, b = std::min(1.0, (i + 1) * step);
            const double f0 = value(a), f1 = value(b), d0 = slope(a), d1 = slope(b);
            table_[i] = {f0, d0, 3 * (f1 - f0) - 2 * d0 - d1, 2 * (f0 - f1) + d0 + d1};
        }
    }

    KernelDensity density_;
    double width_;
    double support_ = 1, hole_ = 0;
    double inverse_step_ = 0;
    std::vector<std::array<double, 4>> table_;
};

struct Axis {
    double theta, phi, sin_theta, cos_theta, cos_phi, sin_phi;
    explicit Axis(const Vec3d& d)
        : theta(std::atan2(std::hypot(d.x, d.z), d.y)),
          phi(std::atan2(d.z, d.x)),
          sin_theta(std::sin(theta)),
          cos_theta(std::cos(theta)),
          cos_phi(std::cos(phi)),
          sin_phi(std::sin(phi)) {}
};

/// Half the azimuth above the horizon at a polar angle.
double horizon(const Axis& axis, double theta) {
    const double up = std::cos(theta) * axis.cos_theta, flat = std::sin(theta) * axis.sin_theta;
    return up >= flat ? k_pi : up <= -flat ? 0 : std::acos(-up / flat);
}

/// Part of a patch: azimuth from the axis's own, polar angle.
struct Cell {
    double phi0, phi1, theta0, theta1;
};

/// Integrates kernel times radiance over one patch, halving it as far as necessary.
class PatchIntegral {
  public:
    PatchIntegral(const Profile& profile, const Axis& axis, const std::array<Vec3d, 4>& corners, const Cell& patch,
                  const Vec3d& mean)
        : profile_(profile), axis_(axis), g_(corners), patch_(patch) {
        for (const Vec3d& g : g_)
            brightness_ = std::max({brightness_, relative(g.x, mean.x), relative(g.y, mean.y), relative(g.z, mean.z)});
    }
    Vec3d operator()(const Cell& cell) const { return integrate(cell, 0); }

  private:
    static double relative(double g, double mean) { return mean > 0 ? g / mean : 0; }

    /// 1 - cos of the angle from the axis, without cancellation.
    double height_below(double theta, double sin_theta, double phi) const {
        const double a = std::sin((theta - axis_.theta) / 2), b = std::sin(phi / 2);
        return 2 * (a * a + sin_theta * axis_.sin_theta * b * b);
    }

    Vec3d integrate(const Cell& cell, int depth) const {
        const double theta = (cell.theta0 + cell.theta1) / 2, phi = (cell.phi0 + cell.phi1) / 2;
        const double half = (cell.theta1 - cell.theta0) / 2;
        const double widest = std::sin(std::clamp(k_pi / 2, theta - half, theta + half));
        const double tall = 2 * half, wide = (cell.phi1 - cell.phi0) * widest, radius = (tall + wide) / 2;
        const double h = height_below(theta, std::sin(theta), phi);
        if (h - radius >= profile_.support() || h + radius < profile_.hole()) return {};

        const double limit = profile_.scale(std::max(0.0, std::sqrt(2 * h) - radius)) / k_near_ratio;
        bool split_theta = tall > limit, split_phi = wide > limit;
        bool on_horizon = profile_.meets_horizon() && h + radius > 1;
        if (on_horizon) {
            // With a kink in a cell the error is about 1/50 of the density's change across the cell. If the cell is cut
            // at the kink, except where the horizon passes through a corner, it is 1/500.
            const double change = profile_.density().scale() * std::max(tall, wide) * tall * wide * brightness_;
            if (0.002 * change > k_horizon_tolerance) split_theta = split_phi = true;
            on_horizon = 0.02 * change > k_horizon_tolerance / 10;
        }
        // Halve only the longer side while the other is much shorter, as at the poles.
        split_theta = split_theta && tall > wide / 2;
        split_phi = split_phi && wide > tall / 2;
        if (depth == k_deepest || (!split_theta && !split_phi)) return on_horizon ? leaf_on_horizon(cell) : leaf(cell);

        Vec3d sum;
        const int rows = split_theta ? 2 : 1, columns = split_phi ? 2 : 1;
        for (int i = 0; i < rows; ++i)
            for (int j = 0; j < columns; ++j)
                sum += integrate({j == 0 ? cell.phi0 : phi, j == columns - 1 ? cell.phi1 : phi,
                                       i == 0 ? cell.theta0 : theta, i == rows - 1 ? cell.theta1 : theta},
                                      depth + 1);
        return sum;
    }

    Vec3d leaf(const Cell& cell) const {
        static const GaussLegendre& rule = gauss_legendre(4);
        const double dphi = cell.phi1 - cell.phi0, dtheta = cell.theta1 - cell.theta0;
        std::array<double, 4> s, b2;  // along the patch's width; sin^2(phi / 2)
        for (int j = 0; j < 4; ++j) {
            const double phi = cell.phi0 + dphi * (1 + rule.x[j]) / 2, b = std::sin(phi / 2);
            s[j] = (phi - patch_.phi0) / (patch_.phi1 - patch_.phi0);
            b2[j] = b * b;
        }
        Vec3d sum;
        for (int i = 0; i < 4; ++i) {
            const double theta = cell.theta0 + dtheta * (1 + rule.x[i]) / 2,
                         t = (theta - patch_.theta0) / (patch_.theta1 - patch_.theta0);
            const double sin_theta = std::sin(theta), a = std::sin((theta - axis_.theta) / 2);
            const Vec3d left = g_[0] * (1 - t) + g_[2] * t, right = g_[1] * (1 - t) + g_[3] * t;
            double weight_left = 0, weight_right = 0;
            for (int j = 0; j < 4; ++j) {
                const double h = 2 * (a * a + sin_theta * axis_.sin_theta * b2[j]);
                const double k = rule.w[j] * profile_(h);
                weight_left += k * (1 - s[j]);
                weight_right += k * s[j];
            }
            sum += (left * weight_left + right * weight_right) * (rule.w[i] * sin_theta);
        }
        return sum * (dphi * dtheta / 4);
    }

    Vec3d radiance(double phi, double theta) const {
        const double s = (phi - patch_.phi0) / (patch_.phi1 - patch_.phi0),
                     t = (theta - patch_.theta0) / (patch_.theta1 - patch_.theta0);
        return (g_[0] * (1 - s) + g_[1] * s) * (1 - t) + (g_[2] * (1 - s) + g_[3] * s) * t;
    }

    /// The same, but the cell is cut at the horizon along the side that the horizon crosses more steeply, so that there
    /// is no kink between nodes.
    Vec3d leaf_on_horizon(const Cell& cell) const {
        const double phi = (cell.phi0 + cell.phi1) / 2, theta = (cell.theta0 + cell.theta1) / 2;
        const double along_theta =
            std::cos(theta) * axis_.sin_theta * std::cos(phi) - std::sin(theta) * axis_.cos_theta;  // dc / dtheta
        const double along_phi = -axis_.sin_theta * std::sin(phi);  // dc / sin theta dphi
        return std::abs(along_theta) > std::abs(along_phi) ? cut_across_theta(cell, along_theta > 0)
                                                           : cut_across_phi(cell);
    }

    /// Each of 4 azimuths sees the lobe on one side of the polar angle where c = 0.
    Vec3d cut_across_theta(const Cell& cell, bool visible_below) const {
        static const GaussLegendre& rule = gauss_legendre(4);
        Vec3d sum;
        for (int j = 0; j < 4; ++j) {
            const double phi = cell.phi0 + (cell.phi1 - cell.phi0) * (1 + rule.x[j]) / 2,
                         flat = axis_.sin_theta * std::cos(phi);
            double cut = std::atan2(axis_.cos_theta, -flat);  // modulo pi
            cut -= k_pi * std::round((cut - (cell.theta0 + cell.theta1) / 2) / k_pi);
            cut = std::clamp(cut, cell.theta0, cell.theta1);
            const double a = visible_below ? cut : cell.theta0, b = visible_below ? cell.theta1 : cut;
            for (int i = 0; i < 4; ++i) {
                const double theta = a + (b - a) * (1 + rule.x[i]) / 2, sin_theta = std::sin(theta);
                const double k = profile_(1 - (std::cos(theta) * axis_.cos_theta + sin_theta * flat));
                sum += radiance(phi, theta) * (rule.w[i] * rule.w[j] * (b - a) * k * sin_theta);
            }
        }
        return sum * ((cell.phi1 - cell.phi0) / 4);
    }

    /// Each of 4 polar angles sees the lobe between two azimuths.
    Vec3d cut_across_phi(const Cell& cell) const {
        static const GaussLegendre& rule = gauss_legendre(4);
        Vec3d sum;
        for (int i = 0; i < 4; ++i) {
            const double theta = cell.theta0 + (cell.theta1 - cell.theta0) * (1 + rule.x[i]) / 2,
                         edge = horizon(axis_, theta);
            const double up = std::cos(theta) * axis_.cos_theta, sin_theta = std::sin(theta),
                         flat = sin_theta * axis_.sin_theta;
            const double a = std::clamp(-edge, cell.phi0, cell.phi1), b = std::clamp(edge, cell.phi0, cell.phi1);
            for (int j = 0; j < 4; ++j) {
                const double phi = a + (b - a) * (1 + rule.x[j]) / 2;
                sum += radiance(phi, theta) * (rule.w[i] * rule.w[j] * (b - a) * sin_theta *
                                                    profile_(1 - (up + flat * std::cos(phi))));
            }
        }
        return sum * ((cell.theta1 - cell.theta0) / 4);
    }

    const Profile& profile_;
    const Axis& axis_;
    std::array<Vec3d, 4> g_;
    Cell patch_;
    double brightness_ = 0;  ///< of the brightest corner, times the mean
};

/// A patch row's 2 x 2 nodes, structure of arrays: node 2 x + j of either polar node carries radiance times weight.
struct RowNodes {
    std::array<double, 2> cos_theta, sin_theta;
    std::array<std::array<std::vector<double>, 3>, 2> value;
    bool ready = false;
};

const double k_node = 0.5 - 0.5 / std::sqrt(3.0);  ///< first of the two Gauss-Legendre nodes on [0, 1]

void fill(RowNodes& nodes, const ReferenceSource& source, int r) {
    const double a = source.theta_begin(r), length = source.theta_end(r) - a;
    const int above = std::max(r - 1, 0), below = std::min(r, source.height() - 1), width = source.width();
    for (int i = 0; i < 2; ++i) {
        const double t = i == 0 ? k_node : 1 - k_node, theta = a + t * length;
        nodes.cos_theta[i] = std::cos(theta);
        nodes.sin_theta[i] = std::sin(theta);
        const double weight = nodes.sin_theta[i] * length / 2 * source.patch_width() / 2;
        for (auto& channel : nodes.value[i]) channel.resize(2 * std::size_t(width));
        for (int x = 0; x < width; ++x) {
            const int next = x + 1 == width ? 0 : x + 1;
            const Vec3d left = (source.texel(x, above) * (1 - t) + source.texel(x, below) * t) * weight;
            const Vec3d right = (source.texel(next, above) * (1 - t) + source.texel(next, below) * t) * weight;
            const Vec3d first = left * (1 - k_node) + right * k_node, second = left * k_node + right * (1 - k_node);
            nodes.value[i][0][2 * x] = first.x, nodes.value[i][0][2 * x + 1] = second.x;
            nodes.value[i][1][2 * x] = first.y, nodes.value[i][1][2 * x + 1] = second.y;
            nodes.value[i][2][2 * x] = first.z, nodes.value[i][2][2 * x + 1] = second.z;
        }
    }
    nodes.ready = true;
}

/// cos and sin of the azimuths of a row's nodes.
struct Azimuths {
    std::vector<double> cosine, sine;
    explicit Azimuths(const ReferenceSource& source) {
        for (int x = 0; x < source.width(); ++x)
            for (const double s : {k_node, 1 - k_node}) {
                const double phi = source.phi_begin(x) + s * source.patch_width();
                cosine.push_back(std::cos(phi));
                sine.push_back(std::sin(phi));
            }
    }
};

/// sum_j k_j v_j for the three channels, in four interleaved partial sums: a fixed order that suits vector
/// instructions.
void add_products(const double* k, const std::array<const double*, 3>& value, int count,
                  std::array<std::array<double, 4>, 3>& sums) {
    for (int channel = 0; channel < 3; ++channel) {
        const double* v = value[channel];
        double s0 = sums[channel][0], s1 = sums[channel][1], s2 = sums[channel][2], s3 = sums[channel][3];
        int j = 0;
        for (; j + 4 <= count; j += 4) {
            s0 += k[j] * v[j];
            s1 += k[j + 1] * v[j + 1];
            s2 += k[j + 2] * v[j + 2];
            s3 += k[j + 3] * v[j + 3];
        }
        for (; j < count; ++j) s0 += k[j] * v[j];
        sums[channel] = {s0, s1, s2, s3};
    }
}

/// Kernel times radiance over the far patches [begin, end) of a row, columns within [0, width).
Vec3d sum_far(const Profile& profile, const Axis& axis, const RowNodes& nodes, const Azimuths& azimuths, int begin,
              int end) {
    constexpr int k_chunk = 256;
    const bool ggx = profile.density().lobe() == Lobe::ggx;
    const double w = profile.density().w(), scale = profile.density().scale();
    std::array<double, k_chunk> k;
    Vec3d total;
    for (int i = 0; i < 2; ++i) {
        const double up = nodes.cos_theta[i] * axis.cos_theta, flat = nodes.sin_theta[i] * axis.sin_theta;
        const double cx = flat * axis.cos_phi, cz = flat * axis.sin_phi;
        std::array<std::array<double, 4>, 3> sums{};
        for (int first = 2 * begin; first < 2 * end; first += k_chunk) {
            const int count = std::min(k_chunk, 2 * end - first);
            const double *cosine = azimuths.cosine.data() + first, *sine = azimuths.sine.data() + first;
            if (ggx) {
                for (int j = 0; j < count; ++j) {
                    const double c = up + cx * cosine[j] + cz * sine[j], d = 1 - w * c;
                    k[j] = scale * std::max(c, 0.0) / (d * d);
                }
            } else {
                for (int j = 0; j < count; ++j) k[j] = profile.tabulated(1 - (up + cx * cosine[j] + cz * sine[j]));
            }
            add_products(
                k.data(),
                {nodes.value[i][0].data() + first, nodes.value[i][1].data() + first, nodes.value[i][2].data() + first},
                count, sums);
        }
        const auto total_of = [&](int channel) {
            return (sums[channel][0] + sums[channel][1]) + (sums[channel][2] + sums[channel][3]);
        };
        total += Vec3d(total_of(0), total_of(1), total_of(2));
    }
    return total;
}

/// Half the azimuth that a cap of chord `radius` about the axis takes in a row, an upper bound; 0 if it does not reach
/// the row.
double reach(const Axis& axis, double theta0, double theta1, double radius) {
    const double gap = std::max({0.0, theta0 - axis.theta, axis.theta - theta1}), s = std::sin(gap / 2);
    const double room = radius * radius / 4 - s * s;
    if (room <= 0) return 0;
    const double flat = std::min(std::sin(theta0), std::sin(theta1)) * axis.sin_theta;
    return room < flat ? 2 * std::asin(std::sqrt(room / flat)) : k_pi;
}

/// One patch row's part of the integral for one axis.
Vec3d integrate_row(const ReferenceSource& source, const Profile& profile, const Axis& axis, RowNodes& nodes,
                    const Azimuths& azimuths, int r) {
    const double theta0 = source.theta_begin(r), theta1 = source.theta_end(r), step = source.patch_width();
    const int width = source.width();
    double inside, outside;  // half azimuths: within the first, all patches are above the horizon; beyond the second,
                             // none is
    if (profile.meets_horizon()) {
        const double a = horizon(axis, theta0), b = horizon(axis, theta1);
        inside = std::min(a, b);
        outside = std::max(a, b);
    } else {
        inside = outside = reach(axis, theta0, theta1, std::sqrt(2 * profile.support()));
    }
    if (outside <= 0) return {};
    const double widest = std::sin(std::clamp(k_pi / 2, theta0, theta1));
    const double near = reach(axis, theta0, theta1, profile.near_radius(std::max(theta1 - theta0, step * widest)));

    const auto far = [&](int begin, int end) -> Vec3d {
        if (!nodes.ready) fill(nodes, source, r);
        Vec3d sum;
        for (int x = begin; x < end;) {  // wraps
            const int turn = (x % width + width) % width, count = std::min(end - x, width - turn);
            sum += sum_far(profile, axis, nodes, azimuths, turn, turn + count);
            x += count;
        }
        return sum;
    };
    if (near <= 0 && inside >= k_pi) return far(0, width);

    // Columns counted from the axis: patch x covers azimuths (x - centre) step .. (x + 1 - centre) step from it.
    const double centre = (axis.phi / (2 * k_pi) + 0.5) * width - 0.5;
    const int first = int(std::ceil(centre - width / 2.0)),
              last = first + width;  // patch last - 1 lies across the far side
    const int low = std::max(first, int(std::floor(centre - outside / step)));
    const int high = centre - outside / step < first ? last : std::min(last, int(std::ceil(centre + outside / step)));
    int left_begin = std::max(first, int(std::ceil(centre - inside / step))),
        left_end = int(std::floor(centre - near / step));
    int right_begin = int(std::ceil(centre + near / step)),
        right_end = std::min(last - 1, int(std::floor(centre + inside / step)));
    if (near <= 0 && left_begin <= left_end && left_end < right_end)
        right_begin = left_end;  // the column of the axis itself is far too
    if (left_end <= left_begin) left_begin = left_end = std::clamp(left_end, low, high);
    if (right_end <= right_begin) right_begin = right_end = std::clamp(std::max(right_begin, left_end), left_end, high);

    Vec3d sum;
    const auto near_patches = [&](int begin, int end) {
        for (int x = begin; x < end; ++x) {
            const double phi = (x - centre) * step, end_phi = phi + step, turn = 2 * k_pi;
            const auto corners = source.corners((x % width + width) % width, r);
            const auto integral = [&](double shift) {
                return PatchIntegral(profile, axis, corners, {phi - shift, end_phi - shift, theta0, theta1},
                                     source.mean());
            };
            sum += integral(0)({phi, std::min(end_phi, k_pi), theta0, theta1});
            if (end_phi > k_pi)
                sum += integral(turn)({-k_pi, end_phi - turn, theta0, theta1});  // across the far side
        }
    };
    near_patches(low, left_begin);
    sum += far(left_begin, left_end);
    near_patches(left_end, right_begin);
    sum += far(right_begin, right_end);
    near_patches(right_end, high);
    return sum;
}

}  // namespace

std::vector<Vec3d> convolve_exactly(ImageView<const float> latlong, const ZonalKernel& kernel,
                                    std::span<const Vec3d> directions, int threads) {
    const ReferenceSource source(latlong);
    const Profile profile(kernel);
    const Azimuths azimuths(source);
    std::vector<Axis> axes(directions.begin(), directions.end());
    std::vector<Vec3d> result(directions.size());
    // Directions of a block share the nodes of the rows. The sum for a direction does not depend on its block.
    const int count = int(directions.size()), block = std::clamp(count / (4 * resolve_threads(threads)), 1, 64);
    parallel_ranges(count, block, threads, [&](int begin, int end) {
        RowNodes nodes;
        for (int r = 0; r < source.patch_rows(); ++r) {
            nodes.ready = false;
            for (int d = begin; d < end; ++d)
                result[d] += integrate_row(source, profile, axes[d], nodes, azimuths, r);
        }
    });
    return result;
}

}  // namespace domelight
