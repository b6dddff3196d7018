// SPDX-License-Identifier: GPL-3.0-or-later
// For x86-64 with SSE4.2.
#include "bvh/kernels/kernel.h"
#if defined(__x86_64__)

#include <immintrin.h>

namespace basicrt::sse42 {
namespace {
// clang-format off: each builds on those before.
#include "bvh/kernels/lanes_sse.inl"
#include "bvh/kernels/lanes_of_two.inl"
#include "bvh/kernels/walk.inl"
// clang-format on
}  // namespace

extern const Kernel kernel;
const Kernel kernel{"sse42", sizeof(Scratch), intersect, occluded};

}  // namespace basicrt::sse42
#endif
