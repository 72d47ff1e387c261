#pragma once
// The search for the orientation of a bake.

#include "domelight/compare/bake_audit.h"

#include "compare/audit_fit.h"

namespace domelight {

/// Compares a level with exact cubes of its size, added one by one, in each of the 48 orientations. The error of an
/// orientation is its least error among the cubes.
class OrientationSearch {
  public:
    explicit OrientationSearch(TexelSample sample);
    void add(const Cubemap& exact, int threads);
    CubeOrientation found() const;

  private:
    TexelSample sample_;
    std::vector<std::vector<int>> turned_;
    std::vector<double> errors_;
};

}  // namespace domelight
