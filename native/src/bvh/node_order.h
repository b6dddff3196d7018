// SPDX-License-Identifier: GPL-3.0-or-later
// The order in which rays visit the children of a node.
#pragma once

#include "bvh/tree.h"

namespace basicrt {

// Fills in TreeNode::order from the bounds of the children that are in use.
void set_order(TreeNode& node);

}  // namespace basicrt
