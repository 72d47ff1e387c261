#include "bake/sh_report.h"

#include "domelight/base/parallel.h"
#include "domelight/projection/projection.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace domelight {
namespace {

/// Sums over one row of an irradiance map, per channel.
struct RowError {
    std::array<double, 3> error{}, truth{}, largest{};
};

std::array<double, 3> channels(const Vec3d& v) {
    return {v.x, v.y, v.z};
}

/// Solid angles of a map's texels: of one face (all are alike), or of a lat-long row's texels.
class SolidAngles {
  public:
    explicit SolidAngles(const FilteredMap& map) : cube_(map.layout == Layout::cube), width_(cube_ ? map.width() : 1) {
        for (int y = 0; y < map.height(); ++y)
            for (int x = 0; x < width_; ++x)
                omega_.push_back(cube_ ? cube_solid_angle(x, y, width_)
                                       : latlong_solid_angle(y, map.width(), map.height()));
    }
    double operator()(int x, int y) const { return cube_ ? omega_[std::size_t(y % width_) * width_ + x] : omega_[y]; }

  private:
    bool cube_;
    int width_;
    std::vector<double> omega_;
};

/// Mean of a map over the sphere: sum of omega E / sum of omega.
std::array<double, 3> map_mean(const FilteredMap& map, const SolidAngles& solid_angle) {
    const auto image = map.image.view();
    std::array<double, 3> sum{};
    double total = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const double omega = solid_angle(x, y);
            for (int c = 0; c < 3; ++c) sum[c] += omega * image.at(x, y)[c];
            total += omega;
        }
    for (double& s : sum) s /= total;
    return sum;
}

}  // namespace

ShReport make_sh_report(std::span<const Vec3d> radiance, int bands, ShWindow window,
                        const FilteredMap& irradiance_over_pi, int threads) {
    ShReport report;
    report.bands = bands;
    report.window = window;
    report.radiance.assign(radiance.begin(), radiance.end());
    sh_window(report.radiance, window);
    const std::vector<Vec3d> over_pi = sh_irradiance_over_pi(report.radiance);
    for (const Vec3d& v : over_pi) report.irradiance.push_back(v * k_pi);

    const auto truth = irradiance_over_pi.image.view();
    const SolidAngles solid_angle(irradiance_over_pi);
    const auto mean = map_mean(irradiance_over_pi, solid_angle);
    std::vector<RowError> rows(truth.height);
    parallel_ranges(truth.height, 8, threads, [&](int begin, int end) {
        for (int y = begin; y < end; ++y)
            for (int x = 0; x < truth.width; ++x) {
                const Vec3d d = map_direction(irradiance_over_pi.layout, irradiance_over_pi.width(),
                                              irradiance_over_pi.height(), x, y);
                const double omega = solid_angle(x, y);
                const auto value = channels(sh_evaluate(over_pi, d));
                for (int c = 0; c < 3; ++c) {
                    const double e = truth.at(x, y)[c], error = std::abs(value[c] - e);
                    rows[y].error[c] += omega * error * error;
                    rows[y].truth[c] += omega * e * e;
                    if (mean[c] > 0)
                        rows[y].largest[c] = std::max(rows[y].largest[c], error / std::max(e, 0.01 * mean[c]));
                }
            }
    });
    double error = 0, square = 0;
    for (const RowError& row : rows)
        for (int c = 0; c < 3; ++c) {
            error += row.error[c];
            square += row.truth[c];
            report.max_error = std::max(report.max_error, row.largest[c]);
        }
    report.rms_error = square > 0 ? std::sqrt(error / square) : 0;
    return report;
}

namespace {

/// Nine numbers even if fewer bands were asked for: the missing ones are 0.
std::vector<Vec3d> nine(const ShReport& sh) {
    std::vector<Vec3d> radiance = sh.radiance;
    radiance.resize(9);
    return sh_filament(radiance);
}

}  // namespace

std::string filament_sh_text(const ShReport& sh) {
    static const char* const labels[] = {"L00", "L1-1", "L10", "L11", "L2-2", "L2-1", "L20", "L21", "L22"};
    std::string text;
    const auto coefficients = nine(sh);
    for (int i = 0; i < 9; ++i)
        text += fmt::format("({:18.15f}, {:18.15f}, {:18.15f}); // {}, irradiance, pre-scaled base\n",
                            coefficients[i].x, coefficients[i].y, coefficients[i].z, labels[i]);
    return text;
}

std::string filament_sh_metadata(const ShReport& sh) {
    std::string text;
    for (const Vec3d& v : nine(sh)) text += fmt::format("{:.9g} {:.9g} {:.9g}\n", v.x, v.y, v.z);
    return text;
}

}  // namespace domelight
