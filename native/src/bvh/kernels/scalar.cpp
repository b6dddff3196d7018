// SPDX-License-Identifier: GPL-3.0-or-later
// Plain C++, for any machine.
#include "bvh/kernels/kernel.h"

namespace basicrt::scalar {
namespace {
// clang-format off: each builds on those before.
#include "bvh/kernels/lanes_scalar.inl"
#include "bvh/kernels/lanes_of_two.inl"
#include "bvh/kernels/walk.inl"
// clang-format on
}  // namespace

extern const Kernel kernel;
const Kernel kernel{"scalar", sizeof(Scratch), intersect, occluded};

}  // namespace basicrt::scalar
