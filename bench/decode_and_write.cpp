// A lower bound of the time of a bake: decoding its source, and writing the bytes that it wrote. bench/command.py runs
// this beside the program.
//
//     decode_and_write SOURCE BAKED SCRATCH [THREADS] [encode]
//
// Decodes SOURCE row by row with the library's reader (into one buffer that every row passes through, as a bake reads
// it), then writes the bytes of every file in the folder BAKED to a file of the same name in SCRATCH with the library's
// atomic writer; with `encode` those are Radiance pictures, decoded before the clock starts and encoded again as they
// are written. The bytes to write are in memory before the clock starts. Prints one JSON object: seconds by the clock
// and CPU seconds of each step.
#include "domelight/image/row_source.h"
#include "domelight/io/environment/open_environment.h"
#include "domelight/io/file/atomic_file.h"
#include "domelight/io/write_image.h"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iterator>
#include <string>

using namespace domelight;

namespace {

struct Times {
    double wall, cpu;
};

Times now() {
    timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return {std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(),
            double(t.tv_sec) + 1e-9 * double(t.tv_nsec)};
}

Times since(const Times& start) {
    const Times end = now();
    return {end.wall - start.wall, end.cpu - start.cpu};
}

Result<void> decode(const std::filesystem::path& source, int threads) {
    EnvironmentOptions options;
    options.threads = threads;
    auto environment = open_environment({source}, options);
    if (!environment) return environment.error();
    if (environment->cube()) return Error{"is not a lat-long image", source.string(), ""};
    const auto rows = environment->rows();
    if (!rows) return rows.error();
    const int height = (*rows)->height();
    ImageF block((*rows)->width(), 64, 3);
    for (int y = 0; y < height; y += block.height())
        if (auto ok = (*rows)->read(block.view().rows(0, std::min(block.height(), height - y))); !ok) return ok;
    return {};
}

struct File {
    std::filesystem::path name;
    std::vector<std::uint8_t> bytes;
    ImageF picture;  ///< with `encode`
};

/// Six faces of a cube, each as a picture.
Result<void> decode_faces(std::vector<File>& files, const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> paths;
    for (const File& file : files) paths.push_back(folder / file.name);
    auto environment = open_environment(paths);
    if (!environment) return environment.error();
    // The order of the faces does not matter here: all are written.
    for (std::size_t f = 0; f < files.size(); ++f) {
        const ImageView<const float> face = environment->cube()->face(int(f));
        files[f].picture = ImageF(face.width, face.height, 3);
        std::copy_n(face.data, files[f].picture.pixels().size(), files[f].picture.pixels().begin());
    }
    return {};
}

std::vector<File> read_folder(const std::filesystem::path& folder) {
    std::vector<File> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        std::ifstream in(entry.path(), std::ios::binary);
        files.push_back({entry.path().filename(), {std::istreambuf_iterator<char>(in), {}}, {}});
    }
    return files;
}

int fail(const Error& error) {
    fmt::print(stderr, "error: {}: {}\n", error.where, error.what);
    return 1;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 4) {
        fmt::print(stderr, "usage: decode_and_write SOURCE BAKED SCRATCH [THREADS]\n");
        return 2;
    }
    const std::filesystem::path scratch = argv[3];
    std::vector<File> files = read_folder(argv[2]);
    const int threads = argc > 4 ? std::atoi(argv[4]) : 0;
    const bool encode = argc > 5 && std::string(argv[5]) == "encode";
    if (encode)
        if (auto ok = decode_faces(files, argv[2]); !ok) return fail(ok.error());
    std::size_t bytes = 0;
    for (const File& file : files) bytes += file.bytes.size();

    const Times decode_start = now();
    if (auto ok = decode(argv[1], threads); !ok) return fail(ok.error());
    const Times decoding = since(decode_start), write_start = now();
    for (const File& file : files)
        if (auto ok = encode ? write_hdr(scratch / file.name, file.picture.view(), threads)
                             : write_file_atomically(scratch / file.name, file.bytes);
            !ok)
            return fail(ok.error());
    const Times writing = since(write_start);
    fmt::print(
        "{{\"decode\": {{\"wall_seconds\": {}, \"cpu_seconds\": {}}}, \"write\": {{\"wall_seconds\": {}, "
        "\"cpu_seconds\": {}}}, \"bytes\": {}}}\n",
        decoding.wall, decoding.cpu, writing.wall, writing.cpu, bytes);
}
