#pragma once

#include <string>
#include <utility>
#include <vector>

namespace domelight {

/// The parts of a request that say who makes it. A header that is absent is empty.
struct RequestOrigin {
    std::string host{};         ///< Host
    std::string origin{};       ///< Origin
    std::string fetch_site{};   ///< Sec-Fetch-Site
    bool opens_a_page = false;  ///< a person follows a link or types an address (Sec-Fetch-Mode: navigate)
};

/// Why a request to a server on 127.0.0.1 and this port is refused; empty where it is not.
///
/// A page of another site can make a browser send requests here. One whose name was made to resolve to 127.0.0.1 (DNS
/// rebinding) sends its own name as Host; any other sends its Origin, or Sec-Fetch-Site. Links to the page are followed.
std::string refusal(const RequestOrigin& request, int port);

/// The headers of each answer. The content security policy allows what the page itself brings, and nothing from
/// elsewhere: its scripts, WebAssembly, workers made of them, and pictures that it draws.
const std::vector<std::pair<std::string, std::string>>& security_headers();

}  // namespace domelight
