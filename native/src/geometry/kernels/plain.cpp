// SPDX-License-Identifier: GPL-3.0-or-later
// For any machine, in vectors as the compiler has them.
#include "geometry/gamma.h"
#include "geometry/kernels/point_kernel.h"

namespace basicrt::plain {
namespace {
// clang-format off: each builds on those before.
#include "geometry/kernels/lanes_plain.inl"
#include "geometry/kernels/triangle_points.inl"
// clang-format on
}  // namespace

extern const PointKernel point_kernel;
const PointKernel point_kernel{"plain", solve};

}  // namespace basicrt::plain
