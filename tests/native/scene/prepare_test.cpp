// SPDX-License-Identifier: GPL-3.0-or-later
// Preparing: what is left out is named, what has not changed is kept.
#include "scene/prepare.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "base/error.h"
#include "bvh/test_scenes.h"

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

// A grid of 2 * cells^2 triangles over bumps.
Mesh large_mesh(std::uint32_t cells) {
  Mesh mesh = test::flat_grid(cells);
  for (Vec3f& p : mesh.positions) {
    const Vec3f place = p * (static_cast<float>(cells) / 2);  // a unit for each cell
    p = {place.x, place.y, std::sin(place.x) * std::cos(place.y)};
  }
  return mesh;
}

TEST(Prepare, a_changed_environment_is_prepared_again) {
  Scene scene = scene_of(one_triangle(0));
  Report report;
  PreparedScene prepared = prepare(scene, report);
  scene.environment.radiance = Color(2.0f);
  prepared = prepare(scene, report, std::move(prepared));
  EXPECT_EQ(prepared.lights.environment_radiance({0, 0, 1}, false), Color(2.0f));
  scene.environment.light_group = 3;
  prepared = prepare(scene, report, std::move(prepared));
  EXPECT_EQ(prepared.lights.environment_light_group(), 3);
}

// Those that ordinary scenes have: of their own mesh each, no catchers.
TEST(Prepare, small_meshes_share_a_tree_unless_they_are_to_be_moved) {
  Scene scene = scene_of(one_triangle(0));
  scene.instances.append({.name = "other", .shape = scene.shapes.append(one_triangle(2)), .object_to_world = {}});
  Report report;
  for (const bool is_live : {false, true}) {
    PreparedScene prepared = prepare(scene, report, {}, {.is_live = is_live});
    const PreparedScene::PreparedInstance& first = prepared.instances[0];
    const Tracer::Move move{0,
                            {.shape = first.shape,
                             .object_to_world = first.placement.object_to_world,
                             .world_to_object = first.placement.world_to_object,
                             .visibility = first.visibility}};
    EXPECT_EQ(prepared.tracer.move_instances(std::span(&move, 1), {}), is_live);
  }
}

TEST(PrepareWatched, gives_what_prepare_gives_and_a_fraction_that_never_falls) {
  const Scene scene = scene_of(large_mesh(700));
  Report report;
  double last = 0;
  int calls = 0;
  const PreparedScene prepared = prepare_watched(scene, report, 1, [&](double fraction) {
    EXPECT_GE(fraction, last);
    EXPECT_LE(fraction, 1);
    last = fraction;
    ++calls;
    return true;
  });
  EXPECT_GT(calls, 0);
  EXPECT_GT(last, 0);
  const PreparedScene expected = prepare(scene, report);
  EXPECT_EQ(prepared.tracer.memory(), expected.tracer.memory());
  const Hit hit = first_hit(prepared, {300.3f, 200.2f, 5}, {0, 0, -1});
  EXPECT_EQ(hit.primitive, first_hit(expected, {300.3f, 200.2f, 5}, {0, 0, -1}).primitive);
  EXPECT_TRUE(hit.is_hit());
}

TEST(PrepareWatched, ends_soon_after_it_is_cancelled) {
  using Clock = std::chrono::steady_clock;
  const Scene scene = scene_of(large_mesh(1000));
  for (const BvhBuilder builder : {BvhBuilder::median, BvhBuilder::binned_sah}) {
    Scene copy = scene;
    copy.settings.bvh_builder = builder;
    Report report;
    // Other programs may hold up any one try.
    double shortest = std::numeric_limits<double>::infinity();
    for (int attempt = 0; attempt < 5 && shortest > 0.1; ++attempt) {
      Clock::time_point cancelled;
      EXPECT_THROW((void)prepare_watched(copy, report, 2,
                                         [&](double) {
                                           cancelled = Clock::now();
                                           return false;
                                         }),
                   Cancelled);
      shortest = std::min(shortest, std::chrono::duration<double>(Clock::now() - cancelled).count());
    }
    EXPECT_LT(shortest, 0.1);
  }
}

TEST(PrepareWatched, ends_with_what_the_watch_throws) {
  const Scene scene = scene_of(large_mesh(700));
  Report report;
  const auto watch = [](double) -> bool { throw std::runtime_error("enough"); };
  EXPECT_THROW((void)prepare_watched(scene, report, 1, watch), std::runtime_error);
}

TEST(Prepare, is_the_same_for_any_number_of_threads) {
  Scene scene = scene_of(large_mesh(150));
  for (int i = 0; i < 40; ++i)
    scene.instances.append(
        {.name = "", .shape = scene.shapes.append(one_triangle(10.0f * static_cast<float>(i))), .object_to_world = {}});
  Report report;
  const PreparedScene one = prepare(scene, report, {}, {.threads = 1}),
                      four = prepare(scene, report, {}, {.threads = 4});
  EXPECT_EQ(one.tracer.memory(), four.tracer.memory());
  for (int i = 0; i < 40; ++i) {
    const Vec3f origin{10.0f * static_cast<float>(i) + 0.2f, 0.3f, 5};
    const Hit a = first_hit(one, origin, {0, 0, -1}), b = first_hit(four, origin, {0, 0, -1});
    EXPECT_TRUE(a.is_hit());
    EXPECT_EQ(a.instance, b.instance);
    EXPECT_EQ(a.primitive, b.primitive);
    EXPECT_EQ(a.t, b.t);
  }
}

}  // namespace
}  // namespace basicrt
