#pragma once

#include <string>

namespace domelight::simd {

/// Name of the instruction set that the kernels run on now: "AVX3", "AVX2", "SSE4" or "SCALAR"
std::string instruction_set();

/// Restricts the kernels to `name` ("AVX3", "AVX2", "SSE4" or "SCALAR") at most; empty: everything that the machine
/// has. For tests and benchmarks that compare instruction sets; must not be called while kernels run.
void limit_instruction_set(const std::string& name);

}  // namespace domelight::simd
