// PlayCanvas atlas reader on arbitrary bytes.
#include "texture/container/playcanvas_atlas.h"

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    (void)!domelight::playcanvas_atlas({data, size});
    return 0;
}
