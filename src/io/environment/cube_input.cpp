#include "io/environment/cube_input.h"

#include <algorithm>
#include <cassert>
#include <cctype>
#include <span>
#include <string>
#include <string_view>

namespace domelight {

namespace {

/// Where a face lies in a picture of columns x rows faces, and what turns it into OpenGL's orientation.
struct Tile {
    int face, column, row;
    bool mirror_x = false, mirror_y = false;  ///< both: turned by 180 degrees
};

struct Sheet {
    int columns, rows;
    std::array<Tile, 6> tiles;
};

Sheet sheet_of(CubeLayout layout) {
    switch (layout) {
        case CubeLayout::horizontal_cross:
            return {4, 3, {{{0, 2, 1}, {1, 0, 1}, {2, 1, 0}, {3, 1, 2}, {4, 1, 1}, {5, 3, 1}}}};
        case CubeLayout::vertical_cross:
            return {3, 4, {{{0, 2, 1}, {1, 0, 1}, {2, 1, 0}, {3, 1, 2}, {4, 1, 1}, {5, 1, 3, true, true}}}};
        case CubeLayout::horizontal_strip:
            return {6, 1, {{{0, 0, 0}, {1, 1, 0}, {2, 2, 0}, {3, 3, 0}, {4, 4, 0}, {5, 5, 0}}}};
        case CubeLayout::vertical_strip:
            return {1, 6, {{{0, 0, 0}, {1, 0, 1}, {2, 0, 2}, {3, 0, 3}, {4, 0, 4}, {5, 0, 5}}}};
        case CubeLayout::openexr_strip:
            break;
    }
    return {1,
            6,
            {{{0, 0, 0, true, false},
              {1, 0, 1, true, false},
              {2, 0, 2, false, true},
              {3, 0, 3, false, true},
              {4, 0, 4, true, false},
              {5, 0, 5, true, false}}}};
}

/// Copies row `y` of a tile, whose texels start at `from`, to its place in the face.
void place_row(const Tile& tile, int y, const float* from, ImageView<float> face) {
    const int n = face.width;
    float* to = face.row(tile.mirror_y ? n - 1 - y : y);
    for (int x = 0; x < n; ++x) std::copy_n(from + 3 * (tile.mirror_x ? n - 1 - x : x), 3, to + 3 * x);
}

/// A face whose samples run from edge to edge, at texel centres: bilinear at (i + 1/2) (n - 1) / n.
void move_to_texel_centres(ImageView<float> face) {
    const int n = face.width;
    const auto mix = [](double a, double b, double s) { return a + s * (b - a); };
    ImageF source(n, n, 3);
    for (int y = 0; y < n; ++y) std::copy_n(face.row(y), 3 * n, source.row(y));
    for (int y = 0; y < n; ++y) {
        const double py = (y + 0.5) * (n - 1) / n;
        const int y0 = int(py), y1 = std::min(y0 + 1, n - 1);
        for (int x = 0; x < n; ++x) {
            const double px = (x + 0.5) * (n - 1) / n;
            const int x0 = int(px), x1 = std::min(x0 + 1, n - 1);
            for (int c = 0; c < 3; ++c)
                face.at(x, y)[c] = float(mix(mix(source.at(x0, y0)[c], source.at(x1, y0)[c], px - x0),
                                             mix(source.at(x0, y1)[c], source.at(x1, y1)[c], px - x0), py - y0));
        }
    }
}

/// The names of the faces +X -X +Y -Y +Z -Z. The first is the axis.
const std::vector<std::string_view> k_face_names[6] = {
    {"+x", "px", "posx", "right"},     {"-x", "nx", "mx", "negx", "left"},
    {"+y", "py", "posy", "top", "up"}, {"-y", "ny", "my", "negy", "bottom", "down"},
    {"+z", "pz", "posz", "front"},     {"-z", "nz", "mz", "negz", "back"},
};

bool is_word(char c) {
    return std::isalnum(static_cast<unsigned char>(c));
}

/// Whether `name` is the end of `stem`, set off from what stands before it.
bool ends_in(std::string_view stem, std::string_view name) {
    if (!stem.ends_with(name)) return false;
    return stem.size() == name.size() || !is_word(name[0]) || !is_word(stem[stem.size() - name.size() - 1]);
}

/// Whether `name` is the start of `stem`, set off from what follows.
bool begins_with(std::string_view stem, std::string_view name) {
    return stem.starts_with(name) && (stem.size() == name.size() || !is_word(stem[name.size()]));
}

}  // namespace

std::optional<CubeLayout> cube_layout_of_shape(int width, int height) {
    for (const CubeLayout layout : {CubeLayout::horizontal_cross, CubeLayout::vertical_cross,
                                    CubeLayout::horizontal_strip, CubeLayout::vertical_strip}) {
        const Sheet sheet = sheet_of(layout);
        if (width % sheet.columns == 0 && height % sheet.rows == 0 && width / sheet.columns == height / sheet.rows)
            return layout;
    }
    return std::nullopt;
}

Result<Cubemap> read_cube_picture(RowSource& source, CubeLayout layout) {
    const Sheet sheet = sheet_of(layout);
    const int n = source.width() / sheet.columns;
    assert(source.width() == n * sheet.columns && source.height() == n * sheet.rows);
    Cubemap cube(n);
    ImageF band(source.width(), std::min(64, n), 3);
    for (int top = 0; top < source.height();) {
        const int count = std::min(band.height(), source.height() - top);
        if (const auto read = source.read(band.view().rows(0, count)); !read) return read.error();
        for (int y = 0; y < count; ++y, ++top)
            for (const Tile& tile : sheet.tiles)
                if (tile.row == top / n) place_row(tile, top % n, band.at(tile.column * n, y), cube.face(tile.face));
    }
    if (layout == CubeLayout::openexr_strip)
        for (int f = 0; f < 6; ++f) move_to_texel_centres(cube.face(f));
    return cube;
}

std::optional<int> cube_face_of_name(const std::filesystem::path& file) {
    std::string stem = file.stem().string();
    std::transform(stem.begin(), stem.end(), stem.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    // The end of a name says more than its start: "front_left.hdr" is a face of the cube "front".
    for (const auto speaks_of : {ends_in, begins_with})
        for (int f = 0; f < 6; ++f)
            for (const std::string_view name : k_face_names[f])
                if (speaks_of(stem, name)) return f;
    return std::nullopt;
}

Result<std::array<std::filesystem::path, 6>> cube_faces_by_name(const std::vector<std::filesystem::path>& files) {
    const std::string hint =
        "Accepted: px nx py ny pz nz, px mx ..., posx negx ..., +x -x ..., or right left top bottom (or up down) "
        "front back, alone or after a prefix (sky_px.hdr).";
    std::array<std::filesystem::path, 6> faces;
    for (const std::filesystem::path& file : files) {
        const std::optional<int> f = cube_face_of_name(file);
        if (!f) return Error{"the name does not say which face of a cube it is", file.string(), hint};
        std::filesystem::path& face = faces[std::size_t(*f)];
        if (!face.empty()) return Error{"is the same face of the cube as " + face.string(), file.string(), hint};
        face = file;
    }
    for (int f = 0; f < 6; ++f)
        if (faces[std::size_t(f)].empty())
            return Error{"face " + std::string(k_face_names[f][0]) + " of the cube is missing",
                         files.empty() ? "" : files[0].string(), hint};
    return faces;
}

std::vector<std::filesystem::path> cube_faces_in_folder(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> found;
    std::error_code error;
    for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
        if (entry->is_regular_file(error) && cube_face_of_name(entry->path())) found.push_back(entry->path());
    std::sort(found.begin(), found.end());
    return found;
}

}  // namespace domelight
