// A cube's faces side by side in one picture.
#include "domelight/image/cube_layout.h"

#include <algorithm>
#include <array>

namespace domelight {

namespace {

/// Where each face +X -X +Y -Y +Z -Z goes, in faces.
struct CubeLayout {
    const char* name;
    int columns, rows;
    std::array<std::array<int, 2>, 6> place;
    bool last_upside_down;  ///< -Z turned by half, so that its top edge meets that of -Y's bottom
};

// Faces in OpenGL's orientation meet unturned along the crosses' middle row and column: +Z has +X to its right, +Y
// above it, -Y below.
constexpr std::array<CubeLayout, 4> k_layouts{{
    {"cross", 4, 3, {{{2, 1}, {0, 1}, {1, 0}, {1, 2}, {1, 1}, {3, 1}}}, false},
    {"vertical-cross", 3, 4, {{{2, 1}, {0, 1}, {1, 0}, {1, 2}, {1, 1}, {1, 3}}}, true},
    {"strip", 6, 1, {{{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}, {5, 0}}}, false},
    {"vertical-strip", 1, 6, {{{0, 0}, {0, 1}, {0, 2}, {0, 3}, {0, 4}, {0, 5}}}, false},
}};

}  // namespace

std::vector<std::string> cube_layout_names() {
    std::vector<std::string> names;
    for (const CubeLayout& layout : k_layouts) names.emplace_back(layout.name);
    return names;
}

ImageF cube_layout(const Cubemap& cube, const std::string& layout) {
    const auto found =
        std::find_if(k_layouts.begin(), k_layouts.end(), [&](const CubeLayout& l) { return layout == l.name; });
    if (found == k_layouts.end()) return {};
    const int size = cube.size(), channels = cube.channels();
    ImageF picture(found->columns * size, found->rows * size, channels);
    for (int f = 0; f < 6; ++f) {
        const auto [column, row] = found->place[std::size_t(f)];
        const bool turned = f == 5 && found->last_upside_down;
        for (int y = 0; y < size; ++y) {
            const float* from = cube.face(f).row(turned ? size - 1 - y : y);
            float* to = picture.at(column * size, row * size + y);
            if (!turned)
                std::copy_n(from, size * channels, to);
            else
                for (int x = 0; x < size; ++x)
                    std::copy_n(from + (size - 1 - x) * channels, channels, to + x * channels);
        }
    }
    return picture;
}

}  // namespace domelight
