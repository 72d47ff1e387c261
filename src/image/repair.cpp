#include "image/repair.h"

#include "domelight/base/parallel.h"

#include "base/text.h"
#include "image/row_sum.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <span>

namespace domelight {

namespace {

/// How far a bad texel looks for better ones, in rows and columns: as wide as a block of the lossy compressions.
constexpr int k_reach = 8;
/// Rows that are decoded at once, at least.
constexpr int k_least_batch = 16;
/// Bytes that a batch may have where more rows are asked for at once.
constexpr std::size_t k_batch_bytes = std::size_t(64) << 20;

bool has_nan(const float* texel) {
    return std::isnan(texel[0]) || std::isnan(texel[1]) || std::isnan(texel[2]);
}

double& channel(Vec3d& v, int c) {
    return c == 0 ? v.x : c == 1 ? v.y : v.z;
}

std::string percent(double share) {
    char digits[40];
    std::snprintf(digits, sizeof digits, "%+.3g %%", 100 * share);
    return digits;
}

std::string rounded(double value) {
    char digits[40];
    std::snprintf(digits, sizeof digits, "%.4g", value);
    return digits;
}

}  // namespace

/// Written so that it vectorises.
bool all_within(std::span<const float> values, float limit) {
    int good = 1;
    for (const float v : values) good &= int(v >= 0) & int(v <= limit);
    return good;
}

RowRepair::RowRepair(int width, int height, RepairOptions options, Read read)
    : width_(width), height_(height), options_(std::move(options)), read_(std::move(read)), weights_(height, 1.0) {
    if (options_.weight)
        for (int y = 0; y < height; ++y) weights_[std::size_t(y)] = options_.weight(y);
}

Result<void> RowRepair::next(ImageView<float> rows, RepairReport& report) {
    const std::size_t row_floats = std::size_t(width_) * 3;
    if (batch_ == 0) {
        const auto most =
            int(std::min<std::size_t>(k_batch_bytes / (row_floats * sizeof(float)), std::size_t(height_)));
        batch_ = std::max(k_least_batch, std::min(rows.height, most));
        capacity_ = batch_ + 3 * k_reach;
        ring_.resize(std::size_t(capacity_) * row_floats);
        rows_.resize(std::size_t(capacity_));
    }
    for (int y = 0; y < rows.height; ++y, ++taken_) {
        while (taken_ >= (balanced_ == height_ ? height_ : balanced_ - k_reach))
            if (const auto loaded = load(report); !loaded) return loaded;
        std::copy_n(texels(taken_), row_floats, rows.row(y));
    }
    return {};
}

/// Reads one batch, and takes every row as far as the rows below it allow.
Result<void> RowRepair::load(RepairReport& report) {
    const int first = loaded_, last = std::min(height_, loaded_ == 0 ? capacity_ : loaded_ + batch_);
    while (loaded_ < last) {
        // The ring's end may lie within the batch.
        const int in_one_piece = std::min(last - loaded_, capacity_ - loaded_ % capacity_);
        if (const auto read = read_({texels(loaded_), width_, in_one_piece, 3, 3 * std::ptrdiff_t(width_)}); !read)
            return read;
        loaded_ += in_one_piece;
    }
    parallel_for(last - first, options_.threads, [&](int i) { receive(first + i); });
    for (int y = first; y < last; ++y) add_repairs(report, row(y).report);

    for (; filled_ < height_ && (loaded_ == height_ || filled_ + k_reach < loaded_); ++filled_) fill(filled_);
    for (; balanced_ < height_ && (filled_ == height_ || balanced_ + k_reach < filled_); ++balanced_)
        balance(balanced_, report);
    report.added += std::exchange(added_, {});
    return {};
}

// --- texels by themselves ---

void RowRepair::receive(int y) {
    row(y) = {};
    const std::span<float> values(texels(y), std::size_t(width_) * 3);
    const float limit = std::min(options_.largest, k_largest_radiance / std::max(options_.scale, 1.0f));
    if (options_.to_rec709 || !all_within(values, limit)) {
        for (int x = 0; x < width_; ++x) receive_texel(y, x);
    } else if (options_.scale != 1) {
        for (float& v : values) v *= options_.scale;
    }
    row(y).report.light = row_sum(values) * weights_[std::size_t(y)] - row(y).report.added;
}

void RowRepair::mark(int y, int x, std::uint8_t what) {
    std::vector<std::uint8_t>& marks = row(y).marks;
    if (marks.empty()) marks.resize(std::size_t(width_));
    marks[std::size_t(x)] = what;
}

/// Infinite channels of one texel; true if there were any. Those whose value neighbours must give become 0 for now, and
/// their marks are added to `wanting`.
bool RowRepair::limit_texel(float* texel, std::uint8_t& wanting) const {
    bool found = false;
    for (int c = 0; c < 3; ++c) {
        if (!std::isinf(texel[c]) && !(texel[c] > options_.largest)) continue;
        found = true;
        const bool known = texel[c] < 0 || options_.largest < k_largest_radiance;
        if (!known) wanting |= std::uint8_t(k_infinite_red << c);
        texel[c] = texel[c] < 0 || !known ? 0 : options_.largest;
    }
    return found;
}

void RowRepair::receive_texel(int y, int x) {
    float* texel = texels(y) + 3 * std::ptrdiff_t(x);
    RepairReport& report = row(y).report;
    if (has_nan(texel)) {
        ++report.not_a_number;
        std::fill_n(texel, 3, 0.0f);
        return mark(y, x, k_nan);
    }
    std::uint8_t wanting = 0;
    bool infinite = limit_texel(texel, wanting);
    const bool was_light = texel[0] >= 0 && texel[1] >= 0 && texel[2] >= 0;
    Vec3d v{texel[0], texel[1], texel[2]};
    if (options_.to_rec709) v = wanting ? Vec3d() : *options_.to_rec709 * v;
    if (wanting) mark(y, x, options_.to_rec709 ? k_all_infinite : wanting);
    for (int c = 0; c < 3; ++c) {
        const double value = channel(v, c) * options_.scale, largest = k_largest_radiance;
        infinite |= value > largest;
        row(y).negative |= value < 0;
        report.negative_radiance = std::min(report.negative_radiance, value);
        texel[c] = value > 0 ? float(std::min(value, largest)) : value < 0 ? float(std::max(value, -largest)) : 0.0f;
    }
    report.infinite += infinite;
    if (was_light && options_.negatives != Negatives::keep) clamp_texel(y, texel);
}

/// A colour outside of Rec. 709 has negative channels there, which its neighbours have no part in.
void RowRepair::clamp_texel(int y, float* texel) {
    RepairReport& report = row(y).report;
    bool negative = false;
    for (int c = 0; c < 3; ++c) {
        if (!(texel[c] < 0)) continue;
        negative = true;
        channel(report.added, c) -= texel[c] * weights_[std::size_t(y)];
        texel[c] = 0;
    }
    report.negative += negative;
}

// --- texels without a value ---

/// Calls visit(row, column) for each texel within `radius` rows and columns.
template <typename Visit>
void RowRepair::visit_near(int y, int x, int radius, const Visit& visit) {
    const int first = std::max(0, y - radius), last = std::min(height_ - 1, y + radius);
    const int left = options_.wraps ? x - radius : std::max(0, x - radius);
    const int right = options_.wraps ? std::min(x + radius, left + width_ - 1) : std::min(width_ - 1, x + radius);
    for (int ny = first; ny <= last; ++ny)
        for (int i = left; i <= right; ++i) visit(ny, options_.wraps ? (i % width_ + width_) % width_ : i);
}

bool RowRepair::is_marked(int y, int x) {
    const std::vector<std::uint8_t>& marks = row(y).marks;
    return !marks.empty() && marks[std::size_t(x)];
}

/// Gives a texel the value that was found for it. Its neighbours may be negative still.
void RowRepair::set(int y, int x, int c, float value) {
    if (options_.negatives != Negatives::keep) value = std::max(value, 0.0f);
    texels(y)[3 * std::ptrdiff_t(x) + c] = value;
    channel(added_, c) += value * weights_[std::size_t(y)];
}

void RowRepair::fill(int y) {
    if (row(y).marks.empty()) return;
    for (int x = 0; x < width_; ++x)
        if (row(y).marks[std::size_t(x)] & k_all_infinite) fill_infinite(y, x);
    fill_not_a_number(y);
    row(y).marks.clear();
}

/// The largest value near: of the nearest square of texels that has any.
void RowRepair::fill_infinite(int y, int x) {
    float largest[3] = {0, 0, 0};
    bool found = false;
    for (int radius = 1; radius <= k_reach && !found; ++radius)
        visit_near(y, x, radius, [&](int ny, int nx) {
            if (is_marked(ny, nx)) return;
            found = true;
            for (int c = 0; c < 3; ++c) largest[c] = std::max(largest[c], texels(ny)[3 * std::ptrdiff_t(nx) + c]);
        });
    for (int c = 0; c < 3; ++c)
        if (row(y).marks[std::size_t(x)] & k_infinite_red << c) set(y, x, c, largest[c]);
    // The mark stays until the row is done, so that infinite neighbours do not take this value for one of the file.
}

/// From the nearest texels to the left and to the right that are none themselves.
void RowRepair::fill_not_a_number(int y) {
    std::vector<std::uint8_t>& marks = row(y).marks;
    const auto good_texels = [&] {
        std::vector<int> good;
        for (int x = 0; x < width_; ++x)
            if (!(marks[std::size_t(x)] & k_nan)) good.push_back(x);
        return good;
    };
    std::vector<int> good = good_texels();
    if (good.empty()) {
        fill_from_rows(y);
        good = good_texels();
    }
    std::size_t next = 0;  // first good texel right of x
    for (int x = 0; x < width_; ++x) {
        while (next < good.size() && good[next] < x) ++next;
        if (!(marks[std::size_t(x)] & k_nan)) continue;
        const int n = int(good.size());
        int left = int(next) - 1, right = int(next);
        if (options_.wraps && n > 0) left = (left + n) % n, right %= n;
        double sum[3] = {}, count = 0;
        for (const int side : {left, right}) {
            if (side < 0 || side >= n) continue;
            for (int c = 0; c < 3; ++c) sum[c] += texels(y)[3 * std::ptrdiff_t(good[std::size_t(side)]) + c];
            ++count;
        }
        for (int c = 0; c < 3; ++c) set(y, x, c, count ? float(sum[c] / count) : 0);
    }
}

/// A row of no numbers: between the row above and the next one below that has any, in proportion to their distances.
/// Texels that neither of them can give keep their marks.
void RowRepair::fill_from_rows(int y) {
    int below = y + 1;
    const auto is_broken = [&](int ny) {
        for (int x = 0; x < width_; ++x)
            if (!is_marked(ny, x)) return false;
        return true;
    };
    const int end = std::min(height_, y + 1 + k_reach);
    while (below < end && is_broken(below)) ++below;
    for (int x = 0; x < width_; ++x) {
        const bool from_above = y > 0, from_below = below < end && !is_marked(below, x);
        if (!from_above && !from_below) continue;
        const double share_above = !from_above ? 0 : !from_below ? 1 : double(below - y) / (below - y + 1);
        for (int c = 0; c < 3; ++c) {
            const std::ptrdiff_t i = 3 * std::ptrdiff_t(x) + c;
            const double a = from_above ? share_above * texels(y - 1)[i] : 0;
            const double b = from_below ? (1 - share_above) * texels(below)[i] : 0;
            set(y, x, c, float(a + b));
        }
        row(y).marks[std::size_t(x)] = 0;
    }
}

// --- negative texels ---

void RowRepair::balance(int y, RepairReport& report) {
    if (!row(y).negative) return;
    int negative = 0;
    const float* p = texels(y);
    for (int x = 0; x < width_; ++x) negative += p[3 * x] < 0 || p[3 * x + 1] < 0 || p[3 * x + 2] < 0;
    report.negative += negative;
    report.negatives_kept = options_.negatives == Negatives::keep;
    if (report.negatives_kept) return;
    // Where most of a row is negative, that is no ringing.
    const bool balances = options_.negatives == Negatives::balance && 2 * negative <= width_;
    for (int x = 0; x < width_; ++x)
        for (int c = 0; c < 3; ++c) {
            float& value = texels(y)[3 * std::ptrdiff_t(x) + c];
            if (!(value < 0)) continue;
            const double owed = -double(value) * weights_[std::size_t(y)];
            value = 0;
            if (!balances || !take_near(y, x, c, owed)) channel(added_, c) += owed;
        }
}

/// Takes that much light of a channel from the texels near. False: they have too little.
bool RowRepair::take_near(int y, int x, int c, double owed) {
    for (int radius = 1; radius <= k_reach; radius *= 2) {
        double light = 0;
        visit_near(y, x, radius, [&](int ny, int nx) {
            light += std::max(0.0f, texels(ny)[3 * std::ptrdiff_t(nx) + c]) * weights_[std::size_t(ny)];
        });
        if (!(owed <= (radius == k_reach ? 0.5 : 0.25) * light)) continue;
        const double factor = 1 - owed / light;
        visit_near(y, x, radius, [&](int ny, int nx) {
            float& value = texels(ny)[3 * std::ptrdiff_t(nx) + c];
            if (value > 0) value = float(value * factor);
        });
        return true;
    }
    return false;
}

// --- whole images and reports ---

void repair_image(ImageView<float> image, const RepairOptions& options, RepairReport& report) {
    int read = 0;
    RowRepair repair(image.width, image.height, options, [&](ImageView<float> rows) -> Result<void> {
        for (int y = 0; y < rows.height; ++y) std::copy_n(image.row(read++), 3 * image.width, rows.row(y));
        return {};
    });
    // What is written has been read long before.
    (void)repair.next(image, report);
}

void add_repairs(RepairReport& sum, const RepairReport& part) {
    sum.not_a_number += part.not_a_number;
    sum.infinite += part.infinite;
    sum.negative += part.negative;
    sum.negative_radiance = std::min(sum.negative_radiance, part.negative_radiance);
    sum.negatives_kept |= part.negatives_kept;
    sum.light += part.light;
    sum.added += part.added;
}

Vec3d RepairReport::share_added() const {
    // Sums of many floats leave a rest where nothing was added.
    const auto share = [](double part, double whole) {
        return whole > 0 && std::abs(part) > 1e-9 * whole ? part / whole : 0;
    };
    return {share(added.x, light.x), share(added.y, light.y), share(added.z, light.z)};
}

std::vector<std::string> RepairReport::lines() const {
    std::vector<std::string> lines = warnings;
    const std::string lowest = rounded(negative_radiance);
    if (negatives_kept && negative > 0)
        lines.push_back(text(negative, " negative texels were kept (down to ", lowest, ")"));
    const std::int64_t changed = negatives_kept ? 0 : negative;
    if (not_a_number + infinite + changed == 0) return lines;
    std::string kinds;
    const auto kind = [&](std::int64_t count, const std::string& what) {
        if (count) kinds += text(kinds.empty() ? "" : ", ", count, " ", what);
    };
    kind(not_a_number, "not a number");
    kind(infinite, "infinite");
    kind(changed, text("negative (down to ", lowest, ")"));
    const Vec3d share = share_added();
    lines.push_back(text("bad texels were repaired: ", kinds, "; that changed the light by ", percent(share.x),
                         " red, ", percent(share.y), " green, ", percent(share.z), " blue"));
    return lines;
}

}  // namespace domelight
