#pragma once

#include <nanobind/nanobind.h>

namespace domelight::python {

/// Pictures of environments, chains and samples, as PNG files in memory.
void declare_pictures(nanobind::module_& module);

}  // namespace domelight::python
