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
