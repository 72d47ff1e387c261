#pragma once

#include "domelight/base/result.h"
#include "domelight/base/vec.h"
#include "domelight/image/image.h"
#include "domelight/image/negatives.h"
#include "domelight/image/repair_report.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace domelight {

/// The largest radiance that readers return. No light is nearly as bright, and sums over the brightest possible image
/// stay finite in float.
inline constexpr float k_largest_radiance = 0x1p100f;

/// How to turn stored texels into radiance: finite, in [0, k_largest_radiance], linear Rec. 709.
struct RepairOptions {
    /// The format's largest finite value, which replaces infinity before `scale` is applied. If it is
    /// k_largest_radiance, the format has none that is near real light: the largest finite value near the texel is
    /// taken then.
    float largest = k_largest_radiance;
    std::optional<Mat3> to_rec709 = std::nullopt;  ///< the file's primaries to Rec. 709
    float scale = 1;                               ///< exposure
    bool wraps = true;                             ///< the row's ends are neighbours (lat-long)
    Negatives negatives = Negatives::balance;
    std::function<double(int)> weight = nullptr;  ///< the solid angle of a texel of a row; null: 1
    int threads = 0;
};

/// Whether every value lies in [0, limit]; false for NaN.
bool all_within(std::span<const float> values, float limit);

/// Repairs an image whose rows are read from the top down. In this order: infinities are replaced, the primaries are
/// converted and the scale is applied; a texel with a NaN becomes the mean of the nearest texels without one to its left
/// and right, or between the rows above and below if its row has none; values above k_largest_radiance are clipped to it
/// and counted with the infinities; negative channels are treated as asked.
///
/// Negative channels are balanced one after the other, in the order of reading: the channel becomes 0, and the texels
/// within 1, 2, 4 or 8 rows and columns (the nearest of these squares that can pay with a quarter of its light, or with
/// half of that of the largest) are scaled down by one factor, so that the sum of radiance times solid angle stays.
/// Where not even that suffices the value is no ringing beside a light but a broken texel, and nothing is taken. Nor is
/// anything taken for channels that are negative only in Rec. 709: they belong to the texel's own colour.
///
/// No more than 24 rows are held beyond those that are read at once.
class RowRepair {
  public:
    /// Reads the next rows as they are stored.
    using Read = std::function<Result<void>(ImageView<float>)>;
    RowRepair(int width, int height, RepairOptions options, Read read);
    /// The next `rows.height` repaired rows (no more than are left). Counts go into `report`; they are complete with the
    /// last row.
    Result<void> next(ImageView<float> rows, RepairReport& report);

  private:
    /// Why a texel has no value yet. Infinite green and blue have the two bits above that of red.
    static constexpr std::uint8_t k_nan = 1, k_infinite_red = 2, k_all_infinite = 14;
    /// What is known of a row in the ring.
    struct Row {
        std::vector<std::uint8_t> marks;  // of texels that have no value yet; empty: there are none
        bool negative = false;
        RepairReport report;
    };

    float* texels(int y) { return ring_.data() + std::size_t(y % capacity_) * std::size_t(width_) * 3; }
    Row& row(int y) { return rows_[std::size_t(y % capacity_)]; }
    bool is_marked(int y, int x);
    void mark(int y, int x, std::uint8_t what);
    void set(int y, int x, int c, float value);
    template <typename Visit>
    void visit_near(int y, int x, int radius, const Visit& visit);

    Result<void> load(RepairReport& report);
    void receive(int y);
    void receive_texel(int y, int x);
    void clamp_texel(int y, float* texel);
    bool limit_texel(float* texel, std::uint8_t& wanting) const;
    void fill(int y);
    void fill_infinite(int y, int x);
    void fill_not_a_number(int y);
    void fill_from_rows(int y);
    void balance(int y, RepairReport& report);
    bool take_near(int y, int x, int c, double owed);

    int width_, height_;
    RepairOptions options_;
    Read read_;
    std::vector<double> weights_;   // by row
    int batch_ = 0, capacity_ = 0;  // rows that are read at once, and in the ring
    std::vector<float> ring_;
    std::vector<Row> rows_;
    int loaded_ = 0, filled_ = 0, balanced_ = 0, taken_ = 0;  // rows that have got so far
    Vec3d added_;
};

/// Repairs an image in place.
void repair_image(ImageView<float> image, const RepairOptions& options, RepairReport& report);

/// Adds the counts and the light of `part` to `sum`; the warnings of `sum` do not change.
void add_repairs(RepairReport& sum, const RepairReport& part);

}  // namespace domelight
