#include "fuzz_image.h"

/// PNG and JPEG, told apart by their first byte as the program does.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const bool jpeg = size > 0 && data[0] == 0xff;
    return domelight::fuzz::read_image(jpeg ? domelight::open_jpeg_reader : domelight::open_png_reader, data, size);
}
