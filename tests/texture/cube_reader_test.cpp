#include "domelight/io/environment/open_environment.h"
#include "domelight/projection/projection.h"
#include "domelight/texture/texture.h"

#include "io/environment/cube_face_names.h"
#include "io/environment/cube_input.h"
#include "io/reader_samples.h"
#include "test.h"

#include <array>
#include <cmath>
#include <functional>

using namespace domelight;
using namespace domelight::test;

namespace {

constexpr int k_size = 8;

/// A smooth function of direction, with a different value in every direction.
void colour_of(const Vec3d& direction, float* rgb) {
    const Vec3d d = normalize(direction);
    rgb[0] = float(2 + d.x), rgb[1] = float(2 + d.y), rgb[2] = float(2 + d.z);
}

/// A picture as a Radiance file; eight bits of mantissa.
Bytes as_hdr(const ImageF& image) {
    Bytes file = hdr_header("-Y " + std::to_string(image.height()) + " +X " + std::to_string(image.width()));
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            for (int c = 0; c < 3; ++c) file.push_back(std::uint8_t(image.at(x, y)[c] * 64));  // values up to 3.98
            file.push_back(130);
        }
    return file;
}

/// The largest difference between a cube and colour_of at the centres of its texels.
double error_of(const Cubemap& cube) {
    double largest = 0;
    for (int f = 0; f < 6; ++f)
        for (int y = 0; y < cube.size(); ++y)
            for (int x = 0; x < cube.size(); ++x) {
                float expected[3];
                colour_of(cube_direction(f, {(x + 0.5) / cube.size(), (y + 0.5) / cube.size()}), expected);
                for (int c = 0; c < 3; ++c)
                    largest = std::max(largest, double(std::abs(cube.face(f).at(x, y)[c] - expected[c])));
            }
    return largest;
}

ImageF face_picture(int f) {
    ImageF image(k_size, k_size, 3);
    for (int y = 0; y < k_size; ++y)
        for (int x = 0; x < k_size; ++x)
            colour_of(cube_direction(f, {(x + 0.5) / k_size, (y + 0.5) / k_size}), image.at(x, y));
    return image;
}

/// A picture of columns x rows faces. `direction(column, row, s, t)` with s, t in (-1, 1) to the right and down, or
/// nothing.
template <typename Direction>
ImageF picture(int columns, int rows, const Direction& direction) {
    ImageF image(columns * k_size, rows * k_size, 3, 0.5f);
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            const double s = 2 * (x % k_size + 0.5) / k_size - 1, t = 2 * (y % k_size + 0.5) / k_size - 1;
            const std::optional<Vec3d> d = direction(x / k_size, y / k_size, s, t);
            if (d) colour_of(*d, image.at(x, y));
        }
    return image;
}

constexpr double k_rgbe_step = 1.0 / 64;  // mantissas are cut off, not rounded

}  // namespace

TEST_CASE("cube reader: crosses are unfolded so that the picture continues across every joint") {
    TemporaryFolder folder;
    // The faces follow from geometry alone: to the right of +Z are +X, −Z and −X in turn; above +Z is +Y, below it −Y
    // and then −Z.
    const auto cross = [](bool vertical) {
        return [vertical](int column, int row, double s, double t) -> std::optional<Vec3d> {
            if (row == 1 && column == 0) return Vec3d{-1, -t, s};
            if (row == 1 && column == 1) return Vec3d{s, -t, 1};
            if (row == 1 && column == 2) return Vec3d{1, -t, -s};
            if (row == 1 && column == 3) return Vec3d{-s, -t, -1};
            if (row == 0 && column == 1) return Vec3d{s, 1, t};
            if (row == 2 && column == 1) return Vec3d{s, -1, -t};
            if (vertical && row == 3 && column == 1) return Vec3d{s, t, -1};
            return std::nullopt;
        };
    };
    save(folder / "h.hdr", as_hdr(picture(4, 3, cross(false))));
    save(folder / "v.hdr", as_hdr(picture(3, 4, cross(true))));
    for (const char* name : {"h.hdr", "v.hdr"})
        for (const char* projection : {"auto", "cube-cross"}) {
            const auto environment = open_environment({folder / name}, {.projection = projection});
            REQUIRE_MESSAGE(environment, environment.error().format());
            CHECK(environment->projection == "cube");
            REQUIRE(environment->cube()->size() == k_size);
            CHECK(error_of(*environment->cube()) <= k_rgbe_step);
        }
}

TEST_CASE("cube reader: strips hold the faces in order, each in OpenGL's orientation") {
    TemporaryFolder folder;
    save(folder / "h.hdr", as_hdr(picture(6, 1, [](int column, int, double s, double t) {
             return std::optional(cube_direction(column, {0.5 * (s + 1), 0.5 * (t + 1)}));
         })));
    save(folder / "v.hdr", as_hdr(picture(1, 6, [](int, int row, double s, double t) {
             return std::optional(cube_direction(row, {0.5 * (s + 1), 0.5 * (t + 1)}));
         })));
    for (const char* name : {"h.hdr", "v.hdr"})
        for (const char* projection : {"auto", "cube-strip"}) {
            const auto environment = open_environment({folder / name}, {.projection = projection});
            REQUIRE_MESSAGE(environment, environment.error().format());
            CHECK(error_of(*environment->cube()) <= k_rgbe_step);
        }
}

TEST_CASE("cube reader: six files are recognised by name, in any order and case") {
    const std::vector<std::vector<std::string>> namings{
        {"px", "nx", "py", "ny", "pz", "nz"},
        {"sky_posx", "sky_negx", "sky_posy", "sky_negy", "sky_posz", "sky_negz"},
        {"Right", "LEFT", "top", "bottom", "front", "back"},
        {"px-studio", "nx-studio", "py-studio", "ny-studio", "pz-studio", "nz-studio"},
        {"studio.px", "studio.nx", "studio.py", "studio.ny", "studio.pz", "studio.nz"},
        {"box+x", "box-x", "box+y", "box-y", "box+z", "box-z"},
        {"sky_+X", "sky_-X", "sky_+Y", "sky_-Y", "sky_+Z", "sky_-Z"},
        {"sky_px", "sky_mx", "sky_py", "sky_my", "sky_pz", "sky_mz"},
        {"sky_right", "sky_left", "sky_up", "sky_down", "sky_front", "sky_back"},
        {"px_sky", "nx_sky", "py_sky", "ny_sky", "pz_sky", "nz_sky"},
        {"front_right", "front_left", "front_top", "front_bottom", "front_front", "front_back"},
        {"sky_rt", "sky_lf", "sky_up", "sky_dn", "sky_ft", "sky_bk"},
        {"desertrt", "desertlf", "desertup", "desertdn", "desertft", "desertbk"},
        {"sky_r", "sky_l", "sky_u", "sky_d", "sky_f", "sky_b"},
        {"sky_0", "sky_1", "sky_2", "sky_3", "sky_4", "sky_5"},
        {"sky0", "sky1", "sky2", "sky3", "sky4", "sky5"},
        {"front_0", "front_1", "front_2", "front_3", "front_4", "front_5"},
        {"sky_px_1k", "sky_nx_1k", "sky_py_1k", "sky_ny_1k", "sky_pz_1k", "sky_nz_1k"},
        {"px_back", "nx_back", "py_back", "ny_back", "pz_back", "nz_back"},
    };
    for (const auto& names : namings) {
        TemporaryFolder folder;
        std::vector<std::filesystem::path> files;
        for (int f = 0; f < 6; ++f) {
            files.push_back(folder / (names[std::size_t(f)] + ".hdr"));
            save(files.back(), as_hdr(face_picture(f)));
        }
        std::swap(files[0], files[4]);
        std::swap(files[1], files[2]);
        for (const auto& input : {files, {folder.path()}}) {
            const auto environment = open_environment(input);
            REQUIRE_MESSAGE(environment, environment.error().format());
            CHECK(error_of(*environment->cube()) <= k_rgbe_step);
        }
        const auto five = open_environment({files[0], files[1], files[2], files[3], files[4], files[4]});
        REQUIRE_FALSE(five);
        CHECK(five.error().what.find("same face") != std::string::npos);
    }
    CHECK(!cube_face_of_name("expx.hdr"));
    CHECK(!cube_face_of_name("topaz.hdr"));
    CHECK(!cube_face_of_name("bright.hdr"));
}

TEST_CASE(
    "cube reader: six files are a cube only where they are named as faces, and square where the names are words") {
    TemporaryFolder folder;
    std::vector<std::filesystem::path> files, axes;
    for (int f = 0; f < 6; ++f) {
        files.push_back(folder / ("day_" + std::to_string(f) + ".hdr"));
        save(files.back(), as_hdr(ImageF(16, 8, 3, 1.0f)));
        axes.push_back(folder / (std::string(f % 2 ? "n" : "p") + "xyz"[f / 2] + ".hdr"));
    }
    CHECK_FALSE(are_cube_faces(files));  // six skies, one after the other
    for (const auto& file : files) save(file, as_hdr(ImageF(8, 8, 3, 1.0f)));
    CHECK(are_cube_faces(files));
    CHECK(are_cube_faces(axes));
    CHECK_FALSE(are_cube_faces({files[0], files[1]}));
    CHECK_FALSE(are_cube_faces({files[0], files[1], files[2], files[3], files[4], folder / "day_7.hdr"}));
}

TEST_CASE("cube reader: the order of files without names of faces is as one says") {
    TemporaryFolder folder;
    std::vector<std::filesystem::path> files;
    for (const int f : {4, 1, 0, 5, 3, 2}) {
        files.push_back(folder / ("image" + std::string(1, char('p' + f)) + "a.hdr"));
        save(files.back(), as_hdr(face_picture(f)));
    }
    CHECK_FALSE(open_environment(files));
    for (const char* order : {"front left right back bottom top", "pz,nx,px,nz,ny,py", "4, 1, 0, 5, 3, 2"}) {
        const auto environment = open_environment(files, {.faces = order});
        REQUIRE_MESSAGE(environment, environment.error().format());
        CHECK(error_of(*environment->cube()) <= k_rgbe_step);
        CHECK(environment->files[0] == files[2]);
    }
    for (const char* order :
         {"front left right back bottom", "front left right back bottom front", "pz nx px nz ny up2"}) {
        const auto refused = open_environment(files, {.faces = order});
        REQUIRE_FALSE(refused);
        CHECK(refused.error().where == "`faces`");
    }
    // The pictures of a strip likewise.
    const int order[] = {4, 1, 0, 5, 3, 2};
    save(folder / "strip.hdr", as_hdr(picture(6, 1, [&](int column, int, double s, double t) {
             return std::optional(cube_direction(order[column], {(s + 1) / 2, (t + 1) / 2}));
         })));
    const auto strip = open_environment({folder / "strip.hdr"}, {.faces = "front left right back bottom top"});
    REQUIRE_MESSAGE(strip, strip.error().format());
    CHECK(error_of(*strip->cube()) <= k_rgbe_step);
    save(folder / "cross.hdr", as_hdr(ImageF(32, 24, 3, 1.0f)));
    CHECK_FALSE(open_environment({folder / "cross.hdr"}, {.faces = "px nx py ny pz nz"}));
    save(folder / "map.hdr", as_hdr(ImageF(16, 8, 3, 1.0f)));
    CHECK_FALSE(open_environment({folder / "map.hdr"}, {.faces = "px nx py ny pz nz"}));
    CHECK_FALSE(open_environment({folder / "map.hdr"}, {.face_orientation = FaceOrientation::directx}));
}

namespace {

/// The six files px.hdr ... (or names of the caller) of a cube of which `place` says where a texel of face f goes.
std::vector<std::filesystem::path> write_faces(const TemporaryFolder& folder, const std::array<const char*, 6>& names,
                                               const std::function<Vec3d(int f, double u, double v)>& direction) {
    std::vector<std::filesystem::path> files;
    for (int f = 0; f < 6; ++f) {
        ImageF image(k_size, k_size, 3);
        for (int y = 0; y < k_size; ++y)
            for (int x = 0; x < k_size; ++x) colour_of(direction(f, x, y), image.at(x, y));
        files.push_back(folder / (std::string(names[std::size_t(f)]) + ".hdr"));
        save(files.back(), as_hdr(image));
    }
    return files;
}

constexpr std::array<const char*, 6> k_axis_names{"px", "nx", "py", "ny", "pz", "nz"};
constexpr std::array<const char*, 6> k_word_names{"right", "left", "top", "bottom", "front", "back"};

bool warns_of(const Environment& environment, const std::string& text) {
    for (const std::string& warning : environment.report().warnings)
        if (warning.find(text) != std::string::npos) return true;
    return false;
}

/// The largest difference between an environment and colour_of, in directions to the centres of a cube's texels.
double error_in_directions(const Environment& environment) {
    double largest = 0;
    for (int f = 0; f < 6; ++f)
        for (const double u : {0.25, 0.5, 0.625})
            for (const double v : {0.3125, 0.5, 0.75}) {
                const Vec3d d = cube_direction(f, {u, v});
                float expected[3];
                colour_of(d, expected);
                const Vec3f is = *environment.radiance(d);
                for (const double e : {is.x - expected[0], is.y - expected[1], is.z - expected[2]})
                    largest = std::max(largest, std::abs(double(e)));
            }
    return largest;
}

}  // namespace

TEST_CASE("cube reader: faces in Direct3D's world are those that a viewer sees around him, and front is ahead") {
    TemporaryFolder folder;
    // What a viewer who looks along -Z, with +X to the right and +Y up, sees in each face as it hangs there upright.
    const auto seen = [](int f, double x, double y) -> Vec3d {
        const double s = 2 * (x + 0.5) / k_size - 1, t = 2 * (y + 0.5) / k_size - 1;
        switch (f) {
            case 0:
                return {1, -t, s};  // right: behind is further to the right
            case 1:
                return {-1, -t, -s};
            case 2:
                return {s, 1, -t};  // above: what is ahead is at the bottom
            case 3:
                return {s, -1, t};
            case 4:
                return {s, -t, -1};  // ahead
            default:
                return {-s, -t, 1};
        }
    };
    const auto files = write_faces(folder, k_word_names, seen);
    const auto environment = open_environment(files, {.face_orientation = FaceOrientation::directx});
    REQUIRE_MESSAGE(environment, environment.error().format());
    CHECK(error_in_directions(*environment) < 0.05);
    CHECK_FALSE(warns_of(*environment, "convention"));
    const auto assumed = open_environment(files);
    REQUIRE(assumed);
    CHECK(warns_of(*assumed, "front +Z"));
    CHECK(error_in_directions(*assumed) > 0.5);
}

TEST_CASE("cube reader: six faces as exrenvmap writes them are recognised by their edges, and read as asked") {
    TemporaryFolder folder;
    // ImfEnvmap.h: samples from edge to edge, each face the mirror image of OpenGL's.
    const auto openexr = [](int f, double x, double y) {
        const double u = x / (k_size - 1), v = y / (k_size - 1);
        const bool vertical = f == 2 || f == 3;
        return cube_direction(f, {vertical ? u : 1 - u, vertical ? 1 - v : v});
    };
    const auto files = write_faces(folder, k_axis_names, openexr);
    const auto found = open_environment(files);
    REQUIRE_MESSAGE(found, found.error().format());
    CHECK(error_in_directions(*found) < 0.05);
    CHECK(warns_of(*found, "exrenvmap"));
    for (const EnvironmentOptions& options :
         {EnvironmentOptions{.face_orientation = FaceOrientation::openexr}, {.projection = "cube/openexr"}}) {
        const auto asked = open_environment(files, options);
        REQUIRE_MESSAGE(asked, asked.error().format());
        CHECK(error_in_directions(*asked) < 0.05);
        CHECK(asked->report().warnings.empty());
    }
    const auto other = open_environment(files, {.face_orientation = FaceOrientation::opengl});
    REQUIRE(other);
    CHECK(error_in_directions(*other) > 0.5);
    const auto contradiction =
        open_environment(files, {.projection = "cube/openexr", .face_orientation = FaceOrientation::opengl});
    REQUIRE_FALSE(contradiction);
    CHECK(contradiction.error().where == "`face_orientation`");
    // Faces in OpenGL's orientation, and faces of one colour, are not taken for them.
    const auto opengl = [](int f, double x, double y) {
        return cube_direction(f, {(x + 0.5) / k_size, (y + 0.5) / k_size});
    };
    const auto usual = open_environment(write_faces(folder, k_axis_names, opengl));
    REQUIRE(usual);
    CHECK(usual->report().warnings.empty());
    const auto plain = open_environment(write_faces(folder, k_axis_names, [](int, double, double) {
        return Vec3d{1, 0, 0};
    }));
    REQUIRE(plain);
    CHECK(plain->report().warnings.empty());
}

TEST_CASE("cube reader: the six files of exrenvmap hold the light of its single file") {
    DOMELIGHT_DATA_FILE(six, "reports/exrenvmap_faces");
    DOMELIGHT_DATA_FILE(single, "reports/exrenvmap_single.exr");
    const auto faces = open_environment({six});
    const auto strip = open_environment({single});
    REQUIRE_MESSAGE(faces, faces.error().format());
    REQUIRE_MESSAGE(strip, strip.error().format());
    double largest = 0;
    for (std::size_t i = 0; i < strip->cube()->pixels().size(); ++i)
        largest = std::max(largest, double(std::abs(strip->cube()->pixels()[i] - faces->cube()->pixels()[i])));
    CHECK(largest == 0);  // mirrored faces differ by up to 0.7
}

TEST_CASE("cube reader: the faces that other tools write are recognised") {
    DOMELIGHT_DATA_FILE(plus, "reports/faces_plus");
    DOMELIGHT_DATA_FILE(minus, "reports/faces_mx");
    DOMELIGHT_DATA_FILE(words, "reports/faces_updown");
    DOMELIGHT_DATA_FILE(exrenvmap, "reports/exrenvmap_faces");
    for (const auto& folder : {plus, minus, words, exrenvmap}) {
        const auto environment = open_environment({folder});
        REQUIRE_MESSAGE(environment, environment.error().format());
        CHECK(environment->projection == "cube");
    }
}

TEST_CASE("cube reader: faces that do not fit together are refused by name") {
    TemporaryFolder folder;
    std::vector<std::filesystem::path> files;
    for (const char* name : {"px", "nx", "py", "ny", "pz", "nz"}) {
        files.push_back(folder / (std::string(name) + ".hdr"));
        save(files.back(), as_hdr(face_picture(0)));
    }
    save(files[3], as_hdr(ImageF(4, 4, 3, 1.0f)));
    const auto smaller = open_environment(files);
    REQUIRE_FALSE(smaller);
    CHECK(smaller.error().where == files[3].string());
    save(files[3], as_hdr(ImageF(8, 4, 3, 1.0f)));
    CHECK_FALSE(open_environment(files));
    CHECK_FALSE(open_environment({files[0]}));
    CHECK_FALSE(open_environment({files[0], files[1]}));
    CHECK_FALSE(open_environment({files[0], files[1], files[2], files[3], files[4], folder / "other.hdr"}));
}

TEST_CASE("cube reader: a cube texture of ours is read back as the environment it holds") {
    TemporaryFolder folder;
    std::vector<FilteredMap> levels(1);
    levels[0] = Cubemap(k_size);
    for (int f = 0; f < 6; ++f) {
        const ImageF face = face_picture(f);
        for (int y = 0; y < k_size; ++y) std::copy_n(face.row(y), 3 * k_size, levels[0].face(f).row(y));
    }
    const Texture texture = encode_texture(levels, Encoding::rgba32f, 1);
    REQUIRE(write_ktx2(folder / "c.ktx2", texture));
    REQUIRE(write_ktx1(folder / "c.ktx", texture));
    REQUIRE(write_dds(folder / "c.dds", texture));
    for (const char* name : {"c.ktx2", "c.ktx", "c.dds"}) {
        const auto environment = open_environment({folder / name}, {.exposure = 0});
        REQUIRE_MESSAGE(environment, environment.error().format());
        CHECK(environment->projection == "cube");
        CHECK(error_of(*environment->cube()) == 0);
        CHECK_FALSE(open_environment({folder / name}, {.max_bytes = 1000}));
    }
    Bytes cut = load(folder / "c.dds");
    cut.resize(cut.size() / 2);
    save(folder / "cut.dds", cut);
    const auto refused = open_environment({folder / "cut.dds"});
    REQUIRE_FALSE(refused);
    CHECK(refused.error().where == (folder / "cut.dds").string());
}
