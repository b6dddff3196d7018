// SPDX-License-Identifier: GPL-3.0-or-later
// Makes the trees that rays walk.
#pragma once

#include <cstdint>
#include <span>

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
};

struct MeshTree {
  NodeTree tree;  // its leaves are `blocks`, marked as triangles
  HugeVector<TriangleBlock> blocks;

  [[nodiscard]] std::size_t memory() const {  // bytes
    return tree.nodes.size() * sizeof(TreeNode) + blocks.size() * sizeof(TriangleBlock);
  }
};

// The same for any number of threads.
[[nodiscard]] MeshTree build_mesh_tree(const Mesh& mesh, const BvhConfig& config);

// A tree with exactly one of the boxes in each leaf, marked as an instance. Empty boxes are left out.
[[nodiscard]] NodeTree build_instance_tree(std::span<const Bounds3f> boxes, const BvhConfig& config);

}  // namespace basicrt
