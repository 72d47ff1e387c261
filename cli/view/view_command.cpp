#include "domelight/base/version.h"
#include "domelight/io/file/file_extension.h"
#include "domelight/view/view_server.h"

#include "cli/commands.h"
#include "cli/console/console.h"
#include "cli/console/environment_options.h"
#include "cli/console/interruption.h"
#include "cli/console/print.h"
#include "io/file/json.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <spawn.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <thread>

extern char** environ;

namespace domelight::cli {
namespace {

namespace fs = std::filesystem;

struct ViewWords {
    CommonOptions common;
    std::vector<std::string> files;
    EnvironmentOptions environment;
    std::optional<int> port;
    std::string app, probes;
    bool no_browser = false;
};

void declare(Arguments& a, ViewWords& w) {
    a.positional("[SCENE] [ENV]", w.files,
                 "a model (.glb, .gltf) and an environment of any kind, in any order; without them the page shows its "
                 "own, and takes files that are dropped on it");
    a.text("--probes", "DIR", w.probes,
           "a set that `domelight probes` captured in the scene: the page lights the scene by it (docs/app.md)");
    a.group("The page");
    a.integer("--port", "N", w.port, "the port on 127.0.0.1, 1 to 65535 (one that is free)");
    a.flag("--no-browser", w.no_browser, "only print the page's address, and open no browser");
    a.text("--app", "DIR", w.app, "the folder of the page's own files (those that were installed with the program)");
    a.group("The environment");
    add_environment_options(a, w.environment);
    add_common_options(a, w.common);
}

bool is_scene(const std::string& file) {
    const std::string ending = lower_case_extension(file);
    return ending == ".glb" || ending == ".gltf";
}

/// The page's folder: beside the program, as `cmake --install` lays it out.
fs::path installed_app() {
    std::error_code code;
    const fs::path program = fs::read_symlink("/proc/self/exe", code);
    return program.parent_path().parent_path() / "share" / "domelight" / "web";
}

Result<ViewOptions> options_of(const ViewWords& w) {
    if (w.port && (*w.port < 1 || *w.port > 65535))
        return Error{fmt::format("{} is not from 1 to 65535", *w.port), "--port", ""};
    ViewOptions options;
    options.app = w.app.empty() ? installed_app() : fs::path(w.app);
    options.environment_options = w.environment;
    options.environment_options.threads = w.common.threads.value_or(0);
    options.threads = w.common.threads.value_or(0);
    options.probes = w.probes;
    options.port = w.port.value_or(0);
    std::vector<std::string> environment;
    for (const std::string& file : w.files) {
        if (!is_scene(file))
            environment.push_back(file);
        else if (options.scene.empty())
            options.scene = file;
        else
            return Error{"is a second scene", file, "The page shows one at a time."};
    }
    if (auto ok = check_one_environment(environment, w.environment); !ok) return ok.error();
    if (!environment.empty()) options.environment = environment_files(environment, w.environment);
    return options;
}

/// Asks the desktop to open an address. Whether it can is not known: the address is printed in any case.
void open_in_browser(const std::string& url) {
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    std::string program = "xdg-open", address = url;
    char* arguments[] = {program.data(), address.data(), nullptr};
    pid_t child = 0;
    posix_spawnp(&child, program.c_str(), &actions, nullptr, arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
}

/// Whether the page is there. A program that was not installed has none beside it.
Result<void> check_app(const ViewWords& w, const ViewOptions& options) {
    std::error_code code;
    if (!w.app.empty() || fs::is_regular_file(options.app / "index.html", code)) return {};
    return Error{"the page is not installed beside the program", "",
                 "In a checkout `./run view` builds it; --app DIR names its folder."};
}

}  // namespace

int run_view(const std::vector<std::string>& words) {
    ViewWords w;
    Arguments arguments(
        "view",
        "Opens a page in the browser that shows a model under an environment, with every method of image-based "
        "lighting beside the truth. The page is served on this machine alone, and no file leaves it. Ctrl-C ends it.",
        {"domelight view", "domelight view helmet.glb studio.hdr",
         "domelight view studio.exr --no-browser --port 8000"});
    declare(arguments, w);
    if (const auto code = begin_command(arguments, words, w.common)) return *code;
    const auto options = options_of(w);
    if (!options) return print_error(options.error());
    if (auto ok = check_app(w, *options); !ok) return print_error(ok.error());
    Interruption interruption;
    const auto server = ViewServer::start(*options);
    if (!server) return print_error(server.error());
    if (w.common.json)
        print_document(Json{{"version", version()}, {"url", server->url()}});
    else
        print("{}\n", server->url());
    if (!w.common.json && !w.common.quiet) print_to_stderr("Ctrl-C ends it.\n");
    std::fflush(nullptr);
    if (!w.no_browser) open_in_browser(server->url());
    while (!Interruption::wanted()) std::this_thread::sleep_for(std::chrono::milliseconds(50));
    return exit_done;
}

}  // namespace domelight::cli
