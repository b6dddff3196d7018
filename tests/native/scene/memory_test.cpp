// SPDX-License-Identifier: GPL-3.0-or-later
// What a scene takes is known in part before it is prepared, and never too high.
#include "scene/memory.h"

#include <gtest/gtest.h>

#include "bvh/test_scenes.h"

namespace basicrt {
namespace {

Scene scene_of(Shape shape) {
  Scene scene;
  scene.camera = PerspectiveCamera{};
  scene.instances.append({.name = "it", .shape = scene.shapes.append(std::move(shape)), .object_to_world = {}});
  return scene;
}

SceneMemory prepared_memory(const Scene& scene) {
  Report report;
  return memory_of(prepare(scene, report));
}

void expect_trees_within(const Shape& shape, double most) {
  const Scene scene = scene_of(shape);
  const SceneMemory expected = expected_memory(scene), used = prepared_memory(scene);
  EXPECT_GT(expected.trees, 0u);
  EXPECT_LE(expected.trees, used.trees);
  EXPECT_GE(static_cast<double>(expected.trees) * most, static_cast<double>(used.trees));
  EXPECT_EQ(expected.shapes, used.shapes);
  EXPECT_EQ(expected.instances, used.instances);
  EXPECT_EQ(expected.picture, used.picture);
}

TEST(SceneMemory, trees_of_meshes_are_no_smaller_than_expected) { expect_trees_within(test::flat_grid(60), 3); }

TEST(SceneMemory, trees_of_moving_meshes_are_no_smaller_than_expected) {
  Mesh mesh = test::flat_grid(30);
  mesh.motion_positions = {mesh.positions, mesh.positions};
  expect_trees_within(mesh, 3);
}

TEST(SceneMemory, trees_of_points_and_curves_are_no_smaller_than_expected) {
  PointCloud cloud;
  Curves curves;
  for (std::uint32_t i = 0; i < 1000; ++i) {
    cloud.positions.push_back({static_cast<float>(i % 30), static_cast<float>(i / 30), 0});
    if (i % 10 == 0) curves.firsts.push_back(i);
    curves.points.push_back({static_cast<float>(i / 10), static_cast<float>(i % 10), 0});
  }
  cloud.radii.assign(1000, 0.3f);
  curves.radii.assign(1000, 0.1f);
  expect_trees_within(cloud, 3);
  expect_trees_within(curves, 6);
}

TEST(SceneMemory, copies_of_an_image_count_once) {
  Scene scene = scene_of(test::flat_grid(2));
  const Image image{.width = 100, .height = 50, .channels = 3, .pixels = std::vector<float>(15000, 0.5f), .path = {}};
  for (int i = 0; i < 3; ++i) scene.textures.append(ImageTexture{.image = image});
  scene.environment.layers.push_back({.image = image});
  EXPECT_EQ(expected_memory(scene).images, 15000 * sizeof(float));
  EXPECT_EQ(prepared_memory(scene).images, 15000 * sizeof(float));
}

TEST(SceneMemory, the_picture_is_what_its_border_and_passes_say) {
  Scene scene = scene_of(test::flat_grid(2));
  scene.settings.width = 100;
  scene.settings.height = 50;
  scene.settings.passes = {};
  scene.settings.passes.enable(Pass::combined);
  scene.settings.passes.enable(Pass::normal);
  EXPECT_EQ(expected_memory(scene).picture, 100u * 50 * 7 * 4);
  scene.settings.border_x = 10;
  scene.settings.border_width = 20;
  scene.settings.border_height = 5;
  EXPECT_EQ(expected_memory(scene).picture, 20u * 5 * 7 * 4);
}

}  // namespace
}  // namespace basicrt
