#include "domelight/environment/sky/sky.h"

#include "domelight/base/parallel.h"

#include "environment/sky/sky_model.h"
#include "environment/sky/solar_disc.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace domelight {
namespace {

using sky::SkyModel;
using sky::SolarDisc;

SkyOptions sanitised(SkyOptions o) {
    o.height = std::max(o.height, 1);
    o.sun_elevation_deg = std::clamp(o.sun_elevation_deg, -18.0, 90.0);
    o.turbidity = std::clamp(o.turbidity, 1.0, 10.0);
    o.ground_albedo = std::clamp(o.ground_albedo, 0.0, 1.0);
    return o;
}

class SkyRows : public RowSource {
  public:
    explicit SkyRows(const SkyOptions& options) : options_(sanitised(options)), model_(options_), disc_(model_) {
        const double sun = options_.sun_azimuth_deg * k_pi / 180;
        taps_.reserve(width());
        for (int x = 0; x < width(); ++x) taps_.push_back(SkyModel::tap(((x + 0.5) / width() - 0.5) * 2 * k_pi - sun));
    }

    int width() const override { return 2 * options_.height; }
    int height() const override { return options_.height; }

    Result<void> read(ImageView<float> rows) override {
        assert(rows.width == width() && rows.channels == 3 && next_row_ + rows.height <= height());
        // A row depends on its number alone, so the result depends neither on the threads nor on how many rows are read
        // at a time.
        parallel_for(rows.height, options_.threads, [&](int y) { make_row(next_row_ + y, rows.row(y)); });
        next_row_ += rows.height;
        return {};
    }

  private:
    void make_row(int y, float* out) const {
        const double elevation = k_pi / 2 - k_pi * (y + 0.5) / height();
        const double sun = model_.sun_elevation();
        const double sines = std::sin(elevation) * std::sin(sun), cosines = std::cos(elevation) * std::cos(sun);
        float nodes[SkyModel::k_row];
        // The middle row of an odd height is half sky, half ground.
        if (2 * y + 1 == height()) {
            float below[SkyModel::k_row];
            model_.row(0, true, nodes);
            model_.row(0, false, below);
            for (int i = 0; i < SkyModel::k_row; ++i) nodes[i] = 0.5f * (nodes[i] + below[i]);
        } else {
            model_.row(elevation, elevation > 0, nodes);
        }
        for (int x = 0; x < width(); ++x) {
            const Vec3f v = SkyModel::radiance(nodes, taps_[x], sines, cosines);
            out[3 * x] = v.x;
            out[3 * x + 1] = v.y;
            out[3 * x + 2] = v.z;
        }
        if (options_.sun_disc) disc_.add_to_row(y, width(), height(), options_.sun_azimuth_deg * k_pi / 180, out);
    }

    SkyOptions options_;
    SkyModel model_;
    SolarDisc disc_;
    std::vector<SkyModel::Tap> taps_;
    int next_row_ = 0;
};

}  // namespace

std::unique_ptr<RowSource> make_sky(const SkyOptions& options) {
    return std::make_unique<SkyRows>(options);
}

}  // namespace domelight
