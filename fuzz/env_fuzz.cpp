// Babylon .env reader on arbitrary bytes.
#include "texture/container/env.h"

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    domelight::MemorySource source({data, size});
    (void)!domelight::env_info(source);
    (void)!domelight::env_file(source);
    return 0;
}
