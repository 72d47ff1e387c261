#include "texture/chain_encoder.h"

#include "texture/block/block_codec.h"
#include "texture/texel/encode_row_simd.h"
#include "texture/texel/rgbe.h"

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

LogScale log_scale_in(const TexelOrder& order, const FilteredMap& map) {
    if (order.keeps_places()) return log_scale_of(map.pixels());
    LogScaleSums sums;
    order.for_each_row(map, [&](std::span<const float> row) { sums.add(row); });
    return sums.scale();
}

}  // namespace

ChainEncoder::ChainEncoder(std::span<const FilteredMap> levels, Encoding encoding,
                           std::map<std::string, std::string> metadata, EncodingQuality quality,
                           const TexelOrder& order)
    : quality_(quality), order_(order) {
    assert(!levels.empty());
    head_.encoding = encoding;
    head_.metadata = std::move(metadata);
    head_.width = levels[0].width();
    head_.height = levels[0].height();
    head_.faces = levels[0].faces();
    for (const FilteredMap& map : levels) {
        Level& level = levels_.emplace_back();
        level.map = &map;
        level.width = map.width();
        level.height = map.height();
        level.log_scale = log_scale_in(order, map);
        level.sums.resize(std::size_t(rows(level_count() - 1)) * head_.faces);
        if (map.layout != Layout::cube) continue;
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

const float* ChainEncoder::rows_in_order(const Level& level, int face, int y, int count,
                                         std::vector<float>& scratch) const {
    if (order_.keeps_places()) return level.map->face(face).row(y);
    const std::size_t values = 3 * std::size_t(level.width);
    scratch.resize(values * std::size_t(count));
    if (count == 1) return order_.row(*level.map, face, y, scratch.data());
    for (int i = 0; i < count; ++i) {
        float* to = scratch.data() + values * std::size_t(i);
        const float* row = order_.row(*level.map, face, y + i, to);
        if (row != to) std::copy_n(row, values, to);
    }
    return scratch.data();
}

void ChainEncoder::encode(int level_index, int first, int count, std::uint8_t* out) {
    Level& level = levels_[level_index];
    constexpr int k_largest_block = 16;
    const int side = encoding_block(head_.encoding), face_rows = rows(level_index);
    assert(side <= k_largest_block);
    std::array<std::vector<float>, k_largest_block> scratch;
    std::array<const float*, k_largest_block> weight;
    std::vector<float> texels;
    for (int row = first; row < first + count; ++row, out += row_bytes(level_index)) {
        const int face = row / face_rows, y = row % face_rows * side, texel_rows = std::min(side, level.height - y);
        for (int i = 0; i < texel_rows; ++i)
            weight[std::size_t(i)] = row_weights(level, y + i, scratch[std::size_t(i)]);
        const float* rgb = rows_in_order(level, face, y, texel_rows, texels);
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

std::vector<EncodingReport> rgbe_reports(std::span<const FilteredMap> levels, const TexelOrder& order) {
    constexpr float k_top = 255 * 0x1p119f;
    std::vector<EncodingReport> reports;
    for (const FilteredMap& map : levels) {
        const int width = map.width(), height = map.height();
        const LogScale log_scale = log_scale_in(order, map);
        std::vector<float> weight(static_cast<std::size_t>(width)), stored(3 * weight.size());
        EncodeSums sums;
        int row = 0;
        order.for_each_row(map, [&](std::span<const float> rgb) {
            if (map.layout == Layout::cube)
                cube_row_weights(width, row % height, weight.data());
            else
                weight.assign(weight.size(), float(std::sin(k_pi * (row + 0.5) / height)));
            for (std::size_t i = 0; i < stored.size(); i += 3) {
                const auto rgbe = rgbe_from_rgb(rgb[i], rgb[i + 1], rgb[i + 2]);
                for (std::size_t c = 0; c < 3; ++c) stored[i + c] = std::ldexp(float(rgbe[c]), int(rgbe[3]) - 136);
            }
            sums += simd::compare_row(rgb.data(), stored.data(), width, weight.data(), 0, k_top, log_scale.floor);
            ++row;
        });
        reports.push_back(report_from(sums, log_scale));
    }
    return reports;
}

}  // namespace domelight
