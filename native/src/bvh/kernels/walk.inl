// SPDX-License-Identifier: GPL-3.0-or-later
// A kernel without its lanes: Mask4, Float4 and Float8 come before it.
// clang-format off: each builds on those before.
#include "bvh/kernels/space.inl"
#include "bvh/kernels/box.inl"
#include "bvh/kernels/triangle.inl"
#include "bvh/kernels/slot.inl"
#include "bvh/kernels/single.inl"
#include "bvh/kernels/stream.inl"
#include "bvh/kernels/packet.inl"
#include "bvh/kernels/trace.inl"
