#include "io/file/file_reader.h"

#include "io/file/sha256.h"
#include "io/io_helpers.h"
#include "test.h"

#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <thread>

using namespace domelight;
using namespace domelight::test;

TEST_CASE("file reader: a file that is shortened afterwards keeps its bytes") {
    const TemporaryFolder temporary;
    const std::filesystem::path& folder = temporary.path();
    const std::vector<std::uint8_t> data(100'000, 7);
    write_bytes(folder / "a", data);
    const auto bytes = FileBytes::open(folder / "a", 1);
    REQUIRE(bytes);
    CHECK((*bytes)->regular());
    // In a mapping, the second page is gone now: touching it would end this program.
    std::filesystem::resize_file(folder / "a", 10);
    CHECK(std::ranges::equal((*bytes)->bytes(), data));
}

TEST_CASE("file reader: pipes are read once, and refused without waiting where a regular file is wanted") {
    const TemporaryFolder temporary;
    const std::filesystem::path& folder = temporary.path();
    const auto pipe = folder / "pipe";
    REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
    CHECK(FileBytes::open(pipe, 100, FileKinds::regular).error().what == "is not a regular file");
    CHECK(sha256_file(pipe).error().what == "is not a regular file");
    const auto feed = [&](std::size_t count) {
        return std::jthread([&, count] { write_bytes(pipe, std::vector<std::uint8_t>(count, 7)); });
    };
    {
        const auto writer = feed(50);
        const auto bytes = FileBytes::open(pipe, 100);
        REQUIRE(bytes);
        CHECK((*bytes)->bytes().size() == 50);
        CHECK_FALSE((*bytes)->regular());
    }
    {
        const auto writer = feed(101);
        CHECK(FileBytes::open(pipe, 100).error().what == "more than 100 bytes");
    }
    CHECK(FileBytes::open(folder, 100).error().what == "is a folder, not a file");
    CHECK(FileBytes::open(folder / "none", 100).error().what == "no such file");
}

TEST_CASE("file reader: the largest file has a limit, which is checked before anything is allocated") {
    const TemporaryFolder temporary;
    const std::filesystem::path& folder = temporary.path();
    write_bytes(folder / "a", {1});
    std::filesystem::resize_file(folder / "a", std::uintmax_t(1) << 40);  // of holes
    CHECK(FileBytes::open(folder / "a", 1).error().what ==
          "has 1099511627776 bytes, more than the limit of 8589934592");
}

TEST_CASE("file reader: a name that a file states leads nowhere else") {
    const TemporaryFolder temporary;
    const std::filesystem::path& folder = temporary.path();
    std::filesystem::create_directory(folder / "b");
    write_bytes(folder / "secret", {'s'});
    write_bytes(folder / "b" / "own", {'o'});
    std::filesystem::create_symlink("../secret", folder / "b" / "out");
    std::filesystem::create_symlink("own", folder / "b" / "in");
    CHECK(*sha256_in_folder(folder / "b", "own") == *sha256_file(folder / "b" / "own"));
    CHECK(*sha256_in_folder(folder / "b", "in") == *sha256_file(folder / "b" / "own"));
    for (const std::string& name : {std::string("../secret"), (folder / "secret").string(), std::string("out"),
                                    std::string("/dev/zero"), std::string("x/../../secret")})
        CHECK(sha256_in_folder(folder / "b", name).error().what.find("leaves the folder") != std::string::npos);
}
