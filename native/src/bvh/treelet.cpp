// SPDX-License-Identifier: GPL-3.0-or-later
// Dynamic programming from the leaves up.
#include "bvh/treelet.h"

#include <algorithm>
#include <limits>

namespace basicrt {
namespace {

// The work of visiting a block of triangles, in visits of a node.
constexpr float block_cost = 1.2f;

// The best ways to share i + 1 trees between two children, for all i at once.
void share_out(const Treelet::Node& left, const Treelet::Node& right, Treelet::Node& node) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  // right_costs[7 + i] is what the right child costs as i + 1 trees; it can't be none.
  alignas(16) float right_costs[16];
  std::fill_n(right_costs, 8, infinity);
  std::copy_n(right.costs, 8, right_costs + 8);
  for (int half = 0; half < 8; half += 4) {
    Float4 best = Float4::all(infinity), best_share = Float4::all(0);
    for (int share = 1; share < half + 4; ++share) {
      const float* const rest = right_costs + 8 + half - share;
      const Float4 cost = Float4::all(left.costs[share - 1]) + Float4::of(rest[0], rest[1], rest[2], rest[3]);
      const Mask4 is_better = cost < best;
      best = select(is_better, cost, best);
      best_share = select(is_better, Float4::all(static_cast<float>(share)), best_share);
    }
    best.store(node.costs + half);
    best_share.truncated().store(node.left_shares + half);
  }
}

}  // namespace

std::uint32_t Treelet::add_leaf(const Box& box, float area, std::uint32_t begin, std::uint32_t count) {
  Node leaf{.box = box, .begin = begin, .count = count};
  std::fill_n(leaf.costs, 8, block_cost * area);
  std::fill_n(leaf.left_shares, 8, 0);
  nodes_.push_back(leaf);
  return static_cast<std::uint32_t>(nodes_.size() - 1);
}

std::uint32_t Treelet::add_node(const Box& box, float area, std::uint32_t left, std::uint32_t right) {
  const Node &left_node = nodes_[left], &right_node = nodes_[right];
  Node node{
      .box = box, .begin = left_node.begin, .count = left_node.count + right_node.count, .left = left, .right = right};
  share_out(left_node, right_node, node);
  node.root_share = node.left_shares[7] > 0 ? node.left_shares[7] : 4;  // areas may be no numbers
  // One tree: a node over the best forest of eight.
  node.costs[0] = node.costs[7] + area;
  for (int i = 1; i < 8; ++i)
    if (!(node.costs[i] < node.costs[i - 1])) {
      node.costs[i] = node.costs[i - 1];
      node.left_shares[i] = 0;
    }
  nodes_.push_back(node);
  return static_cast<std::uint32_t>(nodes_.size() - 1);
}

int Treelet::find_children(std::uint32_t index, std::array<std::uint32_t, 8>& children) const {
  const Node& node = nodes_[index];
  int count = 0;
  gather(node.left, node.root_share, children, count);
  gather(node.right, 8 - node.root_share, children, count);
  return count;
}

// The trees of the best forest of `share` trees.
void Treelet::gather(std::uint32_t index, int share, std::array<std::uint32_t, 8>& children, int& count) const {
  const Node& node = nodes_[index];
  while (share > 1 && node.left_shares[share - 1] == 0) --share;
  if (share == 1) {
    children[count++] = index;
    return;
  }
  const int left_share = node.left_shares[share - 1];
  gather(node.left, left_share, children, count);
  gather(node.right, share - left_share, children, count);
}

}  // namespace basicrt
