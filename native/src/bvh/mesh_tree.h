// SPDX-License-Identifier: GPL-3.0-or-later
// Makes the trees that rays walk.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/huge_pages.h"
#include "bvh/bvh.h"
#include "bvh/tree.h"
#include "geometry/mesh.h"
#include "math/bounds.h"

namespace basicrt {

struct NodeTree {
  HugeVector<TreeNode> nodes;
  TreeReference root = no_reference;
  Bounds3f bounds;

  [[nodiscard]] std::size_t memory() const { return nodes.size() * sizeof(TreeNode); }  // bytes
};

struct MeshTree {
  NodeTree tree;  // its leaves are `blocks`, marked as triangles
  HugeVector<TriangleBlock> blocks;

  [[nodiscard]] std::size_t memory() const {  // bytes
    return tree.memory() + blocks.size() * sizeof(TriangleBlock);
  }
};

// Of a mesh that deforms: a tree for each interval between two keys, in whose boxes the triangles stay throughout.
struct MovingMeshTree {
  struct Interval {
    NodeTree tree;  // its leaves are `blocks`, marked as moving triangles
    HugeVector<MovingTriangleBlock> blocks;
  };
  std::vector<Interval> intervals;
  Bounds3f bounds;  // at all times

  [[nodiscard]] std::size_t memory() const {  // bytes
    std::size_t bytes = 0;
    for (const Interval& interval : intervals)
      bytes += interval.tree.memory() + interval.blocks.size() * sizeof(MovingTriangleBlock);
    return bytes;
  }
};

// The same for any number of threads.
[[nodiscard]] MeshTree build_mesh_tree(const Mesh& mesh, const BvhConfig& config);

[[nodiscard]] MovingMeshTree build_moving_mesh_tree(const Mesh& mesh, const BvhConfig& config);

// Moves the tree along with a mesh that has the triangles it was built from, elsewhere: hits are right again, though
// the tree is no better than it can be for that.
void refit(MeshTree& tree, const Mesh& mesh, int threads = 0);

// A tree with exactly one of the boxes in each leaf, marked as an instance. Empty boxes are left out.
[[nodiscard]] NodeTree build_instance_tree(std::span<const Bounds3f> boxes, const BvhConfig& config);

}  // namespace basicrt
