#include "io/file/json.h"

#include "test.h"

using namespace domelight;

TEST_CASE("Json: braced lists are objects where every element is a list of a string and a value") {
    const Json json{{"size", 256}, {"roughness", {0, 0.5, 1}}, {"name", "studio"}, {"none", nullptr}, {"on", true}};
    CHECK(json.dump() == R"({"size":256,"roughness":[0,0.5,1],"name":"studio","none":null,"on":true})");
    CHECK(Json({"a", "b"}).dump() == R"(["a","b"])");
    CHECK(Json::array({1, 2}).dump(1) == "[\n 1,\n 2\n]");
}

TEST_CASE("Json: what is printed is parsed to the same value") {
    Json json{{"z", -1}, {"a", 1e300}, {"text", "line\n\"quoted\" \x1b[31m"}};
    json["list"].push_back({{"deep", Json::array({Json::object(), Json::array()})}});
    const auto parsed = Json::parse(json.dump(2));
    REQUIRE(parsed);
    CHECK(parsed->dump(2) == json.dump(2));
    CHECK((*parsed)["list"][std::size_t(0)]["deep"].size() == 2);
    CHECK(std::as_const(*parsed)["absent"]["deeper"].is_null());
}

TEST_CASE("Json: bytes that are not UTF-8 are replaced, and of two members with one key the last counts") {
    CHECK(Json("\xff").dump() == "\"\xef\xbf\xbd\"");
    CHECK(Json::parse(R"({"a":1,"b":2,"a":3})")->dump() == R"({"b":2,"a":3})");
}

TEST_CASE("Json: an error says where, and nesting has a bound") {
    const auto broken = Json::parse("{\"a\": 1,\n \"b\": }");
    REQUIRE(!broken);
    CHECK(broken.error().what.find("line 2") != std::string::npos);
    CHECK(Json::parse(std::string(256, '[') + std::string(256, ']')));
    const auto deep = Json::parse(std::string(1000000, '['));
    REQUIRE(!deep);
    CHECK(deep.error().what == "broken JSON: arrays and objects are nested more than 256 deep");
}
