#pragma once
// KTX2 files that hold many cubes of one size, written and read one cube at a time: the memory does not depend on how
// many there are.

#include "domelight/base/result.h"
#include "domelight/texture/texture.h"

#include "io/file/byte_source.h"
#include "io/file/output_file.h"

#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace domelight {

/// The shape of such a file.
struct CubeArrayShape {
    Encoding encoding = Encoding::rgb9e5;
    int size = 0;  ///< of a face of level 0; level l has max(1, size >> l)
    int levels = 1;
    int cubes = 1;
    std::map<std::string, std::string> metadata;  ///< key/value data

    int level_size(int level) const { return std::max(1, size >> level); }
    /// Of all six faces of one cube's level.
    std::uint64_t cube_bytes(int level) const {
        return std::uint64_t(6) * std::uint64_t(level_size(level)) * std::uint64_t(level_size(level)) *
               std::uint64_t(encoding_bytes(encoding));
    }
};

/// Writes the cubes of a file in any order.
class CubeArrayWriter {
  public:
    /// Opens `path` for writing and empties it. The encoding must be one of single texels.
    static Result<CubeArrayWriter> open(const std::filesystem::path& path, const CubeArrayShape& shape);

    /// `texels`: the six faces of one level of a cube, one after the other. May be called from several threads at once.
    /// Failures are remembered, and finish() returns the first.
    void write(int cube, int level, std::span<const std::uint8_t> texels);
    Result<void> finish();

  private:
    CubeArrayWriter(CubeArrayShape shape, std::vector<std::uint64_t> offsets, std::unique_ptr<OutputFile> file)
        : shape_(std::move(shape)), offsets_(std::move(offsets)), file_(std::move(file)) {}

    CubeArrayShape shape_;
    std::vector<std::uint64_t> offsets_;  ///< of each level
    std::unique_ptr<OutputFile> file_;
};

/// Reads the cubes of a file in any order.
class CubeArrayReader {
  public:
    /// Errors name the file: those of read_texture_info(); texels in blocks, or supercompressed; not cubes.
    static Result<CubeArrayReader> open(const std::filesystem::path& path);

    const CubeArrayShape& shape() const { return shape_; }
    /// The six faces of one level of a cube as they are stored.
    Result<Bytes> read(int cube, int level);
    /// The same as floats, in as many channels as the encoding has.
    Result<Cubemap> decode(int cube, int level);

  private:
    CubeArrayReader(CubeArrayShape shape, std::vector<std::uint64_t> offsets, FileSource file)
        : shape_(std::move(shape)), offsets_(std::move(offsets)), file_(std::move(file)) {}

    CubeArrayShape shape_;
    std::vector<std::uint64_t> offsets_;
    FileSource file_;
};

}  // namespace domelight
