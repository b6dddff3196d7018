// SPDX-License-Identifier: GPL-3.0-or-later
// Splits by the surface area heuristic, straight into nodes of eight: all threads build the uppermost nodes together,
// then each builds subtrees.
#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "base/assert.h"
#include "base/worker_pool.h"
#include "bvh/node_order.h"
#include "bvh/splitter.h"
#include "bvh/tree_layout.h"
#include "bvh/treelet.h"

namespace basicrt {
namespace {

// All numbers here are the same for any number of threads, and so is the tree.
constexpr std::uint32_t subtree_size = 16384;  // smaller subtrees are built by one thread
constexpr std::uint32_t treelet_leaves = 256;  // parts of no more than so many full leaves become treelets
// Deeper parts are halved by number, which ends within 12 more levels of nodes, or 8 of a treelet.
constexpr int deepest_sah_node = 48, deepest_treelet = 40, deepest_sah_split = 14;

// Part of a tree, in an order of its own.
struct Subtree {
  std::vector<TreeNode> nodes;  // leaves are counted from 0
  std::vector<std::uint32_t> leaf_begins;
  TreeReference root = no_reference;
};

// Where a subtree hangs.
struct Branch {
  Part part;
  std::uint32_t node;
  int child, depth;
};

// Builds nodes top down. Those of the uppermost levels leave subtrees for others to build.
class NodeBuilder {
 public:
  // Leaves parts that are small enough as `branches`, where it gets that.
  NodeBuilder(Workspace& workspace, WorkerPool& pool, std::vector<Branch>* branches)
      : workspace_(workspace), splitter_(workspace, pool), branches_(branches) {}

  Subtree build(const Part& part, int depth) {
    subtree_.root = build_part(part, depth);
    return std::move(subtree_);
  }

 private:
  TreeReference build_part(const Part& part, int depth) {
    if (part.count() <= workspace_.leaf_size) {
      workspace_.report_work(std::uint64_t{part.count()} * small_part_work);
      return add_leaf(part);
    }
    if (depth <= deepest_treelet && part.count() <= treelet_leaves * workspace_.leaf_size) {
      workspace_.report_work(std::uint64_t{part.count()} * small_part_work);
      treelet_.clear();
      return build_node_of(add_to_treelet(part, 0));
    }
    BASICRT_ASSERT(depth < max_tree_depth);
    Part parts[8] = {part};
    const int count = open(parts, depth >= deepest_sah_node);

    const auto index = static_cast<std::uint32_t>(subtree_.nodes.size());
    subtree_.nodes.emplace_back();
    for (int child = 0; child < 8; ++child)
      set_bounds(subtree_.nodes[index], child, child < count ? parts[child].extents.box : Box());
    for (int child = 0; child < 8; ++child) {
      TreeReference reference = no_reference;
      if (child < count) {
        if (branches_ && parts[child].count() <= subtree_size) {
          branches_->push_back({.part = parts[child], .node = index, .child = child, .depth = depth + 1});
          reference = triangles_mark;  // until join()
        } else {
          reference = build_part(parts[child], depth + 1);
        }
      }
      subtree_.nodes[index].children[child] = reference;
    }
    set_order(subtree_.nodes[index]);
    return index;
  }

  // Splits the first part into up to eight, in the order of their primitives. Returns how many.
  int open(Part (&parts)[8], bool by_number) {
    float sizes[8] = {1};
    int count = 1;
    while (count < 8) {
      const int largest = static_cast<int>(std::max_element(sizes, sizes + count) - sizes);
      if (!(sizes[largest] >= 0)) break;
      const auto [left, right] = by_number ? splitter_.halve(parts[largest]) : splitter_.split(parts[largest]);
      std::copy_backward(parts + largest + 1, parts + count, parts + count + 1);
      std::copy_backward(sizes + largest + 1, sizes + count, sizes + count + 1);
      parts[largest] = left;
      parts[largest + 1] = right;
      for (const int i : {largest, largest + 1}) sizes[i] = size_of(parts[i], by_number);
      ++count;
    }
    return count;
  }

  // By which the next part to open is chosen; negative where it is a leaf.
  float size_of(const Part& part, bool by_number) const {
    if (part.count() <= workspace_.leaf_size) return -1;
    return by_number ? static_cast<float>(part.count()) : workspace_.half_area(part.extents.box);
  }

  static void set_bounds(TreeNode& node, int child, const Box& box) {
    const Bounds3f bounds = box.bounds();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      node.bounds[axis][0][child] = bounds.lower[axis];
      node.bounds[axis][1][child] = bounds.upper[axis];
    }
  }

  // Builds a binary tree.
  std::uint32_t add_to_treelet(const Part& part, int depth) {
    const float area = workspace_.half_area(part.extents.box);
    if (part.count() <= workspace_.leaf_size) {
      write_primitives(part);
      return treelet_.add_leaf(part.extents.box, area, part.begin, part.count());
    }
    const auto [left, right] = depth < deepest_sah_split ? splitter_.split(part) : splitter_.halve(part);
    const std::uint32_t left_node = add_to_treelet(left, depth + 1);
    return treelet_.add_node(part.extents.box, area, left_node, add_to_treelet(right, depth + 1));
  }

  // From a node of the binary tree.
  TreeReference build_node_of(std::uint32_t root) {
    if (treelet_[root].is_leaf()) return add_leaf(treelet_[root].begin);
    std::array<std::uint32_t, 8> children;
    const int count = treelet_.find_children(root, children);
    const auto index = static_cast<std::uint32_t>(subtree_.nodes.size());
    subtree_.nodes.emplace_back();
    for (int child = 0; child < 8; ++child)
      set_bounds(subtree_.nodes[index], child, child < count ? treelet_[children[child]].box : Box());
    for (int child = 0; child < 8; ++child) {
      const TreeReference reference = child < count ? build_node_of(children[child]) : no_reference;
      subtree_.nodes[index].children[child] = reference;
    }
    set_order(subtree_.nodes[index]);
    return index;
  }

  TreeReference add_leaf(const Part& part) {
    write_primitives(part);
    return add_leaf(part.begin);
  }
  TreeReference add_leaf(std::uint32_t begin) {
    subtree_.leaf_begins.push_back(begin);
    return triangles_mark | static_cast<TreeReference>(subtree_.leaf_begins.size() - 1);
  }
  void write_primitives(const Part& part) {
    std::uint32_t* const leaf = workspace_.primitives.data() + part.begin;
    std::uint32_t count = 0;
    for (const Reference& reference : workspace_.references(part)) {
      const std::uint32_t primitive = reference.primitive();
      std::uint32_t place = count++;
      for (; place > 0 && leaf[place - 1] > primitive; --place) leaf[place] = leaf[place - 1];
      leaf[place] = primitive;
    }
    // Of several references to one primitive the first stays; the others repeat the last primitive.
    std::uint32_t* const end = std::unique(leaf, leaf + count);
    std::fill(end, leaf + count, end[-1]);
  }

  Workspace& workspace_;
  Splitter splitter_;
  std::vector<Branch>* branches_;
  Treelet treelet_;
  Subtree subtree_;
};

bool is_leaf(TreeReference reference) { return (reference & triangles_mark) != 0; }

// Joins subtrees to the nodes above them.
TreeLayout join(Subtree top, const std::vector<Branch>& branches, std::vector<Subtree> subtrees, Workspace& workspace,
                WorkerPool& pool) {
  TreeLayout layout;
  std::vector<std::uint32_t> first_nodes{static_cast<std::uint32_t>(top.nodes.size())}, first_leaves{0};
  for (const Subtree& subtree : subtrees) {
    first_nodes.push_back(first_nodes.back() + static_cast<std::uint32_t>(subtree.nodes.size()));
    first_leaves.push_back(first_leaves.back() + static_cast<std::uint32_t>(subtree.leaf_begins.size()));
  }
  BASICRT_ASSERT(first_nodes.back() < reference_index && first_leaves.back() < reference_index);
  layout.nodes.resize(first_nodes.back());
  layout.leaf_begins.resize(first_leaves.back() + 1);
  layout.leaf_begins.back() = static_cast<std::uint32_t>(workspace.primitives.size());
  std::copy(top.nodes.begin(), top.nodes.end(), layout.nodes.begin());
  layout.root = top.root;

  pool.for_each(subtrees.size(), [&](std::size_t i) {
    const auto moved = [&](TreeReference reference) {
      if (reference == no_reference) return reference;
      return reference + (is_leaf(reference) ? first_leaves[i] : first_nodes[i]);
    };
    Subtree subtree = std::move(subtrees[i]);
    for (TreeNode& node : subtree.nodes)
      for (TreeReference& child : node.children) child = moved(child);
    std::copy(subtree.nodes.begin(), subtree.nodes.end(), layout.nodes.begin() + first_nodes[i]);
    std::copy(subtree.leaf_begins.begin(), subtree.leaf_begins.end(), layout.leaf_begins.begin() + first_leaves[i]);
    TreeReference& hook = top.nodes.empty() ? layout.root : layout.nodes[branches[i].node].children[branches[i].child];
    hook = moved(subtree.root);
  });
  layout.primitives = std::move(workspace.primitives);
  return layout;
}

}  // namespace

TreeLayout build_sah_layout(HugeVector<Reference> references, int leaf_size, int most_bins, WorkerPool& pool,
                            WorkProgress* progress) {
  BASICRT_ASSERT(leaf_size == 1 || leaf_size == 2 || leaf_size == 4);
  if (references.empty()) return {};
  Workspace workspace{.leaf_size = static_cast<std::uint32_t>(leaf_size), .most_bins = most_bins, .progress = progress};
  workspace.primitives.resize(references.size());
  workspace.buffers[1].resize(references.size());
  workspace.buffers[0] = std::move(references);

  const Part root = Splitter(workspace, pool).root();
  std::vector<Branch> branches;
  Subtree top;
  if (root.count() <= subtree_size)
    branches.push_back({.part = root, .node = 0, .child = 0, .depth = 0});
  else
    top = NodeBuilder(workspace, pool, &branches).build(root, 0);

  std::vector<Subtree> subtrees(branches.size());
  pool.for_each(branches.size(), [&](std::size_t i) {
    WorkerPool alone(1);
    subtrees[i] = NodeBuilder(workspace, alone, nullptr).build(branches[i].part, branches[i].depth);
  });
  for (HugeVector<Reference>& buffer : workspace.buffers) buffer = {};
  TreeLayout layout = join(std::move(top), branches, std::move(subtrees), workspace, pool);
  layout.bounds = root.extents.box.bounds();
  return layout;
}

}  // namespace basicrt
