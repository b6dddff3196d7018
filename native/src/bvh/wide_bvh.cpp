// SPDX-License-Identifier: GPL-3.0-or-later
// Collapses binary trees.
#include "bvh/wide_bvh.h"

namespace basicrt {

int WideBvhBuilder::choose_children(std::uint32_t source_index, std::uint32_t (&children)[4]) const {
  children[0] = source_index + 1;
  children[1] = source_.nodes[source_index].right_or_first;
  int count = 2;
  while (count < 4) {
    int widest = -1;
    double widest_area = -1;
    for (int i = 0; i < count; ++i) {
      const BvhNode& child = source_.nodes[children[i]];
      const double area = Bounds3<double>{Vec3d(child.bounds.lower), Vec3d(child.bounds.upper)}.half_area();
      if (child.is_leaf() || area <= widest_area) continue;
      widest = i;
      widest_area = area;
    }
    if (widest < 0) break;
    const std::uint32_t opened = children[widest];
    children[widest] = opened + 1;
    children[count++] = source_.nodes[opened].right_or_first;
  }
  return count;
}

WideNode WideBvhBuilder::make_node(const std::uint32_t (&children)[4], int count) const {
  WideNode node{};
  for (int i = 0; i < 4; ++i) {
    const Bounds3f box = i < count ? source_.nodes[children[i]].bounds : Bounds3f{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      node.lower[axis][i] = box.lower[axis];
      node.upper[axis][i] = box.upper[axis];
    }
  }
  return node;
}

}  // namespace basicrt
