// SPDX-License-Identifier: GPL-3.0-or-later
// Builds the trees of shapes.
#include "bvh/shape_tree.h"

#include "base/overloaded.h"

namespace basicrt {

ShapeTree build_shape_tree(const Shape& shape, const BvhConfig& config) {
  return std::visit(Overloaded{[&](const Mesh& mesh) {
                                 if (mesh.is_deforming()) {
                                   MovingMeshTree tree = build_moving_mesh_tree(mesh, config);
                                   const Bounds3f bounds = tree.bounds;
                                   return ShapeTree{std::move(tree), bounds};
                                 }
                                 MeshTree tree = build_mesh_tree(mesh, config);
                                 const Bounds3f bounds = tree.tree.bounds;
                                 return ShapeTree{std::move(tree), bounds};
                               },
                               [&](const Sphere& sphere) { return ShapeTree{sphere, bounds(shape)}; },
                               [&](const PointCloud& cloud) {
                                 PointTree tree = build_point_tree(cloud, config);
                                 const Bounds3f bounds = tree.boxes.tree.bounds;
                                 return ShapeTree{std::move(tree), bounds};
                               },
                               [&](const Curves& curves) {
                                 CurveTree tree = build_curve_tree(curves, config);
                                 const Bounds3f bounds = tree.boxes.tree.bounds;
                                 return ShapeTree{std::move(tree), bounds};
                               }},
                    shape);
}

}  // namespace basicrt
