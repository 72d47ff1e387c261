// Encoding: maps as the texels that graphics processors read. Texels only; texture_files.cpp has the containers.
#include "c/texture.h"

#include "c/filtered.h"
#include "c/pixels.h"

#include <algorithm>
#include <bit>
#include <utility>

using namespace domelight;

namespace {

constexpr domelight_encode_options k_options{};
constexpr int k_max_side = 32768, k_max_sh_bands = 64;

struct EncodeRequest {
    Encoding encoding;
    EncodingQuality quality;
    int threads;
};

Result<EncodeRequest> read_options(const domelight_encode_options* options) {
    const auto given = c::read_struct(options, k_options);
    if (!given) return given.error();
    const auto encoding = c::read_word(given->encoding, Encoding::rgba16f, "encoding");
    if (!encoding) return encoding.error();
    const auto quality = c::read_word(given->quality, EncodingQuality::standard, "quality");
    if (!quality) return quality.error();
    if (auto ok = c::check_threads(given->threads); !ok) return ok.error();
    return EncodeRequest{*encoding, *quality, given->threads};
}

/// An error unless each level has half the size of the one before, rounded down.
Result<void> check_halving(std::span<const FilteredMap> maps) {
    for (std::size_t l = 1; l < maps.size(); ++l) {
        const FilteredMap &map = maps[l], &before = maps[l - 1];
        const int width = std::max(1, before.width() / 2), height = std::max(1, before.height() / 2);
        if (map.layout != before.layout)
            return Error{"cubes and pictures cannot be levels of one texture", field_place("faces"), ""};
        if (map.width() != width || map.height() != height)
            return Error{text("level ", int(l), " is ", map.width(), " x ", map.height(), ", not ", width, " x ",
                              height, ", half of the level before"),
                         field_place("levels"), ""};
    }
    return {};
}

Result<void> encode_maps(std::span<const FilteredMap> maps, const EncodeRequest& request, std::vector<Vec3d> sh,
                         domelight_texture** texture) {
    if (maps.empty()) return Error{"there are none", field_place("levels"), ""};
    if (encoding_channels(request.encoding) != 3)
        return Error{name_of(request.encoding) + " has no room for a colour", field_place("encoding"), ""};
    if (auto ok = check_halving(maps); !ok) return ok;
    std::vector<EncodingReport> reports;
    Texture encoded = encode_texture(maps, request.encoding, request.threads, &reports, request.quality);
    return c::hand_out(texture, std::move(encoded), std::move(reports), std::move(sh));
}

/// A picture of one to three channels for an encoding of fewer than three: the BRDF table.
Result<void> encode_table(const domelight_pixels& table, const EncodeRequest& request, domelight_texture** texture) {
    if (table.faces != 1) return Error{"a table has one face", field_place("faces"), ""};
    const int channels = encoding_channels(request.encoding);
    if (table.channels < channels)
        return Error{text(table.channels, " is less than the ", channels, " of ", name_of(request.encoding)),
                     field_place("channels"), ""};
    const auto pixels = c::copy_pixels(table, table.channels);
    if (!pixels) return pixels.error();
    return c::hand_out(texture, domelight::encode_table(*pixels, request.encoding), std::vector<EncodingReport>(1),
                       std::vector<Vec3d>());
}

/// A texture of the stated size whose levels are empty.
Result<Texture> empty_texture(const domelight_texture_info* info, const char* encoding) {
    const auto given = c::read_struct(info, {});
    if (!given) return given.error();
    const auto known = c::read_word(encoding, Encoding::rgba16f, "encoding");
    if (!known) return known.error();
    if (given->faces != 1 && given->faces != 6)
        return Error{text(given->faces, " is neither 1 nor 6"), field_place("faces"), ""};
    for (const auto& [size, name] : {std::pair(given->width, "width"), std::pair(given->height, "height")})
        if (size < 1 || size > k_max_side)
            return Error{text(size, " is not from 1 to ", k_max_side), field_place(name), ""};
    const int most = std::bit_width(unsigned(std::max(given->width, given->height)));
    if (given->levels < 1 || given->levels > most)
        return Error{text(given->levels, " is not from 1 to ", most), field_place("levels"), ""};
    Texture texture;
    texture.encoding = *known;
    texture.width = given->width;
    texture.height = given->height;
    texture.faces = given->faces;
    texture.levels.resize(std::size_t(given->levels));
    return texture;
}

}  // namespace

extern "C" {

void domelight_encode_options_init_sized(domelight_encode_options* options, size_t struct_size) {
    c::init_struct(options, struct_size, k_options);
}

domelight_error* domelight_encode(const domelight_pixels* levels, size_t count, const domelight_encode_options* options,
                                  domelight_texture** texture) {
    return c::guarded([&]() -> Result<void> {
        if (auto ok = c::check_given({{levels, "levels"}, {texture, "texture"}}); !ok) return ok;
        const auto request = read_options(options);
        if (!request) return request.error();
        std::vector<FilteredMap> maps;
        for (std::size_t l = 0; l < count; ++l) {
            const auto* level = c::element(levels, l);
            const auto given = c::read_struct(level, {});
            if (!given) return given.error();
            if (l == 0 && count == 1 && encoding_channels(request->encoding) < 3)
                return encode_table(*given, *request, texture);
            auto image = c::copy_pixels(*given, 3);
            if (!image) return image.error();
            maps.emplace_back(given->faces == 6 ? Layout::cube : Layout::latlong, *std::move(image));
        }
        return encode_maps(maps, *request, {}, texture);
    });
}

domelight_error* domelight_encode_filtered(const domelight_filtered* filtered, const domelight_encode_options* options,
                                           domelight_texture** texture) {
    return c::guarded([&]() -> Result<void> {
        if (auto ok = c::check_given({{filtered, "filtered"}, {texture, "texture"}}); !ok) return ok;
        const auto request = read_options(options);
        if (!request) return request.error();
        return encode_maps(filtered->result.specular, *request, filtered->result.sh, texture);
    });
}

domelight_error* domelight_texture_from_levels(const domelight_texture_info* info, const char* encoding,
                                               const void* const* levels, const size_t* sizes,
                                               domelight_texture** texture) {
    return c::guarded([&]() -> Result<void> {
        if (auto ok = c::check_given({{info, "info"}, {levels, "levels"}, {sizes, "sizes"}, {texture, "texture"}}); !ok)
            return ok;
        auto made = empty_texture(info, encoding);
        if (!made) return made.error();
        for (std::size_t l = 0; l < made->levels.size(); ++l) {
            if (auto ok = c::check_given({{levels[l], "levels"}}); !ok) return ok;
            const std::int64_t blocks = std::int64_t(made->level_columns(int(l))) * made->level_rows(int(l));
            const std::int64_t expected = blocks * encoding_bytes(made->encoding) * made->faces;
            if (std::int64_t(sizes[l]) != expected)
                return Error{text("level ", int(l), " has ", std::int64_t(sizes[l]), " bytes, not ", expected),
                             field_place("levels"), ""};
            const auto* bytes = static_cast<const std::uint8_t*>(levels[l]);
            made->levels[l].assign(bytes, bytes + sizes[l]);
        }
        const std::size_t count = made->levels.size();
        return c::hand_out(texture, *std::move(made), std::vector<EncodingReport>(count), std::vector<Vec3d>());
    });
}

domelight_error* domelight_texture_set_sh(domelight_texture* texture, const double* rgb, int32_t bands) {
    return c::guarded([&]() -> Result<void> {
        if (auto ok = c::check_given({{texture, "texture"}}); !ok) return ok;
        if (bands < 0 || bands > k_max_sh_bands)
            return Error{text(bands, " is not from 0 to ", k_max_sh_bands), field_place("bands"), ""};
        if (bands > 0)
            if (auto ok = c::check_given({{rgb, "rgb"}}); !ok) return ok;
        texture->sh.clear();
        for (int k = 0; k < bands * bands; ++k) texture->sh.push_back({rgb[3 * k], rgb[3 * k + 1], rgb[3 * k + 2]});
        return {};
    });
}

domelight_error* domelight_texture_get_info(const domelight_texture* texture, domelight_texture_info* info) {
    return c::guarded([&]() -> Result<void> {
        if (auto ok = c::check_given({{texture, "texture"}, {info, "info"}}); !ok) return ok;
        const Texture& t = texture->texture;
        domelight_texture_info known{};
        known.width = t.width;
        known.height = t.height;
        known.faces = t.faces;
        known.levels = std::int32_t(t.levels.size());
        known.block = encoding_block(t.encoding);
        known.block_bytes = encoding_bytes(t.encoding);
        return c::write_struct(info, known);
    });
}

domelight_error* domelight_texture_level(const domelight_texture* texture, size_t level, const void** bytes,
                                         size_t* size) {
    return c::guarded([&]() -> Result<void> {
        if (auto ok = c::check_given({{texture, "texture"}, {bytes, "bytes"}, {size, "size"}}); !ok) return ok;
        const auto& levels = texture->texture.levels;
        if (auto ok = c::check_index(level, levels.size(), "level"); !ok) return ok;
        *bytes = levels[level].data();
        *size = levels[level].size();
        return {};
    });
}

domelight_error* domelight_texture_report(const domelight_texture* texture, size_t level,
                                          domelight_encoding_report* report) {
    return c::guarded([&]() -> Result<void> {
        if (auto ok = c::check_given({{texture, "texture"}, {report, "report"}}); !ok) return ok;
        if (auto ok = c::check_index(level, texture->reports.size(), "level"); !ok) return ok;
        const EncodingReport& found = texture->reports[level];
        domelight_encoding_report known{};
        known.clipped_texels = found.clipped_texels;
        known.clipped_energy = found.clipped_energy;
        known.rms_error = found.rms_error;
        known.log_psnr = found.log_psnr;
        return c::write_struct(report, known);
    });
}

domelight_error* domelight_texture_set_metadata(domelight_texture* texture, const char* key, const char* value) {
    return c::guarded([&]() -> Result<void> {
        if (auto ok = c::check_given({{texture, "texture"}, {key, "key"}}); !ok) return ok;
        if (value)
            texture->texture.metadata[key] = value;
        else
            texture->texture.metadata.erase(key);
        return {};
    });
}

void domelight_texture_free(domelight_texture* texture) {
    delete texture;
}

}  // extern "C"
