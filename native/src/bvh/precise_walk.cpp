// SPDX-License-Identifier: GPL-3.0-or-later
// Walks a tree by the tests of geometry/.
#include "bvh/precise_walk.h"

#include <vector>

#include "bvh/tree_access.h"
#include "geometry/aabb.h"
#include "geometry/triangle.h"

namespace basicrt {
namespace {

Hit make_hit(double t, std::uint32_t primitive, double u, double v) {
  return {.t = static_cast<float>(t), .primitive = primitive, .u = static_cast<float>(u), .v = static_cast<float>(v)};
}

// Takes the nearest of a block's hits, of equal ones the lowest.
void intersect_block(const TriangleBlock& block, PreciseRay& ray, std::uint32_t skipped_primitive,
                     std::optional<Hit>& nearest) {
  for (std::size_t lane = 0; lane < 4; ++lane) {
    if (block.primitives[lane] == skipped_primitive) continue;
    const double t_max = ray.t_max;
    const auto hit =
        intersect_triangle(ray, corner_of(block, lane, 0), corner_of(block, lane, 1), corner_of(block, lane, 2));
    if (!hit) continue;
    const bool is_tie = hit->t == t_max && nearest;
    if (is_tie && block.primitives[lane] >= nearest->primitive) continue;
    nearest = make_hit(hit->t, block.primitives[lane], hit->u, hit->v);
  }
}

// find_block(index) is a leaf's block.
template <class FindBlock>
std::optional<Hit> intersect_tree(const NodeTree& tree, PreciseRay ray, std::uint32_t skipped_primitive,
                                  const FindBlock& find_block) {
  std::optional<Hit> nearest;
  const BoxRay box_ray = make_box_ray(ray.origin, ray.direction);
  std::vector<TreeReference> waiting{tree.root};
  while (!waiting.empty()) {
    const TreeReference current = waiting.back();
    waiting.pop_back();
    if (current == no_reference) continue;
    if (current >= moving_triangles_mark) {
      intersect_block(find_block(current & reference_index), ray, skipped_primitive, nearest);
      continue;
    }
    const TreeNode& node = tree.nodes[current];
    const Interval range{static_cast<float>(ray.t_min), static_cast<float>(ray.t_max)};
    for (std::size_t child = 0; child < 8; ++child)
      if (intersect_box(box_ray, child_bounds(node, child), range)) waiting.push_back(node.children[child]);
  }
  return nearest;
}

}  // namespace

std::optional<Hit> intersect_mesh_precisely(const MeshTree& mesh, PreciseRay ray, std::uint32_t skipped_primitive) {
  return intersect_tree(mesh.tree, ray, skipped_primitive,
                        [&](std::uint32_t index) -> const TriangleBlock& { return mesh.blocks[index]; });
}

std::optional<Hit> intersect_mesh_precisely(const MovingMeshTree& mesh, PreciseRay ray,
                                            std::uint32_t skipped_primitive) {
  const auto [first, fraction] = key_interval(static_cast<std::uint32_t>(mesh.intervals.size()), ray.time);
  const MovingMeshTree::Interval& interval = mesh.intervals[first];
  return intersect_tree(interval.tree, ray, skipped_primitive,
                        [&](std::uint32_t index) { return block_at(interval.blocks[index], fraction); });
}

std::optional<Hit> intersect_sphere_precisely(const Sphere& sphere, PreciseRay ray) {
  const auto t = intersect_sphere(ray, sphere);
  if (!t) return std::nullopt;
  return make_hit(*t, 0, 0, 0);
}

}  // namespace basicrt
