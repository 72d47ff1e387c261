#include "io/picture/png_memory.h"

#include "domelight/base/parallel.h"

namespace domelight {

Result<std::vector<PngBytes>> encode_faces(const Texture& texture, int threads) {
    const std::size_t faces = std::size_t(texture.faces);
    std::vector<PngBytes> pictures(texture.levels.size() * faces);
    std::vector<Result<void>> done(pictures.size());
    parallel_for(int(pictures.size()), threads, [&](int i) {
        const int level = i / texture.faces;
        const std::uint8_t* face =
            texture.levels[std::size_t(level)].data() + texture.face_bytes(level) * std::size_t(i % texture.faces);
        auto png = encode_png({face, texture.level_width(level), texture.level_height(level), 4});
        if (png)
            pictures[std::size_t(i)] = std::move(*png);
        else
            done[std::size_t(i)] = png.error();
    });
    for (const Result<void>& result : done)
        if (!result) return result.error();
    return pictures;
}

}  // namespace domelight
