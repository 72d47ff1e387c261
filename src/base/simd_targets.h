#pragma once
// Included before highway.h by every kernel file. Which instruction sets are compiled: portable code (SCALAR), SSE4,
// AVX2 and AVX-512. The ones between add build time and change little.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)
