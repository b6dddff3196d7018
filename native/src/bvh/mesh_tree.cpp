// SPDX-License-Identifier: GPL-3.0-or-later
// Boxes of triangles and instances go to a builder; blocks are filled in from the leaves that come back.
#include "bvh/mesh_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/assert.h"
#include "base/worker_pool.h"
#include "bvh/cut_references.h"
#include "bvh/node_order.h"
#include "bvh/split_bins.h"
#include "bvh/tree_access.h"
#include "bvh/tree_layout.h"
#include "math/next_float.h"

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

// Over boxes that no builder may cut: bounds_of(i) is the one of triangle i.
template <class BoundsOf>
TreeLayout build_layout_over(std::size_t count, const BoundsOf& bounds_of, const BvhConfig& config, WorkerPool& pool) {
  BASICRT_ASSERT(count < Reference::most_primitives);
  if (config.builder == BvhBuilder::median) {
    std::vector<Bounds3f> boxes(count);
    for_each(pool, config.progress, count, [&](std::size_t i) { boxes[i] = bounds_of(static_cast<std::uint32_t>(i)); });
    return collapse_to_layout(build_median_bvh(boxes, config), boxes, block_size, config.progress);
  }
  HugeVector<Reference> references(count);
  for_each(pool, config.progress, count, [&](std::size_t i) {
    references[i] = Reference(bounds_of(static_cast<std::uint32_t>(i)), static_cast<std::uint32_t>(i));
  });
  const int bins = config.builder == BvhBuilder::split_sah ? fine_bins : coarse_bins;
  return build_sah_layout(std::move(references), config.leaf_size, bins, pool, config.progress);
}

TreeLayout build_layout(const Mesh& mesh, const BvhConfig& config, WorkerPool& pool) {
  const std::size_t count = mesh.triangles.size();
  BASICRT_ASSERT(count < Reference::most_primitives);
  if (config.builder == BvhBuilder::split_sah) {
    const auto most_cuts = static_cast<std::size_t>(cut_budget * static_cast<double>(count));
    return build_sah_layout(cut_references(mesh, most_cuts, pool, config.progress), block_size, fine_bins, pool,
                            config.progress);
  }
  return build_layout_over(
      count, [&](std::uint32_t triangle) { return triangle_bounds(mesh, triangle); }, config, pool);
}

// Of a triangle from one key to the next. Interpolating rounds: each of three operations by half a unit in the last
// place of twice the largest coordinate at most, for which this has room.
Bounds3f moving_bounds(const Mesh& mesh, std::uint32_t triangle, std::size_t first_key) {
  Bounds3f box;
  for (const std::uint32_t vertex : mesh.triangles[triangle])
    for (const std::size_t key : {first_key, first_key + 1}) box.extend(mesh.positions_of_key(key)[vertex]);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float padding = std::max(std::abs(box.lower[axis]), std::abs(box.upper[axis])) * 0x1p-21f;
    box.lower[axis] = next_float_down(box.lower[axis] - padding);
    box.upper[axis] = next_float_up(box.upper[axis] + padding);
  }
  return box;
}

template <std::size_t lanes>
void set_corner(float (&corner)[3][lanes], std::size_t lane, Vec3f position) {
  for (std::size_t axis = 0; axis < 3; ++axis) corner[axis][lane] = position[axis];
}
void set_corners(TriangleBlock& block, std::size_t lane, const Mesh& mesh) {
  for (int corner = 0; corner < 3; ++corner)
    set_corner(block.corners[corner], lane, mesh.position(block.primitives[lane], corner));
}
void set_corners(MovingTriangleBlock& block, std::size_t lane, const Mesh& mesh, std::size_t first_key) {
  const auto& vertices = mesh.triangles[block.primitives[lane]];
  for (std::size_t end = 0; end < 2; ++end)
    for (std::size_t corner = 0; corner < 3; ++corner)
      set_corner(block.corners[end][corner], lane, mesh.positions_of_key(first_key + end)[vertices[corner]]);
}

// Calls place(lane) for each lane, after it has its triangle.
template <class Block, class Place>
void fill(Block& block, std::span<const std::uint32_t> leaf, const Place& place) {
  std::array<std::uint32_t, block_size> triangles;
  triangles.fill(Reference::most_primitives);  // sorts last
  std::copy(leaf.begin(), leaf.end(), triangles.begin());
  std::sort(triangles.begin(), triangles.end());
  for (std::size_t lane = 0; lane < block_size; ++lane) {
    const std::uint32_t triangle = triangles[std::min(lane, leaf.size() - 1)];
    block.primitives[lane] = triangle;
    place(lane);
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
  for_each(pool, config.progress, result.blocks.size(), [&](std::size_t i) {
    fill(result.blocks[i], layout.leaf(i), [&](std::size_t lane) { set_corners(result.blocks[i], lane, mesh); });
  });
  return result;
}

MovingMeshTree build_moving_mesh_tree(const Mesh& mesh, const BvhConfig& config) {
  WorkerPool pool = make_pool(mesh.triangles.size(), config);
  const auto as_moving = [](TreeReference reference) {
    const bool is_leaf = reference != no_reference && (reference & triangles_mark) != 0;
    return is_leaf ? moving_triangles_mark | (reference & reference_index) : reference;
  };
  MovingMeshTree result;
  for (std::size_t first_key = 0; first_key < mesh.motion_intervals(); ++first_key) {
    const auto bounds_of = [&](std::uint32_t triangle) { return moving_bounds(mesh, triangle, first_key); };
    TreeLayout layout = build_layout_over(mesh.triangles.size(), bounds_of, config, pool);
    for (TreeNode& node : layout.nodes)
      for (TreeReference& child : node.children) child = as_moving(child);
    MovingMeshTree::Interval& added = result.intervals.emplace_back();
    added.tree = {std::move(layout.nodes), as_moving(layout.root), layout.bounds};
    added.blocks.resize(layout.leaf_count());
    for_each(pool, config.progress, added.blocks.size(), [&](std::size_t i) {
      fill(added.blocks[i], layout.leaf(i),
           [&](std::size_t lane) { set_corners(added.blocks[i], lane, mesh, first_key); });
    });
    result.bounds.extend(layout.bounds);
  }
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

TreeLayout build_box_layout(std::span<const Bounds3f> boxes, const BvhConfig& config) {
  WorkerPool pool = make_pool(boxes.size(), config);
  return build_layout_over(boxes.size(), [&](std::uint32_t i) { return boxes[i]; }, config, pool);
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
