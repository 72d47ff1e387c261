// glTF reader on arbitrary bytes.
#include "fuzz_scene.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const domelight::SceneOptions options{.max_bytes = domelight::fuzz::k_scene_bytes, .threads = 1};
    const auto scene = domelight::read_gltf(domelight::FileBytes::from_memory({data, data + size}),
                                            domelight::fuzz::k_no_folder, options);
    if (scene) domelight::fuzz::check_scene(*scene);
    return 0;
}
