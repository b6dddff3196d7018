// SPDX-License-Identifier: GPL-3.0-or-later
// Reads what lies in a tree lane by lane, for code that is no kernel.
#pragma once

#include <cstddef>

#include "bvh/tree.h"
#include "math/bounds.h"

namespace basicrt {

[[nodiscard]] inline Vec3f corner_of(const TriangleBlock& block, std::size_t lane, std::size_t corner) {
  const auto& axes = block.corners[corner];
  return {axes[0][lane], axes[1][lane], axes[2][lane]};
}

// The block at a moment, by the fraction of the time between start and end. Number for number as kernels do it.
[[nodiscard]] inline TriangleBlock block_at(const MovingTriangleBlock& block, float fraction) {
  TriangleBlock result;
  for (std::size_t lane = 0; lane < 4; ++lane) {
    result.primitives[lane] = block.primitives[lane];
    for (std::size_t corner = 0; corner < 3; ++corner)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const float start = block.corners[0][corner][axis][lane], end = block.corners[1][corner][axis][lane];
        result.corners[corner][axis][lane] = start + (end - start) * fraction;
      }
  }
  return result;
}

[[nodiscard]] inline Bounds3f child_bounds(const TreeNode& node, std::size_t child) {
  Bounds3f box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.lower[axis] = node.bounds[axis][0][child];
    box.upper[axis] = node.bounds[axis][1][child];
  }
  return box;
}
inline void set_child_bounds(TreeNode& node, std::size_t child, const Bounds3f& box) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    node.bounds[axis][0][child] = box.lower[axis];
    node.bounds[axis][1][child] = box.upper[axis];
  }
}

}  // namespace basicrt
