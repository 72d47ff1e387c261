#include "texture/chain_encoder.h"

#include "texture/block/block_codec.h"
#include "texture/texel/rgbe.h"
#include "texture/texel/encode_row_simd.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace domelight {

namespace {

/// Rows of a face whose sums are added before those of the next rows, in all faces at once. Part of the result's
/// definition.
constexpr int k_rows_per_sum = 16;

/// Solid angle of a cube's texels in row `y` of size^2 up to a common factor: the density at the texel's centre,
/// (1 + s^2 + t^2)^(-3/2). Off by O(1 / size^2), which a report of relative energy does not show, and without
/// arctangents.
void cube_row_weights(int size, int y, float* weight) {
    const float step = 2.0f / float(size), t = (float(y) + 0.5f) * step - 1;
    for (int x = 0; x < size; ++x) {
        const float s = (float(x) + 0.5f) * step - 1, q = 1 + s * s + t * t;
        weight[x] = 1 / (q * std::sqrt(q));
    }
}

EncodingReport report_from(const EncodeSums& sums, const LogScale& log_scale) {
    EncodingReport report;
    report.clipped_texels = sums.clipped;
    if (sums.power > 0) report.clipped_energy = sums.lost / sums.power;
    if (sums.norm > 0) report.rms_error = std::sqrt(sums.error / sums.norm);
    if (sums.log_error > 0)
        report.log_psnr = 10 * std::log10(log_scale.range * log_scale.range * sums.log_norm / sums.log_error);
    return report;
}

}  // namespace

ChainEncoder::ChainEncoder(std::span<const FilteredMap> levels, Encoding encoding,
                           std::map<std::string, std::string> metadata, EncodingQuality quality)
    : quality_(quality) {
    assert(!levels.empty());
    const bool cube = !levels[0].cube.empty();
    head_.encoding = encoding;
    head_.metadata = std::move(metadata);
    head_.width = cube ? levels[0].cube.size() : levels[0].latlong.width();
    head_.height = cube ? levels[0].cube.size() : levels[0].latlong.height();
    head_.faces = cube ? 6 : 1;
    for (const FilteredMap& map : levels) {
        Level& level = levels_.emplace_back();
        level.pixels = map.pixels().data();
        level.width = cube ? map.cube.size() : map.latlong.width();
        level.height = cube ? map.cube.size() : map.latlong.height();
        level.log_scale = log_scale_of(map.pixels());
        level.sums.resize(std::size_t(rows(level_count() - 1)) * head_.faces);
        if (!cube) continue;
        const int half = (level.height + 1) / 2;
        level.weights.resize(std::size_t(half) * level.width);
        for (int y = 0; y < half; ++y)
            cube_row_weights(level.width, y, level.weights.data() + std::size_t(y) * level.width);
    }
}

std::size_t ChainEncoder::row_bytes(int level) const {
    return std::size_t(in_blocks(levels_[level].width)) * std::size_t(encoding_bytes(head_.encoding));
}

std::vector<std::uint64_t> ChainEncoder::level_bytes() const {
    std::vector<std::uint64_t> bytes;
    for (int l = 0; l < level_count(); ++l) bytes.push_back(std::uint64_t(row_bytes(l)) * rows(l) * head_.faces);
    return bytes;
}

const float* ChainEncoder::row_weights(const Level& level, int y, std::vector<float>& scratch) const {
    if (!level.weights.empty())
        return level.weights.data() + std::size_t(level.width) * std::size_t(std::min(y, level.height - 1 - y));
    scratch.assign(std::size_t(level.width), float(std::sin(k_pi * (y + 0.5) / level.height)));
    return scratch.data();
}

void ChainEncoder::encode(int level_index, int first, int count, std::uint8_t* out) {
    Level& level = levels_[level_index];
    constexpr int k_largest_block = 16;
    const int side = encoding_block(head_.encoding), face_rows = rows(level_index);
    assert(side <= k_largest_block);
    std::array<std::vector<float>, k_largest_block> scratch;
    std::array<const float*, k_largest_block> weight;
    for (int row = first; row < first + count; ++row, out += row_bytes(level_index)) {
        const int face = row / face_rows, y = row % face_rows * side, texel_rows = std::min(side, level.height - y);
        for (int i = 0; i < texel_rows; ++i)
            weight[std::size_t(i)] = row_weights(level, y + i, scratch[std::size_t(i)]);
        const float* rgb = level.pixels + 3 * std::size_t(level.width) * (std::size_t(level.height) * face + y);
        level.sums[row] =
            side == 1 ? simd::encode_row(head_.encoding, rgb, level.width, weight[0], level.log_scale.floor, out)
                      : encode_block_row(head_.encoding, quality_, rgb, level.width, texel_rows, weight.data(),
                                         level.log_scale.floor, out);
    }
}

std::vector<EncodingReport> ChainEncoder::reports() const {
    std::vector<EncodingReport> reports;
    for (int l = 0; l < level_count(); ++l) {
        const int face_rows = rows(l);
        EncodeSums total;
        for (int begin = 0; begin < face_rows; begin += k_rows_per_sum) {
            EncodeSums part;
            for (int y = begin; y < std::min(begin + k_rows_per_sum, face_rows); ++y)
                for (int face = 0; face < head_.faces; ++face) part += levels_[l].sums[face * face_rows + y];
            total += part;
        }
        reports.push_back(report_from(total, levels_[l].log_scale));
    }
    return reports;
}

std::vector<EncodingReport> rgbe_reports(std::span<const FilteredMap> levels) {
    constexpr float k_top = 255 * 0x1p119f;
    std::vector<EncodingReport> reports;
    for (const FilteredMap& map : levels) {
        const bool cube = !map.cube.empty();
        const int width = cube ? map.cube.size() : map.latlong.width(),
                  height = cube ? map.cube.size() : map.latlong.height(), rows = cube ? 6 * height : height;
        const LogScale log_scale = log_scale_of(map.pixels());
        std::vector<float> weight(static_cast<std::size_t>(width)), stored(3 * weight.size());
        EncodeSums sums;
        for (int row = 0; row < rows; ++row) {
            if (cube)
                cube_row_weights(width, row % height, weight.data());
            else
                weight.assign(weight.size(), float(std::sin(k_pi * (row + 0.5) / height)));
            const float* rgb = map.pixels().data() + stored.size() * std::size_t(row);
            for (std::size_t i = 0; i < stored.size(); i += 3) {
                const auto rgbe = rgbe_from_rgb(rgb[i], rgb[i + 1], rgb[i + 2]);
                for (std::size_t c = 0; c < 3; ++c) stored[i + c] = std::ldexp(float(rgbe[c]), int(rgbe[3]) - 136);
            }
            sums += simd::compare_row(rgb, stored.data(), width, weight.data(), 0, k_top, log_scale.floor);
        }
        reports.push_back(report_from(sums, log_scale));
    }
    return reports;
}

}  // namespace domelight
