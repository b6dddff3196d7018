// SPDX-License-Identifier: GPL-3.0-or-later
// Both builders make sound trees of eight children of anything, the same at any number of threads.
#include "bvh/mesh_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <functional>

#include "bvh/test_scenes.h"
#include "bvh/tree_access.h"
#include "bvh/tree_fault.h"

namespace basicrt {
namespace {

constexpr BvhBuilder builders[] = {BvhBuilder::median, BvhBuilder::binned_sah};

struct NamedMesh {
  std::string name;
  Mesh mesh;
};

void scale(Mesh& mesh, float factor) {
  for (Vec3f& position : mesh.positions) position *= factor;
}

std::vector<NamedMesh> meshes_of_every_kind() {
  test::Random rng(11);
  std::vector<NamedMesh> result;
  for (auto& [name, shape] : test::shapes_of_every_kind(rng))
    if (Mesh* mesh = std::get_if<Mesh>(&shape)) result.push_back({name, std::move(*mesh)});
  result.push_back({"five triangles", test::soup(rng, 5, 1)});
  result.push_back({"more than a thread takes", test::soup(rng, 50000, 0.02f)});
  result.push_back({"many that coincide", test::coincident(rng, 40000)});
  result.push_back({"huge", test::soup(rng, 3000, 1)});
  scale(result.back().mesh, 1.5e38f);
  result.push_back({"all in a point", test::soup(rng, 3000, 1)});
  for (Vec3f& position : result.back().mesh.positions) position = {1, 2, 3};

  Mesh collinear = test::soup(rng, 3000, 0.1f), doubling, mixed = test::soup(rng, 2000, 0.1f);
  for (Vec3f& p : collinear.positions) p = {p.x, 2 * p.x, 0};
  for (std::uint32_t i = 0; i < 250; ++i) {  // each twice as far as the last
    for (int corner = 0; corner < 3; ++corner)
      doubling.positions.emplace_back(std::ldexp(1.0f, static_cast<int>(i) - 125));
    doubling.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  for (std::size_t i = 0; i < mixed.positions.size(); i += 7) mixed.positions[i] *= i % 2 ? 1e-42f : 1e37f;
  result.push_back({"collinear", std::move(collinear)});
  result.push_back({"each twice as far", std::move(doubling)});
  result.push_back({"of all sizes", std::move(mixed)});
  return result;
}

std::vector<Bounds3f> boxes_of(const Mesh& mesh) {
  std::vector<Bounds3f> boxes(mesh.triangles.size());
  for (std::uint32_t triangle = 0; triangle < boxes.size(); ++triangle)
    for (int corner = 0; corner < 3; ++corner) boxes[triangle].extend(mesh.position(triangle, corner));
  return boxes;
}

template <class T>
bool is_same_memory(const HugeVector<T>& a, const HugeVector<T>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

TEST(MeshTree, both_builders_make_sound_trees_of_anything) {
  for (const BvhBuilder builder : builders)
    for (const auto& [name, mesh] : meshes_of_every_kind()) {
      const MeshTree tree = build_mesh_tree(mesh, {.builder = builder});
      EXPECT_EQ(find_tree_fault(tree, mesh), "") << name;
      EXPECT_EQ(tree.tree.root == no_reference, mesh.triangles.empty()) << name;
    }
}

// The expected number of nodes and blocks that a random line which meets the tree's box meets.
double expected_work(const MeshTree& tree) {
  double work = 0;
  for (const TreeNode& node : tree.tree.nodes)
    for (std::size_t child = 0; child < 8; ++child) {
      Bounds3<double> box;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        box.lower[axis] = static_cast<double>(node.bounds[axis][0][child]);
        box.upper[axis] = static_cast<double>(node.bounds[axis][1][child]);
      }
      work += box.half_area();
    }
  return work / static_cast<double>(tree.tree.bounds.half_area());
}

// Long triangles in all directions among many small ones.
Mesh beams() {
  test::Random rng(20);
  Mesh mesh = test::soup(rng, 3000, 0.02f);
  for (std::uint32_t i = 0; i < 40; ++i) mesh.positions[3 * i] = test::random_point(rng, 2);
  return mesh;
}

TEST(CutMeshTree, is_sound_and_covers_triangles_of_any_kind) {
  for (const auto& [name, mesh] : meshes_of_every_kind())
    EXPECT_EQ(find_cut_tree_fault(build_mesh_tree(mesh, {.builder = BvhBuilder::split_sah}), mesh), "") << name;
}

TEST(CutMeshTree, has_long_triangles_in_several_small_boxes) {
  const Mesh mesh = beams();
  const MeshTree whole = build_mesh_tree(mesh, {}), cut = build_mesh_tree(mesh, {.builder = BvhBuilder::split_sah});
  EXPECT_EQ(find_cut_tree_fault(cut, mesh), "");
  EXPECT_NE(find_tree_fault(cut, mesh), "") << "no triangle is cut";
  EXPECT_LT(expected_work(cut), 0.8 * expected_work(whole));
  EXPECT_LT(static_cast<double>(cut.memory()), 1.4 * static_cast<double>(whole.memory()));
}

TEST(CutMeshTree, gives_the_hits_of_brute_force) {
  test::Random rng(23);
  const std::vector<TracedInstance> instances{TracedInstance{}};
  const std::vector<Shape> shapes{beams()};
  const Tracer tracer = test::make_tracer(shapes, instances, {.builder = BvhBuilder::split_sah});
  int hits = 0;
  for (int i = 0; i < 1000; ++i) {
    const Ray ray = test::random_ray(rng);
    Hit hit;
    tracer.intersect({&ray, 1}, {&hit, 1});
    const Hit expected = test::brute_force(shapes, instances, ray);
    hits += expected.is_hit();
    EXPECT_EQ(hit.primitive, expected.primitive);
  }
  EXPECT_GT(hits, 100);
}

TEST(CutMeshTree, can_be_refitted) {
  const Mesh mesh = beams();
  MeshTree tree = build_mesh_tree(mesh, {.builder = BvhBuilder::split_sah});
  Mesh moved = mesh;
  for (Vec3f& position : moved.positions) position = Vec3f{position.y, position.z, position.x} * 2.0f;
  refit(tree, moved);
  EXPECT_EQ(find_cut_tree_fault(tree, moved), "");
}

TEST(InstanceTree, has_every_box_that_is_not_empty_in_a_leaf_of_its_own) {
  for (const BvhBuilder builder : builders)
    for (const auto& [name, mesh] : meshes_of_every_kind()) {
      std::vector<Bounds3f> boxes = boxes_of(mesh);
      for (std::size_t i = 0; i < boxes.size(); i += 5) boxes[i] = {};
      EXPECT_EQ(find_tree_fault(build_instance_tree(boxes, {.builder = builder}), boxes), "") << name;
    }
}

TEST(InstanceTree, takes_boxes_without_end) {
  test::Random rng(12);
  std::vector<Bounds3f> boxes = boxes_of(test::soup(rng, 1000, 0.1f));
  constexpr float infinity = std::numeric_limits<float>::infinity();
  for (std::size_t i = 0; i < boxes.size(); i += 3) {
    if (i % 2) boxes[i].lower[i % 5 % 3] = -infinity;
    boxes[i].upper[i % 3] = infinity;
  }
  for (const BvhBuilder builder : builders)
    EXPECT_EQ(find_tree_fault(build_instance_tree(boxes, {.builder = builder}), boxes), "");
}

TEST(MeshTree, is_the_same_for_any_number_of_threads) {
  for (const auto& [name, mesh] : meshes_of_every_kind()) {
    for (const BvhBuilder builder : {BvhBuilder::median, BvhBuilder::binned_sah, BvhBuilder::split_sah}) {
      const MeshTree one = build_mesh_tree(mesh, {.builder = builder, .threads = 1});
      for (const int threads : {2, 3, 7}) {
        const MeshTree several = build_mesh_tree(mesh, {.builder = builder, .threads = threads});
        EXPECT_TRUE(is_same_memory(one.tree.nodes, several.tree.nodes)) << name;
        EXPECT_TRUE(is_same_memory(one.blocks, several.blocks)) << name;
        EXPECT_EQ(one.tree.root, several.tree.root) << name;
      }
    }
  }
}

TEST(InstanceTree, is_the_same_for_any_number_of_threads) {
  test::Random rng(24);
  const std::vector<Bounds3f> boxes = boxes_of(test::soup(rng, 40000, 0.05f));
  for (const BvhBuilder builder : builders) {
    const NodeTree one = build_instance_tree(boxes, {.builder = builder, .threads = 1});
    for (const int threads : {2, 5})
      EXPECT_TRUE(
          is_same_memory(one.nodes, build_instance_tree(boxes, {.builder = builder, .threads = threads}).nodes));
  }
}

TEST(MeshTree, sah_trees_cost_less_than_median_trees) {
  test::Random rng(13);
  Mesh uneven = test::soup(rng, 2000, 0.01f);
  for (std::size_t i = 0; i < 300; ++i) uneven.positions[i] *= 40;  // some far larger than the others, and far away
  const auto ratio = [](const Mesh& mesh) {
    return expected_work(build_mesh_tree(mesh, {})) /
           expected_work(build_mesh_tree(mesh, {.builder = BvhBuilder::median}));
  };
  EXPECT_LT(ratio(test::soup(rng, 2000, 0.05f)), 0.97);  // as even as can be
  EXPECT_LT(ratio(uneven), 0.8);
}

TEST(MeshTree, sah_trees_fill_their_blocks_and_nodes) {
  test::Random rng(14);
  for (const Mesh& mesh : {test::soup(rng, 20000, 0.02f), test::flat_grid(100)}) {
    const MeshTree tree = build_mesh_tree(mesh, {});
    EXPECT_LT(static_cast<double>(tree.memory()), 62.0 * static_cast<double>(mesh.triangles.size()));
  }
}

TEST(MeshTree, refitted_is_sound_and_as_tight_as_it_can_be) {
  test::Random rng(18);
  for (const BvhBuilder builder : builders)
    for (auto& [name, mesh] : meshes_of_every_kind()) {
      const MeshTree before = build_mesh_tree(mesh, {.builder = builder});
      Mesh moved = mesh;
      for (Vec3f& position : moved.positions) position += test::random_point(rng, 0.2f);
      MeshTree tree = before;
      refit(tree, moved);
      EXPECT_EQ(find_tree_fault(tree, moved), "") << name;
      Bounds3f everything;
      for (const Bounds3f& box : boxes_of(moved)) everything.extend(box);
      EXPECT_TRUE(everything.contains(tree.tree.bounds)) << name;

      refit(tree, mesh);
      EXPECT_TRUE(is_same_memory(tree.blocks, before.blocks)) << name;
      EXPECT_TRUE(is_same_memory(tree.tree.nodes, before.tree.nodes)) << name;
    }
}

TEST(MeshTree, refitted_gives_the_hits_of_brute_force) {
  test::Random rng(19);
  const Mesh mesh = test::soup(rng, 500, 0.2f);
  Mesh moved = mesh;
  for (Vec3f& position : moved.positions) position = Vec3f{position.y, -position.x, position.z} * 1.2f;
  MeshTree tree = build_mesh_tree(mesh, {});
  refit(tree, moved);
  const std::vector<TracedInstance> instances{TracedInstance{}};
  const Bounds3f bounds = tree.tree.bounds;
  std::vector<ShapeTree> trees;
  trees.push_back({std::move(tree), bounds});
  const Tracer tracer(std::move(trees), instances, {});
  int hits = 0;
  for (int i = 0; i < 2000; ++i) {
    const Ray ray = test::random_ray(rng);
    Hit hit;
    tracer.intersect({&ray, 1}, {&hit, 1});
    const Hit expected = test::brute_force({moved}, instances, ray);
    hits += expected.is_hit();
    EXPECT_EQ(hit.is_hit(), expected.is_hit());
    EXPECT_EQ(hit.primitive, expected.primitive);
  }
  EXPECT_GT(hits, 500);
}

TEST(MeshTree, reports_about_as_much_work_as_was_announced) {
  test::Random rng(16);
  for (const BvhBuilder builder : builders)
    for (const int count : {1, 100, 3000, 60000}) {
      const Mesh mesh = test::soup(rng, count, 0.02f);
      WorkProgress progress;
      progress.expect(build_work(mesh.triangles.size()));
      EXPECT_EQ(progress.fraction(), 0);
      (void)build_mesh_tree(mesh, {.builder = builder, .progress = &progress});
      EXPECT_GT(progress.fraction(), 0.7) << count;
    }
}

TEST(MeshTree, is_cancelled_by_progress_from_any_number_of_threads) {
  test::Random rng(17);
  const Mesh mesh = test::soup(rng, 30000, 0.02f);
  for (const BvhBuilder builder : builders)
    for (const int threads : {1, 3}) {
      WorkProgress progress;
      progress.cancel();
      EXPECT_THROW((void)build_mesh_tree(mesh, {.builder = builder, .threads = threads, .progress = &progress}),
                   Cancelled);
      EXPECT_THROW(
          (void)build_instance_tree(boxes_of(mesh), {.builder = builder, .threads = threads, .progress = &progress}),
          Cancelled);
    }
}

TEST(MeshTreeFault, is_found_wherever_it_is_planted) {
  test::Random rng(15);
  const Mesh mesh = test::soup(rng, 200, 0.1f);
  const MeshTree sound = build_mesh_tree(mesh, {});
  std::size_t unused = 0;  // a node with fewer than eight children
  while (sound.tree.nodes[unused].children[7] != no_reference) ++unused;
  std::size_t partial = 0;  // a block of three triangles
  const auto is_partial = [&](const auto& p) { return p[1] != p[2] && p[2] == p[3]; };
  while (!is_partial(sound.blocks[partial].primitives)) ++partial;

  const auto fault = [&](const std::function<void(MeshTree&)>& damage) {
    MeshTree damaged = sound;
    damage(damaged);
    return find_tree_fault(damaged, mesh);
  };
  const auto expect = [&](const char* part, const std::function<void(MeshTree&)>& damage) {
    const std::string text = fault(damage);
    EXPECT_NE(text.find(part), std::string::npos) << part << " / " << text;
  };
  EXPECT_EQ(fault([](MeshTree&) {}), "");
  expect("not inside", [](MeshTree& t) { t.tree.nodes[0].bounds[0][1][0] += 10; });
  expect("not inside its leaf", [](MeshTree& t) {
    for (TreeNode& node : t.tree.nodes)
      for (std::size_t child = 0; child < 8; ++child)
        if (node.children[child] == triangles_mark) node.bounds[0][1][child] = node.bounds[0][0][child];
  });
  expect("does not exist", [](MeshTree& t) { t.tree.nodes[0].children[0] = 1u << 29; });
  expect("does not exist", [](MeshTree& t) { t.tree.nodes[0].children[0] = triangles_mark | 1u << 20; });
  expect("two parents", [](MeshTree& t) { t.tree.nodes[0].children[0] = 0; });
  expect("no parent", [](MeshTree& t) { t.tree.nodes.push_back(t.tree.nodes.back()); });
  expect("no parent", [](MeshTree& t) { t.blocks.push_back(t.blocks.back()); });
  expect("no permutation", [](MeshTree& t) { t.tree.nodes[0].order[3] = t.tree.nodes[0].order[4]; });
  expect("unused child comes after", [&](MeshTree& t) {
    auto& order = t.tree.nodes[unused].order;
    std::swap(order[0], order[7]);
  });
  expect("unused child is not empty", [&](MeshTree& t) {
    for (auto& axis : t.tree.nodes[unused].bounds) axis[0][7] = axis[1][7] = 0;
  });
  expect("not where the mesh has it", [](MeshTree& t) { t.blocks[5].corners[1][2][3] += 0.001f; });
  expect("is in", [&](MeshTree& t) {
    t.blocks[0] = t.blocks[1];  // and the boxes large enough for both
    for (TreeNode& node : t.tree.nodes)
      for (std::size_t child = 0; child < 8; ++child)
        for (std::size_t axis = 0; axis < 3 && node.children[child] != no_reference; ++axis) {
          node.bounds[axis][0][child] = t.tree.bounds.lower[axis];
          node.bounds[axis][1][child] = t.tree.bounds.upper[axis];
        }
  });
  expect("comes after a missing one", [&](MeshTree& t) {
    TriangleBlock& block = t.blocks[partial];
    for (std::size_t lane = 1; lane < 3; ++lane) {
      block.primitives[lane] = block.primitives[0];
      for (auto& corner : block.corners)
        for (auto& axis : corner) axis[lane] = axis[0];
    }
    block.primitives[3] = t.blocks[(partial + 1) % t.blocks.size()].primitives[0];
  });
  expect("ascending", [&](MeshTree& t) {
    TriangleBlock& block = t.blocks[partial];
    std::swap(block.primitives[0], block.primitives[1]);
    for (auto& corner : block.corners)
      for (auto& axis : corner) std::swap(axis[0], axis[1]);
  });
}

// Calls visit(block, box) for each leaf of an interval.
template <class Visit>
void for_each_moving_leaf(const MovingMeshTree::Interval& interval, const Visit& visit) {
  const auto leaf = [&](TreeReference reference, const Bounds3f& box) {
    ASSERT_EQ(reference & ~reference_index, moving_triangles_mark);
    visit(interval.blocks[reference & reference_index], box);
  };
  if (interval.tree.nodes.empty() && interval.tree.root != no_reference) leaf(interval.tree.root, interval.tree.bounds);
  for (const TreeNode& node : interval.tree.nodes)
    for (std::size_t child = 0; child < 8; ++child)
      if (node.children[child] != no_reference && node.children[child] >= interval.tree.nodes.size())
        leaf(node.children[child], child_bounds(node, child));
}

TEST(MovingMeshTree, boxes_hold_their_triangles_at_every_time) {
  test::Random rng(12);
  for (const BvhBuilder builder : {BvhBuilder::median, BvhBuilder::binned_sah, BvhBuilder::split_sah})
    for (const float middle : {0.0f, 1e5f}) {  // far off, interpolating rounds as much as triangles are large
      Mesh mesh = test::soup(rng, 500, 0.1f);
      for (Vec3f& position : mesh.positions) position += Vec3f(middle);
      mesh = test::deforming(rng, mesh, 2, 0.5f);
      const MovingMeshTree tree = build_moving_mesh_tree(mesh, {.builder = builder});
      ASSERT_EQ(tree.intervals.size(), 2u);
      for (std::uint32_t number = 0; number < 2; ++number) {
        std::vector<int> uses(mesh.triangles.size());
        for_each_moving_leaf(tree.intervals[number], [&](const MovingTriangleBlock& block, const Bounds3f& box) {
          for (std::size_t lane = 0; lane < 4; ++lane)
            if (lane == 0 || block.primitives[lane] != block.primitives[lane - 1]) ++uses[block.primitives[lane]];
          for (int i = 0; i < 20; ++i) {
            const float fraction = i == 0 ? 0 : i == 1 ? 1 : test::uniform(rng, 0, 1);
            const TriangleBlock now = block_at(block, fraction);
            for (std::size_t lane = 0; lane < 4; ++lane)
              for (std::size_t corner = 0; corner < 3; ++corner) {
                const Vec3f position = corner_of(now, lane, corner);
                EXPECT_TRUE(box.contains({position, position}));
                const float time = (static_cast<float>(number) + fraction) / 2;
                // At the first and the last key it is where the mesh has it.
                if (i < 2 && (number == 0) == (i == 0)) {
                  EXPECT_EQ(position, mesh.position_at(now.primitives[lane], static_cast<int>(corner), time));
                }
              }
          }
        });
        EXPECT_EQ(std::count(uses.begin(), uses.end(), 1), 500);
      }
    }
}

}  // namespace
}  // namespace basicrt
