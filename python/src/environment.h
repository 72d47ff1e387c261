#pragma once
// Environments in Python.

#include "domelight/environment/environment.h"

#include "array_input.h"

#include <string>

namespace domelight::python {

/// An environment with Python's functions of it: class domelight._core.Environment.
void declare_environment(nb::module_& module);

/// Three numbers as a tuple.
nb::tuple tuple_of(const Vec3d& v);
/// A matrix as a tuple of its rows.
nb::tuple tuple_of(const Mat3& m);

/// Directions of an array of shape (..., 3): its numbers as float64. Raises domelight.Error for another shape, and for a
/// direction that is zero or not finite.
std::vector<Vec3d> directions_of(nb::handle array, const char* keyword);

/// The environment as one lat-long picture in the default convention, so that a picture of it shows the world.
Result<ImageF> world_latlong(const Environment& environment, int height, int threads);

}  // namespace domelight::python
