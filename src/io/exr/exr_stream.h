#pragma once
// What the readers of OpenEXR share.

#include "io/file/file_reader.h"

#include <ImfIO.h>

#include <cstdint>
#include <exception>
#include <memory>
#include <string>
#include <vector>

namespace domelight {

/// The file's bytes as the stream that OpenEXR wants, with the headers replaced by the checked ones.
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

/// What OpenEXR says, on one line and without the name it knows the stream by.
std::string exr_message(const std::exception& error);

/// Makes the library's pool of threads at least `threads` large; one thread needs none.
void provide_exr_threads(int threads);

}  // namespace domelight
