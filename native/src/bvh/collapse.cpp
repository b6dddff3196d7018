// SPDX-License-Identifier: GPL-3.0-or-later
// Collapses binary trees into nodes of eight children.
#include <algorithm>
#include <vector>

#include "base/assert.h"
#include "bvh/node_order.h"
#include "bvh/tree_access.h"
#include "bvh/tree_layout.h"

namespace basicrt {
namespace {

// A part of the binary tree, or where a leaf is too long, a part of that leaf.
struct Part {
  Bounds3f bounds;
  std::uint32_t node = 0;
  std::uint32_t first = 0, count = 0;  // primitives, of a leaf

  [[nodiscard]] bool is_leaf() const { return count > 0; }
};

double area_of(const Part& part) {
  return Bounds3<double>{Vec3d(part.bounds.lower), Vec3d(part.bounds.upper)}.half_area();
}

class Collapse {
 public:
  Collapse(const Bvh& bvh, std::span<const Bounds3f> boxes, std::uint32_t leaf_size, WorkProgress* progress)
      : bvh_(bvh), boxes_(boxes), leaf_size_(leaf_size), progress_(progress) {}

  TreeLayout build() {
    layout_.bounds = bvh_.nodes[0].bounds;
    layout_.primitives.assign(bvh_.primitives.begin(), bvh_.primitives.end());
    layout_.root = build_part(part_of(0), 0);
    layout_.leaf_begins.push_back(static_cast<std::uint32_t>(bvh_.primitives.size()));
    return std::move(layout_);
  }

 private:
  // A node with no more primitives than a leaf may have counts as a leaf.
  Part part_of(std::uint32_t index) const {
    const BvhNode& node = bvh_.nodes[index];
    const auto [first, count] = primitives_of(index);
    if (!node.is_leaf() && count > leaf_size_) return {.bounds = node.bounds, .node = index};
    return {.bounds = node.bounds, .first = first, .count = count};
  }
  std::pair<std::uint32_t, std::uint32_t> primitives_of(std::uint32_t index) const {
    std::uint32_t leftmost = index, rightmost = index;
    while (!bvh_.nodes[leftmost].is_leaf()) ++leftmost;
    while (!bvh_.nodes[rightmost].is_leaf()) rightmost = bvh_.nodes[rightmost].right_or_first;
    const std::uint32_t first = bvh_.nodes[leftmost].right_or_first;
    return {first, bvh_.nodes[rightmost].right_or_first + bvh_.nodes[rightmost].count - first};
  }
  Part part_of(std::uint32_t first, std::uint32_t count) const {
    Part part{.first = first, .count = count};
    for (std::uint32_t i = first; i < first + count; ++i) part.bounds.extend(boxes_[bvh_.primitives[i]]);
    return part;
  }
  bool can_open(const Part& part) const { return !part.is_leaf() || part.count > leaf_size_; }
  std::pair<Part, Part> open(const Part& part) const {
    if (!part.is_leaf()) return {part_of(part.node + 1), part_of(bvh_.nodes[part.node].right_or_first)};
    const std::uint32_t half = part.count / 2;
    return {part_of(part.first, half), part_of(part.first + half, part.count - half)};
  }

  TreeReference build_part(const Part& part, int depth) {
    if (!can_open(part)) {
      if (progress_ != nullptr) progress_->advance(part.count);
      const auto first = layout_.primitives.begin() + part.first;
      std::sort(first, first + part.count);
      layout_.leaf_begins.push_back(part.first);
      return triangles_mark | static_cast<TreeReference>(layout_.leaf_begins.size() - 1);
    }
    BASICRT_ASSERT(depth < max_tree_depth);
    const std::vector<Part> parts = open_to_eight(part);
    const std::size_t index = layout_.nodes.size();
    BASICRT_ASSERT(index < reference_index);
    layout_.nodes.push_back({});
    for (std::size_t child = 0; child < 8; ++child) {
      set_child_bounds(layout_.nodes[index], child, child < parts.size() ? parts[child].bounds : Bounds3f{});
      const TreeReference reference = child < parts.size() ? build_part(parts[child], depth + 1) : no_reference;
      layout_.nodes[index].children[child] = reference;
    }
    set_order(layout_.nodes[index]);
    return static_cast<TreeReference>(index);
  }

  // In the order of their primitives.
  std::vector<Part> open_to_eight(const Part& part) const {
    std::vector<Part> parts{part};
    while (parts.size() < 8) {
      auto widest = parts.end();
      for (auto it = parts.begin(); it != parts.end(); ++it)
        if (can_open(*it) && (widest == parts.end() || area_of(*it) > area_of(*widest))) widest = it;
      if (widest == parts.end()) break;
      const auto [left, right] = open(*widest);
      *widest = left;
      parts.insert(widest + 1, right);
    }
    return parts;
  }

  const Bvh& bvh_;
  std::span<const Bounds3f> boxes_;
  std::uint32_t leaf_size_;
  WorkProgress* progress_;
  TreeLayout layout_;
};

}  // namespace

TreeLayout collapse_to_layout(const Bvh& bvh, std::span<const Bounds3f> boxes, int leaf_size, WorkProgress* progress) {
  if (bvh.nodes.empty()) return {};
  return Collapse(bvh, boxes, static_cast<std::uint32_t>(leaf_size), progress).build();
}

}  // namespace basicrt
