#include "view/truth.h"

#include "domelight/base/parallel.h"
#include "domelight/scene/scene.h"

#include "base/field_place.h"
#include "io/file/json_fields.h"

#include <fmt/core.h>

#include <chrono>
#include <cmath>
#include <optional>

namespace domelight {

struct Truth::Loaded {
    RayScene scene;
    Environment environment;
};

namespace {

using Clock = std::chrono::steady_clock;

/// The largest picture that is rendered, in pixels.
constexpr std::int64_t k_most_pixels = std::int64_t(1) << 23;

struct TruthRequest {
    RenderOptions options;
    double rotate_y_deg = 0;
};

/// The whole number `key` of a request.
Result<int> whole(const Json& request, const char* key, int fallback, int low, int high) {
    const Json* value = request.find(key);
    if (!value) return fallback;
    const double number = value->is_number() ? value->get<double>() : std::nan("");
    if (number >= low && number <= high && number == std::floor(number)) return int(number);
    return Error{fmt::format("{} is not a whole number from {} to {}", value->dump(), low, high), field_place(key), ""};
}

Result<double> within(const Json& request, const char* key, std::optional<double> fallback, double low, double high) {
    const Json* value = request.find(key);
    if (!value && fallback) return *fallback;
    if (!value) return Error{"is missing", field_place(key), ""};
    const double number = value->is_number() ? value->get<double>() : std::nan("");
    if (number >= low && number <= high) return number;
    return Error{fmt::format("{} is not a number from {} to {}", value->dump(), low, high), field_place(key), ""};
}

Result<Vec3f> point(const Json& request, const char* key) {
    const Json* value = request.find(key);
    Vec3f p;
    float* const to[] = {&p.x, &p.y, &p.z};
    bool good = value && value->elements().size() == 3;
    for (std::size_t i = 0; good && i < 3; ++i) {
        const Json& number = value->elements()[i];
        good = number.is_number() && std::abs(number.get<double>()) <= 1e9;
        if (good) *to[i] = number.get<float>();
    }
    if (!good) return Error{"is not three numbers from -1e9 to 1e9", field_place(key), ""};
    return p;
}

bool flag(const Json& request, const char* key, bool fallback) {
    const Json* value = request.find(key);
    return value && value->is_boolean() ? value->get<bool>() : fallback;
}

/// The camera of a picture of height x width pixels in whose upper left corner lies that of `camera`, which is view_width x
/// view_height: with the same steps from pixel to pixel, and its middle where `camera` looks. A view off the middle is a
/// shear: u right + v up - back, with u and v moved, is a sum of the moved `back`.
Camera continued(Camera camera, int view_width, int view_height, int width, int height) {
    const float step = 2 * std::tan(0.5f * camera.fov_y) / float(view_height);
    const float right = 0.5f * step * float(width - view_width), down = 0.5f * step * float(height - view_height);
    Affine& m = camera.to_world;
    m.z = m.z - m.x * right + m.y * down;
    camera.fov_y = 2 * std::atan(0.5f * step * float(height));
    return camera;
}

Result<TruthRequest> parse(std::string_view text) {
    const auto json = parse_json(text);
    if (!json) return json.error();
    if (!json->is_object()) return Error{"the request is not a JSON object", "", ""};
    const auto width = whole(*json, "width", 512, 1, 8192), height = whole(*json, "height", 512, 1, 8192),
               samples = whole(*json, "samples", 256, 1, 65536), bounces = whole(*json, "bounces", 0, 0, 64),
               seed = whole(*json, "seed", 0, 0, 1 << 30);
    for (const auto* number : {&width, &height, &samples, &bounces, &seed})
        if (!*number) return number->error();
    if (std::int64_t(*width) * *height > k_most_pixels)
        return Error{fmt::format("{} x {} is more than 2^23 pixels", *width, *height), field_place("width"), ""};
    const auto view_width = whole(*json, "view_width", *width, 1, *width),
               view_height = whole(*json, "view_height", *height, 1, *height);
    for (const auto* number : {&view_width, &view_height})
        if (!*number) return number->error();
    const auto position = point(*json, "position"), target = point(*json, "target");
    for (const auto* place : {&position, &target})
        if (!*place) return place->error();
    const auto fov = within(*json, "fov_y_deg", std::nullopt, 0.1, 170),
               turn = within(*json, "rotate_y_deg", 0.0, -1e6, 1e6);
    for (const auto* number : {&fov, &turn})
        if (!*number) return number->error();

    TruthRequest request;
    request.rotate_y_deg = *turn;
    RenderOptions& o = request.options;
    o.width = *width, o.height = *height, o.samples = *samples, o.bounces = *bounces, o.seed = std::uint64_t(*seed);
    o.occlusion = flag(*json, "occlusion", true);
    o.multiple_scattering = flag(*json, "multiple_scattering", false);
    o.background = flag(*json, "transparent", false) ? Background::transparent : Background::environment;
    o.camera =
        continued(look_at(*position, *target, float(*fov * k_pi / 180)), *view_width, *view_height, *width, *height);
    return request;
}

}  // namespace

Truth::Truth(std::filesystem::path scene, std::vector<std::filesystem::path> environment, EnvironmentOptions options,
             int threads)
    : scene_(std::move(scene)), environment_(std::move(environment)), options_(std::move(options)), threads_(threads) {}

Result<std::shared_ptr<const Truth::Loaded>> Truth::loaded() {
    const std::lock_guard lock(loading_);
    if (loaded_) return loaded_;
    SceneOptions scene_options;
    scene_options.threads = threads_;
    auto scene = load_scene(scene_, scene_options);
    if (!scene) return scene.error();
    auto environment = open_environment(environment_, options_);
    if (!environment) return environment.error();
    auto traced = RayScene::build(*std::move(scene));
    if (!traced) return traced.error().at(scene_.string());
    loaded_ = std::make_shared<const Loaded>(Loaded{*std::move(traced), *std::move(environment)});
    return loaded_;
}

Result<void> Truth::render(std::uint64_t number, std::string_view text, const Receive& receive) {
    auto request = parse(text);
    if (!request) return request.error();
    const std::lock_guard lock(rendering_);
    bool wanted = true;
    const auto goes_on = [&] { return wanted && newest_ == number && !stopped_; };
    if (!goes_on()) return Error{"cancelled", "", ""};
    const auto files = loaded();
    if (!files) return files.error();
    Environment light = (*files)->environment;
    light.world_to_source = light.world_to_source * rotation_y(request->rotate_y_deg * k_pi / 180).transposed();
    RenderOptions& options = request->options;
    options.threads = threads_;
    const auto sampler = EnvironmentSampler::build(light, reference_sampler_options(options.strategy, threads_));
    if (!sampler) return sampler.error();

    // The first frame as soon as there is one, the next ones after longer and longer pauses, up to a second.
    RenderStatus status;
    auto shown = Clock::now();
    double pause = 0.05;
    options.status = [&](const RenderStatus& now) { status = now; };
    options.progress = [&](std::string_view, double) { return goes_on(); };
    options.checkpoint_wanted = [&] { return std::chrono::duration<double>(Clock::now() - shown).count() >= pause; };
    options.checkpoint = [&](const RenderResult& so_far) {
        if (!goes_on()) return;
        wanted = receive({so_far.radiance, status.samples, so_far.noise, false});
        shown = Clock::now();
        pause = std::min(1.0, pause * 1.6);
    };
    const auto picture = render_reference((*files)->scene, *sampler, options);
    if (!picture) return picture.error();
    receive({picture->radiance, double(picture->sample_count), picture->noise, true});
    return {};
}

void Truth::stop() {
    stopped_ = true;
}

}  // namespace domelight
