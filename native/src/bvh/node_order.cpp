// SPDX-License-Identifier: GPL-3.0-or-later
// Sorts the children for all eight octants at once.
#include "bvh/node_order.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <limits>

#include "math/simd.h"

namespace basicrt {
namespace {

// Keys of one child, for each octant.
struct alignas(16) Keys {
  float of_octant[8];
};

constexpr float largest = std::numeric_limits<float>::max();

// How far along the octant's diagonal a box begins, with the child's number in the last bits, so that no two are equal.
float key_of(float distance, std::uint32_t child) {
  const float finite = std::max(-largest, std::min(distance, largest));
  return std::bit_cast<float>((std::bit_cast<std::uint32_t>(finite) & ~7u) | child);
}
std::uint32_t child_of(float key) { return std::bit_cast<std::uint32_t>(key) & 7; }

Keys keys_of(const TreeNode& node, std::size_t child) {
  Keys keys;
  for (std::size_t octant = 0; octant < 8; ++octant) {
    const bool x = octant & 1, y = octant & 2, z = octant & 4;  // rays go down
    const float distance = (x ? -node.bounds[0][1][child] : node.bounds[0][0][child]) +
                           (y ? -node.bounds[1][1][child] : node.bounds[1][0][child]) +
                           (z ? -node.bounds[2][1][child] : node.bounds[2][0][child]);
    keys.of_octant[octant] = key_of(distance, static_cast<std::uint32_t>(child));
  }
  return keys;
}

// So that the larger keys come first. None is lost even where denormals count as zero, and so as equal.
void sort_two(Keys& first, Keys& second) {
  for (int half = 0; half < 8; half += 4) {
    const Float4 a = Float4::load(first.of_octant + half), b = Float4::load(second.of_octant + half);
    const Mask4 is_sorted = b < a;
    select(is_sorted, a, b).store(first.of_octant + half);
    select(is_sorted, b, a).store(second.of_octant + half);
  }
}

// Batcher's odd-even merge sort of eight.
constexpr std::uint8_t comparisons[][2] = {{0, 1}, {2, 3}, {4, 5}, {6, 7}, {0, 2}, {1, 3}, {4, 6},
                                           {5, 7}, {1, 2}, {5, 6}, {0, 4}, {1, 5}, {2, 6}, {3, 7},
                                           {2, 4}, {3, 5}, {1, 2}, {3, 4}, {5, 6}};

}  // namespace

void set_order(TreeNode& node) {
  Keys keys[8];
  for (std::size_t child = 0; child < 8; ++child) {
    if (node.children[child] != no_reference)
      keys[child] = keys_of(node, child);
    else
      std::fill_n(keys[child].of_octant, 8, key_of(largest, static_cast<std::uint32_t>(child)));
  }
  for (const auto& [a, b] : comparisons) sort_two(keys[a], keys[b]);
  for (std::size_t i = 0; i < 8; ++i) {
    node.order[i] = 0;
    for (std::size_t octant = 0; octant < 8; ++octant)
      node.order[i] |= child_of(keys[i].of_octant[octant]) << (3 * octant);
  }
}

}  // namespace basicrt
