#include "base/instruction_set.h"

#include "base/simd_targets.h"

#include <hwy/highway.h>

namespace domelight::simd {

std::string instruction_set() {
    // The lowest bit set is the best target.
    const auto targets = hwy::SupportedTargets() & HWY_TARGETS;
    return hwy::TargetName(targets & ~(targets - 1));
}

void limit_instruction_set(const std::string& name) {
    hwy::SetSupportedTargetsForTest(0);
    auto targets = hwy::SupportedTargets();
    if (name == "AVX2") targets &= ~(HWY_AVX2 - 1);
    if (name == "SSE4") targets &= ~(HWY_SSE4 - 1);
    if (name == "SCALAR") targets = HWY_SCALAR;
    hwy::SetSupportedTargetsForTest(targets);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

}  // namespace domelight::simd
