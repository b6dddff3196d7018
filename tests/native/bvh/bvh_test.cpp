// SPDX-License-Identifier: GPL-3.0-or-later
// The reference builder makes sound trees of anything, and the fault finder finds what is planted.
#include "bvh/bvh.h"

#include <gtest/gtest.h>

#include <functional>
#include <set>

#include "bvh/test_scenes.h"
#include "bvh/tree.h"

namespace basicrt {
namespace {

std::vector<Bounds3f> boxes_of(const Mesh& mesh) {
  std::vector<Bounds3f> boxes(mesh.triangles.size());
  for (std::uint32_t triangle = 0; triangle < boxes.size(); ++triangle)
    for (int corner = 0; corner < 3; ++corner) boxes[triangle].extend(mesh.position(triangle, corner));
  return boxes;
}

struct NamedBoxes {
  std::string name;
  std::vector<Bounds3f> boxes;
};

std::vector<NamedBoxes> boxes_of_every_kind() {
  test::Random rng(1);
  std::vector<NamedBoxes> result;
  for (const auto& [name, shape] : test::shapes_of_every_kind(rng))
    if (const Mesh* mesh = std::get_if<Mesh>(&shape)) result.push_back({name, boxes_of(*mesh)});

  NamedBoxes huge{"huge", {}}, doubling{"each twice as far", {}}, with_empty{"some empty", {}};
  for (int i = 0; i < 300; ++i) {
    Bounds3f box;
    box.extend(test::random_point(rng, 3e38f));
    box.extend(test::random_point(rng, 3e38f));
    huge.boxes.push_back(box);
    with_empty.boxes.push_back(i % 3 ? Bounds3f{} : box);
  }
  for (int i = 0; i < 250; ++i) {
    const Vec3f p(std::ldexp(1.0f, i - 125));
    doubling.boxes.push_back({p, p});
  }
  result.push_back(std::move(huge));
  result.push_back(std::move(doubling));
  result.push_back(std::move(with_empty));
  return result;
}

int depth(const Bvh& bvh, std::uint32_t node = 0) {
  if (bvh.nodes.empty() || bvh.nodes[node].is_leaf()) return 0;
  return 1 + std::max(depth(bvh, node + 1), depth(bvh, bvh.nodes[node].right_or_first));
}

std::uint32_t largest_leaf(const Bvh& bvh) {
  std::uint32_t largest = 0;
  for (const BvhNode& node : bvh.nodes) largest = std::max(largest, node.count);
  return largest;
}

TEST(Bvh, is_a_sound_tree_of_anything) {
  for (const auto& [name, boxes] : boxes_of_every_kind()) {
    const Bvh bvh = build_median_bvh(boxes, {});
    EXPECT_EQ(find_bvh_fault(bvh, boxes), "") << name;
    EXPECT_EQ(bvh.nodes.empty(), boxes.empty()) << name;
  }
}

TEST(Bvh, median_leaves_hold_two_unless_the_depth_is_cut_off) {
  test::Random rng(2);
  const std::vector<Bounds3f> boxes = boxes_of(test::soup(rng, 1000, 0.1f));
  const Bvh full = build_median_bvh(boxes, {});
  EXPECT_LE(largest_leaf(full), 2u);
  EXPECT_EQ(depth(full), 9);  // 1000 halved nine times is at most 2
  const Bvh cut = build_median_bvh(boxes, {.max_depth = 4});
  EXPECT_EQ(depth(cut), 4);
  EXPECT_LE(largest_leaf(cut), 63u);
  EXPECT_EQ(find_bvh_fault(cut, boxes), "");
}

TEST(Bvh, median_splits_the_axis_of_largest_extent) {
  std::vector<Bounds3f> boxes;
  for (int i = 0; i < 8; ++i) {
    const Vec3f p{0, static_cast<float>(7 * i % 8), static_cast<float>(i % 2)};
    boxes.push_back({p, p});
  }
  const Bvh bvh = build_median_bvh(boxes, {});
  const BvhNode& left = bvh.nodes[1];
  const BvhNode& right = bvh.nodes[bvh.nodes[0].right_or_first];
  EXPECT_EQ(left.bounds.upper.y, 3);
  EXPECT_EQ(right.bounds.lower.y, 4);
}

TEST(Bvh, building_twice_gives_the_same_tree) {
  const std::vector<Bounds3f> boxes = boxes_of(test::flat_grid(20));
  const Bvh a = build_median_bvh(boxes, {}), b = build_median_bvh(boxes, {});
  EXPECT_EQ(a.primitives, b.primitives);
  ASSERT_EQ(a.nodes.size(), b.nodes.size());
  for (std::size_t i = 0; i < a.nodes.size(); ++i) EXPECT_EQ(a.nodes[i].right_or_first, b.nodes[i].right_or_first);
}

TEST(BvhFault, is_found_wherever_it_is_planted) {
  test::Random rng(6);
  const std::vector<Bounds3f> boxes = boxes_of(test::soup(rng, 100, 0.1f));
  const Bvh sound = build_median_bvh(boxes, {});
  std::size_t leaf = 0;
  while (!sound.nodes[leaf].is_leaf()) ++leaf;

  const auto fault = [&](const std::function<void(Bvh&)>& damage) {
    Bvh damaged = sound;
    damage(damaged);
    return find_bvh_fault(damaged, boxes);
  };
  const auto contains = [](const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
  };
  EXPECT_EQ(fault([](Bvh&) {}), "");
  EXPECT_TRUE(contains(fault([](Bvh& b) { b.nodes[1].bounds.upper.x += 10; }), "is not inside its parent"));
  EXPECT_TRUE(contains(fault([&](Bvh& b) { b.nodes[leaf].bounds = {Vec3f(0.1f), Vec3f(0.1f)}; }), "is not inside"));
  EXPECT_TRUE(contains(fault([](Bvh& b) { b.primitives[3] = b.primitives[4]; }), "is"));
  EXPECT_TRUE(contains(fault([](Bvh& b) { b.primitives[3] = 100; }), "does not exist"));
  EXPECT_TRUE(contains(fault([&](Bvh& b) {
                         b.nodes[leaf].right_or_first = 99;
                         b.nodes[leaf].count = 2;
                       }),
                       "primitives are out of range"));
  EXPECT_TRUE(contains(fault([](Bvh& b) { b.nodes[0].right_or_first = 1u << 30; }), "child is out of range"));
  EXPECT_TRUE(contains(fault([](Bvh& b) { b.nodes[0].right_or_first = 0; }), "two parents"));
  EXPECT_TRUE(contains(fault([](Bvh& b) { b.nodes.push_back(b.nodes.back()); }), "no parent"));
  EXPECT_TRUE(contains(fault([](Bvh& b) { b.nodes.clear(); }), "no nodes"));
  EXPECT_TRUE(contains(fault([&](Bvh& b) {
                         b.nodes[leaf].count = 0;
                         b.nodes[leaf].right_or_first = 1;
                       }),
                       "node"));
  // The same primitive in two leaves, both large enough to hold it.
  const std::vector<Bounds3f> same(4, Bounds3f{Vec3f(0), Vec3f(1)});
  Bvh twice = build_median_bvh(same, {});
  twice.primitives[1] = twice.primitives[0];
  EXPECT_TRUE(contains(find_bvh_fault(twice, same), "leaves"));
}

}  // namespace
}  // namespace basicrt
