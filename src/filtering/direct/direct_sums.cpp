#include "filtering/direct/direct_sums.h"

#include "domelight/base/parallel.h"
#include "domelight/projection/projection.h"

#include "base/aligned.h"
#include "base/sort.h"
#include "filtering/direct/lobe_sums.h"
#include "filtering/direct/refined_rows.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace domelight {
namespace {

/// Patches are integrated where b is less than this many rows; wider lobes are smooth enough for a sum over texels.
constexpr double k_smooth_rows = 4;
/// b in rows of the image, at least: finer rows are interpolated for narrower lobes.
constexpr double k_least_rows = 1.2;
/// Texels around the axis whose patches are integrated.
constexpr int k_core = 3;
/// A mean of texels counts at this many times its size from the axis, and where less than k_little of the lobe is left,
/// at k_least_reach times.
constexpr double k_reach = 3, k_least_reach = 2, k_little = 5e-4;
/// Texels themselves are summed up to this many b from the axis.
constexpr double k_near = 3;
/// Both distances are this many times as large in an interpolated image, where neighbouring texels are alike and their
/// errors do not cancel.
constexpr double k_interpolated = 2.4;
/// b below this is left to the harmonics: the interpolated image would be too large.
constexpr double k_least_width = 1e-3;
/// Where b is more than this many of the map's texels, there are too many texels for sums to be faster.
constexpr double k_most_texels_wide = 0.5;

constexpr int k_batch = 64;    // rows of the image between two rounds of sums; a power of two
constexpr int k_streamed = 3;  // levels of the pyramid that are not kept
constexpr int k_lanes = 16;    // what a kernel may read past the end of a row
constexpr int k_margin = 256;  // texels repeated around the seam
constexpr int k_texels_at_once = 256;

simd::Colatitude colatitude(double theta, double weight) {
    return {std::sin(0.5 * theta), std::cos(0.5 * theta), float(std::sin(theta)), float(weight)};
}

/// How many times as many rows a lobe of width `b` needs: an odd number.
int refinement(int height, double b) {
    const int factor = int(std::ceil(k_least_rows * k_pi / (height * b)));
    return factor + (factor % 2 == 0);
}

}  // namespace

bool DirectSums::takes_directly(const LevelSpec& level, Layout layout) {
    if (level.mirror || level.kernel.lobe != Lobe::ggx) return false;
    const double b = level.kernel.angular_width(), texels = (layout == Layout::cube ? 2.0 : 1.0) * level.size / k_pi;
    return b >= k_least_width && b * texels < k_most_texels_wide;
}

/// The image and its means over 2 x 2, 4 x 4, ... texels, in planes; the finest levels only as far as the last batch.
class DirectSums::Pyramid {
  public:
    Pyramid(int width, int height, int factor, int threads)
        : rows_(width, height, factor), width_(rows_.width()), height_(rows_.height()), threads_(threads) {
        for (int l = 0; l == 0 || height_at(l - 1) > 1; ++l) add_level(l);
    }

    int levels() const { return int(levels_.size()); }
    bool is_interpolated() const { return rows_.is_interpolated(); }
    int columns() const { return width_; }
    int width_at(int l) const { return (width_ + (1 << l) - 1) >> l; }
    int height_at(int l) const { return (height_ + (1 << l) - 1) >> l; }
    double row_angle() const { return k_pi / height_; }
    /// sin θ at the upper edge of a row, and at the image's lower edge.
    double edge_sine(int l, int row) const {
        return std::max(levels_[std::size_t(l)].edge_sines[std::size_t(row)], 0.0);
    }

    void add_rows(ImageView<const float> rows, const std::function<void()>& batch_is_ready) {
        rows_.add_rows(rows);
        while (rows_.next_row() < rows_.end_row()) {
            const int y = rows_.next_row(), end = std::min(rows_.end_row(), (y / k_batch + 1) * k_batch);
            parallel_ranges(end - y, 4, threads_, [&](int from, int to) {
                for (int k = from; k < to; ++k) read_row(y + k);
            });
            rows_.advance_to(end);
            if (end % k_batch && end < height_) return;  // the batch goes on with the next rows
            complete_batch(end);
            batch_is_ready();
        }
    }
    /// The rows of level l that the last batch has completed.
    int batch_begin(int l) const { return batch_begin_ >> l; }
    int batch_end(int l) const { return (batch_end_ + (1 << l) - 1) >> l; }
    bool is_complete() const { return batch_end_ == height_; }

    simd::CellRows cells(int l) const {
        const PyramidLevel& level = levels_[std::size_t(l)];
        const double h = row_angle(), size = h * (1 << l);
        return {
            level.row(level.first_row),           level.stride, level.first_row, level.x.data(), level.places.data(),
            float((3 * h * h - size * size) / 24)};
    }
    /// Patch row p lies between the texel rows p - 1 and p; the first and the last one reach the poles.
    simd::PatchRow patches(int p, int row_begin, int row_end, int first_texel) const {
        const PyramidLevel& texels = levels_.front();
        const int above = std::max(p - 1, 0), below = std::min(p, height_ - 1);
        return {texels.row(above) + first_texel, texels.row(below) + first_texel, above >= row_begin && above < row_end,
                below >= row_begin && below < row_end, patch_nodes_.data() + 3 * p};
    }
    std::ptrdiff_t texel_stride() const { return levels_.front().stride; }

    /// After the last row: the levels that are kept, from the means that were kept.
    void complete() {
        for (int l = k_streamed + 1; l < levels(); ++l)
            for (int y = 0; y < height_at(l); ++y) average(l, y);
    }

  private:
    struct PyramidLevel {
        int margin = 0;
        int first_row = 0;  ///< that is held
        int rows_held = 0;
        std::ptrdiff_t stride = 0;
        AlignedArray<float> planes;
        std::vector<float> x;
        std::vector<simd::Colatitude> places;
        std::vector<double> edge_sines;
        const float* row(int y) const { return planes.data() + slot(y) * 4 * stride + margin; }
        float* row(int y) { return planes.data() + slot(y) * 4 * stride + margin; }
        /// The finest level holds the last row of the batch before, in slot 0.
        std::ptrdiff_t slot(int y) const { return y - first_row + (margin ? 1 : 0); }
    };

    void add_level(int l) {
        PyramidLevel& level = levels_.emplace_back();
        const int width = width_at(l), height = height_at(l), cell = 1 << l;
        level.margin = l == 0 ? k_margin : 0;
        level.rows_held = l < k_streamed ? std::max(k_batch >> l, 1) : height;
        level.stride = (width + 2 * level.margin + k_lanes + 15) / 16 * 16;
        level.planes = AlignedArray<float>(std::size_t(level.rows_held + (l == 0)) * 4 * std::size_t(level.stride));
        level.x.assign(std::size_t(width) + k_lanes, 0);
        for (int i = 0; i < width; ++i)
            level.x[std::size_t(i)] = 0.5f * float(i * cell + std::min((i + 1) * cell, width_));
        for (int y = 0; y < height; ++y) {
            const double top = row_angle() * y * cell, bottom = row_angle() * std::min((y + 1) * cell, height_);
            level.places.push_back(colatitude(0.5 * (top + bottom), (std::cos(top) - std::cos(bottom)) * cell));
            level.edge_sines.push_back(std::sin(top));
        }
        level.edge_sines.push_back(0);
        if (l == 0) add_patch_nodes();
    }

    void add_patch_nodes() {
        constexpr double node[3] = {0.1127016653792583, 0.5, 0.8872983346207417},
                         share[3] = {5 / 18., 8 / 18., 5 / 18.};
        for (int p = 0; p <= height_; ++p) {
            const double top = std::max(p - 0.5, 0.0), size = std::min(p + 0.5, double(height_)) - top;
            for (int n = 0; n < 3; ++n) {
                const double theta = row_angle() * (top + node[n] * size);
                patch_nodes_.push_back(colatitude(theta, share[n] * size * row_angle() * std::sin(theta)));
            }
        }
    }

    void read_row(int y) {
        PyramidLevel& texels = levels_.front();
        float* row = texels.row(y);
        rows_.read(y, row, texels.stride);
        for (int c = 0; c < 3; ++c) {
            float* plane = row + c * texels.stride;
            for (int i = 0; i < k_margin; ++i) {
                plane[-1 - i] = plane[width_ - 1 - i % width_];
                plane[width_ + i] = plane[i % width_];
            }
        }
        std::fill_n(row + 3 * texels.stride, width_, 1.f);
    }

    void complete_batch(int end) {
        batch_begin_ = (end - 1) / k_batch * k_batch;
        batch_end_ = end;
        for (int l = 1; l <= std::min(k_streamed, levels() - 1); ++l) {
            if (l < k_streamed) levels_[std::size_t(l)].first_row = batch_begin(l);
            parallel_ranges(batch_end(l) - batch_begin(l), 4, threads_, [&](int from, int to) {
                for (int k = from; k < to; ++k) average(l, batch_begin(l) + k);
            });
        }
    }

  public:
    /// After the sums of a batch: makes room for the next one.
    void leave_batch() {
        PyramidLevel& texels = levels_.front();
        if (is_complete()) return;
        std::copy_n(texels.row(batch_end_ - 1) - k_margin, 4 * texels.stride, texels.planes.data());
        texels.first_row = batch_end_;
    }

  private:
    /// Row y of level l from two rows of the level below.
    void average(int l, int y) {
        const PyramidLevel& fine = levels_[std::size_t(l) - 1];
        PyramidLevel& coarse = levels_[std::size_t(l)];
        const int upper = 2 * y, lower = std::min(2 * y + 1, height_at(l - 1) - 1), width = width_at(l - 1);
        const float a = fine.places[std::size_t(upper)].weight,
                    b = upper < lower ? fine.places[std::size_t(lower)].weight : 0;
        const float wa = 0.5f * a / (a + b), wb = 0.5f * b / (a + b);
        for (int c = 0; c < 4; ++c) {
            const float *p = fine.row(upper) + c * fine.stride, *q = fine.row(lower) + c * fine.stride;
            float* out = coarse.row(y) + c * coarse.stride;
            for (int x = 0; x < width / 2; ++x)
                out[x] = wa * (p[2 * x] + p[2 * x + 1]) + wb * (q[2 * x] + q[2 * x + 1]);
            if (width % 2) out[width / 2] = wa * p[width - 1] + wb * q[width - 1];
        }
    }

    RefinedRows rows_;
    int width_, height_, threads_;
    int batch_begin_ = 0, batch_end_ = 0;
    std::vector<PyramidLevel> levels_;
    std::vector<simd::Colatitude> patch_nodes_;
};

/// The sums of one map, one for each texel, while its rows are added.
class DirectSums::Level {
  public:
    Level(const Pyramid& pyramid, const FilterOptions& options, const LevelSpec& spec)
        : pyramid_(pyramid), options_(options), spec_(spec), b_(spec.kernel.angular_width()) {
        const double h = pyramid.row_angle();
        has_core_ = b_ < k_smooth_rows * h;
        const double farther = pyramid.is_interpolated() ? k_interpolated : 1;
        reach_.push_back(0);
        for (int l = 1; l < pyramid.levels(); ++l) {
            double reach = farther * std::max(k_reach * h * (1 << l), k_near * b_);
            const double little = b_ / std::sqrt(k_little);
            if (reach > little) reach = std::max({k_least_reach * h * (1 << l), little, reach_.back()});
            if (reach > 1.2) break;
            reach_.push_back(reach);
        }
        place_texels();
    }

    /// Adds what the rows of the last batch give.
    void add_batch() {
        if (has_core_) add_core();
        for (int l = 0; l < std::min(k_streamed, int(reach_.size())); ++l)
            add_cells(l, pyramid_.batch_begin(l), pyramid_.batch_end(l));
    }
    /// After the last batch.
    void add_kept() {
        for (int l = k_streamed; l < int(reach_.size()); ++l) add_cells(l, 0, pyramid_.height_at(l));
    }

    FilteredMap map(const BrightSplit& split) const {
        const int size = spec_.size, width = options_.layout == Layout::cube ? size : 2 * size;
        ImageF image = ImageF::uninitialized(width, options_.layout == Layout::cube ? 6 * size : size, 3);
        for (const Texel& t : texels_) {
            float* p = image.pixels().data() + 3 * std::ptrdiff_t(t.index);
            p[0] = float(t.sum.r / t.sum.weight);
            p[1] = float(t.sum.g / t.sum.weight);
            p[2] = float(t.sum.b / t.sum.weight);
        }
        if (!split.empty()) add_lights(split, image);
        return {options_.layout, std::move(image)};
    }

  private:
    struct Texel {
        double theta;
        simd::LobeAxis axis;
        simd::LobeSum sum;
        int index;                ///< in the map
        bool all_around = false;  ///< so near a pole that whole rows are summed around it
    };
    /// Rows [row_begin, row_end) and columns [begin, end) of the image, the latter from minus a half turn on; of cells
    /// of some level.
    struct Box {
        int row_begin = 0, row_end = 0;
        double begin = 0, end = 0;
        bool all_around = false;
    };

    Vec3d direction(int index) const {
        const int size = spec_.size, width = options_.layout == Layout::cube ? size : 2 * size;
        return map_direction(options_.layout, width, size, index % width, index / width);
    }

    void place_texels() {
        const int count = options_.layout == Layout::cube ? 6 * spec_.size * spec_.size : 2 * spec_.size * spec_.size;
        texels_.resize(std::size_t(count));
        parallel_ranges(count, 1024, options_.threads, [&](int from, int to) {
            for (int i = from; i < to; ++i) {
                const Vec3d d = options_.world_to_source * direction(i);
                const double theta = std::atan2(std::hypot(d.x, d.z), d.y);
                const double x = (0.5 + std::atan2(d.z, d.x) / (2 * k_pi)) * pyramid_.columns();
                Texel& texel = texels_[std::size_t(i)];
                texel = {theta, {colatitude(theta, 0), x, float(b_ * b_), float(pyramid_.columns())}, {}, i};
                texel.all_around = has_core_ && core(texel).all_around;
            }
        });
        sort_items(texels_, [](const Texel& a, const Texel& b) {
            return a.theta != b.theta ? a.theta < b.theta : a.index < b.index;
        });
    }

    /// Calls add(texel) for those between two colatitudes.
    template <typename Add>
    void for_texels(double from, double to, const Add& add) {
        const auto at = [&](double theta) {
            return int(std::lower_bound(texels_.begin(), texels_.end(), theta,
                                        [](const Texel& t, double value) { return t.theta < value; }) -
                       texels_.begin());
        };
        const int first = at(from), count = at(to) - first;
        parallel_ranges(count, k_texels_at_once, options_.threads, [&](int begin, int end) {
            for (int i = begin; i < end; ++i) add(texels_[std::size_t(first + i)]);
        });
    }

    void add_core() {
        const double h = pyramid_.row_angle();
        const int begin = pyramid_.batch_begin(0), end = pyramid_.batch_end(0);
        const int last = pyramid_.is_complete() ? end : end - 1;
        for_texels((begin - k_core - 2) * h, (end + k_core + 2) * h, [&](Texel& texel) {
            const Box box = core(texel);
            simd::PatchColumns columns{0, pyramid_.columns(), box.all_around, pyramid_.texel_stride()};
            if (!box.all_around) columns.first = int(box.begin), columns.count = int(box.end - box.begin);
            for (int p = std::max(box.row_begin, begin); p <= std::min(box.row_end, last); ++p)
                add(texel.sum, simd::sum_patches(pyramid_.patches(p, box.row_begin, box.row_end, columns.first - 1),
                                                 columns, texel.axis));
        });
    }

    void add_cells(int l, int row_begin, int row_end) {
        const bool is_last = l + 1 == int(reach_.size());
        const double cell = pyramid_.row_angle() * (1 << l),
                     reach = is_last ? 4 : reach_[std::size_t(l) + 1] + 3 * cell;
        for_texels(row_begin * cell - reach, row_end * cell + reach, [&](Texel& texel) {
            const Box outer = is_last ? Box{0, pyramid_.height_at(l), 0, 0, true} : box(texel, l + 1);
            const Box inner = l > 0 ? box(texel, l) : has_core_ ? core(texel) : Box{};
            simd::CellBox cells{};
            const int scale = is_last ? 1 : 2;
            cells.row_begin = std::max(row_begin, outer.row_begin * scale);
            cells.row_end = std::min({row_end, outer.row_end * scale, pyramid_.height_at(l)});
            if (cells.row_begin >= cells.row_end) return;
            set_columns(cells, outer, l);
            cells.hole_row_begin = inner.row_begin, cells.hole_row_end = inner.row_end;
            const double around = 2.0 * pyramid_.columns();
            cells.hole_begin = float(inner.all_around ? -around : inner.begin - texel.axis.x);
            cells.hole_end = float(inner.all_around ? around : inner.end - texel.axis.x);
            add(texel.sum, simd::sum_cells(pyramid_.cells(l), cells, texel.axis));
        });
    }

    /// Columns of cells, as indices in [0, width).
    void set_columns(simd::CellBox& cells, const Box& box, int l) const {
        const int columns = pyramid_.columns();
        const auto index = [l](double x) { return int(std::ceil(x / (1 << l))); };
        if (box.all_around) {
            cells.end[0] = pyramid_.width_at(l);
            return;
        }
        cells.begin[0] = index(std::max(box.begin, 0.0));
        cells.end[0] = index(std::min(box.end, double(columns)));
        if (box.begin < 0) cells.begin[1] = index(box.begin + columns), cells.end[1] = pyramid_.width_at(l);
        if (box.end > columns) cells.begin[1] = 0, cells.end[1] = index(box.end - columns);
    }

    /// How many columns an arc spans at a latitude.
    double columns_of(double angle, double sine) const {
        return angle / (2 * k_pi) * pyramid_.columns() / std::max(sine, 1e-9);
    }

    /// The texels around the axis whose patches are integrated.
    Box core(const Texel& texel) const {
        const int height = pyramid_.height_at(0), columns = pyramid_.columns();
        const int y = std::min(int(texel.theta / pyramid_.row_angle()), height - 1);
        Box box{std::max(y - k_core, 0), std::min(y + k_core + 1, height), 0, 0, false};
        const double sine = std::min(pyramid_.edge_sine(0, box.row_begin), pyramid_.edge_sine(0, box.row_end));
        const double half = columns_of((k_core + 0.5) * pyramid_.row_angle(), sine);
        if (half >= std::min(k_margin - 8.0, columns / 2.0 - 4)) {
            box.all_around = true;
        } else {
            const double x = std::floor(texel.axis.x);
            box.begin = x - std::ceil(half), box.end = x + std::ceil(half) + 1;
        }
        return box;
    }

    /// The cells of level l, as large as that level's reach around the axis, that are left to the levels below.
    Box box(const Texel& texel, int l) const {
        const double cell = pyramid_.row_angle() * (1 << l), reach = reach_[std::size_t(l)];
        const int columns = pyramid_.columns(), size = 1 << l;
        Box box{std::max(int(std::floor((texel.theta - reach) / cell)), 0),
                std::min(int(std::ceil((texel.theta + reach) / cell)), pyramid_.height_at(l)), 0, 0, false};
        const double sine = std::min(pyramid_.edge_sine(l, box.row_begin), pyramid_.edge_sine(l, box.row_end));
        const double half = columns_of(reach, sine);
        if (texel.all_around || 2 * half >= columns - 8 * size) {
            box.all_around = true;
            return box;
        }
        // Outwards to the borders of cells; the last one before the seam may be cut off by it.
        const double low = texel.axis.x - half, high = texel.axis.x + half;
        box.begin = low < 0 ? std::floor((low + columns) / size) * size - columns : std::floor(low / size) * size;
        box.end = high > columns ? columns + std::ceil((high - columns) / size) * size
                                 : std::min(std::ceil(high / size) * size, double(columns));
        return box;
    }

    static void add(simd::LobeSum& sum, const simd::LobeSum& part) {
        sum.r += part.r, sum.g += part.g, sum.b += part.b, sum.weight += part.weight;
    }

    void add_lights(const BrightSplit& split, ImageF& image) const {
        const BrightSplit::Lights lights = split.lights(spec_.kernel);
        const DirectKernelTable kernel(spec_.kernel);
        parallel_ranges(image.height(), 4, options_.threads, [&](int from, int to) {
            const int width = image.width();
            std::vector<float> unit(3 * std::size_t(width));
            float *x = unit.data(), *y = x + width, *z = y + width;
            for (int row = from; row < to; ++row) {
                for (int i = 0; i < width; ++i) {
                    const Vec3d d = options_.world_to_source * direction(row * width + i);
                    x[i] = float(d.x), y[i] = float(d.y), z[i] = float(d.z);
                }
                simd::add_direct_lights(lights.nodes.data(), int(lights.nodes.size()), lights.points.view(),
                                        kernel.view(), x, y, z, width, image.row(row));
            }
        });
    }

    const Pyramid& pyramid_;
    const FilterOptions& options_;
    LevelSpec spec_;
    double b_;
    bool has_core_ = false;
    std::vector<double> reach_;  ///< of each level of the pyramid: nearer than this, finer ones are summed
    std::vector<Texel> texels_;  ///< by colatitude
};

DirectSums::DirectSums(int width, int height, const FilterOptions& options, const std::vector<int>& levels)
    : options_(options) {
    double least = 4;
    for (const int l : levels) least = std::min(least, options.specular[std::size_t(l)].kernel.angular_width());
    pyramid_ = std::make_unique<Pyramid>(width, height, refinement(height, least), options.threads);
    for (const int l : levels)
        levels_.push_back(std::make_unique<Level>(*pyramid_, options_, options.specular[std::size_t(l)]));
}

DirectSums::~DirectSums() = default;

void DirectSums::add_rows(ImageView<const float> rows) {
    pyramid_->add_rows(rows, [&] {
        for (auto& level : levels_) level->add_batch();
        pyramid_->leave_batch();
    });
}

std::vector<FilteredMap> DirectSums::finish(const BrightSplit& split) {
    pyramid_->complete();
    std::vector<FilteredMap> maps;
    for (auto& level : levels_) {
        level->add_kept();
        maps.push_back(level->map(split));
    }
    return maps;
}

}  // namespace domelight
