// SPDX-License-Identifier: GPL-3.0-or-later
// For x86-64 with AVX2.
#include "bvh/kernels/kernel.h"
#if defined(__x86_64__)

#include <immintrin.h>

namespace basicrt::avx2 {
namespace {
// clang-format off: each builds on those before.
#include "bvh/kernels/lanes_sse.inl"
#include "bvh/kernels/lanes_avx2.inl"
#include "bvh/kernels/walk.inl"
// clang-format on
}  // namespace

extern const Kernel kernel;
const Kernel kernel{"avx2", sizeof(Scratch), intersect, occluded};

}  // namespace basicrt::avx2
#endif
