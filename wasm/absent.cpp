// Functions of the library that the module leaves out, with what they would need. Readers say so; npm/library.js refuses what would call the encoders.

#include "io/picture/texture_image.h"
#include "scene/gltf/gltf_document.h"
#include "scene/gltf/gltf_image_light.h"
#include "texture/block/astc_codec.h"

#include <cstdlib>
#include <string>

namespace domelight {

namespace {

Error absent(const std::string& what) {
    return {what + " is not read by the WebAssembly module", "", "Decode the picture, and give its pixels."};
}

}  // namespace

bool may_be_gltf_image_light(std::span<const std::uint8_t>) {
    return false;
}
Result<GltfImageLight> read_gltf_image_light(std::shared_ptr<const FileBytes>, const std::optional<std::filesystem::path>&, std::int64_t, int) {
    return absent("glTF");
}
Result<TextureSize> webp_size(std::span<const std::uint8_t>) {
    return absent("WebP");
}
Result<Rgba8Image> decode_webp_texture(std::span<const std::uint8_t>) {
    return absent("WebP");
}

bool has_astc_codec() {
    return false;
}
void encode_astc_hdr(int, const float*, int, EncodingQuality, std::uint8_t*) {
    std::abort();
}
void decode_astc_hdr(int, const std::uint8_t*, int, float*) {
    std::abort();
}
}  // namespace domelight
