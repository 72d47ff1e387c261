#include "view/request_guard.h"

#include <fmt/core.h>

#include <algorithm>

namespace domelight {

std::string refusal(const RequestOrigin& request, int port) {
    const std::string hosts[] = {fmt::format("127.0.0.1:{}", port), fmt::format("localhost:{}", port)};
    if (std::ranges::find(hosts, request.host) == std::end(hosts))
        return fmt::format("This server answers to {} only.", hosts[0]);
    const bool own_origin = request.origin.empty() ||
                            std::ranges::any_of(hosts, [&](const auto& h) { return request.origin == "http://" + h; });
    const bool own_site = request.fetch_site.empty() || request.fetch_site == "same-origin" ||
                          request.fetch_site == "none" || request.opens_a_page;
    return own_origin && own_site ? "" : "Pages of another origin are not answered.";
}

const std::vector<std::pair<std::string, std::string>>& security_headers() {
    static const std::vector<std::pair<std::string, std::string>> headers{
        {"Content-Security-Policy",
         "default-src 'self'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self'; img-src 'self' blob: data:; "
         "connect-src 'self' blob: data:; worker-src 'self' blob:; object-src 'none'; base-uri 'none'; "
         "form-action 'none'; frame-ancestors 'none'"},
        {"X-Content-Type-Options", "nosniff"},
        {"Referrer-Policy", "no-referrer"},
        {"Cross-Origin-Opener-Policy", "same-origin"},
        {"Cross-Origin-Resource-Policy", "same-origin"},
        {"Cache-Control", "no-store"},
    };
    return headers;
}

}  // namespace domelight
