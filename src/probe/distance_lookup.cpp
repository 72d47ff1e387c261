#include "probe/distance_lookup.h"

#include "domelight/projection/projection.h"

#include <algorithm>
#include <cmath>

namespace domelight {
namespace {

/// The surface in the middle of a texel, by the coordinates of a face: at z (s, t, 1).
struct SurfaceOnFace {
    float s = 0, t = 0;
    float reciprocal = 0;  ///< 1 / z; not above 0: not in front of this face
};

/// The surfaces that one cube's texels see, by the coordinates of one of its faces.
class FaceView {
  public:
    FaceView(const CubeStore<PackedMoments>& cubes, int index, int face) : cubes_(cubes), index_(index), face_(face) {}

    /// The column and row may lie a little outside of the face: then it is the texel of another face.
    SurfaceOnFace at(int column, int row) const {
        const int n = cubes_.size();
        if (column >= 0 && row >= 0 && column < n && row < n) {
            const float s = (2 * float(column) + 1) / float(n) - 1, t = (2 * float(row) + 1) / float(n) - 1;
            return {s, t, std::sqrt(1 + s * s + t * t) / mean(face_, column, row)};
        }
        const CubePoint other = cube_point(cube_direction(face_, {(column + 0.5) / n, (row + 0.5) / n}));
        const auto nearest = [&](double uv) { return std::clamp(int(uv * n), 0, n - 1); };
        const int x = nearest(other.uv.u), y = nearest(other.uv.v);
        const Vec3d seen =
            normalize(cube_direction(other.face, {(x + 0.5) / n, (y + 0.5) / n})) * double(mean(other.face, x, y));
        const Vec3d axis = cube_direction(face_, {0.5, 0.5});
        const double z = dot(seen, axis);
        return {float(dot(seen, cube_direction(face_, {1, 0.5}) - axis) / z),
                float(dot(seen, cube_direction(face_, {0.5, 1}) - axis) / z), float(1 / z)};
    }

  private:
    float mean(int face, int column, int row) const {
        return std::max(cubes_.texel(index_, face, column, row).mean, 1e-6f);
    }

    const CubeStore<PackedMoments>& cubes_;
    int index_, face_;
};

/// 1 / z at (s, t) of the plane through three surfaces; 0 if they do not define one.
float on_plane(const SurfaceOnFace& a, const SurfaceOnFace& b, const SurfaceOnFace& c, float s, float t) {
    if (!(a.reciprocal > 0 && b.reciprocal > 0 && c.reciprocal > 0)) return 0;
    const float bs = b.s - a.s, bt = b.t - a.t, cs = c.s - a.s, ct = c.t - a.t, d = bs * ct - bt * cs;
    if (d == 0) return 0;
    const float bf = b.reciprocal - a.reciprocal, cf = c.reciprocal - a.reciprocal;
    return a.reciprocal + ((bf * ct - cf * bt) * (s - a.s) + (cf * bs - bf * cs) * (t - a.t)) / d;
}

}  // namespace

DistanceMoments distance_between_texels(const CubeStore<PackedMoments>& cubes, int index, const Vec3f& direction) {
    const int size = cubes.size();
    const CubeTap tap = cube_tap(size, direction);
    const FaceView view(cubes, index, tap.face);
    const float s = (2 * (float(tap.column) + tap.s) + 1) / float(size) - 1,
                t = (2 * (float(tap.row) + tap.t) + 1) / float(size) - 1;
    const auto moments = cubes.texels(index, tap);
    const float weight[4] = {(1 - tap.s) * (1 - tap.t), tap.s * (1 - tap.t), (1 - tap.s) * tap.t, tap.s * tap.t};
    float bilinear = 0, planes = 0, variance = 0;
    for (int i = 0; i < 4; ++i) {
        const int right = i & 1, down = i >> 1, column = tap.column + right, row = tap.row + down;
        const SurfaceOnFace here = view.at(column, row);
        const auto& m = moments[std::size_t(i)];
        bilinear += weight[i] * here.reciprocal;
        variance += weight[i] * std::max(0.f, m.mean_square - m.mean * m.mean);
        planes = std::max(planes, on_plane(here, view.at(column + (right ? 1 : -1), row),
                                           view.at(column, row + (down ? 1 : -1)), s, t));
    }
    // A corner of two walls that are seen at 45 degrees lies between texels by 1 / (2 size) of its distance.
    const float reciprocal = std::clamp(planes, bilinear * (1 - 2 / float(size + 2)), bilinear);
    const auto squared = [](float v) { return v * v; };
    const float slope = squared(moments[1].mean - moments[0].mean) + squared(moments[3].mean - moments[2].mean) +
                        squared(moments[2].mean - moments[0].mean) + squared(moments[3].mean - moments[1].mean);
    const float mean = std::sqrt(1 + s * s + t * t) / reciprocal;
    // A distance that rises by d across a texel has the variance d^2 / 12; each direction has two differences.
    return {mean, mean * mean + std::max(0.f, variance - slope / 24)};
}

}  // namespace domelight
