#pragma once

#include <nanobind/nanobind.h>

namespace domelight::python {

/// The environment sampler, and points to draw from it.
void declare_sampling(nanobind::module_& module);

}  // namespace domelight::python
