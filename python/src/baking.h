#pragma once

#include <nanobind/nanobind.h>

namespace domelight::python {

/// bake, which writes a folder for an engine.
void declare_baking(nanobind::module_& module);

}  // namespace domelight::python
