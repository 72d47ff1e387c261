#include "domelight/environment/environment.h"

#include "domelight/filtering/resample/area_resample.h"
#include "domelight/projection/projection.h"

#include "base/mutex.h"
#include "base/text.h"
#include "projection/bilinear.h"

#include <algorithm>
#include <optional>

namespace domelight {
namespace {

/// The greatest height that a lat-long image made from another projection gets.
constexpr int k_most_latlong_height = 8192;

/// Rows of an image that several readers share.
class SharedRows : public RowSource {
  public:
    explicit SharedRows(std::shared_ptr<const ImageF> image) : image_(std::move(image)), rows_(image_->view()) {}
    int width() const override { return rows_.width(); }
    int height() const override { return rows_.height(); }
    Result<void> read(ImageView<float> rows) override { return rows_.read(rows); }

  private:
    std::shared_ptr<const ImageF> image_;
    ImageRowSource rows_;
};

}  // namespace

/// What the copies of an environment share.
struct Environment::State {
    // Set once, before the environment is handed out.
    Storage storage = Storage::none;
    int latlong_width = 0, latlong_height = 0;
    RowsOpener open_rows;
    std::optional<Cubemap> cube;
    std::optional<ProjectedImage> picture;
    std::int64_t max_bytes = 0;
    int threads = 0;

    Mutex mutex;  // over the rest
    RepairReport report;
    std::shared_ptr<const ImageF> latlong;
    std::shared_ptr<const BorderedCube> bordered;

    /// The stored cube or picture as a lat-long image.
    Result<std::shared_ptr<const ImageF>> resampled() const;
    std::shared_ptr<const BorderedCube> bordered_cube() {
        const Lock lock(mutex);
        if (!bordered) bordered = std::make_shared<const BorderedCube>(*cube);
        return bordered;
    }
    std::shared_ptr<const ImageF> kept() {
        const Lock lock(mutex);
        return latlong;
    }
};

namespace {

/// Rows of which a report is kept: it becomes the environment's own when the last row has been read.
class ReportedRows : public RowSource {
  public:
    using Publish = std::function<void(const RepairReport&)>;
    ReportedRows(std::unique_ptr<RowSource> rows, std::shared_ptr<const RepairReport> report, Publish publish)
        : rows_(std::move(rows)), report_(std::move(report)), publish_(std::move(publish)) {}
    int width() const override { return rows_->width(); }
    int height() const override { return rows_->height(); }
    Result<void> read(ImageView<float> rows) override {
        if (auto ok = rows_->read(rows); !ok) return ok;
        next_row_ += rows.height;
        if (next_row_ == height()) publish_(*report_);
        return {};
    }

  private:
    std::unique_ptr<RowSource> rows_;
    std::shared_ptr<const RepairReport> report_;
    Publish publish_;
    int next_row_ = 0;
};

}  // namespace

Environment::Environment() : state_(std::make_shared<State>()) {}

Environment Environment::from_latlong(ImageF latlong, const Mat3& world_to_source) {
    Environment environment;
    environment.projection = "latlong";
    environment.world_to_source = world_to_source;
    environment.width = environment.state_->latlong_width = latlong.width();
    environment.height = environment.state_->latlong_height = latlong.height();
    environment.state_->storage = Storage::rows;
    environment.state_->latlong = std::make_shared<const ImageF>(std::move(latlong));
    return environment;
}

Environment Environment::from_rows(int width, int height, RowsOpener open, std::vector<std::string> notes) {
    Environment environment;
    environment.projection = "latlong";
    environment.width = environment.state_->latlong_width = width;
    environment.height = environment.state_->latlong_height = height;
    environment.state_->storage = Storage::rows;
    environment.state_->open_rows = std::move(open);
    environment.state_->report.warnings = std::move(notes);
    return environment;
}

Environment Environment::from_cube(Cubemap cube, const Mat3& world_to_source, RepairReport report, int threads) {
    Environment environment;
    environment.projection = "cube";
    environment.world_to_source = world_to_source;
    environment.width = environment.height = cube.size();
    State& state = *environment.state_;
    state.storage = Storage::cube;
    state.latlong_width = 4 * cube.size();
    state.latlong_height = 2 * cube.size();
    state.cube = std::move(cube);
    state.report = std::move(report);
    state.threads = threads;
    return environment;
}

Environment Environment::from_picture(ProjectedImage picture, const Mat3& world_to_source, RepairReport report,
                                      std::int64_t max_bytes, int threads) {
    Environment environment;
    environment.projection = picture.projection.name();
    environment.world_to_source = world_to_source;
    environment.width = picture.width();
    environment.height = picture.height();
    State& state = *environment.state_;
    state.storage = Storage::picture;
    state.latlong_height =
        std::clamp(picture.projection.shape().latlong_height(picture.height()), 1, k_most_latlong_height);
    state.latlong_width = 2 * state.latlong_height;
    state.picture = std::move(picture);
    state.report = std::move(report);
    state.max_bytes = max_bytes;
    state.threads = threads;
    return environment;
}

Environment::Storage Environment::storage() const {
    return state_->storage;
}

const Cubemap* Environment::cube() const {
    return state_->cube ? &*state_->cube : nullptr;
}

const ProjectedImage* Environment::picture() const {
    return state_->picture ? &*state_->picture : nullptr;
}

int Environment::latlong_width() const {
    return state_->latlong_width;
}

int Environment::latlong_height() const {
    return state_->latlong_height;
}

Result<std::shared_ptr<const ImageF>> Environment::State::resampled() const {
    if (cube) return std::make_shared<const ImageF>(area_resample_cube_to_latlong(*cube, latlong_height, {}, threads));
    const std::int64_t bytes = std::int64_t(latlong_width) * latlong_height * 3 * std::int64_t(sizeof(float));
    if (bytes > max_bytes)
        return Error{text("the lat-long image needs ", bytes, " bytes, more than the limit of ", max_bytes), "", ""};
    return std::make_shared<const ImageF>(
        reproject(*picture, *projection_from_name("latlong"), latlong_width, latlong_height, threads).pixels);
}

Result<std::unique_ptr<RowSource>> Environment::rows() const {
    if (state_->storage == Storage::none) return Error{"the environment holds no light", "", ""};
    if (auto image = state_->kept()) return std::unique_ptr<RowSource>(std::make_unique<SharedRows>(std::move(image)));
    if (state_->storage != Storage::rows) {
        auto image = latlong();
        if (!image) return image.error();
        return std::unique_ptr<RowSource>(std::make_unique<SharedRows>(*std::move(image)));
    }
    const auto report = std::make_shared<RepairReport>();
    auto rows = state_->open_rows(report);
    if (!rows) return rows.error();
    return std::unique_ptr<RowSource>(
        std::make_unique<ReportedRows>(*std::move(rows), report, [state = state_](const RepairReport& complete) {
            const Lock lock(state->mutex);
            state->report = complete;
        }));
}

Result<std::shared_ptr<const ImageF>> Environment::latlong() const {
    if (auto image = state_->kept()) return image;
    Result<std::shared_ptr<const ImageF>> image = std::shared_ptr<const ImageF>();
    if (state_->cube || state_->picture) {
        image = state_->resampled();
    } else {
        auto source = rows();
        if (!source) return source.error();
        auto pixels = read_latlong(**source);
        if (!pixels) return pixels.error();
        image = std::make_shared<const ImageF>(*std::move(pixels));
    }
    if (!image) return image.error();
    const Lock lock(state_->mutex);
    if (!state_->latlong) state_->latlong = *image;
    return state_->latlong;
}

Result<Vec3f> Environment::radiance(const Vec3d& direction) const {
    const Vec3d source = world_to_source * direction;
    if (state_->cube) return look_up(*state_->bordered_cube(), Vec3f(source));
    const auto image = latlong();
    if (!image) return image.error();
    return bilinear(**image, latlong_uv(source), true);
}

RepairReport Environment::report() const {
    const Lock lock(state_->mutex);
    return state_->report;
}

}  // namespace domelight
