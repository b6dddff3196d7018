// SPDX-License-Identifier: GPL-3.0-or-later
// Looks for faults in the trees that rays walk, for tests and for hunting bugs.
#pragma once

#include <span>
#include <string>

#include "bvh/mesh_tree.h"

namespace basicrt {

// What is wrong with the tree, or an empty string: every triangle in exactly one lane of one block, everything inside
// the boxes above it, references in range and each used once, order a permutation, the tree not too deep.
[[nodiscard]] std::string find_tree_fault(const MeshTree& tree, const Mesh& mesh);

// The same where triangles may be cut: each is in one block or more, and the boxes of these cover it, as far as points
// picked at random tell.
[[nodiscard]] std::string find_cut_tree_fault(const MeshTree& tree, const Mesh& mesh);

// The same for a tree over boxes, of which empty ones are left out.
[[nodiscard]] std::string find_tree_fault(const NodeTree& tree, std::span<const Bounds3f> boxes);

}  // namespace basicrt
