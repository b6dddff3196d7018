// SPDX-License-Identifier: GPL-3.0-or-later
// Builds the trees of shapes.
#include "bvh/shape_tree.h"

#include <span>

#include "base/overloaded.h"

namespace basicrt {
namespace {

// Copies a leaf's triangles, two by two.
WideReference add_pairs(std::vector<TrianglePair>& pairs, const Mesh& mesh, std::span<const std::uint32_t> leaf) {
  const auto first = static_cast<std::uint32_t>(pairs.size());
  for (std::size_t i = 0; i < leaf.size(); ++i) {
    const std::uint32_t triangle = leaf[i];
    if (i % 2 == 0) pairs.emplace_back();
    pairs.back().set(i % 2, triangle,
                     {mesh.position(triangle, 0), mesh.position(triangle, 1), mesh.position(triangle, 2)});
  }
  return {first, static_cast<std::uint32_t>(pairs.size()) - first};
}

MeshTree build_mesh_tree(const Mesh& mesh, const BvhConfig& config) {
  std::vector<Bounds3f> boxes(mesh.triangles.size());
  for (std::uint32_t triangle = 0; triangle < boxes.size(); ++triangle)
    for (int corner = 0; corner < 3; ++corner) boxes[triangle].extend(mesh.position(triangle, corner));
  const Bvh bvh = build_bvh(boxes, config);
  MeshTree tree;
  tree.pairs.reserve(boxes.size() / 2);
  tree.bvh =
      WideBvhBuilder(bvh).build([&](std::span<const std::uint32_t> leaf) { return add_pairs(tree.pairs, mesh, leaf); });
  return tree;
}

}  // namespace

ShapeTree build_shape_tree(const Shape& shape, const BvhConfig& config) {
  return std::visit(Overloaded{[&](const Mesh& mesh) {
                                 MeshTree tree = build_mesh_tree(mesh, config);
                                 const Bounds3f bounds = tree.bvh.bounds;
                                 return ShapeTree{std::move(tree), bounds};
                               },
                               [&](const Sphere& sphere) { return ShapeTree{sphere, bounds(shape)}; }},
                    shape);
}

}  // namespace basicrt
