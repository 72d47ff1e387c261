// Functions of the library that the module leaves out, with what they would need. Readers say so; npm/library.js refuses what would call the encoders.

#include "io/environment/cube_texture_reader.h"
#include "io/image_reader.h"
#include "scene/gltf/gltf_document.h"
#include "scene/gltf/gltf_image_light.h"
#include "texture/block/astc_codec.h"
#include "texture/block/uastc_hdr.h"

#include <openexr.h>

#include <cstdlib>
#include <string>

namespace domelight {

namespace {

Error absent(const std::string& what) {
    return {what + " is not read by the WebAssembly module", "", "Decode the picture, and give its pixels."};
}

}  // namespace

Result<std::unique_ptr<ImageReader>> open_png_reader(std::shared_ptr<const FileBytes>, const ReaderOptions&) {
    return absent("PNG");
}
Result<std::unique_ptr<ImageReader>> open_jpeg_reader(std::shared_ptr<const FileBytes>, const ReaderOptions&) {
    return absent("JPEG");
}
bool may_be_gltf_image_light(std::span<const std::uint8_t>) {
    return false;
}
Result<GltfEnvironment> read_gltf_environment(std::shared_ptr<const FileBytes>, const std::optional<std::filesystem::path>&, std::int64_t,
                                              RepairOptions, RepairReport&) {
    return absent("glTF");
}
Result<Cubemap> read_cube_texture(std::span<const std::uint8_t> bytes, std::int64_t, RepairOptions, RepairReport&, Decode) {
    return absent(texture_container(bytes));
}
std::string texture_container(std::span<const std::uint8_t> bytes) {
    const std::string_view start(reinterpret_cast<const char*>(bytes.data()), std::min<std::size_t>(bytes.size(), 16));
    if (start.starts_with("\xabKTX 20\xbb\r\n\x1a\n")) return "KTX2";
    if (start.starts_with("\xabKTX 11\xbb\r\n\x1a\n")) return "KTX";
    if (start.starts_with("DDS ")) return "DDS";
    if (start.starts_with("\x86\x16\x87\x96\xf6\xd6\x96\x36")) return "Babylon .env";
    return "";
}

void encode_astc_hdr(int, const float*, int, EncodingQuality, std::uint8_t*) {
    std::abort();
}
void decode_astc_hdr(int, const std::uint8_t*, int, float*) {
    std::abort();
}
void encode_uastc_hdr(const float*, int, EncodingQuality, std::uint8_t*) {
    std::abort();
}
void decode_uastc_hdr(const std::uint8_t*, int, float*) {
    std::abort();
}

}  // namespace domelight
