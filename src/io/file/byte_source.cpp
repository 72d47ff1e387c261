#include "io/file/byte_source.h"

#include <algorithm>
#include <string>

namespace domelight {

Error ByteSource::truncated(std::uint64_t offset, std::uint64_t count, const char* what) const {
    return {"ends too early: the " + std::string(what) + " should take " + std::to_string(count) + " bytes from byte " +
                std::to_string(offset) + ", but there are only " + std::to_string(size()),
            "", "the file is truncated or damaged"};
}

Result<Bytes> ByteSource::take(std::uint64_t offset, std::uint64_t count, const char* what) {
    if (!contains(offset, count)) return truncated(offset, count, what);
    Bytes bytes(static_cast<std::size_t>(count));
    Result<void> done = read(offset, bytes, what);
    if (!done) return done.error();
    return bytes;
}

Result<void> MemorySource::read(std::uint64_t offset, std::span<std::uint8_t> out, const char* what) {
    if (!contains(offset, out.size())) return truncated(offset, out.size(), what);
    std::copy_n(bytes_.begin() + std::ptrdiff_t(offset), out.size(), out.begin());
    return {};
}

}  // namespace domelight
