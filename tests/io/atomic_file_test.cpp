#include "domelight/io/file/atomic_file.h"

#include "domelight/io/write_image.h"
#include "domelight/texture/texture.h"

#include "io/file/output_file.h"
#include "io/io_helpers.h"
#include "test.h"
#include "texture/chain_encoder.h"
#include "texture/container/texture_stream.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <string>
#include <thread>

using namespace domelight;
using namespace domelight::test;

namespace {

std::vector<std::uint8_t> bytes_of(const std::string& text) {
    return {text.begin(), text.end()};
}

std::size_t entries(const TemporaryFolder& folder) {
    std::size_t n = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder.path())) ++n;
    return n;
}

/// Runs `work` in a child process and returns its wait status. Threads that libraries have started do not exist there.
template <typename Work>
int in_child(Work work) {
    const pid_t child = ::fork();
    if (child == 0) ::_exit(work());
    int status = 0;
    ::waitpid(child, &status, 0);
    return status;
}

/// Runs `work` in this process while no file may grow beyond `room` bytes. (In a child process, OpenEXR's threads,
/// which earlier tests may have started, would be missing.)
template <typename Work>
int with_room(rlim_t room, Work work) {
    const auto handler = ::signal(SIGXFSZ, SIG_IGN);
    rlimit before = {};
    ::getrlimit(RLIMIT_FSIZE, &before);
    const rlimit limit{room, before.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    const int result = work();
    ::setrlimit(RLIMIT_FSIZE, &before);
    ::signal(SIGXFSZ, handler);
    return result;
}

/// Runs all writers in one folder, with the files a to h. Returns how many failed.
int write_everything(const TemporaryFolder& folder) {
    const Texture texture = sample_texture(Encoding::rgba16f, 64, 6, 3);
    ImageF image(256, 256, 3);
    Image<std::uint8_t> pixels(256, 256, 3);
    std::uint32_t state = 9;
    for (float& p : image.pixels()) p = float((state = state * 1664525u + 1013904223u) >> 8) * 0x1p-12f;
    for (auto& p : pixels.pixels()) p = std::uint8_t((state = state * 1664525u + 1013904223u) >> 24);
    const auto failed = [](const Result<void>& written) {
        return !written && !written.error().where.empty() && written.error().what.find("cannot write: ") == 0 ? 1 : 0;
    };
    return failed(write_ktx2(folder / "a", texture)) +
           failed(write_ktx2(folder / "b", texture, Supercompression::zstd)) +
           failed(write_ktx1(folder / "c", texture)) + failed(write_dds(folder / "d", texture)) +
           failed([&]() -> Result<void> {
               const std::vector<FilteredMap> chain{{Layout::latlong, image}};
               ChainEncoder encoder(chain, Encoding::rgba32f);
               const auto bytes = encoder.level_bytes();
               const auto hash = encode_to_file(folder / "h", encoder, *dds_layout(encoder.head(), bytes), 3, true);
               if (!hash) return hash.error();
               return {};
           }()) +
           failed(write_hdr(folder / "e", image, 1)) + failed(write_exr(folder / "f", image, {.threads = 1})) +
           failed(write_png(folder / "g", pixels));
}

}  // namespace

TEST_CASE("write_file_atomically: makes, replaces, and leaves no other file") {
    const TemporaryFolder folder;
    REQUIRE(write_file_atomically(folder / "a", bytes_of("one")));
    CHECK(file_bytes(folder / "a") == bytes_of("one"));
    REQUIRE(write_file_atomically(folder / "a", bytes_of("two")));
    CHECK(file_bytes(folder / "a") == bytes_of("two"));
    CHECK(entries(folder) == 1);
}

TEST_CASE("write_file_atomically: a failure leaves the old file and nothing else") {
    const TemporaryFolder folder;
    REQUIRE(write_file_atomically(folder / "a", bytes_of("old")));
    const auto written = write_file_atomically(folder / "a", [&](const std::filesystem::path& path) -> Result<void> {
        write_bytes(path, bytes_of("half of it"));
        CHECK(file_bytes(folder / "a") == bytes_of("old"));
        return Error{"it broke", "", "mend it"};
    });
    REQUIRE(!written);
    CHECK(written.error().where == (folder / "a").string());
    CHECK(written.error().what == "it broke");
    CHECK(file_bytes(folder / "a") == bytes_of("old"));
    CHECK(entries(folder) == 1);
}

TEST_CASE("write_file_atomically: no such folder, a folder, a long name, one link") {
    const TemporaryFolder folder;
    const auto nowhere = write_file_atomically(folder / "none/a", bytes_of("x"));
    REQUIRE(!nowhere);
    CHECK(nowhere.error().format().find("none/a") != std::string::npos);
    std::filesystem::create_directory(folder / "sub");
    CHECK(!write_file_atomically(folder / "sub", bytes_of("x")));
    CHECK(write_file_atomically(folder / std::string(255, 'n'), bytes_of("x")));
    CHECK(!write_file_atomically(folder / std::string(256, 'n'), bytes_of("x")));

    REQUIRE(write_file_atomically(folder / "sub/real", bytes_of("x")));
    std::filesystem::create_symlink("sub/real", folder / "link");
    REQUIRE(write_file_atomically(folder / "link", bytes_of("through")));
    CHECK(std::filesystem::is_symlink(folder / "link"));
    CHECK(file_bytes(folder / "sub/real") == bytes_of("through"));
}

TEST_CASE("write_file_atomically: a link that leads nowhere gets its file, and stays a link") {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "sub");
    std::filesystem::create_symlink("sub/next", folder / "link");
    std::filesystem::create_symlink(folder / "file", folder / "sub/next");
    REQUIRE(write_file_atomically(folder / "link", bytes_of("through")));
    CHECK(std::filesystem::is_symlink(folder / "link"));
    CHECK(std::filesystem::is_symlink(folder / "sub/next"));
    CHECK(file_bytes(folder / "file") == bytes_of("through"));

    std::filesystem::create_symlink("none/file", folder / "astray");
    std::filesystem::create_symlink("circle", folder / "circle");
    for (const char* name : {"astray", "circle"}) {
        const auto written = write_file_atomically(folder / name, bytes_of("x"));
        REQUIRE(!written);
        CHECK(written.error().where == (folder / name).string());
        CHECK(std::filesystem::is_symlink(folder / name));
    }
    CHECK(entries(folder) == 5);
}

TEST_CASE("write_file_atomically: keeps the permissions of the file it replaces") {
    const TemporaryFolder folder;
    REQUIRE(write_file_atomically(folder / "a", bytes_of("x")));
    REQUIRE(::chmod((folder / "a").c_str(), 0640) == 0);
    REQUIRE(write_file_atomically(folder / "a", bytes_of("y")));
    struct stat facts = {};
    REQUIRE(::stat((folder / "a").c_str(), &facts) == 0);
    CHECK((facts.st_mode & 0777) == 0640);
}

TEST_CASE("write_file_atomically: a device is written to, and a full one reported") {
    CHECK(write_file_atomically("/dev/null", bytes_of("x")));
    const auto full = write_file_atomically("/dev/full", bytes_of("x"));
    REQUIRE(!full);
    CHECK(full.error().what == "cannot write: No space left on device");
    CHECK(full.error().where == "/dev/full");
    CHECK(std::filesystem::exists("/dev/full"));
}

TEST_CASE("every writer: no room is one error, the old file stays, the new one goes") {
    const TemporaryFolder folder;
    for (const char* name : {"a", "b", "c", "d", "e", "f", "g", "h"})
        REQUIRE(write_file_atomically(folder / name, bytes_of("old")));
    for (rlim_t room : {rlim_t(0), rlim_t(100), rlim_t(10000)}) {
        CHECK(with_room(room, [&] { return write_everything(folder); }) == 8);
        for (const char* name : {"a", "b", "c", "d", "e", "f", "g", "h"})
            REQUIRE(file_bytes(folder / name) == bytes_of("old"));
        CHECK(entries(folder) == 8);
    }
}

TEST_CASE("remove_temporaries_on_signals: interruption removes the temporary and ends as the signal does") {
    const TemporaryFolder folder;
    REQUIRE(write_file_atomically(folder / "a", bytes_of("old")));
    for (int signal : {SIGINT, SIGTERM, SIGHUP}) {
        const int status = in_child([&] {
            ::signal(signal, SIG_DFL);
            remove_temporaries_on_signals();
            (void)!write_file_atomically(folder / "a", [&](const std::filesystem::path& path) -> Result<void> {
                write_bytes(path, bytes_of("half of it"));
                // Two at a time: both are removed.
                (void)!write_file_atomically(folder / "b", [&](const std::filesystem::path&) -> Result<void> {
                    ::raise(signal);
                    return {};
                });
                return {};
            });
            return 0;
        });
        REQUIRE(WIFSIGNALED(status));
        CHECK(WTERMSIG(status) == signal);
        CHECK(entries(folder) == 1);
        CHECK(file_bytes(folder / "a") == bytes_of("old"));
    }
}

TEST_CASE("remove_temporaries_on_signals: what other threads are writing goes too, at any moment") {
    const TemporaryFolder folder;
    for (int round = 0; round < 40; ++round) {
        const pid_t child = ::fork();
        if (child == 0) {
            ::signal(SIGTERM, SIG_DFL);
            remove_temporaries_on_signals();
            std::vector<std::thread> writers;
            for (int t = 0; t < 4; ++t)
                writers.emplace_back([&, t] {
                    for (;;) (void)!write_file_atomically(folder / std::to_string(t), bytes_of("whole"));
                });
            for (;;) ::pause();
        }
        ::usleep(useconds_t(5000 + 501 * round));
        ::kill(child, SIGTERM);
        int status = 0;
        ::waitpid(child, &status, 0);
        REQUIRE(WIFSIGNALED(status));
        for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
            CHECK(entry.path().filename().string().size() == 1);
            CHECK(file_bytes(entry.path()) == bytes_of("whole"));
        }
    }
}

TEST_CASE("remove_temporaries_on_signals: a signal that was ignored stays ignored, and a file-size limit is an error") {
    const TemporaryFolder folder;
    const int status = in_child([&] {
        ::signal(SIGHUP, SIG_IGN);
        remove_temporaries_on_signals();
        ::raise(SIGHUP);
        const rlimit limit{10, 10};
        ::setrlimit(RLIMIT_FSIZE, &limit);
        return write_file_atomically(folder / "a", bytes_of("more than ten bytes")) ? 1 : 0;
    });
    CHECK(WIFEXITED(status));
    CHECK(WEXITSTATUS(status) == 0);
    CHECK(entries(folder) == 0);
}
