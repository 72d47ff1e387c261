#pragma once

#include "io/file/output_file.h"

#include <Iex.h>
#include <ImfIO.h>

#include <span>
#include <vector>

namespace domelight {

/// An OpenEXR stream that writes to our file. OpenEXR's own stream loses errors on closing; ours keeps the error, and
/// throws to stop the writing.
class ExrOutputStream : public Imf::OStream {
  public:
    explicit ExrOutputStream(OutputFile& file) : OStream("image"), file_(file) { buffer_.reserve(k_buffer_bytes); }

    void write(const char bytes[], int count) override {
        if (buffer_.size() + std::size_t(count) > k_buffer_bytes) flush();
        if (std::size_t(count) > k_buffer_bytes)
            file_.write(std::span(bytes, std::size_t(count)));
        else
            buffer_.insert(buffer_.end(), bytes, bytes + count);
        if (file_.failed()) throw Iex::IoExc("write");
    }
    std::uint64_t tellp() override { return file_.position() + buffer_.size(); }
    void seekp(std::uint64_t position) override {
        flush();
        file_.seek(position);
    }
    void flush() {
        file_.write(std::span<const char>(buffer_));
        buffer_.clear();
    }

  private:
    static constexpr std::size_t k_buffer_bytes = std::size_t(1) << 20;
    OutputFile& file_;
    std::vector<char> buffer_;
};

}  // namespace domelight
