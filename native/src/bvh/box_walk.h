// SPDX-License-Identifier: GPL-3.0-or-later
// One ray through a tree of eight children, nearest first, for shapes that kernels don't know.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "bvh/mesh_tree.h"
#include "bvh/tree.h"
#include "geometry/aabb.h"
#include "geometry/precise_ray.h"

namespace basicrt {

// Where the ray enters each child's box: intersect_box() number for number, of eight boxes at once. Bit i of the result: it does enter
// the i-th.
inline unsigned enter_children(const BoxRay& ray, const TreeNode& node, Interval range, float (&entries)[8]) {
  const Float4 scale = Float4::all(slab_scale);
  unsigned entered = 0;
  for (std::size_t first = 0; first < 8; first += 4) {
    Float4 entry = Float4::all(range.entry), exit = Float4::all(range.exit);
    const auto clip = [&]<int axis>() {
      const bool flipped = ray.enters_at_upper_of(axis);
      const Float4 entry_plane = Float4::load(&node.bounds[axis][flipped][first]);
      const Float4 exit_plane = Float4::load(&node.bounds[axis][!flipped][first]);
      const Float4 inverse = ray.inverse_direction.broadcast<axis>();
      // A NaN changes nothing.
      entry = max((entry_plane - ray.entry_origin.broadcast<axis>()) * inverse, entry);
      exit = min((exit_plane - ray.exit_origin.broadcast<axis>()) * inverse, exit);
    };
    clip.template operator()<0>();
    clip.template operator()<1>();
    clip.template operator()<2>();
    const Float4 nearest = entry * scale;
    nearest.store(entries + first);
    entered |= static_cast<unsigned>((nearest <= exit).bits()) << first;
  }
  return entered;
}

// Calls visit(index) for each leaf that the ray may enter before ray.t_max, which `visit` may lessen.
template <class Visit>
void walk_boxes(const NodeTree& tree, const PreciseRay& ray, const Visit& visit) {
  struct Waiting {
    TreeReference reference;
    float entry;
  };
  const BoxRay box_ray = make_box_ray(ray.origin, ray.direction);
  const unsigned octant = static_cast<unsigned>(box_ray.enters_at_upper) & 7u;
  std::array<Waiting, 8 * max_tree_depth + 1> waiting;
  std::size_t count = 0;
  if (tree.root != no_reference) waiting[count++] = {tree.root, 0};
  while (count > 0) {
    const Waiting current = waiting[--count];
    const Interval range{static_cast<float>(ray.t_min), static_cast<float>(ray.t_max)};
    if (current.entry * slab_scale > range.exit) continue;
    if (current.reference >= triangles_mark) {
      visit(current.reference & reference_index);
      continue;
    }
    const TreeNode& node = tree.nodes[current.reference];
    alignas(16) float entries[8];
    const unsigned entered = enter_children(box_ray, node, range, entries);
    for (const std::uint32_t order : node.order) {
      const std::uint32_t child = order >> (3 * octant) & 7u;
      if (entered >> child & 1u) waiting[count++] = {node.children[child], entries[child]};
    }
  }
}

}  // namespace basicrt
