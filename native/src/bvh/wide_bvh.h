// SPDX-License-Identifier: GPL-3.0-or-later
// A tree with four children to a node, whose boxes are tested together.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "base/assert.h"
#include "bvh/bvh.h"

namespace basicrt {

// A node where count is 0, else a leaf with that many items.
struct WideReference {
  std::uint32_t first;  // index of the node, or of the leaf's first item
  std::uint32_t count;
};

// Two cache lines. Unused children have empty bounds, which no ray enters.
struct alignas(64) WideNode {
  float lower[3][4], upper[3][4];  // [axis][child]
  WideReference children[4];
};

struct WideBvh {
  // Builders stop far above: binned_sah at 64 levels and as many as it takes to halve what is left.
  static constexpr int max_depth = 128;

  std::vector<WideNode> nodes;
  WideReference root{};  // a leaf where there is no node
  Bounds3f bounds;

  [[nodiscard]] bool is_empty() const { return nodes.empty() && root.count == 0; }
};

// Collapses a binary tree, opening the child with the largest surface until there are four. `add_leaf(span of
// primitives)` stores a leaf's items wherever its user keeps them, and says where that was.
class WideBvhBuilder {
 public:
  explicit WideBvhBuilder(const Bvh& source) : source_(source) {}

  template <class AddLeaf>
  WideBvh build(AddLeaf&& add_leaf) {
    if (source_.nodes.empty()) return {};
    result_.bounds = source_.nodes[0].bounds;
    result_.root = build_reference(0, 0, add_leaf);
    return std::move(result_);
  }

 private:
  template <class AddLeaf>
  WideReference build_reference(std::uint32_t source_index, int depth, AddLeaf& add_leaf) {
    BASICRT_ASSERT(depth < WideBvh::max_depth);
    const BvhNode& source = source_.nodes[source_index];
    if (source.is_leaf()) return add_leaf(std::span(source_.primitives).subspan(source.right_or_first, source.count));
    std::uint32_t children[4];
    const int child_count = choose_children(source_index, children);
    const auto index = static_cast<std::uint32_t>(result_.nodes.size());
    result_.nodes.push_back(make_node(children, child_count));
    for (int i = 0; i < child_count; ++i) {
      const WideReference child = build_reference(children[i], depth + 1, add_leaf);
      result_.nodes[index].children[i] = child;
    }
    return {index, 0};
  }

  int choose_children(std::uint32_t source_index, std::uint32_t (&children)[4]) const;
  [[nodiscard]] WideNode make_node(const std::uint32_t (&children)[4], int count) const;

  const Bvh& source_;
  WideBvh result_;
};

}  // namespace basicrt
