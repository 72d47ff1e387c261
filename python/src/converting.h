#pragma once

#include <nanobind/nanobind.h>

namespace domelight::python {

/// convert, and writing images and textures.
void declare_converting(nanobind::module_& module);

}  // namespace domelight::python
