// Filtered levels to texture levels, with a report of what the encoding lost.
#include "domelight/parallel.h"
#include "domelight/texture.h"

#include "codec/encode_row.h"
#include "simd/encode_row.h"

#include <cassert>
#include <cmath>

namespace domelight {

namespace {

/// Rows of a face that one task encodes. Part of the result's definition: sums are added a task at a time.
constexpr int k_rows_per_task = 16;

/// Some consecutive rows of one level, of all its faces.
struct Task {
    int level, first_row, rows;
};

/// A level's pixels as faces of width x height.
struct LevelShape {
    int width, height, faces;
};

LevelShape shape_of(const FilteredMap& map) {
    if (map.cube.empty()) return {map.latlong.width(), map.latlong.height(), 1};
    return {map.cube.size(), map.cube.size(), 6};
}

/// Solid angle of the texels of row `y` up to a factor common to the level. For a cube the density at the texel's
/// centre, (1 + s^2 + t^2)^(-3/2): off by O(1 / size^2), which a report of relative energy does not show, and without
/// arctangents.
void row_weights(const LevelShape& shape, int y, std::vector<float>& weight) {
    weight.resize(std::size_t(shape.width));
    if (shape.faces == 1) {
        weight.assign(weight.size(), float(std::sin(k_pi * (y + 0.5) / shape.height)));
        return;
    }
    const float step = 2.0f / float(shape.width), t = (float(y) + 0.5f) * step - 1;
    for (int x = 0; x < shape.width; ++x) {
        const float s = (float(x) + 0.5f) * step - 1, q = 1 + s * s + t * t;
        weight[std::size_t(x)] = 1 / (q * std::sqrt(q));
    }
}

EncodeSums encode_rows(const FilteredMap& map, const Task& task, Encoding encoding, std::uint8_t* out) {
    const LevelShape shape = shape_of(map);
    const std::span<const float> pixels = map.pixels();
    const std::size_t bytes = std::size_t(encoding_bytes(encoding));
    EncodeSums sums;
    std::vector<float> weight;
    for (int y = task.first_row; y < task.first_row + task.rows; ++y) {
        row_weights(shape, y, weight);
        for (int face = 0; face < shape.faces; ++face) {
            const std::size_t first = (std::size_t(face) * shape.height + y) * shape.width;
            sums +=
                simd::encode_row(encoding, pixels.data() + 3 * first, shape.width, weight.data(), out + bytes * first);
        }
    }
    return sums;
}

EncodingReport report_from(const EncodeSums& sums) {
    EncodingReport report;
    report.clipped_texels = sums.clipped;
    if (sums.power > 0) report.clipped_energy = sums.lost / sums.power;
    if (sums.norm > 0) report.rms_error = std::sqrt(sums.error / sums.norm);
    return report;
}

}  // namespace

Texture encode_texture(std::span<const FilteredMap> levels, Encoding encoding, int threads,
                       std::vector<EncodingReport>* reports) {
    Texture texture;
    texture.encoding = encoding;
    if (reports) reports->assign(levels.size(), {});
    if (levels.empty()) return texture;
    const LevelShape base = shape_of(levels[0]);
    texture.width = base.width;
    texture.height = base.height;
    texture.faces = base.faces;

    std::vector<Task> tasks;
    for (int l = 0; l < int(levels.size()); ++l) {
        const LevelShape shape = shape_of(levels[l]);
        assert(shape.width == texture.level_width(l) && shape.height == texture.level_height(l) &&
               shape.faces == base.faces);
        texture.levels.emplace_back(std::size_t(shape.width) * shape.height * shape.faces * encoding_bytes(encoding));
        for (int y = 0; y < shape.height; y += k_rows_per_task)
            tasks.push_back({l, y, std::min(k_rows_per_task, shape.height - y)});
    }
    std::vector<EncodeSums> sums(tasks.size());
    parallel_for(int(tasks.size()), threads, [&](int i) {
        sums[i] = encode_rows(levels[tasks[i].level], tasks[i], encoding, texture.levels[tasks[i].level].data());
    });
    if (reports) {
        std::vector<EncodeSums> totals(levels.size());
        for (std::size_t i = 0; i < tasks.size(); ++i) totals[tasks[i].level] += sums[i];
        for (std::size_t l = 0; l < levels.size(); ++l) (*reports)[l] = report_from(totals[l]);
    }
    return texture;
}

Texture encode_table(ImageView<const float> table, Encoding encoding) {
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
    const bool two_channels = texture.encoding == Encoding::rg16f || texture.encoding == Encoding::rg32f;
    const int width = texture.level_width(level), height = texture.level_height(level);
    ImageF image(width, height, two_channels ? 2 : 3);
    const std::size_t face_bytes = std::size_t(width) * height * encoding_bytes(texture.encoding);
    assert(texture.levels[level].size() == face_bytes * texture.faces);
    decode_texels(texture.encoding, texture.levels[level].data() + face_bytes * face, width * height,
                  image.pixels().data());
    return image;
}

}  // namespace domelight
