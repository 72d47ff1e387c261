#pragma once

#include <nanobind/nanobind.h>

namespace domelight::python {

/// lights, and the environment without them.
void declare_extraction(nanobind::module_& module);

}  // namespace domelight::python
