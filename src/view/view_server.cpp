#include "domelight/view/view_server.h"

#include "domelight/base/version.h"

#include "base/field_place.h"
#include "io/file/json.h"
#include "view/request_guard.h"
#include "view/served_files.h"
#include "view/truth.h"

#include <fmt/core.h>
#include <httplib.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <fstream>
#include <mutex>
#include <optional>
#include <thread>

namespace domelight {
namespace fs = std::filesystem;

namespace {

/// The bytes of a file that are sent at once.
constexpr std::size_t k_piece = std::size_t(1) << 16;
/// The longest request for a picture.
constexpr std::size_t k_most_request = std::size_t(1) << 16;
/// How long a browser may take none of the bytes that are sent to it.
constexpr int k_send_seconds = 2;

/// An address with the characters escaped that a URL gives a meaning to.
std::string escaped(const std::string& address) {
    std::string out;
    for (const char c : address)
        if (std::isalnum(static_cast<unsigned char>(c)) || std::strchr("/-_.~", c))
            out += c;
        else
            out += fmt::format("%{:02X}", static_cast<unsigned char>(c));
    return out;
}

void answer_json(httplib::Response& response, const Json& json) {
    response.set_content(json.dump(), "application/json");
}

/// A frame as it is streamed: four little-endian numbers of 32 bits (width, height, and as floats the samples and the
/// noise), then width x height x 3 floats from the top. docs/view.md.
std::string frame_bytes(const Truth::Frame& frame) {
    static_assert(std::endian::native == std::endian::little);
    const ImageF& image = frame.radiance;
    const std::uint32_t size[] = {std::uint32_t(image.width()), std::uint32_t(image.height())};
    const float numbers[] = {float(frame.samples), float(frame.noise)};
    std::string bytes(sizeof(size) + sizeof(numbers) + image.pixels().size_bytes(), '\0');
    std::memcpy(bytes.data(), size, sizeof(size));
    std::memcpy(bytes.data() + sizeof(size), numbers, sizeof(numbers));
    std::memcpy(bytes.data() + sizeof(size) + sizeof(numbers), image.pixels().data(), image.pixels().size_bytes());
    return bytes;
}

/// The end of a stream that failed: a width and a height of 0, the length of the text, 0, and the text.
std::string error_bytes(const Error& error) {
    const std::string text = error.format();
    const std::uint32_t head[] = {0, 0, std::uint32_t(text.size()), 0};
    std::string bytes(sizeof(head), '\0');
    std::memcpy(bytes.data(), head, sizeof(head));
    return bytes + text;
}

}  // namespace

struct ViewServer::Impl {
    httplib::Server http;
    ServedFiles files;
    std::unique_ptr<Truth> truth;  ///< null where there is nothing to render
    Json session;
    int port = 0;
    std::thread listening;

    ~Impl() {
        if (truth) truth->stop();
        http.stop();
        if (listening.joinable()) listening.join();
    }

    Result<void> find_files(const ViewOptions& options);
    void add_answers();
    Result<void> listen(int wanted);
    void answer_file(const httplib::Request& request, httplib::Response& response) const;
    void answer_truth(const httplib::Request& request, httplib::Response& response) const;
};

Result<void> ViewServer::Impl::find_files(const ViewOptions& options) {
    if (auto ok = files.add_app(options.app); !ok) return Error{ok.error().what, field_place("app"), ""};
    fs::path scene = options.scene;
    std::vector<fs::path> environment = options.environment;
    Json scene_json, environment_json = Json::array();
    if (!scene.empty()) {
        const auto address = files.add_scene(scene);
        if (!address) return address.error();
        scene_json = {{"name", scene.filename().string()}, {"url", escaped(*address)}};
    } else if (files.find("/default.glb")) {
        scene = options.app / "default.glb";
    }
    for (const fs::path& file : environment) {
        const auto address = files.add_environment(file, int(environment_json.size()) + 1);
        if (!address) return address.error();
        environment_json.push_back({{"name", file.filename().string()}, {"url", escaped(*address)}});
    }
    Json probes_json = Json::array();
    if (!options.probes.empty()) {
        const auto addresses = files.add_probes(options.probes);
        if (!addresses) return addresses.error();
        for (const std::string& address : *addresses)
            probes_json.push_back({{"name", fs::path(address).filename().string()}, {"url", escaped(address)}});
    }
    if (environment.empty() && files.find("/default.hdr")) environment = {options.app / "default.hdr"};

    const EnvironmentOptions& o = options.environment_options;
    const bool renders = !scene.empty() && !environment.empty();
    session = Json{{"version", version()},
                   {"scene", scene_json},
                   {"environment", environment_json},
                   {"environment_options",
                    {{"projection", o.projection},
                     {"latlong", o.latlong},
                     {"layer", o.layer},
                     {"up", o.up},
                     {"rotate_y_deg", o.rotate_y_deg},
                     {"exposure", o.exposure}}},
                   {"probes", std::move(probes_json)},
                   {"truth", renders}};
    if (renders) truth = std::make_unique<Truth>(scene, environment, o, options.threads);
    return {};
}

void ViewServer::Impl::answer_file(const httplib::Request& request, httplib::Response& response) const {
    const ServedFiles::File* file = files.find(request.path);
    std::error_code code;
    const auto size = file ? fs::file_size(file->place, code) : 0;
    auto stream = file && !code ? std::make_shared<std::ifstream>(file->place, std::ios::binary) : nullptr;
    if (!stream || !*stream) {
        response.status = 404;
        response.set_content("There is no such file.", "text/plain");
        return;
    }
    if (size == 0) return response.set_content("", file->type);
    response.set_content_provider(size, file->type, [stream](std::size_t from, std::size_t length, auto& sink) {
        std::string bytes(std::min(length, k_piece), '\0');
        stream->clear();
        stream->seekg(std::streamoff(from));
        stream->read(bytes.data(), std::streamsize(bytes.size()));
        return stream->gcount() > 0 && sink.write(bytes.data(), std::size_t(stream->gcount()));
    });
}

void ViewServer::Impl::answer_truth(const httplib::Request& request, httplib::Response& response) const {
    // A page of another origin can send forms and plain text here, but no JSON without being asked for its origin.
    if (request.get_header_value("Content-Type") != "application/json") {
        response.status = 415;
        return response.set_content("The request is not JSON.", "text/plain");
    }
    if (!truth) {
        response.status = 404;
        return response.set_content("There is no scene or no environment on the command line.", "text/plain");
    }
    response.set_chunked_content_provider(
        "application/octet-stream",
        [this, number = truth->take_number(), text = request.body](std::size_t, httplib::DataSink& sink) {
            // In pieces, so that a browser that has stopped reading is noticed within the time limit of one.
            const auto send = [&](const std::string& bytes) {
                for (std::size_t at = 0; at < bytes.size(); at += k_piece)
                    if (!sink.is_writable() || !sink.write(bytes.data() + at, std::min(k_piece, bytes.size() - at)))
                        return false;
                return true;
            };
            const auto done =
                truth->render(number, text, [&](const Truth::Frame& frame) { return send(frame_bytes(frame)); });
            if (!done && !send(error_bytes(done.error()))) return false;
            sink.done();
            return true;
        });
}

void ViewServer::Impl::add_answers() {
    http.set_payload_max_length(k_most_request);
    http.set_write_timeout(k_send_seconds);
    http.set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
        for (const auto& [name, value] : security_headers()) response.set_header(name, value);
        const std::string why = refusal({.host = request.get_header_value("Host"),
                                         .origin = request.get_header_value("Origin"),
                                         .fetch_site = request.get_header_value("Sec-Fetch-Site"),
                                         .opens_a_page = request.get_header_value("Sec-Fetch-Mode") == "navigate"},
                                        port);
        const bool reads = request.method == "GET" || request.method == "HEAD";
        const bool renders = request.method == "POST" && request.path == "/api/truth";
        if (why.empty() && (reads || renders)) return httplib::Server::HandlerResponse::Unhandled;
        response.status = why.empty() ? 405 : 403;
        response.set_content(why.empty() ? "Files are read only." : why, "text/plain");
        return httplib::Server::HandlerResponse::Handled;
    });
    http.Get("/api/session", [this](const auto&, auto& response) { answer_json(response, session); });
    http.Post("/api/truth", [this](const auto& request, auto& response) { answer_truth(request, response); });
    http.Get(".*", [this](const auto& request, auto& response) { answer_file(request, response); });
}

Result<void> ViewServer::Impl::listen(int wanted) {
    if (wanted < 0 || wanted > 65535)
        return Error{fmt::format("{} is not from 0 to 65535", wanted), field_place("port"), ""};
    // Without SO_REUSEPORT, which the library sets by default and which lets two programs share a port. A time limit for
    // sending, which connections inherit, because a browser that stops reading would hold its thread.
    http.set_socket_options([](auto socket) {
        const int yes = 1;
        const timeval limit{.tv_sec = k_send_seconds, .tv_usec = 0};
        setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
        setsockopt(socket, SOL_SOCKET, SO_SNDTIMEO, &limit, sizeof(limit));
    });
    if (wanted == 0)
        port = http.bind_to_any_port("127.0.0.1");
    else
        port = http.bind_to_port("127.0.0.1", wanted) ? wanted : -1;
    if (port <= 0)
        return Error{wanted ? fmt::format("{} is in use or not allowed", wanted) : "no port is free",
                     field_place("port"), wanted ? "Leave it out, and a free one is taken." : ""};
    listening = std::thread([this] { http.listen_after_bind(); });
    while (!http.is_running()) std::this_thread::yield();
    return {};
}

ViewServer::ViewServer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
ViewServer::~ViewServer() = default;
ViewServer::ViewServer(ViewServer&&) noexcept = default;
ViewServer& ViewServer::operator=(ViewServer&&) noexcept = default;

Result<ViewServer> ViewServer::start(const ViewOptions& options) {
    auto impl = std::make_unique<Impl>();
    if (auto ok = impl->find_files(options); !ok) return ok.error();
    impl->add_answers();
    if (auto ok = impl->listen(options.port); !ok) return ok.error();
    return ViewServer(std::move(impl));
}

int ViewServer::port() const {
    return impl_->port;
}

std::string ViewServer::url() const {
    return fmt::format("http://127.0.0.1:{}/", impl_->port);
}

}  // namespace domelight
