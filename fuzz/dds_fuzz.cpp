// DDS reader on arbitrary bytes.
#include "texture/container/texture_reading.h"

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    domelight::MemorySource source({data, size});
    (void)!domelight::dds_info(source);
    (void)!domelight::dds_texture(source);
    (void)!domelight::dds_texture(source, domelight::Decode::rgbm);
    return 0;
}
