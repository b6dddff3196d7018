// SPDX-License-Identifier: GPL-3.0-or-later
// The walks through a wide tree: of one ray, and of many rays together while they stay together.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <span>

#include "bvh/wide_bvh.h"
#include "geometry/aabb.h"
#include "math/simd.h"

namespace basicrt {

// A ray with each number four times, its planes of entry and exit chosen by the signs of its direction.
struct WideBoxRay {
  Float4 entry_origin[3], exit_origin[3], inverse_direction[3];
  float t_min;
  int enters_at_upper;  // bit i for axis i

  void set(const BoxRay& ray, float ray_t_min) {
    broadcast(entry_origin, ray.entry_origin);
    broadcast(exit_origin, ray.exit_origin);
    broadcast(inverse_direction, ray.inverse_direction);
    t_min = ray_t_min;
    enters_at_upper = ray.enters_at_upper;
  }

 private:
  static void broadcast(Float4 (&to)[3], Float4 from) {
    to[0] = from.broadcast<0>();
    to[1] = from.broadcast<1>();
    to[2] = from.broadcast<2>();
  }
};

// Where in a WideNode are the planes that rays of one octant enter (exit) through, in floats.
struct PlaneOffsets {
  std::uint8_t entry[3], exit[3];
};
inline constexpr auto plane_offsets = [] {
  std::array<PlaneOffsets, 8> table{};
  for (unsigned octant = 0; octant < 8; ++octant)
    for (unsigned axis = 0; axis < 3; ++axis) {
      const bool enters_at_upper = octant >> axis & 1;
      table[octant].entry[axis] = static_cast<std::uint8_t>(4 * (enters_at_upper ? axis + 3 : axis));
      table[octant].exit[axis] = static_cast<std::uint8_t>(4 * (enters_at_upper ? axis : axis + 3));
    }
  return table;
}();

struct ChildHits {
  Float4 entry;
  int bits;  // bit i: the ray meets child i in [t_min, t_max]
};

// intersect_box() for four.
inline ChildHits intersect_children(const WideNode& node, const WideBoxRay& ray, float t_max) {
  const float* planes = &node.lower[0][0];
  const PlaneOffsets& offsets = plane_offsets[ray.enters_at_upper];
  Float4 entry = Float4::all(ray.t_min), exit = Float4::all(t_max);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Float4 entry_plane = Float4::load(planes + offsets.entry[axis]);
    const Float4 exit_plane = Float4::load(planes + offsets.exit[axis]);
    entry = max((entry_plane - ray.entry_origin[axis]) * ray.inverse_direction[axis], entry);
    exit = min((exit_plane - ray.exit_origin[axis]) * ray.inverse_direction[axis], exit);
  }
  entry = entry * Float4::all(slab_scale);
  return {entry, (entry <= exit).bits()};
}

// Calls visit_leaf(first, count) for each leaf below `root` whose box the ray meets in [t_min, t_max], about nearest
// first. It returns the t_max from there on: nothing beyond is visited, and nothing at all after -infinity.
template <class VisitLeaf>
void walk(const WideBvh& bvh, WideReference root, const WideBoxRay& ray, float t_max, VisitLeaf&& visit_leaf) {
  struct Pending {
    WideReference reference;
    float entry;
  };
  Pending stack[3 * WideBvh::max_depth + 1];  // each level leaves at most three siblings waiting
  Pending* top = stack;
  *top++ = {root, -std::numeric_limits<float>::infinity()};
  while (top != stack) {
    const Pending current = *--top;
    if (current.entry > t_max) continue;
    if (current.reference.count > 0) {
      t_max = visit_leaf(current.reference.first, current.reference.count);
      continue;
    }
    const WideNode& node = bvh.nodes[current.reference.first];
    const ChildHits hits = intersect_children(node, ray, t_max);
    alignas(16) float entries[4];
    hits.entry.store(entries);
    Pending* const base = top;
    for (auto bits = static_cast<unsigned>(hits.bits); bits; bits &= bits - 1) {
      const int child = std::countr_zero(bits);
      // Insert so that the nearest ends up on top.
      Pending* slot = top++;
      for (; slot != base && slot[-1].entry < entries[child]; --slot) *slot = slot[-1];
      *slot = {node.children[child], entries[child]};
    }
  }
}

// Rays by their index in a batch.
using RayIndex = std::uint8_t;
inline constexpr std::size_t batch_size = 32;

// As many rays as are worth the trouble: fewer walk on alone, each in its own order.
inline constexpr std::size_t smallest_group = 2;

// Walks several rays through the tree together: each node is read once for all of them, and the tests of one ray don't
// wait for those of another (a stream traversal as in Barringer and Akenine-Moller 2014, "Dynamic Ray Stream
// Traversal"). Visitor: t_max(ray), and visit_leaf(first, count, rays).
template <class Visitor>
class GroupWalk {
 public:
  GroupWalk(const WideBvh& bvh, const WideBoxRay* rays, Visitor& visitor) : bvh_(bvh), rays_(rays), visitor_(visitor) {}

  void visit(WideReference reference, std::span<const RayIndex> group) {
    if (reference.count > 0) return visitor_.visit_leaf(reference.first, reference.count, group);
    if (group.size() >= smallest_group) return visit_node(bvh_.nodes[reference.first], group);
    for (const RayIndex& ray : group)
      walk(bvh_, reference, rays_[ray], visitor_.t_max(ray), [&](std::uint32_t first, std::uint32_t count) {
        visitor_.visit_leaf(first, count, std::span(&ray, 1));
        return visitor_.t_max(ray);
      });
  }

 private:
  void visit_node(const WideNode& node, std::span<const RayIndex> group) {
    RayIndex groups[4][batch_size];
    std::size_t sizes[4] = {};
    Float4 nearest = Float4::all(std::numeric_limits<float>::infinity());
    for (const RayIndex ray : group) {
      const ChildHits hits = intersect_children(node, rays_[ray], visitor_.t_max(ray));
      for (int child = 0; child < 4; ++child) {
        groups[child][sizes[child]] = ray;
        sizes[child] += hits.bits >> child & 1;
      }
      nearest = min(hits.entry, nearest);
    }
    alignas(16) float entries[4];
    nearest.store(entries);
    int order[4], count = 0;  // of children that any ray meets, nearest first
    for (int child = 0; child < 4; ++child) {
      if (sizes[child] == 0) continue;
      int slot = count++;
      for (; slot > 0 && entries[order[slot - 1]] > entries[child]; --slot) order[slot] = order[slot - 1];
      order[slot] = child;
    }
    for (int i = 0; i < count; ++i)
      visit(node.children[order[i]], std::span<const RayIndex>(groups[order[i]], sizes[order[i]]));
  }

  const WideBvh& bvh_;
  const WideBoxRay* rays_;  // by the numbers in the groups
  Visitor& visitor_;
};

}  // namespace basicrt
