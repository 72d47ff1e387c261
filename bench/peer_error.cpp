// The error of a specular chain made by any tool, against the truth. Used by bench/peers.py.
//
//     peer_error SOURCE.hdr ROUGHNESS,ROUGHNESS,... CHAIN [TEXELS]
//
// CHAIN is a KTX2, KTX1 or DDS cube with levels, or a folder of faces m<level>_<px|nx|...>.exr as cmgen writes them.
// Tools differ in how they turn and mirror the light, so all 48 orientations that permute and mirror the axes are
// tried, and the best one is printed. Prints one JSON object: for each level the relative RMS error and the largest
// relative error as docs/math/prefilter.md defines them, over random texels.

#include "domelight/domelight.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>

using namespace domelight;

namespace {

[[noreturn]] void fail(const Error& error) {
    std::fprintf(stderr, "error: %s\n", error.format().c_str());
    std::exit(1);
}

template <typename T>
T take(Result<T> result) {
    if (!result) fail(result.error());
    return std::move(*result);
}

std::vector<Cubemap> read_chain(const std::filesystem::path& place, int levels) {
    std::vector<Cubemap> chain;
    if (!std::filesystem::is_directory(place)) {
        const Texture texture = take(read_texture(place));
        for (int l = 0; l < levels && l < int(texture.levels.size()); ++l) {
            Cubemap cube(texture.level_width(l));
            for (int f = 0; f < 6; ++f) {
                const ImageF face = decode_texture(texture, l, f);
                std::ranges::copy(face.pixels(), cube.face(f).data);
            }
            chain.push_back(std::move(cube));
        }
        return chain;
    }
    for (int l = 0; l < levels; ++l) {
        std::vector<std::filesystem::path> faces;
        for (const char* name : {"px", "nx", "py", "ny", "pz", "nz"}) {
            faces.push_back(place / fmt::format("m{}_{}.exr", l, name));
        }
        const Environment level = take(open_environment(faces));
        chain.push_back(*level.cube());
    }
    return chain;
}

/// The 48 matrices that permute axes and flip signs; the identity first.
std::vector<Mat3> orientations() {
    std::vector<Mat3> all;
    std::array<int, 3> axis{0, 1, 2};
    do {
        for (int signs = 0; signs < 8; ++signs) {
            Mat3 m;
            for (int i = 0; i < 3; ++i) {
                std::array<double, 3> row{};
                row[axis[i]] = signs >> i & 1 ? -1 : 1;
                m.row[i] = {row[0], row[1], row[2]};
            }
            all.push_back(m);
        }
    } while (std::ranges::next_permutation(axis).found);
    return all;
}

struct TexelGrid {
    std::vector<Vec3d> directions;  ///< world
    std::vector<double> weights;    ///< solid angles
    std::vector<Vec3d> values;
};

TexelGrid pick_texels(const Cubemap& cube, int count, unsigned seed) {
    std::mt19937 random(seed);
    const int size = cube.size();
    TexelGrid t;
    for (int i = 0; i < count; ++i) {
        const int f = int(random() % 6), x = int(random() % size), y = int(random() % size);
        t.directions.push_back(normalize(cube_direction(f, {(x + 0.5) / size, (y + 0.5) / size})));
        t.weights.push_back(cube_solid_angle(x, y, size));
        const float* p = cube.face(f).at(x, y);
        t.values.push_back({p[0], p[1], p[2]});
    }
    return t;
}

struct ErrorMeasure {
    double rms = 0, max = 0;
};

ErrorMeasure measure(const TexelGrid& t, const std::vector<Vec3d>& truth) {
    double squares = 0, total = 0, weight = 0;
    Vec3d mean;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        const Vec3d e = t.values[i] - truth[i];
        squares += t.weights[i] * dot(e, e);
        total += t.weights[i] * dot(truth[i], truth[i]);
        mean += truth[i] * t.weights[i];
        weight += t.weights[i];
    }
    mean = mean / weight;
    ErrorMeasure m{std::sqrt(squares / total), 0};
    for (std::size_t i = 0; i < truth.size(); ++i) {
        const Vec3d e = t.values[i] - truth[i];
        m.max = std::max({m.max, std::abs(e.x) / std::max(truth[i].x, 0.01 * mean.x),
                          std::abs(e.y) / std::max(truth[i].y, 0.01 * mean.y),
                          std::abs(e.z) / std::max(truth[i].z, 0.01 * mean.z)});
    }
    return m;
}

std::vector<Vec3d> truth_for(const ImageF& source, double roughness, const std::vector<Vec3d>& directions,
                             const Mat3& turn) {
    std::vector<Vec3d> turned;
    for (const Vec3d& d : directions) turned.push_back(turn * d);
    return convolve_exactly(source, ZonalKernel::ggx(roughness), turned);
}

/// The orientation of the chain relative to the source: the one in which its roughest level, which is smooth, agrees
/// best with ours.
Mat3 orientation_of(const Cubemap& roughest, const ImageF& source, double roughness) {
    FilterOptions options;
    options.specular.push_back({32, false, ZonalKernel::ggx(roughness)});
    ImageRowSource rows(source);
    const FilterResult ours = take(prefilter(rows, options));
    const FilteredMap& cube = ours.specular[0];
    const TexelGrid few = pick_texels(roughest, 200, 1);
    Mat3 best;
    double least = 1e30;
    for (const Mat3& m : orientations()) {
        std::vector<Vec3d> there;
        for (const Vec3d& d : few.directions) {
            const CubePoint p = cube_point(m * d);
            const float* value = cube.face(p.face).at(std::min(31, int(p.uv.u * 32)), std::min(31, int(p.uv.v * 32)));
            there.push_back({value[0], value[1], value[2]});
        }
        const double rms = measure(few, there).rms;
        if (rms < least) least = rms, best = m;
    }
    return best;
}

std::string matrix_name(const Mat3& m) {
    std::string name;
    for (const Vec3d& row : m.row) {
        const int axis = row.x != 0 ? 0 : row.y != 0 ? 1 : 2;
        name += row.x + row.y + row.z > 0 ? '+' : '-';
        name += "xyz"[axis];
    }
    return name;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 4) {
        std::fprintf(stderr, "usage: peer_error SOURCE ROUGHNESSES CHAIN [TEXELS]\n");
        return 2;
    }
    std::vector<double> roughness;
    std::istringstream numbers(argv[2]);
    for (std::string number; std::getline(numbers, number, ',');) roughness.push_back(std::atof(number.c_str()));
    const int texels = argc > 4 ? std::atoi(argv[4]) : 200;

    Environment environment = take(open_environment({argv[1]}));
    const ImageF source = take(read_latlong(**environment.rows()));
    const std::vector<Cubemap> chain = read_chain(argv[3], int(roughness.size()));

    const Mat3 turn = environment.world_to_source * orientation_of(chain.back(), source, roughness.back());
    nlohmann::ordered_json out{{"orientation", matrix_name(turn)}, {"levels", nlohmann::ordered_json::array()}};
    for (std::size_t l = 0; l < chain.size(); ++l) {
        if (roughness[l] <= 0) continue;  // a mirror level is not filtered
        const TexelGrid t = pick_texels(chain[l], texels, unsigned(l) + 2);
        const ErrorMeasure m = measure(t, truth_for(source, roughness[l], t.directions, turn));
        out["levels"].push_back({{"level", l}, {"roughness", roughness[l]}, {"rms", m.rms}, {"max", m.max}});
    }
    std::printf("%s\n", out.dump(1).c_str());
    return 0;
}
