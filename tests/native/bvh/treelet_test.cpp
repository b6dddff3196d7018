// SPDX-License-Identifier: GPL-3.0-or-later
// The choice of children costs as little as any that is found by trying all.
#include "bvh/treelet.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "bvh/test_scenes.h"

namespace basicrt {
namespace {

// As in treelet.cpp.
constexpr double block_cost = 1.2;

struct Tree {
  Treelet treelet;
  std::vector<double> areas;  // by node
  std::uint32_t root = 0;
};

std::uint32_t grow(Tree& tree, test::Random& rng, std::uint32_t begin, std::uint32_t leaves, float area) {
  if (leaves == 1) {
    tree.areas.push_back(double{area});
    return tree.treelet.add_leaf(Box(), area, begin, 1);
  }
  const auto left_leaves = std::uniform_int_distribution<std::uint32_t>(1, leaves - 1)(rng);
  const float left_area = area * test::uniform(rng, 0.1f, 0.9f), right_area = area * test::uniform(rng, 0.1f, 0.9f);
  const std::uint32_t left = grow(tree, rng, begin, left_leaves, left_area);
  const std::uint32_t right = grow(tree, rng, begin + left_leaves, leaves - left_leaves, right_area);
  tree.areas.push_back(double{area});
  return tree.treelet.add_node(Box(), area, left, right);
}

// The least cost of a subtree as at most so many trees of eight, by trying everything.
double least_cost(const Tree& tree, std::uint32_t index, int trees) {
  const Treelet::Node& node = tree.treelet[index];
  if (node.is_leaf()) return block_cost * tree.areas[index];
  double best = std::numeric_limits<double>::infinity();
  const auto share = [&](int total) {
    for (int left = 1; left < total; ++left)
      best = std::min(best, least_cost(tree, node.left, left) + least_cost(tree, node.right, total - left));
  };
  share(8);
  best += tree.areas[index];
  for (int total = 2; total <= trees; ++total) share(total);
  return best;
}

double cost_of_choice(const Tree& tree, std::uint32_t index, std::vector<std::uint32_t>& leaves) {
  const Treelet::Node& node = tree.treelet[index];
  if (node.is_leaf()) {
    leaves.push_back(node.begin);
    return block_cost * tree.areas[index];
  }
  std::array<std::uint32_t, 8> children;
  const int count = tree.treelet.find_children(index, children);
  EXPECT_GE(count, 2);
  EXPECT_LE(count, 8);
  double cost = tree.areas[index];
  for (int i = 0; i < count; ++i) cost += cost_of_choice(tree, children[i], leaves);
  return cost;
}

TEST(Treelet, chooses_the_cheapest_children) {
  test::Random rng(21);
  for (std::uint32_t leaves = 2; leaves <= 9; ++leaves)
    for (int repetition = 0; repetition < 5; ++repetition) {
      Tree tree;
      tree.root = grow(tree, rng, 0, leaves, 1);
      std::vector<std::uint32_t> seen;
      const double cost = cost_of_choice(tree, tree.root, seen), least = least_cost(tree, tree.root, 1);
      EXPECT_NEAR(cost, least, 1e-5 * least) << leaves << " leaves";
      EXPECT_EQ(seen.size(), leaves);
      EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()));
    }
}

TEST(Treelet, has_children_for_every_node_whatever_the_areas) {
  for (const float area : {0.0f, std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
    Tree tree;
    test::Random rng(22);
    tree.root = grow(tree, rng, 0, 100, area);
    std::vector<std::uint32_t> seen;
    (void)cost_of_choice(tree, tree.root, seen);
    EXPECT_EQ(seen.size(), 100u);
  }
}

}  // namespace
}  // namespace basicrt
