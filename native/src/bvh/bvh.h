// SPDX-License-Identifier: GPL-3.0-or-later
// The binary tree of the reference builder, and what can be said about how trees are built.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/progress.h"
#include "math/bounds.h"

namespace basicrt {

enum class BvhBuilder : std::uint8_t {
  median,      // the reference: binary, axis of largest extent, median split; then collapsed
  binned_sah,  // surface area heuristic over bins, straight into nodes of eight
  split_sah,   // the same with more bins and with long triangles cut: slower, for final renders of difficult scenes
};

struct BvhConfig {
  BvhBuilder builder = BvhBuilder::binned_sah;
  int max_depth = 64;  // median: a node this deep becomes a leaf
  int leaf_size = 4;   // triangles in a block: fewer take more memory and fewer tests
  // Small meshes share a tree, where a ray needn't enter each; none of them can be moved alone.
  bool merges_small_meshes = true;
  int threads = 0;  // 0: one for each processor; the tree is the same for any number
  WorkProgress* progress =
      nullptr;  // hears of the work in units of build_work(), and can cancel it: Cancelled is thrown
};

// Parts of a tree with fewer primitives are reported when they are done, at so much work for each primitive.
inline constexpr std::size_t large_part = 8192;
inline constexpr int small_part_work = 12;

// About how much work it is to build a tree over so many primitives.
[[nodiscard]] std::uint64_t build_work(std::size_t primitives);

struct BvhNode {
  Bounds3f bounds;
  // An inner node: its left child is the next node, its right child nodes[right_or_first]; count is 0.
  // A leaf: primitives[right_or_first] to primitives[right_or_first + count - 1].
  std::uint32_t right_or_first = 0;
  std::uint32_t count = 0;

  [[nodiscard]] bool is_leaf() const { return count > 0; }
};

struct Bvh {
  std::vector<BvhNode> nodes;  // the root first; empty where there are no primitives
  std::vector<std::uint32_t> primitives;
};

// Halves the primitives along the longest axis of their bounds. A leaf holds two, or more where it is at `config.max_depth`.
[[nodiscard]] Bvh build_median_bvh(std::span<const Bounds3f> bounds, const BvhConfig& config);

// What is wrong with the tree, or an empty string: every primitive in exactly one leaf, children inside parents.
[[nodiscard]] std::string find_bvh_fault(const Bvh& bvh, std::span<const Bounds3f> bounds);

}  // namespace basicrt
