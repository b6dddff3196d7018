// SPDX-License-Identifier: GPL-3.0-or-later
// For x86-64 with AVX2.
#include "geometry/gamma.h"
#include "geometry/kernels/point_kernel.h"
#if defined(__x86_64__)

#include <immintrin.h>

namespace basicrt::avx2 {
namespace {
// clang-format off: each builds on those before.
#include "geometry/kernels/lanes_avx2.inl"
#include "geometry/kernels/triangle_points.inl"
// clang-format on
}  // namespace

extern const PointKernel point_kernel;
const PointKernel point_kernel{"avx2", solve};

}  // namespace basicrt::avx2
#endif
