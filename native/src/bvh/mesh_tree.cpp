// SPDX-License-Identifier: GPL-3.0-or-later
// Boxes of triangles and instances go to a builder; blocks are filled in from the leaves that come back.
#include "bvh/mesh_tree.h"

#include <algorithm>
#include <array>
#include <vector>

#include "base/assert.h"
#include "base/worker_pool.h"
#include "bvh/cut_references.h"
#include "bvh/node_order.h"
#include "bvh/split_bins.h"
#include "bvh/tree_access.h"
#include "bvh/tree_layout.h"

namespace basicrt {
namespace {

constexpr std::size_t block_size = 4;
constexpr int coarse_bins = 16, fine_bins = SplitBins::most_bins;
constexpr double cut_budget = 0.3;        // cuts for each triangle, on average
constexpr std::size_t chunk_size = 8192;  // triangles or blocks that a thread does at a time

// Threads are not worth starting for less.
WorkerPool make_pool(std::size_t primitives, const BvhConfig& config) {
  return WorkerPool(primitives < 2 * chunk_size ? 1 : config.threads);
}

// Calls work(i) for each i in [0, count), on all threads.
template <class Work>
void for_each(WorkerPool& pool, WorkProgress* progress, std::size_t count, const Work& work) {
  pool.for_each((count + chunk_size - 1) / chunk_size, [&](std::size_t chunk) {
    const std::size_t end = std::min(count, (chunk + 1) * chunk_size);
    if (progress != nullptr) progress->advance(end - chunk * chunk_size);
    for (std::size_t i = chunk * chunk_size; i < end; ++i) work(i);
  });
}

TreeLayout build_layout(const Mesh& mesh, const BvhConfig& config, WorkerPool& pool) {
  const std::size_t count = mesh.triangles.size();
  BASICRT_ASSERT(count < Reference::most_primitives);
  if (config.builder == BvhBuilder::median) {
    std::vector<Bounds3f> boxes(count);
    for_each(pool, config.progress, count,
             [&](std::size_t i) { boxes[i] = triangle_bounds(mesh, static_cast<std::uint32_t>(i)); });
    return collapse_to_layout(build_median_bvh(boxes, config), boxes, block_size, config.progress);
  }
  if (config.builder == BvhBuilder::split_sah) {
    const auto most_cuts = static_cast<std::size_t>(cut_budget * static_cast<double>(count));
    return build_sah_layout(cut_references(mesh, most_cuts, pool, config.progress), block_size, fine_bins, pool,
                            config.progress);
  }
  HugeVector<Reference> references(count);
  for_each(pool, config.progress, count, [&](std::size_t i) {
    references[i] = Reference(triangle_bounds(mesh, static_cast<std::uint32_t>(i)), static_cast<std::uint32_t>(i));
  });
  return build_sah_layout(std::move(references), config.leaf_size, coarse_bins, pool, config.progress);
}

void set_corners(TriangleBlock& block, std::size_t lane, const Mesh& mesh) {
  for (int corner = 0; corner < 3; ++corner) {
    const Vec3f position = mesh.position(block.primitives[lane], corner);
    for (std::size_t axis = 0; axis < 3; ++axis) block.corners[corner][axis][lane] = position[axis];
  }
}

void fill(TriangleBlock& block, const Mesh& mesh, std::span<const std::uint32_t> leaf) {
  std::array<std::uint32_t, block_size> triangles;
  triangles.fill(Reference::most_primitives);  // sorts last
  std::copy(leaf.begin(), leaf.end(), triangles.begin());
  std::sort(triangles.begin(), triangles.end());
  for (std::size_t lane = 0; lane < block_size; ++lane) {
    const std::uint32_t triangle = triangles[std::min(lane, leaf.size() - 1)];
    block.primitives[lane] = triangle;
    set_corners(block, lane, mesh);
  }
}

Bounds3f bounds_of(const TreeNode& node) {
  Bounds3f box;
  for (std::size_t child = 0; child < 8; ++child) box.extend(child_bounds(node, child));
  return box;
}

// From the last node to the first, so that children come before their parents. Returns the bounds of it all.
Bounds3f refit_nodes(NodeTree& tree, std::span<const Bounds3f> block_bounds) {
  const auto bounds_at = [&](TreeReference reference) {
    if (reference == no_reference) return Bounds3f();
    return reference & triangles_mark ? block_bounds[reference & reference_index] : bounds_of(tree.nodes[reference]);
  };
  for (std::size_t i = tree.nodes.size(); i-- > 0;) {
    TreeNode& node = tree.nodes[i];
    for (std::size_t child = 0; child < 8; ++child) set_child_bounds(node, child, bounds_at(node.children[child]));
    set_order(node);
  }
  return bounds_at(tree.root);
}

}  // namespace

MeshTree build_mesh_tree(const Mesh& mesh, const BvhConfig& config) {
  WorkerPool pool = make_pool(mesh.triangles.size(), config);
  TreeLayout layout = build_layout(mesh, config, pool);
  MeshTree result{.tree = {std::move(layout.nodes), layout.root, layout.bounds}, .blocks = {}};
  result.blocks.resize(layout.leaf_count());
  for_each(pool, config.progress, result.blocks.size(),
           [&](std::size_t i) { fill(result.blocks[i], mesh, layout.leaf(i)); });
  return result;
}

void refit(MeshTree& tree, const Mesh& mesh, int threads) {
  WorkerPool pool = make_pool(mesh.triangles.size(), {.threads = threads});
  std::vector<Bounds3f> block_bounds(tree.blocks.size());
  for_each(pool, nullptr, tree.blocks.size(), [&](std::size_t i) {
    TriangleBlock& block = tree.blocks[i];
    for (std::size_t lane = 0; lane < block_size; ++lane) {
      set_corners(block, lane, mesh);
      block_bounds[i].extend(triangle_bounds(mesh, block.primitives[lane]));
    }
  });
  tree.tree.bounds = refit_nodes(tree.tree, block_bounds);
}

NodeTree build_instance_tree(std::span<const Bounds3f> boxes, const BvhConfig& config) {
  WorkerPool pool = make_pool(boxes.size(), config);
  std::vector<Bounds3f> filled;
  std::vector<std::uint32_t> indices;
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    if (boxes[i].is_empty()) continue;
    filled.push_back(boxes[i]);
    indices.push_back(i);
  }
  TreeLayout layout;
  if (config.builder == BvhBuilder::median) {
    layout = collapse_to_layout(build_median_bvh(filled, config), filled, 1, config.progress);
  } else {
    HugeVector<Reference> references;
    for (std::uint32_t i = 0; i < filled.size(); ++i) references.emplace_back(filled[i], i);
    layout = build_sah_layout(std::move(references), 1, fine_bins, pool, config.progress);
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
