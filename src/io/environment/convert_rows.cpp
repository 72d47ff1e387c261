#include "io/environment/convert_rows.h"

#include "filtering/resample/area_resample_aligned.h"
#include "filtering/resample/area_resample_latlong.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace domelight {
namespace {

/// Between latlong_direction's frame (x at the centre, z to the right) and a picture's (z at the centre, x to the
/// right); its own inverse.
constexpr Mat3 k_swap{{Vec3d{0, 0, 1}, Vec3d{0, 1, 0}, Vec3d{1, 0, 0}}};

/// The whole columns by which a lat-long image of `width` moves under the matrix, if it is such a turn about its axis.
std::optional<int> column_shift(const Mat3& m, int width) {
    if (std::abs(m.row[1].y - 1) > 1e-12 || std::abs(m.row[0].x - m.row[2].z) > 1e-12) return std::nullopt;
    const double columns = std::atan2(m.row[2].x, m.row[0].x) / (2 * k_pi) * width;
    if (std::abs(columns - std::round(columns)) > 1e-6) return std::nullopt;
    return int(std::round(columns));
}

/// Copies rows, each rotated by the same number of columns.
class ShiftedColumns : public AreaResampler {
  public:
    ShiftedColumns(int width, int height, int shift)
        : image_(width, height, 3), first_((shift % width + width) % width) {}
    void add_rows(ImageView<const float> rows) override {
        for (int y = 0; y < rows.height; ++y, ++next_) {
            const float* from = rows.row(y);
            std::rotate_copy(from, from + 3 * first_, from + 3 * rows.width, image_.row(next_));
        }
    }
    ImageF finish() override { return std::move(image_); }

  private:
    ImageF image_;
    int first_, next_ = 0;
};

}  // namespace

RowConversion convert_rows(int width, int height, const Projection& target, int out_width, int out_height,
                           const Mat3& world_to_source, int threads, bool sharp) {
    if (target.grid() != SampleGrid::centres) return {};
    const Mat3 picture_to_source = world_to_source * target.world_to_picture().transposed();
    if (target.name() == "cube" && !sharp && area::align(picture_to_source))
        return {area_resample_to_cube(width, height, out_height, picture_to_source, threads)};
    if (target.name() != "latlong" || out_width != 2 * out_height) return {};
    const Mat3 m = picture_to_source * k_swap;  // both in latlong_direction's frame
    if (const auto shift = column_shift(m, width); shift && out_width == width && out_height == height)
        return {std::make_unique<ShiftedColumns>(width, height, *shift), true};
    if (const auto aligned = area::align(m); !sharp && aligned && area::keeps_polar_axis(*aligned))
        return {area_resample_to_latlong(width, height, out_height, m, threads)};
    return {};
}

}  // namespace domelight
