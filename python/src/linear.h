#pragma once

#include <nanobind/nanobind.h>

namespace domelight::python {

/// The filter as a linear function of signed images, and its transpose: what domelight.torch differentiates.
void declare_linear(nanobind::module_& module);

}  // namespace domelight::python
