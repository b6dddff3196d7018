// SPDX-License-Identifier: GPL-3.0-or-later
// The tree: one array of nodes over the bounds of primitives, and the builders that make it.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "math/bounds.h"

namespace basicrt {

enum class BvhBuilder : std::uint8_t {
  median,      // the reference: axis of largest extent, median split
  binned_sah,  // surface area heuristic over bins
};

struct BvhConfig {
  BvhBuilder builder = BvhBuilder::binned_sah;
  int max_leaf_size = 4;  // binned_sah: no leaf holds more
  int max_depth = 64;     // median: a node this deep becomes a leaf
  int bins = 16;          // binned_sah
};

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

// A tree over `bounds`, in which every primitive is in exactly one leaf.
[[nodiscard]] Bvh build_bvh(std::span<const Bounds3f> bounds, const BvhConfig& config);

// What is wrong with the tree, or an empty string: every primitive in exactly one leaf, children inside parents.
[[nodiscard]] std::string find_bvh_fault(const Bvh& bvh, std::span<const Bounds3f> bounds);

}  // namespace basicrt
