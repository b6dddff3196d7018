// SPDX-License-Identifier: GPL-3.0-or-later
// A shape made ready for rays, in its own space.
#pragma once

#include <variant>

#include "bvh/bvh.h"
#include "bvh/mesh_tree.h"
#include "bvh/round_trees.h"
#include "geometry/shape.h"

namespace basicrt {

// Keeps no pointer to the shape it was built from.
struct ShapeTree {
  std::variant<MeshTree, MovingMeshTree, Sphere, PointTree, CurveTree> geometry;
  Bounds3f bounds;  // empty where there is nothing to hit
};

[[nodiscard]] ShapeTree build_shape_tree(const Shape& shape, const BvhConfig& config);

}  // namespace basicrt
