// SPDX-License-Identifier: GPL-3.0-or-later
// What builders make: the nodes, and which primitives are in which leaf. Blocks of triangles are filled in from it.
#pragma once

#include <cstdint>
#include <span>

#include "base/huge_pages.h"
#include "bvh/bvh.h"
#include "bvh/mesh_tree.h"
#include "bvh/references.h"
#include "bvh/tree.h"
#include "math/bounds.h"

namespace basicrt {

class WorkerPool;

struct TreeLayout {
  HugeVector<TreeNode> nodes;  // references to leaves are marked as triangles, with the leaf's number
  TreeReference root = no_reference;
  Bounds3f bounds;
  // Leaf i holds primitives[leaf_begins[i]] up to before primitives[leaf_begins[i + 1]], ascending. The last may be repeated.
  HugeVector<std::uint32_t> leaf_begins, primitives;

  [[nodiscard]] std::size_t leaf_count() const { return leaf_begins.empty() ? 0 : leaf_begins.size() - 1; }
  [[nodiscard]] std::span<const std::uint32_t> leaf(std::size_t index) const {
    return std::span(primitives).subspan(leaf_begins[index], leaf_begins[index + 1] - leaf_begins[index]);
  }
};

// By the surface area heuristic, straight into nodes of eight. Leaves hold up to `leaf_size` primitives: 1, 2 or 4. A
// primitive may have several references. The same for any number of threads.
[[nodiscard]] TreeLayout build_sah_layout(HugeVector<Reference> references, int leaf_size, int most_bins,
                                          WorkerPool& pool, WorkProgress* progress);

// Collapses a binary tree, opening the child with the largest surface until there are eight.
[[nodiscard]] TreeLayout collapse_to_layout(const Bvh& bvh, std::span<const Bounds3f> boxes, int leaf_size,
                                            WorkProgress* progress);

// Over boxes of anything, none of which may be empty, as `config` says. The same for any number of threads.
[[nodiscard]] TreeLayout build_box_layout(std::span<const Bounds3f> boxes, const BvhConfig& config);

}  // namespace basicrt
