#include "view/request_guard.h"

#include "test.h"

using namespace domelight;

TEST_CASE("view: only requests to 127.0.0.1 at the server's own port are answered") {
    CHECK(refusal({.host = "127.0.0.1:8123"}, 8123).empty());
    CHECK(refusal({.host = "localhost:8123"}, 8123).empty());
    for (const char* host : {"", "127.0.0.1", "127.0.0.1:8124", "evil.example:8123", "127.0.0.1.evil.example:8123",
                             "localhost:8123.evil.example", "[::1]:8123"}) {
        INFO(host);
        CHECK_FALSE(refusal({.host = host}, 8123).empty());
    }
}

TEST_CASE("view: pages of other origins are refused, links to the page are followed") {
    const auto from = [](const char* origin, const char* site, bool opens_a_page = false) {
        return refusal({"127.0.0.1:8123", origin, site, opens_a_page}, 8123);
    };
    CHECK(from("http://127.0.0.1:8123", "same-origin").empty());
    CHECK(from("", "none").empty());
    CHECK(from("", "cross-site", true).empty());
    CHECK_FALSE(from("", "cross-site").empty());
    CHECK_FALSE(from("", "same-site").empty());
    CHECK_FALSE(from("null", "").empty());
    CHECK_FALSE(from("https://127.0.0.1:8123", "").empty());
    CHECK_FALSE(from("http://127.0.0.1:8124", "").empty());
    CHECK_FALSE(from("http://evil.example", "same-origin").empty());
}
