#include "view/served_files.h"

#include "test.h"

#include <fstream>

using namespace domelight;
using namespace domelight::test;
namespace fs = std::filesystem;

namespace {

void write(const fs::path& file, const std::string& text = "x") {
    fs::create_directories(file.parent_path());
    std::ofstream(file) << text;
}

}  // namespace

TEST_CASE("view: the page's folder is served, without what links lead to") {
    TemporaryFolder folder;
    write(folder / "app/index.html");
    write(folder / "app/learn/index.html");
    write(folder / "app/assets/main.js");
    write(folder / "secret.txt");
    fs::create_symlink(folder / "secret.txt", folder / "app/link.txt");
    ServedFiles files;
    REQUIRE(files.add_app(folder / "app"));
    REQUIRE(files.find("/"));
    CHECK(files.find("/")->place == folder / "app/index.html");
    CHECK(files.find("/")->type == "text/html; charset=utf-8");
    CHECK(files.find("/learn/")->place == folder / "app/learn/index.html");
    CHECK(files.find("/assets/main.js")->type == "text/javascript; charset=utf-8");
    for (const char* none : {"/link.txt", "/../secret.txt", "/secret.txt", "", "/assets", "/assets/../index.html"}) {
        INFO(none);
        CHECK(files.find(none) == nullptr);
    }
}

TEST_CASE("view: of a set of probes, probes.json and the files that it names are served") {
    TemporaryFolder folder;
    const auto record = [&](const std::string& specular) {
        write(folder / "set/probes.json",
              R"({"format": 1, "grid": null, "specular": {"file": ")" + specular +
                  R"(", "size": 8, "levels": [{"roughness": 0}]}, "irradiance": {"file": "irradiance.ktx2", "size": 4},
                  "probes": [{"place": [0, 1, 0], "position": [0, 1, 0], "harmonics": [[1,1,1],[0,0,0],[0,0,0],[0,0,0],
                  [0,0,0],[0,0,0],[0,0,0],[0,0,0],[0,0,0]]}]})");
    };
    record("specular.ktx2");
    write(folder / "set/specular.ktx2");
    write(folder / "set/notes.txt");
    write(folder / "secret.ktx2");
    ServedFiles missing;
    CHECK_FALSE(missing.add_probes(folder / "set"));
    write(folder / "set/irradiance.ktx2");
    ServedFiles files;
    const auto addresses = files.add_probes(folder / "set");
    REQUIRE(addresses);
    CHECK(*addresses == std::vector<std::string>{"/files/probes/probes.json", "/files/probes/specular.ktx2",
                                                 "/files/probes/irradiance.ktx2"});
    for (const std::string& address : *addresses) CHECK(files.find(address));
    for (const char* none : {"/files/probes/notes.txt", "/files/probes/distance.ktx2", "/files/probes/"})
        CHECK(files.find(none) == nullptr);

    record("../secret.ktx2");
    const auto outside = ServedFiles().add_probes(folder / "set");
    REQUIRE_FALSE(outside);
    CHECK_FALSE(ServedFiles().add_probes(folder / "nowhere"));
}

TEST_CASE("view: a folder without a page is refused") {
    TemporaryFolder folder;
    const auto added = ServedFiles().add_app(folder.path());
    REQUIRE_FALSE(added);
    CHECK(added.error().what == "there is no index.html");
    CHECK_FALSE(ServedFiles().add_app(folder / "nowhere"));
}

TEST_CASE("view: a .gltf brings the files that it names, but none from outside of its folder") {
    TemporaryFolder folder;
    write(folder / "scene/quad.gltf",
          R"({"buffers": [{"uri": "bin/quad%20data.bin"}, {"uri": "../secret.bin"}, {"uri": "data:;base64,AA=="}, {}],
              "images": [{"uri": "wood.png"}, {"uri": "/etc/passwd"}, {"uri": "link.png"}, {"bufferView": 0}]})");
    write(folder / "scene/bin/quad data.bin");
    write(folder / "scene/wood.png");
    write(folder / "scene/unnamed.png");
    write(folder / "secret.bin");
    fs::create_symlink(folder / "secret.bin", folder / "scene/link.png");
    ServedFiles files;
    const auto address = files.add_scene(folder / "scene/quad.gltf");
    REQUIRE(address);
    CHECK(*address == "/files/scene/quad.gltf");
    CHECK(files.find("/files/scene/bin/quad data.bin"));
    CHECK(files.find("/files/scene/wood.png")->type == "image/png");
    for (const char* none : {"/files/scene/unnamed.png", "/files/scene/../secret.bin", "/files/secret.bin",
                             "/files/scene//etc/passwd", "/files/scene/link.png"})
        CHECK(files.find(none) == nullptr);
}

TEST_CASE("view: scenes that the page cannot read, and files that do not exist, are refused") {
    TemporaryFolder folder;
    write(folder / "a.obj");
    const auto obj = ServedFiles().add_scene(folder / "a.obj");
    REQUIRE_FALSE(obj);
    CHECK(obj.error().what == "the page reads .glb and .gltf");
    const auto missing = ServedFiles().add_environment(folder / "a.hdr", 1);
    REQUIRE_FALSE(missing);
    CHECK(missing.error().format() == (folder / "a.hdr").string() + ": there is no such file");
}
