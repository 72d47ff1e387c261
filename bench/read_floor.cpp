// How near to the truth a level can be as it is read: the smallest error that any texels have under a seamless bilinear
// lookup, beside that of our texels, of texels that hold the light of their centres, and of another tool's.
//
//     read_floor [--size N] [--levels N] [--theirs FOLDER] PHOTOGRAPH...
//
// The chain is three.js': roughness 1 - sqrt(1 - l / (levels - 1)), in half floats. FOLDER has another tool's chain of
// each photograph, PHOTOGRAPH.dds (bench/three_pmrem.mjs makes three.js' own), which may have other levels. Prints, for
// each of our levels up to 128^2, the relative RMS error over the sphere at its own roughness; and for the whole chain that of random
// roughnesses, between levels too (docs/math/prefilter.md, "Between texels and between levels").
#include "domelight/compare/read_error.h"
#include "domelight/io/environment/open_environment.h"
#include "domelight/projection/projection.h"
#include "domelight/texture/texture.h"

#include "projection/bilinear.h"
#include "projection/cube_solid_angles.h"
#include "texture/texel/half.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>

using namespace domelight;

namespace {

template <typename T>
T take(Result<T> result) {
    if (!result) {
        fmt::print(stderr, "error: {}\n", result.error().format());
        std::exit(1);
    }
    return std::move(*result);
}

using Values = std::vector<Vec3d>;

/// Larger levels are left out: their least squares take a gigabyte.
constexpr int k_most_solved = 128;

/// The lookup of the centres of a fine cube's texels in a cube of `size`^2 texels, as a sparse matrix R.
class Lookup {
  public:
    Lookup(int size, int fine) : size_(size), fine_(fine) {
        for (int k = 0; k < 6 * fine * fine; ++k) {
            const int face = k / (fine * fine), y = k / fine % fine, x = k % fine;
            rows_.push_back(row(Vec3f(cube_direction(face, {(x + 0.5) / fine, (y + 0.5) / fine}))));
        }
        const std::vector<double> face = cube_solid_angles(fine, 0);
        for (int f = 0; f < 6; ++f) angles_.insert(angles_.end(), face.begin(), face.end());
    }

    std::size_t texels() const { return std::size_t(6) * size_ * size_; }
    double angle(std::size_t sample) const { return angles_[sample]; }

    Values read(const Values& texels) const {
        Values out(rows_.size());
        for (std::size_t k = 0; k < rows_.size(); ++k)
            for (const Entry& e : rows_[k]) out[k] += texels[std::size_t(e.texel)] * e.weight;
        return out;
    }
    /// R^T of the samples times their solid angles.
    Values gather(const Values& samples) const {
        Values out(texels());
        for (std::size_t k = 0; k < rows_.size(); ++k)
            for (const Entry& e : rows_[k]) out[std::size_t(e.texel)] += samples[k] * (e.weight * angles_[k]);
        return out;
    }

  private:
    struct Entry {
        int texel = 0;
        double weight = 0;
    };

    std::array<Entry, 6> row(const Vec3f& direction) const {
        const CubeTap tap = cube_tap(size_, direction);
        std::array<Entry, 6> entries;
        int count = 0;
        const auto outside = [&](int i) { return i < 0 || i == size_; };
        const auto add = [&](int x, int y, double weight) {
            entries[std::size_t(count++)] = {texel_or_across(size_, tap.face, x, y), weight};
        };
        for (int down = 0; down < 2; ++down)
            for (int right = 0; right < 2; ++right) {
                const int x = tap.column + right, y = tap.row + down;
                const double weight = (right ? tap.s : 1 - tap.s) * (down ? tap.t : 1 - tap.t);
                if (!outside(x) || !outside(y)) {
                    add(x, y, weight);
                    continue;
                }
                // Where three faces meet: the mean of their texels.
                const int inner_x = std::clamp(x, 0, size_ - 1), inner_y = std::clamp(y, 0, size_ - 1);
                add(inner_x, inner_y, weight / 3);
                add(x, inner_y, weight / 3);
                add(inner_x, y, weight / 3);
            }
        return entries;
    }

    int size_, fine_;
    std::vector<std::array<Entry, 6>> rows_;
    std::vector<double> angles_;
};

double product(const Values& a, const Values& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += dot(a[i], b[i]);
    return sum;
}

/// The texels whose lookups are nearest to `light`: R^T w R x = R^T w f, solved to rounding by conjugate gradients. The
/// three channels are one system, block by block the same.
Values nearest_texels(const Lookup& lookup, const Values& light) {
    Values x(lookup.texels()), residual = lookup.gather(light), step = residual;
    const double start = product(residual, residual);
    double size = start;
    for (int k = 0; k < 400 && size > 1e-26 * start; ++k) {
        const Values image = lookup.gather(lookup.read(step));
        const double length = size / product(step, image);
        for (std::size_t i = 0; i < x.size(); ++i) x[i] += step[i] * length;
        for (std::size_t i = 0; i < x.size(); ++i) residual[i] -= image[i] * length;
        const double next = product(residual, residual);
        for (std::size_t i = 0; i < x.size(); ++i) step[i] = residual[i] + step[i] * (next / size);
        size = next;
    }
    if (size > 1e-20 * start) fmt::print(stderr, "warning: the least squares have not converged\n");
    return x;
}

Values values_of(const Cubemap& cube) {
    Values out;
    for (std::size_t k = 0; k < cube.pixels().size(); k += 3)
        out.push_back({cube.pixels()[k], cube.pixels()[k + 1], cube.pixels()[k + 2]});
    return out;
}

double error_of(const Lookup& lookup, const Values& read, const Values& light) {
    double off = 0, all = 0;
    for (std::size_t k = 0; k < read.size(); ++k) {
        const Vec3d d = read[k] - light[k];
        off += lookup.angle(k) * dot(d, d);
        all += lookup.angle(k) * dot(light[k], light[k]);
    }
    return std::sqrt(off / all);
}

Cubemap in_halves(Cubemap cube) {
    for (float& value : cube.pixels()) value = float_from_half(half_from_float(value));
    return cube;
}

/// The levels after the first at these sizes, filtered by us.
std::vector<FilteredMap> filtered(const Environment& environment, std::vector<LevelSpec> levels, Texels texels) {
    FilterOptions options;
    options.specular = std::move(levels);
    options.texels = texels;
    options.sh_bands = 0;
    auto maps = take(prefilter(environment, options)).specular;
    return maps;
}

std::vector<FilteredMap> their_levels(const std::filesystem::path& file) {
    const Texture texture = take(read_texture(file));
    std::vector<FilteredMap> levels;
    for (int l = 0; l < int(texture.levels.size()); ++l) {
        Cubemap cube(texture.level_width(l));
        for (int f = 0; f < 6; ++f) {
            const ImageF face = decode_texture(texture, l, f);
            std::copy(face.pixels().begin(), face.pixels().end(), cube.face(f).data);
        }
        levels.emplace_back(std::move(cube));
    }
    return levels;
}

struct Chains {
    std::vector<double> roughness;
    std::vector<FilteredMap> ours, centre, theirs;
};

double roughness_of(int level, int levels) {
    return 1 - std::sqrt(1 - double(level) / (levels - 1));
}

double as_read(const std::vector<FilteredMap>& levels, const Environment& environment) {
    ReadChain chain;
    chain.levels = levels;
    const int count = int(levels.size());
    for (int l = 0; l < count; ++l) chain.roughness.push_back(roughness_of(l, count));
    chain.level_of = [count](double r) { return (count - 1) * r * (2 - r); };
    return take(measure_as_read(chain, environment)).relative_rmse;
}

/// What the shader reads of a chain at a roughness, between two levels where none has it.
Values read_chain(const std::vector<FilteredMap>& chain, double roughness, int fine) {
    const double last = double(chain.size()) - 1, at = last * roughness * (2 - roughness);
    const std::size_t below = std::min(std::size_t(at + 1e-9), chain.size() - 1);
    const double t = std::max(0.0, at - double(below));
    const auto level = [&](std::size_t l) { return Lookup(chain[l].width(), fine).read(values_of(chain[l].cube())); };
    Values read = level(below);
    if (t < 1e-6) return read;
    const Values next = level(below + 1);
    for (std::size_t k = 0; k < read.size(); ++k) read[k] = read[k] * (1 - t) + next[k] * t;
    return read;
}

void print_level(int size, double roughness, const Environment& environment, const FilteredMap& our_level,
                 const FilteredMap& centre, const std::vector<FilteredMap>& theirs) {
    const int fine = std::max(256, 4 * size);
    const Lookup lookup(size, fine);
    const Values light =
        values_of(filtered(environment, {{fine, false, ZonalKernel::ggx(roughness)}}, Texels::centre)[0].cube());
    const auto error = [&](const Values& texels) { return error_of(lookup, lookup.read(texels), light); };
    const double least = error(nearest_texels(lookup, light)), ours = error(values_of(our_level.cube()));
    fmt::print("  {:>5.3f} {:>5} {:>9.2e} {:>9.2e} {:>6.3f} {:>9.2e}", roughness, size, least, ours, ours / least,
               error(values_of(centre.cube())));
    if (!theirs.empty()) {
        const double other = error_of(lookup, read_chain(theirs, roughness, fine), light);
        fmt::print(" {:>9.2e} {:>7.1f} {:>9.1f}", other, other / ours, other / least);
    }
    fmt::print("\n");
}

void measure(const std::filesystem::path& photograph, int size, int count, const std::filesystem::path& folder) {
    const Environment environment = take(open_environment({photograph}));
    std::vector<LevelSpec> specs{{size, true, {}}};
    for (int l = 1; l < count; ++l) specs.push_back({size >> l, false, ZonalKernel::ggx(roughness_of(l, count))});
    auto ours = filtered(environment, specs, Texels::read), centre = filtered(environment, specs, Texels::centre);
    for (auto* chain : {&ours, &centre})
        for (FilteredMap& map : *chain) map = FilteredMap(in_halves(map.cube()));
    std::vector<FilteredMap> theirs;
    if (!folder.empty()) theirs = their_levels(folder / photograph.stem().concat(".dds"));
    fmt::print("{}\n  rough  size     least      ours  ratio    centre    theirs  /ours    /least\n",
               photograph.stem().string());
    for (int l = 1; l < count; ++l)
        if (size >> l <= k_most_solved)
            print_level(size >> l, roughness_of(l, count), environment, ours[std::size_t(l)], centre[std::size_t(l)],
                        theirs);
    fmt::print("  roughness 0.1 to 1, between levels too: ours {:.4f}", as_read(ours, environment));
    if (!theirs.empty()) fmt::print(", theirs {:.4f}", as_read(theirs, environment));
    fmt::print("\n");
    std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
    int size = 256, levels = 6;
    std::filesystem::path theirs;
    for (int i = 1; i < argc; ++i) {
        const auto is = [&](const char* name) { return !std::strcmp(argv[i], name) && i + 1 < argc; };
        if (is("--size"))
            size = std::atoi(argv[++i]);
        else if (is("--levels"))
            levels = std::atoi(argv[++i]);
        else if (is("--theirs"))
            theirs = argv[++i];
        else
            measure(argv[i], size, levels, theirs);
    }
}
