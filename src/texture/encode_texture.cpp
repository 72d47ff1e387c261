// Converts filtered levels to texture levels, with a report of the encoding's errors.
#include "domelight/base/parallel.h"
#include "domelight/texture/texture.h"

#include "texture/block/block_codec.h"
#include "texture/chain_encoder.h"
#include "texture/texel/encode_row.h"

#include <algorithm>
#include <cassert>

namespace domelight {

namespace {

/// The number of rows of texels that one task encodes.
constexpr int k_rows_a_piece = 96;

}  // namespace

Texture encode_texture(std::span<const FilteredMap> levels, Encoding encoding, int threads,
                       std::vector<EncodingReport>* reports, EncodingQuality quality) {
    if (reports) reports->assign(levels.size(), {});
    if (levels.empty()) {
        Texture texture;
        texture.encoding = encoding;
        return texture;
    }
    ChainEncoder encoder(levels, encoding, {}, quality);
    Texture texture = encode_in_memory(encoder, threads);
    if (reports) *reports = encoder.reports();
    return texture;
}

Texture encode_in_memory(ChainEncoder& encoder, int threads) {
    Texture texture = encoder.head();
    struct Piece {
        int level, first, rows;
    };
    std::vector<Piece> pieces;
    for (int l = 0; l < encoder.level_count(); ++l) {
        const int rows = encoder.rows(l) * texture.faces, step = k_rows_a_piece / encoding_block(texture.encoding);
        texture.levels.emplace_back(encoder.row_bytes(l) * std::size_t(rows));
        for (int y = 0; y < rows; y += step) pieces.push_back({l, y, std::min(step, rows - y)});
    }
    parallel_for(int(pieces.size()), threads, [&](int i) {
        const Piece& piece = pieces[i];
        encoder.encode(piece.level, piece.first, piece.rows,
                       texture.levels[piece.level].data() + encoder.row_bytes(piece.level) * std::size_t(piece.first));
    });
    return texture;
}

Texture encode_table(ImageView<const float> table, Encoding encoding) {
    assert(encoding_block(encoding) == 1);
    Texture texture;
    texture.encoding = encoding;
    texture.width = table.width;
    texture.height = table.height;
    const std::size_t row_bytes = std::size_t(table.width) * encoding_bytes(encoding);
    texture.levels.emplace_back(row_bytes * table.height);
    for (int y = 0; y < table.height; ++y)
        encode_texels(encoding, table.row(y), table.channels, table.width, texture.levels[0].data() + row_bytes * y);
    return texture;
}

ImageF decode_texture(const Texture& texture, int level, int face) {
    const int width = texture.level_width(level), height = texture.level_height(level);
    ImageF image(width, height, encoding_channels(texture.encoding));
    const std::size_t face_bytes = texture.face_bytes(level);
    assert(texture.levels[level].size() == face_bytes * texture.faces);
    const std::uint8_t* bytes = texture.levels[level].data() + face_bytes * face;
    if (encoding_block(texture.encoding) > 1) {
        decode_blocks(texture.encoding, bytes, width, height, image.pixels().data());
    } else {
        decode_texels(texture.encoding, bytes, width * height, image.pixels().data());
    }
    return image;
}

Result<std::vector<Cubemap>> decode_cubes(const Texture& texture) {
    if (texture.faces != 6) return Error{"texture is not a cube", "", "Wanted is a specular cube, as a bake has it."};
    if (encoding_channels(texture.encoding) != 3)
        return Error{"texture has fewer than three channels: no colour", "", ""};
    std::vector<Cubemap> levels;
    for (int l = 0; l < int(texture.levels.size()); ++l) {
        Cubemap cube(texture.level_width(l));
        for (int f = 0; f < 6; ++f) std::ranges::copy(decode_texture(texture, l, f).pixels(), cube.face(f).data);
        levels.push_back(std::move(cube));
    }
    return levels;
}

}  // namespace domelight
