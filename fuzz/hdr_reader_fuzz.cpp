#include "fuzz_image.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return domelight::fuzz::read_image(domelight::open_hdr_reader, data, size);
}
