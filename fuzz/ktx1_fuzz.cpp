// KTX 1 reader on arbitrary bytes.
#include "texture/container/texture_reading.h"

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    domelight::MemorySource source({data, size});
    (void)!domelight::ktx1_info(source);
    (void)!domelight::ktx1_texture(source);
    return 0;
}
