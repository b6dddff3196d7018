// SPDX-License-Identifier: GPL-3.0-or-later
// Looks for faults in a tree.
#include "bvh/bvh.h"

#include <bit>
#include <string_view>

namespace basicrt {
namespace {

// Walks the tree, which may be wrong in any way, and stops at the first fault.
class FaultFinder {
 public:
  FaultFinder(const Bvh& bvh, std::span<const Bounds3f> bounds)
      : bvh_(bvh), bounds_(bounds), uses_(bounds.size()), is_reached_(bvh.nodes.size()) {}

  std::string find() {
    if (bvh_.nodes.empty()) return bounds_.empty() ? "" : "no nodes, but there are primitives";
    std::vector<std::uint32_t> pending{0};
    while (!pending.empty() && fault_.empty()) {
      const std::uint32_t index = pending.back();
      pending.pop_back();
      if (is_reached_[index]) return "node " + std::to_string(index) + ": has two parents";
      is_reached_[index] = true;
      if (bvh_.nodes[index].is_leaf()) {
        check_leaf(index);
      } else {
        check_child(index, index + 1, pending);
        check_child(index, bvh_.nodes[index].right_or_first, pending);
      }
    }
    if (fault_.empty()) check_uses();
    return fault_;
  }

 private:
  void report(std::string_view kind, std::size_t index, std::string_view problem) {
    if (fault_.empty()) fault_ = std::string(kind) + " " + std::to_string(index) + ": " + std::string(problem);
  }

  void check_child(std::uint32_t parent, std::uint32_t child, std::vector<std::uint32_t>& pending) {
    if (child >= bvh_.nodes.size()) return report("node", parent, "a child is out of range");
    if (!bvh_.nodes[parent].bounds.contains(bvh_.nodes[child].bounds))
      report("node", child, "is not inside its parent");
    pending.push_back(child);
  }

  void check_leaf(std::uint32_t index) {
    const BvhNode& leaf = bvh_.nodes[index];
    if (std::size_t{leaf.right_or_first} + leaf.count > bvh_.primitives.size())
      return report("node", index, "its primitives are out of range");
    for (std::uint32_t i = 0; i < leaf.count; ++i) {
      const std::uint32_t primitive = bvh_.primitives[leaf.right_or_first + i];
      if (primitive >= bounds_.size()) return report("primitive", primitive, "does not exist");
      if (!leaf.bounds.contains(bounds_[primitive])) report("primitive", primitive, "is not inside its leaf");
      ++uses_[primitive];
    }
  }

  void check_uses() {
    for (std::size_t i = 0; i < uses_.size(); ++i)
      if (uses_[i] != 1) report("primitive", i, "is in " + std::to_string(uses_[i]) + " leaves");
    for (std::size_t i = 0; i < is_reached_.size(); ++i)
      if (!is_reached_[i]) report("node", i, "has no parent");
  }

  const Bvh& bvh_;
  std::span<const Bounds3f> bounds_;
  std::vector<std::uint32_t> uses_;
  std::vector<bool> is_reached_;
  std::string fault_;
};

}  // namespace

// Builders move each primitive about once a level; the levels of small parts are counted when these are done.
std::uint64_t build_work(std::size_t primitives) {
  const int large_levels = static_cast<int>(std::bit_width(primitives / large_part));
  return primitives * static_cast<std::uint64_t>(large_levels + small_part_work + 4);
}

std::string find_bvh_fault(const Bvh& bvh, std::span<const Bounds3f> bounds) { return FaultFinder(bvh, bounds).find(); }

}  // namespace basicrt
