#include "filtering/resample/area_resample_aligned.h"

#include "domelight/base/parallel.h"
#include "domelight/projection/projection.h"

#include "base/aligned.h"
#include "base/mutex.h"
#include "base/sort.h"
#include "filtering/resample/area_resample_tile.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace domelight::area {

std::optional<AlignedOrientation> align(const Mat3& m) {
    const Vec3d axes[6] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    const Vec3d *polar = nullptr, *first = nullptr;
    for (const Vec3d& e : axes)
        if (length(m.row[1] - e) < 1e-12) polar = &e;
    if (!polar) return std::nullopt;
    // The axis that is nearest to the source's x: rotation_y(angle) has rows (c, 0, -s), (0, 1, 0), (s, 0, c).
    for (const Vec3d& e : axes)
        if (!first || dot(m.row[0], e) > dot(m.row[0], *first) + 1e-9) first = &e;
    const double c = dot(m.row[0], *first), s = dot(m.row[2], *first);
    const Vec3d third = (m.row[2] - *first * s) / c;
    AlignedOrientation out{{{*first, *polar, {std::round(third.x), std::round(third.y), std::round(third.z)}}},
                           std::atan2(s, c)};
    if (std::abs(out.angle) < 1e-12) out.angle = 0;
    return out;
}

namespace {

/// The faces (and quarters of the polar faces) with the same pattern of columns: they share one set of stencils.
struct PhaseGroup {
    ColumnPhase columns;
    struct Member {
        int quarter;  ///< turns about the polar axis: face 0..3 at azimuth quarter * 90 degrees
        int origin;   ///< source column of node 0
    };
    std::vector<Member> members;
    bool mirror_symmetric;    ///< the pattern is its own mirror image about the middle of a face
    bool diagonal_symmetric;  ///< the same about 45 degrees
};

struct PlacedTile {
    TileShape shape;
    int group;
    bool whole_height;  ///< its stencils hold both hemispheres
    int first_row, last_row;
    std::vector<simd::StencilInstance> north, south;
    Tile stencils;
};

/// The `tile` of the jobs that compute the middle texels of the polar faces of an odd size.
constexpr int k_pole = -1;

struct Job {
    int tile;
    bool south;
    int first_row, last_row;
};

class AlignedResampler : public AreaResampler {
  public:
    AlignedResampler(int width, int height, int size, const AlignedOrientation& orientation, int threads);
    void add_rows(ImageView<const float> rows) override;
    ImageF finish() override;

  private:
    void make_groups();
    void make_tiles();
    void add_tiles(bool polar, int group, int i0, int j0, int j1, bool triangle);
    PlacedTile place(const TileShape& shape, int group, bool use_mirror) const;
    std::pair<int, int> rows_of(const TileShape& shape) const;
    simd::StencilInstance instance(const TileShape& shape, const PhaseGroup::Member& member, bool mirror, bool south,
                                   int mirror_sum) const;
    std::ptrdiff_t out_texel(bool polar, int quarter, bool mirror, bool south, int i, int j) const;
    void copy_rows(ImageView<const float> rows);
    void process();
    void run(const Job& job);
    void store_pole_texel(bool south);
    void apply(const PlacedTile& tile, std::span<const simd::StencilInstance> instances, bool south);

    int width_, height_, size_, threads_;
    AlignedOrientation orientation_;
    SourceGrid grid_;
    std::vector<PhaseGroup> groups_;
    std::vector<PlacedTile> tiles_;
    std::vector<Job> jobs_;  ///< by last row
    std::size_t next_job_ = 0;
    AlignedArray<float> ring_data_;
    simd::RowRing ring_;
    int batch_ = 0, received_ = 0, processed_ = 0;
    ImageF out_;
    Mutex builders_mutex_;
    std::vector<std::unique_ptr<TileBuilder>> builders_;
    StencilArena arena_;
};

AlignedResampler::AlignedResampler(int width, int height, int size, const AlignedOrientation& orientation, int threads)
    : width_(width),
      height_(height),
      size_(size),
      threads_(resolve_threads(threads)),
      orientation_(orientation),
      grid_(width, height),
      out_(ImageF::uninitialized(size, 6 * size, 3)) {
    make_groups();
    make_tiles();
    int span = 1;
    for (const Job& j : jobs_) span = std::max(span, j.last_row - j.first_row + 1);
    // Work starts when the ring buffer is full. A small one stays in the caches.
    ring_.capacity = int(std::bit_ceil(unsigned(span + 24)));
    batch_ = ring_.capacity - span;
    ring_.width = width;
    ring_.height = height;
    ring_.stride = 4 * ring_.quarter_stride() + 16 * 7;
    ring_data_ = AlignedArray<float>(ring_.stride * ring_.capacity, false);
    ring_.data = ring_data_.data();
}

void AlignedResampler::make_groups() {
    for (int quarter = 0; quarter < 4; ++quarter) {
        // Source column (of texel centres) that lies at the middle of the face.
        const double middle = (0.25 * quarter + orientation_.angle / (2 * k_pi) + 0.5) * width_ - 0.5;
        double origin = std::floor(middle), phase = middle - origin;
        if (phase > 1 - 1e-9) phase = 0, origin += 1;
        if (phase < 1e-9) phase = 0;
        const PhaseGroup::Member member{quarter, int(origin)};
        const auto same = [&](const PhaseGroup& g) { return std::abs(g.columns.phase - phase) < 1e-9; };
        if (const auto g = std::ranges::find_if(groups_, same); g != groups_.end()) {
            g->members.push_back(member);
            continue;
        }
        const bool symmetric = phase == 0 || std::abs(phase - 0.5) < 1e-9;
        groups_.push_back({ColumnPhase(grid_, symmetric && phase > 0 ? 0.5 : phase),
                           {member},
                           symmetric,
                           symmetric && width_ % 4 == 0});
    }
}

void AlignedResampler::make_tiles() {
    for (int g = 0; g < int(groups_.size()); ++g) {
        const PhaseGroup& group = groups_[g];
        // Side faces: the upper half (with the middle row), or its right half where the left one is the mirror image.
        add_tiles(false, g, group.mirror_symmetric ? size_ / 2 : 0, 0, (size_ + 1) / 2, false);
        // Polar faces: a quarter, or half of it.
        add_tiles(true, g, (size_ + 1) / 2, size_ / 2, size_, group.diagonal_symmetric && size_ % 2 == 0);
    }
    for (int t = 0; t < int(tiles_.size()); ++t) {
        const PlacedTile& tile = tiles_[t];
        jobs_.push_back({t, false, tile.first_row, tile.last_row});
        if (!tile.whole_height) jobs_.push_back({t, true, height_ - 1 - tile.last_row, height_ - 1 - tile.first_row});
    }
    if (size_ % 2) {
        const double corner = std::atan(std::sqrt(2.0) / size_);
        const int last = std::min(height_ - 1, int(corner / grid_.row_angle) + 2);
        jobs_.push_back({k_pole, false, 0, last});
        jobs_.push_back({k_pole, true, height_ - 1 - last, height_ - 1});
    }
    sort_stably(jobs_, [](const Job& a, const Job& b) { return a.last_row < b.last_row; });
}

void AlignedResampler::add_tiles(bool polar, int group, int i0, int j0, int j1, bool triangle) {
    // Small enough for a short window of source rows, and large enough that the lines shared by neighbouring tiles cost
    // little.
    const double rows_per_texel = 1.5 * 2 / size_ / grid_.row_angle;
    const int edge = std::clamp(int(96 / rows_per_texel), 1, simd::k_block_side);
    // The middle row of an odd size needs its own tiles: its stencils hold both hemispheres.
    const bool middle_row = !polar && size_ % 2;
    const int regular = middle_row ? j1 - 1 : j1;
    for (int j = j0; j < j1; j += edge)
        for (int i = i0; i < size_; i += edge) {
            const int end = std::min(size_, i + edge);
            // Only texels with x >= z where the others are their mirror images; the tiles that hold the diagonal are
            // whole, and not mirrored.
            if (triangle && end - 1 - size_ / 2 < j - size_ / 2) continue;
            const bool on_diagonal = i < std::min(j1, j + edge);
            if (j < regular)
                tiles_.push_back(place({polar, i, end, j, std::min(regular, j + edge)}, group,
                                       polar ? triangle && !on_diagonal : true));
        }
    if (middle_row)
        for (int i = i0; i < size_; i += edge)
            tiles_.push_back(place({false, i, std::min(size_, i + edge), j1 - 1, j1}, group, true));
}

/// Source rows that the northern stencils of a tile may touch, with a row to spare either side.
std::pair<int, int> AlignedResampler::rows_of(const TileShape& shape) const {
    const auto coordinate = [&](int k) { return std::abs(2.0 * k - size_) / size_; };
    const auto range = [&](int a, int b) {
        const bool straddles = 2 * a < size_ && 2 * b > size_;
        return std::pair(straddles ? 0.0 : std::min(coordinate(a), coordinate(b)),
                         std::max(coordinate(a), coordinate(b)));
    };
    const auto [x0, x1] = range(shape.i0, shape.i1);
    double theta0, theta1;
    if (shape.polar) {
        const auto [z0, z1] = range(shape.j0, shape.j1);
        theta0 = std::atan(std::hypot(x0, z0));
        theta1 = std::atan(std::hypot(x1, z1));
    } else {
        const double top = coordinate(shape.j0), bottom = 2 * shape.j1 > size_ ? 0 : coordinate(shape.j1);
        theta0 = std::atan2(std::hypot(1, x0), top);
        theta1 = std::atan2(std::hypot(1, x1), bottom);
    }
    const int first = std::max(0, int(std::floor(theta0 / grid_.row_angle - 0.5)) - 1);
    const int last = std::min(height_ - 1, int(std::floor(theta1 / grid_.row_angle - 0.5)) + 2);
    const bool middle = !shape.polar && 2 * shape.j1 > size_;
    return {middle ? std::min(first, height_ - 1 - last) : first,
            middle ? height_ - 1 - std::min(first, height_ - 1 - last) : last};
}

/// Texel (i, j) of a face in the source's aligned frame, turned by `quarter` and mirrored: its place in the output
/// strip.
std::ptrdiff_t AlignedResampler::out_texel(bool polar, int quarter, bool mirror, bool south, int i, int j) const {
    const double a = (2.0 * i + 1 - size_) / size_, b = (2.0 * j + 1 - size_) / size_;
    // Before turning: side faces look along +x with +z to the right and b downwards; polar ones have i along x and j
    // along z.
    Vec3d d;
    if (polar)
        d = {mirror ? b : a, south ? -1.0 : 1.0, mirror ? a : b};
    else
        d = {1, south ? b : -b, mirror ? -a : a};
    for (int q = 0; q < quarter; ++q) d = {-d.z, d.y, d.x};  // +x to +z
    const CubePoint p = cube_point(orientation_.axes.transposed() * d);
    const int x = int(p.uv.u * size_), y = int(p.uv.v * size_);
    return (std::ptrdiff_t(p.face) * size_ + y) * size_ + x;
}

simd::StencilInstance AlignedResampler::instance(const TileShape& s, const PhaseGroup::Member& member, bool mirror,
                                                 bool south, int mirror_sum) const {
    simd::StencilInstance out;
    out.direction = mirror ? -1 : 1;
    out.column_origin = ((member.origin + (mirror ? mirror_sum : 0)) % width_ + width_) % width_;
    out.out = out_texel(s.polar, member.quarter, mirror, south, s.i0, s.j0);
    if (s.i1 > s.i0 + 1) out.out_i = out_texel(s.polar, member.quarter, mirror, south, s.i0 + 1, s.j0) - out.out;
    if (s.j1 > s.j0 + 1) out.out_j = out_texel(s.polar, member.quarter, mirror, south, s.i0, s.j0 + 1) - out.out;
    return out;
}

PlacedTile AlignedResampler::place(const TileShape& shape, int g, bool use_mirror) const {
    const PhaseGroup& group = groups_[g];
    PlacedTile tile{.shape = shape,
                    .group = g,
                    .whole_height = !shape.polar && 2 * shape.j1 > size_,
                    .first_row = 0,
                    .last_row = 0,
                    .north = {},
                    .south = {},
                    .stencils = {}};
    std::tie(tile.first_row, tile.last_row) = rows_of(shape);
    // Mirrored, node n becomes node mirror_sum - n: about the face's middle, or about 45 degrees from it.
    const int mirror_sum = int(std::lround(2 * group.columns.phase)) + (shape.polar ? width_ / 4 : 0);
    for (const bool mirror : {false, true}) {
        if (mirror && !(use_mirror && group.mirror_symmetric)) continue;
        for (const PhaseGroup::Member& member : group.members) {
            tile.north.push_back(instance(shape, member, mirror, false, mirror_sum));
            tile.south.push_back(instance(shape, member, mirror, true, mirror_sum));
        }
    }
    return tile;
}

void AlignedResampler::copy_rows(ImageView<const float> rows) {
    const auto copy = [&](int y) {
        const float* from = rows.row(y);
        float* to = ring_data_.data() + ((received_ + y) & (ring_.capacity - 1)) * ring_.stride;
        const int quarter = ring_.quarter();
        for (int q = 0; q * quarter < width_; ++q, to += ring_.quarter_stride()) {
            const int first = q * quarter, count = std::min(quarter, width_ - first);
            // The fourth float of a texel is the first of the next one, which is finite like the others.
            const int whole = first + count < width_ ? count : count - 1;
            for (int x = 0; x < whole; ++x) std::memcpy(to + 4 * x, from + 3 * (first + x), 4 * sizeof(float));
            for (int x = whole; x < count + simd::k_ring_padding; ++x) {
                std::memcpy(to + 4 * x, from + 3 * ((first + x) % width_), 3 * sizeof(float));
                to[4 * x + 3] = 0;
            }
        }
    };
    parallel_ranges(rows.height, 4, std::int64_t(rows.height) * width_ < 1 << 16 ? 1 : threads_,
                    [&](int begin, int end) {
                        for (int y = begin; y < end; ++y) copy(y);
                    });
    received_ += rows.height;
}

void AlignedResampler::add_rows(ImageView<const float> rows) {
    assert(rows.width == width_ && rows.channels == 3 && received_ + rows.height <= height_);
    for (int y = 0; y < rows.height;) {
        const int count = std::min(rows.height - y, processed_ + batch_ - received_);
        copy_rows(rows.rows(y, count));
        y += count;
        if (received_ == processed_ + batch_ || received_ == height_) process();
    }
}

/// Runs every job whose rows have all been read.
void AlignedResampler::process() {
    processed_ = received_;
    std::vector<Job> north, south;
    for (; next_job_ < jobs_.size() && jobs_[next_job_].last_row < received_; ++next_job_)
        (jobs_[next_job_].south ? south : north).push_back(jobs_[next_job_]);
    // The southern half uses the stencils of the northern half.
    parallel_for(int(north.size()), threads_, [&](int k) { run(north[k]); });
    parallel_for(int(south.size()), threads_, [&](int k) { run(south[k]); });
}

/// The middle texel of a polar face of an odd size is the mean of four quarters, one for each side face below it.
void AlignedResampler::store_pole_texel(bool south) {
    TileBuilder builder(grid_, size_, arena_);
    float quarters[12], *out = out_.pixels().data() + 3 * out_texel(true, 0, false, south, size_ / 2, size_ / 2);
    for (const PhaseGroup& group : groups_) {
        const Tile tile = builder.build_pole_quarter(group.columns);
        for (const PhaseGroup::Member& member : group.members) {
            const simd::StencilInstance place{(member.origin % width_ + width_) % width_, 1, member.quarter, 0, 0};
            simd::apply_stencils(
                {tile.stencils, tile.weights, 1, 1, tile.first_row, tile.last_row, tile.first_column, tile.last_column},
                std::span(&place, 1), ring_, south, quarters);
        }
    }
    for (int c = 0; c < 3; ++c)
        out[c] = 0.25f * ((quarters[c] + quarters[3 + c]) + (quarters[6 + c] + quarters[9 + c]));
}

void AlignedResampler::run(const Job& job) {
    if (job.tile == k_pole) {
        store_pole_texel(job.south);
        return;
    }
    PlacedTile& tile = tiles_[job.tile];
    if (!job.south) {
        std::unique_ptr<TileBuilder> builder;
        {
            const Lock lock(builders_mutex_);
            if (!builders_.empty()) {
                builder = std::move(builders_.back());
                builders_.pop_back();
            }
        }
        if (!builder) builder = std::make_unique<TileBuilder>(grid_, size_, arena_);
        tile.stencils = builder->build(tile.shape, groups_[tile.group].columns);
        const Lock lock(builders_mutex_);
        builders_.push_back(std::move(builder));
    }
    apply(tile, job.south ? tile.south : tile.north, job.south);
}

void AlignedResampler::apply(const PlacedTile& tile, std::span<const simd::StencilInstance> instances, bool south) {
    for ([[maybe_unused]] const simd::Stencil& s : tile.stencils.stencils)
        assert(s.row >= tile.first_row && s.row + s.rows - 1 <= tile.last_row);
    const Tile& t = tile.stencils;
    const simd::StencilBlock block{t.stencils,
                                   t.weights,
                                   tile.shape.i1 - tile.shape.i0,
                                   tile.shape.j1 - tile.shape.j0,
                                   t.first_row,
                                   t.last_row,
                                   t.first_column,
                                   t.last_column};
    simd::apply_stencils(block, instances, ring_, south, out_.pixels().data());
}

ImageF AlignedResampler::finish() {
    assert(received_ == height_ && next_job_ == jobs_.size());
    return std::move(out_);
}

}  // namespace

std::unique_ptr<AreaResampler> aligned_to_cube(int width, int height, int size, const AlignedOrientation& orientation,
                                               int threads) {
    return std::make_unique<AlignedResampler>(width, height, size, orientation, threads);
}

}  // namespace domelight::area
