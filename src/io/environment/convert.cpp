#include "domelight/io/environment/convert.h"

#include "domelight/base/parallel.h"
#include "domelight/filtering/resample/area_resample.h"
#include "domelight/image/row_source.h"

#include "image/row_sum.h"
#include "io/environment/convert_rows.h"

#include <algorithm>
#include <cmath>

namespace domelight {

namespace {

/// Reads rows, and adds up their radiant power and reports progress while it does so.
class MeasuredRows {
  public:
    MeasuredRows(RowSource& rows, const Progress& progress) : rows_(rows), progress_(progress) {}
    Result<void> read(ImageView<float> block, int threads) {
        if (const auto read = rows_.read(block); !read) return read;
        std::vector<Vec3d> sums(std::size_t(block.height));
        parallel_for(block.height, threads, [&](int y) {
            sums[std::size_t(y)] = row_sum({block.row(y), std::size_t(3) * std::size_t(block.width)}) *
                                   latlong_solid_angle(next_ + y, rows_.width(), rows_.height());
        });
        for (const Vec3d& sum : sums) power_ += sum;
        next_ += block.height;
        if (progress_ && !progress_("convert", double(next_) / rows_.height())) return Error{"cancelled", "", ""};
        return {};
    }
    const Vec3d& power() const { return power_; }

  private:
    RowSource& rows_;
    const Progress& progress_;
    Vec3d power_;
    int next_ = 0;
};

/// Rows in a block: few enough to stay in a core's cache until they are used, more where several cores share them.
int block_rows(int threads) {
    return resolve_threads(threads) <= 2 ? 16 : 64;
}

Result<ImageF> stream(RowSource& rows, AreaResampler& resampler, const ConvertOptions& options, Vec3d& power) {
    MeasuredRows measured(rows, options.progress);
    ImageF block(rows.width(), std::min(block_rows(options.threads), rows.height()), 3);
    for (int y = 0; y < rows.height(); y += block.height()) {
        const ImageView<float> view = block.view().rows(0, std::min(block.height(), rows.height() - y));
        if (const auto read = measured.read(view, options.threads); !read) return read.error();
        resampler.add_rows(view);
    }
    power = measured.power();
    return resampler.finish();
}

bool permutes_axes(const Mat3& m) {
    for (const Vec3d& r : m.row)
        for (const double e : {r.x, r.y, r.z})
            if (std::abs(e - std::round(e)) > 1e-12) return false;
    return true;
}

/// The converted image where it can be computed while rows are read; nothing where the whole image is needed first.
Result<std::optional<ImageF>> by_rows(const Environment& environment, const Projection& target,
                                      const Mat3& world_to_source, const ConvertOptions& o, Conversion& result) {
    const RowConversion conversion = convert_rows(environment.latlong_width(), environment.latlong_height(), target,
                                                  o.width, o.height, world_to_source, o.threads, o.sharp);
    if (!conversion.rows) return std::optional<ImageF>();
    const auto rows = environment.rows();
    if (!rows) return rows.error();
    auto image = stream(**rows, *conversion.rows, o, result.power_before);
    if (!image) return image.error();
    result.method = conversion.copies ? "copy" : "exact";
    return std::optional<ImageF>(*std::move(image));
}

/// The conversion, with the power of what was read after its repair as that before.
Result<Conversion> convert_repaired(const Environment& environment, const Projection& target, const ConvertOptions& o) {
    Conversion result{{target, {}}, {}, {}, "conservative"};
    const Mat3 world_to_source = environment.world_to_source * o.turn.transposed();
    if (environment.storage() == Environment::Storage::rows) {
        auto image = by_rows(environment, target, world_to_source, o, result);
        if (!image) return image.error();
        if (*image) {
            result.image.pixels = **std::move(image);
            result.power_after = radiant_power(result.image, o.threads);
            return result;
        }
    }
    ProjectedImage source{*projection_from_name("cube"), {}};
    if (const Cubemap* cube = environment.cube()) {
        const Mat3 m = world_to_source * target.world_to_picture().transposed();
        if (target.name() == "cube" && target.grid() == SampleGrid::centres && o.height == cube->size() &&
            permutes_axes(m)) {
            ProjectedImage moved = projected_cube(area_resample_cube(*cube, o.width, m, o.threads));
            result.method = "copy";
            result.power_before = radiant_power(moved, o.threads);
            result.image.pixels = std::move(moved.pixels);
            result.power_after = result.power_before;
            return result;
        }
        source = projected_cube(*cube, world_to_source);
    } else if (const ProjectedImage* picture = environment.picture()) {
        source = {picture->projection.turned(world_to_source), picture->pixels};
    } else {
        const auto rows = environment.rows();
        if (!rows) return rows.error();
        auto image = read_latlong(**rows);
        if (!image) return image.error();
        source = {projection_from_name("latlong")->turned(world_to_source), *std::move(image)};
    }
    result.power_before = radiant_power(source, o.threads);
    result.image = reproject(source, target, o.width, o.height, o.threads, o.progress);
    result.power_after = radiant_power(result.image, o.threads);
    return result;
}

/// Undoes in the power of the repaired image what the repair changed.
Vec3d power_as_stored(const Vec3d& repaired, const Vec3d& share_added) {
    return {repaired.x / (1 + share_added.x), repaired.y / (1 + share_added.y), repaired.z / (1 + share_added.z)};
}

}  // namespace

Result<Conversion> convert(const Environment& environment, const Projection& target, const ConvertOptions& o) {
    auto made = convert_repaired(environment, target, o);
    if (made) made->power_before = power_as_stored(made->power_before, environment.report().share_added());
    return made;
}

int matched_height(const Environment& environment, const Projection& target) {
    const ProjectionShape& shape = target.shape();
    double latlong = environment.latlong_height();
    if (const ProjectedImage* picture = environment.picture())
        latlong = picture->projection.shape().latlong_height(
            picture->height());  // rows() may be smaller: its height is bounded
    return std::max(1, int(std::round(latlong * 1000 / shape.latlong_height(1000))));
}

}  // namespace domelight
