#include "capture/engine_files/volume_texture.h"

#include "texture/container/texture_layout.h"
#include "texture/texel/half.h"
#include "texture/texel/rgb9e5.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace domelight {
namespace {

template <typename Stored>
void append(TexelBytes& out, const Stored& stored) {
    const std::size_t at = out.size();
    out.resize(at + sizeof stored);
    std::memcpy(out.data() + at, &stored, sizeof stored);
}

}  // namespace

Result<std::int64_t> write_volume(const std::filesystem::path& file, const VolumeTexels& volume, Encoding encoding) {
    Texture texture;
    texture.encoding = encoding, texture.width = volume.width(), texture.height = volume.height();
    TexelBytes& bytes = texture.levels.emplace_back();
    const float most = float(encoding_max(encoding));
    std::int64_t clipped = 0;
    for (const VolumeTexels::Texel& t : volume.texels()) {
        const float values[4] = {t.r, t.g, t.b, t.a};
        clipped += std::any_of(values, values + 4, [&](float v) { return std::abs(v) > most; });
        const auto held = [&](float v) { return std::clamp(v, -most, most); };
        if (encoding == Encoding::rgb9e5)
            append(bytes, rgb9e5_from_rgb({held(t.r), held(t.g), held(t.b)}));
        else
            for (const float v : values) append(bytes, half_from_float(held(v)));
    }
    const std::uint64_t size[1] = {bytes.size()};
    const auto layout = ktx2_layout(texture, size, Supercompression::none, size, {.depth = volume.depth()});
    if (!layout) return layout.error();
    if (auto written = write_with_layout(file, *layout, 1, texture.levels); !written) return written.error();
    return clipped;
}

}  // namespace domelight
