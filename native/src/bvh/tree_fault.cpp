// SPDX-License-Identifier: GPL-3.0-or-later
// Walks the tree, which may be wrong in any way, and stops at the first fault.
#include "bvh/tree_fault.h"

#include <algorithm>
#include <functional>
#include <random>
#include <vector>

#include "bvh/tree_access.h"

namespace basicrt {
namespace {

bool is_same_position(Vec3f a, Vec3f b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

bool is_leaf(TreeReference reference) { return (reference & triangles_mark) != 0; }

class FaultFinder {
 public:
  // check_leaf(reference, box) returns what is wrong with a leaf inside that box.
  using CheckLeaf = std::function<std::string(TreeReference, const Bounds3f&)>;

  FaultFinder(const NodeTree& tree, CheckLeaf check_leaf)
      : tree_(tree), check_leaf_(std::move(check_leaf)), is_reached_(tree.nodes.size()) {}

  std::string find() {
    if (tree_.root != no_reference) visit(tree_.root, tree_.bounds, 0, 0);
    for (std::size_t i = 0; i < is_reached_.size(); ++i)
      if (!is_reached_[i]) report("node " + std::to_string(i) + ": has no parent");
    return fault_;
  }

 private:
  void report(const std::string& fault) {
    if (fault_.empty()) fault_ = fault;
  }

  void visit(TreeReference reference, const Bounds3f& box, TreeReference parent, int depth) {
    if (!fault_.empty()) return;
    if (is_leaf(reference)) return report(check_leaf_(reference, box));
    const std::string name = "node " + std::to_string(reference) + ": ";
    if (reference >= tree_.nodes.size()) return report(name + "does not exist");
    if (is_reached_[reference]) return report(name + "has two parents");
    if (depth >= max_tree_depth) return report(name + "is too deep");
    if (depth > 0 && reference <= parent) report(name + "comes before its parent");
    is_reached_[reference] = true;
    const TreeNode& node = tree_.nodes[reference];
    check_order(node, name);
    for (std::size_t child = 0; child < 8; ++child) {
      const Bounds3f child_box = child_bounds(node, child);
      if (node.children[child] == no_reference) {
        if (!(child_box.lower.x > child_box.upper.x)) report(name + "an unused child is not empty");
      } else {
        if (!box.contains(child_box) || child_box.is_empty()) report(name + "a child is not inside its parent");
        visit(node.children[child], child_box, reference, depth + 1);
      }
    }
  }

  void check_order(const TreeNode& node, const std::string& name) {
    for (int octant = 0; octant < 8; ++octant) {
      unsigned seen = 0;
      bool is_used_before = false;
      for (const std::uint32_t order : node.order) {
        const std::uint32_t child = order >> (3 * octant) & 7;
        seen |= 1u << child;
        const bool is_used = node.children[child] != no_reference;
        if (is_used_before && !is_used) report(name + "an unused child comes after others");
        is_used_before = is_used;
      }
      if (seen != 255) report(name + "the order is no permutation");
    }
  }

  const NodeTree& tree_;
  CheckLeaf check_leaf_;
  std::vector<bool> is_reached_;
  std::string fault_;
};

// Which primitives were seen, and how often.
class Uses {
 public:
  explicit Uses(std::size_t count) : uses_(count) {}
  // Returns what is wrong.
  std::string add(std::uint32_t primitive) {
    if (primitive >= uses_.size()) return "primitive " + std::to_string(primitive) + ": does not exist";
    ++uses_[primitive];
    return {};
  }
  template <class Expected>
  std::string find_fault(const Expected& expected) const {
    for (std::size_t i = 0; i < uses_.size(); ++i)
      if (uses_[i] != expected(i))
        return "primitive " + std::to_string(i) + ": is in " + std::to_string(uses_[i]) + " leaves";
    return {};
  }

 private:
  std::vector<unsigned> uses_;
};

// Calls visit(triangle) for each lane in use. Returns what is wrong.
template <class Visit>
std::string check_block(const TriangleBlock& block, const Mesh& mesh, const Visit& visit) {
  for (std::size_t lane = 0; lane < 4; ++lane) {
    const std::uint32_t triangle = block.primitives[lane];
    const bool is_missing = lane > 0 && triangle == block.primitives[lane - 1];
    const bool was_missing = lane > 1 && block.primitives[lane - 1] == block.primitives[lane - 2];
    const std::string name = "primitive " + std::to_string(triangle) + ": ";
    if (was_missing && !is_missing) return name + "comes after a missing one";
    if (lane > 0 && triangle < block.primitives[lane - 1]) return name + "is not in ascending order";
    if (triangle >= mesh.triangles.size()) return name + "does not exist";
    for (int corner = 0; corner < 3; ++corner) {
      const Vec3f position = corner_of(block, lane, corner);
      if (!is_same_position(position, mesh.position(triangle, corner))) return name + "is not where the mesh has it";
    }
    if (!is_missing)
      if (std::string fault = visit(triangle); !fault.empty()) return fault;
  }
  return {};
}

// Checks the nodes, and blocks with visit(triangle, box).
template <class Visit>
std::string check_mesh_tree(const MeshTree& tree, const Mesh& mesh, const Visit& visit) {
  std::vector<bool> is_reached(tree.blocks.size());
  const auto check_leaf = [&](TreeReference reference, const Bounds3f& box) -> std::string {
    const std::uint32_t index = reference & reference_index;
    const std::string name = "block " + std::to_string(index) + ": ";
    if ((reference & ~reference_index) != triangles_mark || index >= tree.blocks.size()) return name + "does not exist";
    if (is_reached[index]) return name + "has two parents";
    is_reached[index] = true;
    return check_block(tree.blocks[index], mesh, [&](std::uint32_t triangle) { return visit(triangle, box); });
  };
  if (std::string fault = FaultFinder(tree.tree, check_leaf).find(); !fault.empty()) return fault;
  for (std::size_t i = 0; i < is_reached.size(); ++i)
    if (!is_reached[i]) return "block " + std::to_string(i) + ": has no parent";
  return {};
}

bool is_covered(const Mesh& mesh, std::uint32_t triangle, const std::vector<Bounds3f>& boxes) {
  std::minstd_rand rng(triangle + 1);  // soon made
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int i = 0; i < 50; ++i) {
    double u = uniform(rng), v = i % 2 ? 0 : uniform(rng);  // half of them on an edge
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const auto corner = [&](int k) { return Vec3d(mesh.position(triangle, (i + k) % 3)); };
    const Vec3d point = corner(0) * (1 - u - v) + corner(1) * u + corner(2) * v;
    const Vec3d error = max(abs(corner(0)), max(abs(corner(1)), abs(corner(2)))) * 1e-14;
    const auto holds = [&](const Bounds3f& box) {
      const Vec3d lower = Vec3d(box.lower) - error, upper = Vec3d(box.upper) + error;
      return point.x >= lower.x && point.y >= lower.y && point.z >= lower.z && point.x <= upper.x &&
             point.y <= upper.y && point.z <= upper.z;
    };
    if (std::none_of(boxes.begin(), boxes.end(), holds)) return false;
  }
  return true;
}

}  // namespace

std::string find_tree_fault(const MeshTree& tree, const Mesh& mesh) {
  Uses uses(mesh.triangles.size());
  const auto visit = [&](std::uint32_t triangle, const Bounds3f& box) -> std::string {
    if (!box.contains(triangle_bounds(mesh, triangle)))
      return "primitive " + std::to_string(triangle) + ": is not inside its leaf";
    return uses.add(triangle);
  };
  if (std::string fault = check_mesh_tree(tree, mesh, visit); !fault.empty()) return fault;
  return uses.find_fault([](std::size_t) { return 1u; });
}

std::string find_cut_tree_fault(const MeshTree& tree, const Mesh& mesh) {
  std::vector<std::vector<Bounds3f>> boxes(mesh.triangles.size());
  const auto visit = [&](std::uint32_t triangle, const Bounds3f& box) {
    boxes[triangle].push_back(box);
    return std::string();
  };
  if (std::string fault = check_mesh_tree(tree, mesh, visit); !fault.empty()) return fault;
  for (std::uint32_t triangle = 0; triangle < boxes.size(); ++triangle)
    if (!is_covered(mesh, triangle, boxes[triangle]))
      return "primitive " + std::to_string(triangle) + ": is not covered by its leaves";
  return {};
}

std::string find_tree_fault(const NodeTree& tree, std::span<const Bounds3f> boxes) {
  Uses uses(boxes.size());
  const auto check_leaf = [&](TreeReference reference, const Bounds3f& box) -> std::string {
    const std::uint32_t index = reference & reference_index;
    if ((reference & ~reference_index) != instance_mark) return "a leaf is no instance";
    if (std::string fault = uses.add(index); !fault.empty()) return fault;
    return box.contains(boxes[index]) ? "" : "primitive " + std::to_string(index) + ": is not inside its leaf";
  };
  if (std::string fault = FaultFinder(tree, check_leaf).find(); !fault.empty()) return fault;
  return uses.find_fault([&](std::size_t i) { return boxes[i].is_empty() ? 0u : 1u; });
}

}  // namespace basicrt
