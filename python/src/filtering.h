#pragma once

#include <nanobind/nanobind.h>

namespace domelight::python {

/// prefilter, irradiance, spherical_harmonics and brdf_table.
void declare_filtering(nanobind::module_& module);

}  // namespace domelight::python
