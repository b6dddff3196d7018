// SPDX-License-Identifier: GPL-3.0-or-later
// A ray against the boxes of a node's children, number for number as intersect_box() in geometry/aabb.h.

constexpr float slab_scale = 1 - 0x1p-19f;

// A child is met where entry <= exit.
inline void intersect_children(const TreeNode& node, const BoxSpace& space, float t_max, Float8& entry, Float8& exit) {
  const float* planes = &node.bounds[0][0][0];
  entry = Float8::all(space.begin);
  exit = Float8::all(t_max);
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t entry_plane = space.octant.entry_planes[axis], exit_plane = entry_plane ^ 8;
    const Float8 inverse = Float8::all(space.inverse_direction[axis]);
    entry = max((Float8::load(planes + entry_plane) - Float8::all(space.entry_origin[axis])) * inverse, entry);
    exit = min((Float8::load(planes + exit_plane) - Float8::all(space.exit_origin[axis])) * inverse, exit);
  }
  entry = entry * Float8::all(slab_scale);
}
