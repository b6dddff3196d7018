// SPDX-License-Identifier: GPL-3.0-or-later
// Boxes of triangles and instances go to a builder; blocks are filled in from the leaves that come back.
#include "bvh/mesh_tree.h"

#include <algorithm>
#include <array>
#include <vector>

#include "base/assert.h"
#include "base/worker_pool.h"
#include "bvh/tree_layout.h"

namespace basicrt {
namespace {

constexpr std::size_t block_size = 4;
constexpr std::size_t chunk_size = 8192;  // triangles or blocks that a thread does at a time

// Calls work(i) for each i in [0, count), on all threads.
template <class Work>
void for_each(WorkerPool& pool, std::size_t count, const Work& work) {
  pool.for_each((count + chunk_size - 1) / chunk_size, [&](std::size_t chunk) {
    const std::size_t end = std::min(count, (chunk + 1) * chunk_size);
    for (std::size_t i = chunk * chunk_size; i < end; ++i) work(i);
  });
}

Bounds3f bounds_of(const Mesh& mesh, std::size_t triangle) {
  Bounds3f box;
  for (int corner = 0; corner < 3; ++corner) box.extend(mesh.position(static_cast<std::uint32_t>(triangle), corner));
  return box;
}

TreeLayout build_layout(const Mesh& mesh, const BvhConfig& config, WorkerPool& pool) {
  const std::size_t count = mesh.triangles.size();
  BASICRT_ASSERT(count < Reference::most_primitives);
  if (config.builder == BvhBuilder::median) {
    std::vector<Bounds3f> boxes(count);
    for_each(pool, count, [&](std::size_t i) { boxes[i] = bounds_of(mesh, i); });
    return collapse_to_layout(build_median_bvh(boxes, config.max_depth), boxes, block_size);
  }
  HugeVector<Reference> references(count);
  for_each(pool, count,
           [&](std::size_t i) { references[i] = Reference(bounds_of(mesh, i), static_cast<std::uint32_t>(i)); });
  return build_sah_layout(std::move(references), config.leaf_size, pool);
}

void fill(TriangleBlock& block, const Mesh& mesh, std::span<const std::uint32_t> leaf) {
  std::array<std::uint32_t, block_size> triangles;
  triangles.fill(Reference::most_primitives);  // sorts last
  std::copy(leaf.begin(), leaf.end(), triangles.begin());
  std::sort(triangles.begin(), triangles.end());
  for (std::size_t lane = 0; lane < block_size; ++lane) {
    const std::uint32_t triangle = triangles[std::min(lane, leaf.size() - 1)];
    block.primitives[lane] = triangle;
    for (int corner = 0; corner < 3; ++corner) {
      const Vec3f position = mesh.position(triangle, corner);
      for (std::size_t axis = 0; axis < 3; ++axis) block.corners[corner][axis][lane] = position[axis];
    }
  }
}

}  // namespace

MeshTree build_mesh_tree(const Mesh& mesh, const BvhConfig& config) {
  WorkerPool pool(config.threads);
  TreeLayout layout = build_layout(mesh, config, pool);
  MeshTree result{.tree = {std::move(layout.nodes), layout.root, layout.bounds}, .blocks = {}};
  result.blocks.resize(layout.leaf_count());
  for_each(pool, result.blocks.size(), [&](std::size_t i) { fill(result.blocks[i], mesh, layout.leaf(i)); });
  return result;
}

NodeTree build_instance_tree(std::span<const Bounds3f> boxes, const BvhConfig& config) {
  WorkerPool pool(config.threads);
  std::vector<Bounds3f> filled;
  std::vector<std::uint32_t> indices;
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    if (boxes[i].is_empty()) continue;
    filled.push_back(boxes[i]);
    indices.push_back(i);
  }
  TreeLayout layout;
  if (config.builder == BvhBuilder::median) {
    layout = collapse_to_layout(build_median_bvh(filled, config.max_depth), filled, 1);
  } else {
    HugeVector<Reference> references;
    for (std::uint32_t i = 0; i < filled.size(); ++i) references.emplace_back(filled[i], i);
    layout = build_sah_layout(std::move(references), 1, pool);
  }
  const auto as_instance = [&](TreeReference reference) {
    if (reference == no_reference || !(reference & triangles_mark)) return reference;
    return instance_mark | indices[layout.leaf(reference & reference_index)[0]];
  };
  for (TreeNode& node : layout.nodes)
    for (TreeReference& child : node.children) child = as_instance(child);
  return {std::move(layout.nodes), as_instance(layout.root), layout.bounds};
}

}  // namespace basicrt
