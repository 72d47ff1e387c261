#pragma once

#include <nanobind/nanobind.h>

namespace domelight::python {

/// compare, flip and audit.
void declare_comparing(nanobind::module_& module);

}  // namespace domelight::python
