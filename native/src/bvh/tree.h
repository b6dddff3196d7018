// SPDX-License-Identifier: GPL-3.0-or-later
// The tree that rays walk: eight children to a node, whose boxes are tested together, and four triangles to a block.
// Plain data without functions, so that kernels for any instruction set may include it (see kernels/kernel.h).
#pragma once

#include <cstdint>

namespace basicrt {

// What a child is, and where: a node by its index; a block of triangles, which may move, or an instance by its index and this mark.
using TreeReference = std::uint32_t;
inline constexpr TreeReference moving_triangles_mark = 0x4000'0000u;
inline constexpr TreeReference triangles_mark = 0x8000'0000u;
inline constexpr TreeReference instance_mark = 0xC000'0000u;
inline constexpr TreeReference reference_index = 0x3FFF'FFFFu;  // the bits of the index
inline constexpr TreeReference no_reference = 0xFFFF'FFFFu;     // an unused child, or the root of an empty tree

// No path from a root to a leaf is longer: kernels have room for that much.
inline constexpr int max_tree_depth = 64;

// Four cache lines. Nodes come before those below them. Unused children have empty bounds, which no ray enters.
struct alignas(64) TreeNode {
  float bounds[3][2][8];  // [axis][lower, upper][child]
  TreeReference children[8];
  // Bits 3 o to 3 o + 2 of order[i]: which child comes i-th, farthest first, for rays of octant o, whose bit a is set where they go
  // down along axis a. Unused children come first.
  std::uint32_t order[8];
};

// Up to four triangles, copied out of the mesh in the order in which leaves are visited; in each block by ascending number. Missing ones are
// copies of the last.
struct alignas(32) TriangleBlock {
  float corners[3][3][4];  // [corner][axis][triangle]
  std::uint32_t primitives[4];
};

// The same of triangles that move along lines between two moments.
struct alignas(32) MovingTriangleBlock {
  float corners[2][3][3][4];  // [start, end][corner][axis][triangle]
  std::uint32_t primitives[4];
};

}  // namespace basicrt
