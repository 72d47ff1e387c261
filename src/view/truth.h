#pragma once

#include "domelight/base/result.h"
#include "domelight/io/environment/open_environment.h"
#include "domelight/render/render.h"

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <string_view>
#include <vector>

namespace domelight {

/// Path-traced pictures of one scene under one environment, for the page to compare its own with. The scene and the
/// environment are loaded at the first picture. Of several pictures asked for, the last one is rendered: the others end.
class Truth {
  public:
    Truth(std::filesystem::path scene, std::vector<std::filesystem::path> environment, EnvironmentOptions options,
          int threads);

    /// A picture as it converges.
    struct Frame {
        const ImageF& radiance;  ///< with the environment behind the scene
        double samples = 0;      ///< of a pixel, on average
        double noise = 0;        ///< standard error of L / (1 + L), rms over the pixels
        bool last = false;
    };
    /// Called with each frame, from one thread; returns false to end the render.
    using Receive = std::function<bool(const Frame&)>;

    /// The number of a picture that is asked for now: it is the last one from here on. Rendering may begin later, and
    /// not in the order in which the pictures were asked for.
    std::uint64_t take_number() { return ++newest_; }
    /// number   of this picture, from take_number()
    /// request  docs/view.md
    ///
    /// Errors: broken JSON; a member that is missing or out of its range, which the error names; those of loading the
    /// files; "cancelled".
    Result<void> render(std::uint64_t number, std::string_view request, const Receive& receive);
    /// Ends the render under way, and all later ones at their start.
    void stop();

  private:
    struct Loaded;
    Result<std::shared_ptr<const Loaded>> loaded();

    std::filesystem::path scene_;
    std::vector<std::filesystem::path> environment_;
    EnvironmentOptions options_;
    int threads_;
    std::mutex loading_, rendering_;
    std::shared_ptr<const Loaded> loaded_;
    std::atomic<std::uint64_t> newest_{0};
    std::atomic<bool> stopped_{false};
};

}  // namespace domelight
