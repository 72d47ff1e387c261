#pragma once
// The surfaces of a scene that emit light, to draw points on them.

#include "domelight/base/unit_point.h"

#include "render/hit.h"

#include <vector>

namespace domelight {

/// A point drawn from the emitting surfaces, as a place that it lights sees it.
struct EmitterSample {
    Hit hit;                    ///< what a ray from the place meets there; hit.instance is -1 where nothing was drawn
    Vec3f direction;            ///< from the place, unit length
    float pdf_solid_angle = 0;  ///< per steradian at the place, > 0
};

/// All triangles whose material emits light. A point is drawn in two steps: a triangle in proportion to its radiant
/// power, and a point with constant density on its area (Shirley, Wang and Zimmerman 1996, 3.2).
class Emitters {
  public:
    Emitters() = default;
    /// The power of a textured triangle is estimated at 16 points; a twentieth of the mean is added to each, so that
    /// light between them is drawn as well. Emission that is not finite is left out.
    explicit Emitters(const Scene& scene);

    bool empty() const { return cumulative_.empty(); }
    EmitterSample sample(const Scene& scene, const Vec3f& place, UnitPoint u) const;
    /// The density per steradian with which sample() draws what a ray has hit; 0: never.
    /// direction   of the ray, unit length
    float pdf_solid_angle(const Hit& hit, const Vec3f& direction) const;

  private:
    struct Triangle {
        int instance = 0, triangle = 0;
        float pdf_area = 0;  ///< per square metre
    };
    std::vector<int> first_;  ///< of each instance: its first triangle in triangles_; -1: it emits no light
    std::vector<Triangle> triangles_;
    std::vector<double> cumulative_;  ///< the probabilities of the triangles up to and including each; the last is 1
};

}  // namespace domelight
