#include "cli/render/render_turntable.h"

#include "domelight/base/version.h"
#include "domelight/io/picture/animation.h"
#include "domelight/io/write_image.h"

#include "cli/console/interruption.h"
#include "cli/console/light_options.h"
#include "cli/console/print.h"
#include "cli/render/render_outputs.h"
#include "io/file/file_reader.h"
#include "io/file/json.h"
#include "io/picture/texture_image.h"
#include "preview/exposure_meter.h"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace domelight::cli {

namespace fs = std::filesystem;

std::string frame_file(const std::string& file, int frame) {
    const fs::path path(file);
    return (path.parent_path() / fmt::format("{}_{:04}{}", path.stem().string(), frame, path.extension().string()))
        .string();
}

namespace {

Vec3f turned(const Vec3f& v, double angle) {
    return Vec3f(rotation_y(angle) * Vec3d(v));
}

class Turntable {
  public:
    Turntable(const RenderWords& w, const RayScene& scene, const EnvironmentSampler& sampler, const EngineLight& light,
              const RenderOptions& options)
        : words_(w), scene_(scene), sampler_(sampler), light_(light), options_(options) {
        const auto [low, high] = scene.scene().bounds();
        centre_ = w.camera_target.empty() ? (low + high) * 0.5f
                                          : Vec3f(Vec3d{w.camera_target[0], w.camera_target[1], w.camera_target[2]});
    }

    int frames() const { return *words_.frames; }
    std::vector<std::string> files(int frame) const {
        std::vector<std::string> names;
        for (const std::string& o : words_.outputs) names.push_back(frame_file(o, frame));
        return names;
    }
    bool there(int frame) const {
        const auto names = files(frame);
        return std::all_of(names.begin(), names.end(), [](const auto& f) { return fs::is_regular_file(f); });
    }

    /// One exposure for all frames, independent of which exist already: the one that suits four small views together,
    /// so that a view of the dark side does not overexpose the others.
    Result<double> exposure() const {
        if (!std::isnan(words_.ev)) return words_.ev;
        RenderOptions o = options_;
        const int longest = std::max(o.width, o.height);
        o.width = std::max(1, o.width * 96 / longest), o.height = std::max(1, o.height * 96 / longest);
        o.samples = 16;
        o.noise = o.seconds = 0;
        constexpr int views = 4;
        RenderWords words = words_;
        words.shadow_catcher = false;
        const bool background_shows = tracing_options(words, o).background != Background::transparent;
        ExposureMeter meter;
        for (int i = 0; i < views; ++i) {
            const auto picture = draw_at(words, o, double(i) / views, words_.ev);
            if (!picture) return picture.error();
            meter.add(picture->result.radiance, picture->result.opacity, !background_shows);
        }
        return meter.ev();
    }

    Result<FinishedPicture> draw(int frame, const RenderOptions& options, double ev) const {
        return draw_at(words_, options, double(frame - 1) / frames(), ev);
    }

  private:
    /// `part`: the share of a whole turn, 0 to 1.
    Result<FinishedPicture> draw_at(const RenderWords& words, RenderOptions o, double part, double ev) const {
        const double angle = 2 * k_pi * part;
        if (words_.turn == "camera") {
            Affine& m = o.camera.to_world;
            m = {turned(m.x, angle), turned(m.y, angle), turned(m.z, angle),
                 centre_ + turned(m.translation - centre_, angle)};
            return draw_finished(words, scene_, sampler_, light_, o, ev);
        }
        auto light = EnvironmentSampler::build(sampler_.image(), sampler_.options(),
                                               sampler_.world_to_source() * rotation_y(angle).transposed());
        if (!light) return light.error();
        const auto maps = maps_for(words, *light);
        if (!maps) return maps.error();
        const LightMaps* own = *maps ? &**maps : nullptr;
        o.background_maps = own;
        for (PunctualLight& l : o.environment_lights) l = turned_light(l, rotation_y(angle));
        return draw_finished(words, scene_, *light, {own, light_.probes}, o, ev);
    }

    const RenderWords& words_;
    const RayScene& scene_;
    const EnvironmentSampler& sampler_;
    const EngineLight& light_;
    const RenderOptions& options_;
    Vec3f centre_;
};

/// The pixels of a frame's PNG or JPEG.
Result<Image<std::uint8_t>> read_frame(const std::string& file, bool transparent) {
    const auto bytes = FileBytes::open(file, std::int64_t(1) << 30);
    if (!bytes) return bytes.error().at(file);
    const auto image = decode_texture_image((*bytes)->bytes());
    if (!image) return image.error().at(file);
    const int channels = transparent ? 4 : 3;
    Image<std::uint8_t> pixels(image->width, image->height, channels);
    for (std::size_t i = 0; i < image->rgba.size() / 4; ++i)
        std::copy_n(&image->rgba[4 * i], channels, &pixels.pixels()[std::size_t(channels) * i]);
    return pixels;
}

/// The frames whose files exist, as ranges: "1-12, 30".
std::string existing(const Turntable& turntable) {
    std::string text;
    for (int i = 1; i <= turntable.frames(); ++i) {
        if (!turntable.there(i)) continue;
        int last = i;
        while (last < turntable.frames() && turntable.there(last + 1)) ++last;
        text += (text.empty() ? "" : ", ") + (last > i ? fmt::format("{}-{}", i, last) : std::to_string(i));
        i = last;
    }
    return text;
}

struct Tally {
    int drawn = 0, kept = 0;
    std::int64_t non_finite_samples = 0;
    double seconds = 0;
};

void print_turntable(const RenderWords& w, const RenderOptions& o, const Turntable& turntable, const Tally& tally,
                     const std::vector<std::string>& animations, double ev) {
    print_warnings(non_finite_warning(tally.non_finite_samples), w.common, w.scene_name());
    if (w.common.json) {
        Json json{{"version", version()},        {"width", o.width}, {"height", o.height},
                  {"shading", w.shading_name()}, {"ev", ev},         {"turn", w.turn}};
        auto& frames = json["frames"] = Json::array();
        for (int i = 1; i <= turntable.frames(); ++i) frames.push_back(turntable.files(i));
        json["drawn"] = tally.drawn, json["kept"] = tally.kept;
        json["non_finite_samples"] = tally.non_finite_samples;
        json["animations"] = animations, json["fps"] = w.fps, json["seconds"] = tally.seconds;
        print_document(json);
    } else if (!w.common.quiet) {
        print("{} to {}: {} x {}, {} frames ({} drawn, {} kept), {:.2f} s{}\n", turntable.files(1).front(),
              turntable.files(turntable.frames()).front(), o.width, o.height, turntable.frames(), tally.drawn,
              tally.kept, tally.seconds, exposure_text(w, ev));
        for (const std::string& a : animations)
            print("{}: {:.2f} s, {:g} frames a second\n", a, turntable.frames() / w.fps, w.fps);
    }
}

}  // namespace

int run_turntable(const RenderWords& w, const RayScene& scene, const EnvironmentSampler& sampler,
                  const EngineLight& light, const RenderOptions& given) {
    Interruption interruption;
    RenderOptions options = given;
    options.progress = [](std::string_view, double) { return !Interruption::wanted(); };
    const Turntable turntable(w, scene, sampler, light, options);
    const auto stop = [&] {
        const std::string have = existing(turntable);
        return interruption.end(
            fmt::format("{}; --resume draws the others",
                        have.empty() ? "no frame is complete" : fmt::format("frames {} of {} exist", have, *w.frames)));
    };
    const auto ev = turntable.exposure();
    if (!ev) return Interruption::wanted() ? stop() : print_error(ev.error());

    const auto start = std::chrono::steady_clock::now();
    Tally tally;
    const auto left_to_draw = [&](int from) {
        int n = 0;
        for (int i = from; i <= turntable.frames(); ++i) n += !(w.resume && turntable.there(i));
        return n;
    };
    const int to_draw = left_to_draw(1);
    {
        ProgressBar bar(w.scene_name(), w.common);
        for (int i = 1; i <= turntable.frames(); ++i) {
            if (w.resume && turntable.there(i)) {
                ++tally.kept;
                continue;
            }
            RenderOptions o = options;
            bar.detail(fmt::format("frame {} of {}", i, turntable.frames()));
            o.progress = [&](std::string_view stage, double done) {
                // A shadow pass is short beside the picture's own.
                bar.update("frames", (tally.drawn + (stage == "shadow" ? 1 : done)) / to_draw);
                return !Interruption::wanted();
            };
            const auto picture = turntable.draw(i, o, *ev);
            if (!picture && Interruption::wanted()) return stop();
            if (!picture) return print_error(picture.error());
            if (auto ok = write_pictures(turntable.files(i), *picture, scene.scene(), w); !ok)
                return print_error(ok.error());
            ++tally.drawn;
            tally.non_finite_samples += picture->result.non_finite_samples;
            if (Interruption::wanted()) return stop();
        }
    }

    std::vector<std::string> animations;
    AnimationOptions animation;
    animation.frames_per_second = w.fps;
    for (const std::string& o : w.outputs) {
        if (!is_screen_picture(o)) continue;
        const std::string file = fs::path(o).replace_extension(".webp").string();
        // turn.png and turn.jpg share one animation.
        if (std::find(animations.begin(), animations.end(), file) != animations.end()) continue;
        ProgressBar bar(w.scene_name(), w.common);
        const auto frame = [&](int i) -> Result<Image<std::uint8_t>> {
            if (Interruption::wanted()) return Error{"cancelled", "", ""};
            bar.update("animate", double(i) / turntable.frames());
            return read_frame(frame_file(o, i + 1), w.backdrop == Background::transparent);
        };
        if (auto ok = write_webp_animation(file, turntable.frames(), frame, animation); !ok)
            return Interruption::wanted() ? stop() : print_error(ok.error());
        animations.push_back(file);
    }
    tally.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    print_turntable(w, options, turntable, tally, animations, *ev);
    return exit_done;
}

}  // namespace domelight::cli
