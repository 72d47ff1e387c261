#include "filtering/brdf/brdf_embedded.h"

#include <cstring>

namespace domelight {

ImageF embedded_brdf_table() {
    ImageF image(k_brdf_embedded_size, k_brdf_embedded_size, 3);
    std::memcpy(image.pixels().data(), k_brdf_embedded, image.pixels().size_bytes());
    return image;
}

}  // namespace domelight
