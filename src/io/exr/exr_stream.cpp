#include "io/exr/exr_stream.h"

#include "io/file/printable.h"

#include <Iex.h>
#include <ImfChannelList.h>
#include <ImfHeader.h>
#include <ImfPartType.h>
#include <ImfThreading.h>

#include <algorithm>
#include <cstring>
#include <mutex>

namespace domelight {

bool ExrStream::read(char out[], int n) {
    const auto all = bytes_->bytes();
    if (n < 0 || std::size_t(n) > all.size() - at_) throw Iex::InputExc("file ends too early");
    std::size_t from_headers = 0;
    if (at_ < headers_.size()) {
        from_headers = std::min(std::size_t(n), headers_.size() - at_);
        std::memcpy(out, headers_.data() + at_, from_headers);
    }
    std::memcpy(out + from_headers, all.data() + at_ + from_headers, std::size_t(n) - from_headers);
    at_ += std::size_t(n);
    return at_ < all.size();
}

void ExrStream::seekg(std::uint64_t position) {
    if (position > bytes_->bytes().size()) throw Iex::InputExc("an offset points past the end of the file");
    at_ = std::size_t(position);
}

std::vector<ExrPart> exr_parts(const Imf::MultiPartInputFile& file) {
    std::vector<ExrPart> parts;
    for (int p = 0; p < file.parts(); ++p) {
        const Imf::Header& header = file.header(p);
        ExrPart& part = parts.emplace_back();
        if (file.parts() > 1 && header.hasName()) part.name = header.name();
        if (header.hasView()) part.view = header.view();
        part.deep = header.hasType() && Imf::isDeepData(header.type());
        for (auto c = header.channels().begin(); c != header.channels().end(); ++c) part.channels.push_back(c.name());
    }
    return parts;
}

std::string exr_message(const std::exception& error) {
    std::string text = error.what();
    if (const std::size_t named = text.find("\"image\". "); named != std::string::npos) text.erase(0, named + 9);
    while (text.ends_with('.') || text.ends_with('\n')) text.pop_back();
    return printable(text, 200);
}

void provide_exr_threads(int threads) {
    static std::mutex mutex;
    const std::lock_guard lock(mutex);
    if (threads > 1 && Imf::globalThreadCount() < threads) Imf::setGlobalThreadCount(threads);
}

}  // namespace domelight
