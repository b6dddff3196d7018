// SPDX-License-Identifier: GPL-3.0-or-later
// Preparing: what is left out is named, what has not changed is kept.
#include "scene/prepare.h"

#include <gtest/gtest.h>

#include "base/error.h"

namespace basicrt {
namespace {

Mesh one_triangle(float x) {
  Mesh mesh;
  mesh.positions = {{x, 0, 0}, {x + 1, 0, 0}, {x, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  return mesh;
}

Scene scene_of(Shape shape) {
  Scene scene;
  scene.camera = PerspectiveCamera{};
  scene.instances.append({.name = "it", .shape = scene.shapes.append(std::move(shape)), .object_to_world = {}});
  return scene;
}

Hit first_hit(const PreparedScene& scene, Vec3f origin, Vec3f direction) {
  const Ray ray{.origin = origin, .direction = direction};
  Hit hit;
  scene.tracer.intersect({&ray, 1}, {&hit, 1});
  return hit;
}

TEST(Prepare, an_empty_mesh_is_left_out_with_a_warning) {
  Report report;
  const PreparedScene prepared = prepare(scene_of(Mesh{}), report);
  EXPECT_TRUE(prepared.instances.empty());
  ASSERT_EQ(report.warnings().size(), 1u);
  EXPECT_NE(report.warnings()[0].find("shapes[0]"), std::string::npos);
}

TEST(Prepare, no_camera_is_an_error) {
  Scene scene = scene_of(one_triangle(0));
  scene.camera.reset();
  Report report;
  EXPECT_THROW((void)prepare(scene, report), SceneError);
}

TEST(Prepare, a_slot_without_a_material_is_grey) {
  Scene scene = scene_of(one_triangle(0));
  Report report;
  const PreparedScene prepared = prepare(scene, report);
  EXPECT_EQ(prepared.material_of(SurfacePoint{}).material.name, "default");
}

TEST(Prepare, a_changed_shape_is_built_again_and_an_unchanged_one_is_still_hit) {
  Scene scene = scene_of(one_triangle(0));
  const Id<Shape> second = scene.shapes.append(one_triangle(10));
  scene.instances.append({.name = "second", .shape = second, .object_to_world = {}});
  Report report;
  PreparedScene prepared = prepare(scene, report);
  EXPECT_TRUE(first_hit(prepared, {10.2f, 0.2f, 1}, {0, 0, -1}).is_hit());

  scene.shapes.set(second, one_triangle(20));
  prepared = prepare(scene, report, std::move(prepared));
  EXPECT_TRUE(first_hit(prepared, {0.2f, 0.2f, 1}, {0, 0, -1}).is_hit());
  EXPECT_FALSE(first_hit(prepared, {10.2f, 0.2f, 1}, {0, 0, -1}).is_hit());
  EXPECT_TRUE(first_hit(prepared, {20.2f, 0.2f, 1}, {0, 0, -1}).is_hit());
}

}  // namespace
}  // namespace basicrt
