// SPDX-License-Identifier: GPL-3.0-or-later
// A small binary tree, and the choice of those of its nodes that together make the cheapest tree of eight children
// (Ylitie, Karras and Laine 2017, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs").
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "bvh/references.h"

namespace basicrt {

class Treelet {
 public:
  struct Node {
    Box box;
    std::uint32_t begin = 0, count = 0;  // primitives
    std::uint32_t left = 0, right = 0;   // both 0: a leaf
    // The least cost of all below, as a forest of at most i + 1 trees of eight; how many of them the left child gets,
    // or 0 where one tree less costs no more.
    alignas(16) float costs[8];
    alignas(16) std::int32_t left_shares[8];
    std::int32_t root_share;  // how many of eight the left child gets where this becomes a node of eight

    [[nodiscard]] bool is_leaf() const { return right == 0; }
  };

  void clear() { nodes_.clear(); }
  // `area` is the box's, in any unit.
  std::uint32_t add_leaf(const Box& box, float area, std::uint32_t begin, std::uint32_t count);
  std::uint32_t add_node(const Box& box, float area, std::uint32_t left, std::uint32_t right);

  [[nodiscard]] const Node& operator[](std::uint32_t index) const { return nodes_[index]; }
  // The children of a node of eight, in the order of their primitives. Returns how many.
  int find_children(std::uint32_t index, std::array<std::uint32_t, 8>& children) const;

 private:
  void gather(std::uint32_t index, int share, std::array<std::uint32_t, 8>& children, int& count) const;

  std::vector<Node> nodes_;
};

}  // namespace basicrt
