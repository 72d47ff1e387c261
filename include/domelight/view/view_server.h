#pragma once
// The page of `domelight view`, served to a browser on the same machine.
//
//     auto server = ViewServer::start({.app = "share/domelight/web", .scene = "helmet.glb", .environment = {"studio.hdr"}});
//     open_in_browser(server->url());
//
// docs/view.md describes the addresses and the stream of pictures.

#include "domelight/base/result.h"
#include "domelight/io/environment/open_environment.h"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace domelight {

struct ViewOptions {
    /// The folder of the page: index.html and what it loads. Where it holds default.glb or default.hdr, these stand for
    /// a scene or an environment that is not given.
    std::filesystem::path app;
    std::filesystem::path scene;                     ///< .glb, .gltf, .obj or .ply; empty: the page's own
    std::vector<std::filesystem::path> environment;  ///< what open_environment() takes; empty: the page's own
    EnvironmentOptions environment_options;
    std::filesystem::path probes;  ///< the folder of a set of probes by which the page lights the scene; empty: none
    int port = 0;                  ///< 1 to 65535; 0: any that is free
    int threads = 0;               ///< for path tracing; 0: all
};

/// Serves the page's folder, the files that the options name with those that they refer to, and pictures that are path
/// traced on demand. Nothing else can be read, and nothing can be written.
///
/// Only 127.0.0.1 is listened on. Requests for a different Host (DNS rebinding), or that a page of another origin
/// makes, are refused.
class ViewServer {
  public:
    /// Listens when it returns; requests are answered on threads of its own. Errors: no index.html in `app`; a file that
    /// does not exist (`scene`, `environment`); no set of probes (`probes`); the port is in use or not allowed (`port`).
    static Result<ViewServer> start(const ViewOptions& options);
    /// Ends all answers, and the path tracing.
    ~ViewServer();
    ViewServer(ViewServer&&) noexcept;
    ViewServer& operator=(ViewServer&&) noexcept;

    int port() const;
    std::string url() const;  ///< "http://127.0.0.1:8123/"

  private:
    struct Impl;
    explicit ViewServer(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace domelight
