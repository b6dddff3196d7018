// SPDX-License-Identifier: GPL-3.0-or-later
// A tree with four children to a node, whose boxes are tested together, and the walk through it.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "base/assert.h"
#include "bvh/bvh.h"
#include "bvh/simd.h"
#include "geometry/aabb.h"

namespace basicrt {

// A node where count is 0, else a leaf with that many items.
struct WideReference {
  std::uint32_t first = 0;  // index of the node, or of the leaf's first item
  std::uint32_t count = 0;
};

// Two cache lines. Unused children have empty bounds, which no ray enters.
struct alignas(64) WideNode {
  float lower[3][4], upper[3][4];  // [axis][child]
  WideReference children[4];
};

struct WideBvh {
  // Of walks: each level leaves at most three siblings waiting. Builders stop far above.
  static constexpr int max_depth = 128;

  std::vector<WideNode> nodes;
  WideReference root;  // a leaf where there is no node
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

// A ray with each number four times, its planes of entry and exit chosen by the signs of its direction.
struct WideBoxRay {
  Float4 entry_origin[3], exit_origin[3], inverse_direction[3];
  Float4 t_min;
  std::size_t entry_offset[3], exit_offset[3];  // of the rows in a WideNode

  WideBoxRay(const BoxRay& ray, float ray_t_min) : t_min(Float4::all(ray_t_min)) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      entry_origin[axis] = Float4::all(ray.entry_origin[axis]);
      exit_origin[axis] = Float4::all(ray.exit_origin[axis]);
      inverse_direction[axis] = Float4::all(ray.inverse_direction[axis]);
      entry_offset[axis] = axis + (ray.enters_at_upper[axis] ? 3 : 0);
      exit_offset[axis] = axis + (ray.enters_at_upper[axis] ? 0 : 3);
    }
  }
};

// The bits of the children that the ray meets in [t_min, t_max], and where it enters them: intersect_box() for four.
inline int intersect_children(const WideNode& node, const WideBoxRay& ray, float t_max, float (&entries)[4]) {
  const float* rows = &node.lower[0][0];
  const Float4 largest = Float4::all(std::numeric_limits<float>::max()), error = Float4::all(slab_error);
  Float4 entry = Float4::all(-std::numeric_limits<float>::infinity());
  Float4 exit = Float4::all(std::numeric_limits<float>::infinity());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Float4 near_plane = Float4::load(rows + 4 * ray.entry_offset[axis]);
    const Float4 far_plane = Float4::load(rows + 4 * ray.exit_offset[axis]);
    entry = max((near_plane - ray.entry_origin[axis]) * ray.inverse_direction[axis], entry);
    exit = min((far_plane - ray.exit_origin[axis]) * ray.inverse_direction[axis], exit);
  }
  entry = max(entry - min(abs(entry), largest) * error, ray.t_min);
  exit = min(exit + min(abs(exit), largest) * error, Float4::all(t_max));
  entry.store(entries);
  return less_equal_bits(entry, exit);
}

// Calls visit_leaf(first, count) for each leaf whose box the ray meets in [t_min, t_max], about nearest first. It
// returns the t_max from there on: nothing beyond is visited, and nothing at all after -infinity.
template <class VisitLeaf>
void walk(const WideBvh& bvh, const WideBoxRay& ray, float t_max, VisitLeaf&& visit_leaf) {
  struct Pending {
    WideReference reference;
    float entry;
  };
  Pending stack[3 * WideBvh::max_depth + 1];
  Pending* top = stack;
  *top++ = {bvh.root, -std::numeric_limits<float>::infinity()};
  while (top != stack) {
    const Pending current = *--top;
    if (current.entry > t_max) continue;
    if (current.reference.count > 0) {
      t_max = visit_leaf(current.reference.first, current.reference.count);
      continue;
    }
    const WideNode& node = bvh.nodes[current.reference.first];
    alignas(16) float entries[4];
    Pending* const base = top;
    for (auto bits = static_cast<unsigned>(intersect_children(node, ray, t_max, entries)); bits; bits &= bits - 1) {
      const int child = std::countr_zero(bits);
      // Insert so that the nearest ends up on top.
      Pending* slot = top++;
      for (; slot != base && slot[-1].entry < entries[child]; --slot) *slot = slot[-1];
      *slot = {node.children[child], entries[child]};
    }
  }
}

}  // namespace basicrt
