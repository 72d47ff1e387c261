#pragma once
// The arithmetic of the bilinear density, shared by its scalar form and (operation by operation) its SIMD kernel.

#include <algorithm>
#include <cmath>

namespace domelight {

/// A density that is linear in t over [0, 1]: its value at t is begin (1 - t) + end t, its integral (begin + end) / 2.
struct LinearSegment {
    double begin, end;

    double at(double t) const { return begin * (1 - t) + end * t; }
    /// Integral from 0 to t.
    double before(double t) const { return begin * t + 0.5 * (end - begin) * (t * t); }
    /// The t with before(t) == mass, without cancellation whichever end is larger. Kept away from the ends, where the
    /// density may be zero, by less than a sixteenth of a quantum.
    double invert(double mass) const {
        const double root = std::sqrt(std::max(begin * begin + 2 * (end - begin) * mass, 0.0));
        return std::clamp(2 * mass / std::max(begin + root, 1e-300), k_margin, 1 - k_margin);
    }
    static constexpr double k_margin = 0x1p-36;
};

/// Where segment s of a column of `height` rows begins and how long it is, in rows: half a row at either end, from
/// centre to centre else.
struct RowSegment {
    double start, length;
    int above, below;  ///< the rows it lies between; the same one in the half rows
};
inline RowSegment row_segment(int s, int height) {
    return {s == 0 ? 0.0 : s - 0.5, s == 0 || s == height ? 0.5 : 1.0, std::max(s - 1, 0), std::min(s, height - 1)};
}
/// The segment that v is in.
inline int row_segment_at(double v, int height) {
    return std::clamp(int(std::clamp(v, 0.0, 1.0) * height + 0.5), 0, height);
}

}  // namespace domelight
