// SPDX-License-Identifier: GPL-3.0-or-later
// Children come farthest first along the diagonal of each octant, unused ones before all.
#include "bvh/node_order.h"

#include <gtest/gtest.h>

#include "bvh/test_scenes.h"

namespace basicrt {
namespace {

TEST(NodeOrder, is_by_distance_along_the_diagonal_of_the_octant) {
  test::Random rng(31);
  for (int count = 0; count <= 8; ++count)
    for (int repetition = 0; repetition < 50; ++repetition) {
      TreeNode node{};
      for (std::size_t child = 0; child < 8; ++child) {
        Bounds3f box;
        node.children[child] = no_reference;
        if (child < static_cast<std::size_t>(count)) {
          node.children[child] = static_cast<TreeReference>(child);
          box.extend(test::random_point(rng));
          box.extend(repetition % 2 ? box.lower : test::random_point(rng));
        }
        for (std::size_t axis = 0; axis < 3; ++axis) {
          node.bounds[axis][0][child] = box.lower[axis];
          node.bounds[axis][1][child] = box.upper[axis];
        }
      }
      set_order(node);
      for (unsigned octant = 0; octant < 8; ++octant) {
        unsigned seen = 0;
        float last = std::numeric_limits<float>::infinity();
        for (int i = 0; i < 8; ++i) {
          const std::uint32_t child = node.order[i] >> (3 * octant) & 7;
          seen |= 1u << child;
          EXPECT_EQ(i < 8 - count, child >= static_cast<std::uint32_t>(count));
          if (i < 8 - count) continue;
          float distance = 0;
          for (unsigned axis = 0; axis < 3; ++axis)
            distance += octant >> axis & 1 ? -node.bounds[axis][1][child] : node.bounds[axis][0][child];
          EXPECT_LE(distance, last + 1e-5f);
          last = distance;
        }
        EXPECT_EQ(seen, 255u);
      }
    }
}

}  // namespace
}  // namespace basicrt
