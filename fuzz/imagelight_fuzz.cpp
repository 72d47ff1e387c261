// glTF with EXT_lights_image_based on arbitrary bytes.
#include "fuzz_scene.h"
#include "scene/gltf/gltf_image_light.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    (void)domelight::may_be_gltf_image_light({data, size});
    (void)!domelight::read_gltf_image_light(domelight::FileBytes::from_memory({data, data + size}),
                                            domelight::fuzz::k_no_folder, domelight::fuzz::k_scene_bytes);
    return 0;
}
