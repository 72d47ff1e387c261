#include "deflate.h"

#include <zlib.h>

namespace domelight {

std::vector<std::uint8_t> deflated(std::span<const std::uint8_t> bytes, int level, int strategy, int window_bits) {
    z_stream stream{};
    deflateInit2(&stream, level, Z_DEFLATED, window_bits, 8, strategy);
    std::vector<std::uint8_t> packed(deflateBound(&stream, uLong(bytes.size())));
    stream.next_in = const_cast<Bytef*>(bytes.data());
    stream.avail_in = uInt(bytes.size());
    stream.next_out = packed.data();
    stream.avail_out = uInt(packed.size());
    deflate(&stream, Z_FINISH);
    packed.resize(stream.total_out);
    deflateEnd(&stream);
    return packed;
}

}  // namespace domelight
