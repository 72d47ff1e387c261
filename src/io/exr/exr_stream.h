#pragma once
// Functions shared by the readers of OpenEXR.

#include "io/exr/exr_channels.h"
#include "io/exr/exr_header_reader.h"
#include "io/file/file_reader.h"

#include <ImathBox.h>
#include <ImfIO.h>
#include <ImfMultiPartInputFile.h>

#include <cstdint>
#include <exception>
#include <memory>
#include <string>
#include <vector>

namespace domelight {

inline ExrWindow exr_window(const Imath::Box2i& box) {
    return {box.min.x, box.min.y, box.max.x, box.max.y};
}

/// The file's bytes as an OpenEXR stream, with the headers replaced by the checked ones.
class ExrStream : public Imf::IStream {
  public:
    ExrStream(std::shared_ptr<const FileBytes> bytes, std::vector<char> headers)
        : Imf::IStream("image"), bytes_(std::move(bytes)), headers_(std::move(headers)) {}

    bool read(char out[], int n) override;
    std::uint64_t tellg() override { return at_; }
    void seekg(std::uint64_t position) override;

  private:
    std::shared_ptr<const FileBytes> bytes_;
    std::vector<char> headers_;
    std::size_t at_ = 0;
};

/// The parts of a file, as their headers state them.
std::vector<ExrPart> exr_parts(const Imf::MultiPartInputFile& file);

/// OpenEXR's message, on one line and without its name of the stream.
std::string exr_message(const std::exception& error);

/// Enlarges the library's thread pool to at least `threads`; a single thread needs no pool.
void provide_exr_threads(int threads);

}  // namespace domelight
