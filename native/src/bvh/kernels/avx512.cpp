// SPDX-License-Identifier: GPL-3.0-or-later
// For x86-64 with AVX-512 (F, VL, DQ and BW).
#include "bvh/kernels/kernel.h"
#if defined(__x86_64__)

#include <immintrin.h>

namespace basicrt::avx512 {
namespace {
// clang-format off: each builds on those before.
#include "bvh/kernels/lanes_sse.inl"
#include "bvh/kernels/lanes_avx512.inl"
#include "bvh/kernels/walk.inl"
// clang-format on
}  // namespace

extern const Kernel kernel;
const Kernel kernel{"avx512", sizeof(Scratch), intersect, occluded};

}  // namespace basicrt::avx512
#endif
