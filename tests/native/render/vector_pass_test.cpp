// SPDX-License-Identifier: GPL-3.0-or-later
// The pass Vector: how far what a pixel shows moves on the film from frame to frame.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <utility>
#include <variant>
#include <vector>

#include "render/session.h"

namespace basicrt {
namespace {

using Vector = std::array<float, 4>;

constexpr int width = 16, height = 8;

Transform moved(Vec3f by) {
  Transform transform;
  for (std::size_t axis = 0; axis < 3; ++axis) transform.rows[axis][3] = by[static_cast<int>(axis)];
  return transform;
}

// An orthographic camera from above: a pixel is half a metre wide.
Camera camera_from_above() {
  OrthographicCamera camera;
  camera.to_world = moved({0, 0, 5});
  camera.window_min = {-4, -2};
  camera.window_max = {4, 2};
  return camera;
}

// A level rectangle before it.
Scene scene_of_rectangle(Vec2f lower, Vec2f upper) {
  Scene scene;
  scene.camera = camera_from_above();
  scene.settings.width = width;
  scene.settings.height = height;
  scene.settings.samples = 4;
  scene.settings.passes.enable(Pass::vector);
  Mesh mesh;
  mesh.positions = {{lower.x, lower.y, 0}, {upper.x, lower.y, 0}, {upper.x, upper.y, 0}, {lower.x, upper.y, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  scene.instances.append(
      {.name = "rectangle", .shape = scene.shapes.append(mesh), .object_to_world = {}, .materials = {}});
  return scene;
}

Scene scene_of_floor() { return scene_of_rectangle({-99, -99}, {99, 99}); }

template <class Edit>
void edit_instance(Scene& scene, Edit&& change) {
  Instance instance = scene.instances[0];
  change(instance);
  scene.instances.set({0}, instance);
}

std::vector<Vector> vectors_of(const Scene& scene) {
  Report report;
  const Film film = render(prepare(scene, report));
  const std::vector<float>& values = film.values(Pass::vector);
  std::vector<Vector> vectors(values.size() / 4);
  for (std::size_t i = 0; i < values.size(); ++i) vectors[i / 4][i % 4] = values[i];
  return vectors;
}

void expect_all(const Scene& scene, const Vector& expected, float tolerance = 1e-4f) {
  const std::vector<Vector> vectors = vectors_of(scene);
  for (std::size_t pixel = 0; pixel < vectors.size(); ++pixel)
    for (std::size_t i = 0; i < 4; ++i)
      ASSERT_NEAR(vectors[pixel][i], expected[i], tolerance) << "pixel " << pixel << ", number " << i;
}

TEST(VectorPass, an_object_comes_from_the_frame_before_and_goes_to_the_frame_after) {
  Scene scene = scene_of_floor();
  expect_all(scene, {0, 0, 0, 0}, 0);
  edit_instance(scene,
                [](Instance& floor) { floor.adjacent_transforms = {moved({-1, 0, 0}), moved({1.5f, 0.5f, 0})}; });
  expect_all(scene, {-2, 0, -3, -1});
}

TEST(VectorPass, a_mesh_s_vertices_move_within_their_object) {
  Scene scene = scene_of_floor();
  Mesh mesh = std::get<Mesh>(scene.shapes[Id<Shape>{0}]);
  mesh.adjacent_positions = {mesh.positions, mesh.positions};
  for (Vec3f& position : mesh.adjacent_positions[0]) position.y *= 3;
  for (Vec3f& position : mesh.adjacent_positions[1]) position.x += 1;
  scene.shapes.set({0}, mesh);
  edit_instance(scene, [](Instance& floor) { floor.adjacent_transforms = {moved({2, 0, 0}), moved({0, -1, 0})}; });
  const std::vector<Vector> vectors = vectors_of(scene);
  for (int y = 0; y < height; ++y) {
    const Vector& vector = vectors[static_cast<std::size_t>(y * width + 3)];
    EXPECT_NEAR(vector[0], 4, 1e-3f);
    // Within a pixel samples are half of one up or down: it is tripled, so up to one.
    EXPECT_NEAR(vector[1], 2 * (static_cast<float>(y) + 0.5f - 0.5f * height), 1.01f);
    EXPECT_NEAR(vector[2], -2, 1e-3f);
    EXPECT_NEAR(vector[3], 2, 1e-3f);
  }
}

TEST(VectorPass, the_camera_of_each_frame_counts) {
  Scene scene = scene_of_floor();
  OrthographicCamera before = std::get<OrthographicCamera>(*scene.camera), after = before;
  before.to_world = moved({1, 0, 5});
  after.window_min.y = -1;  // lens shift
  after.window_max.y = 3;
  scene.adjacent_cameras = {before, after};
  expect_all(scene, {-2, 0, 0, 2});
  edit_instance(scene, [](Instance& floor) { floor.adjacent_transforms = {moved({1, 0, 0}), moved({0, 1, 0})}; });
  expect_all(scene, {0, 0, 0, 0});
}

// A point at a place of the film goes away from its middle by the camera's zoom.
TEST(VectorPass, a_zoom_moves_all_away_from_the_middle) {
  Scene scene = scene_of_floor();
  PerspectiveCamera camera;
  camera.to_world = moved({0, 0, 5});
  camera.window_min = {-2, -1};
  camera.window_max = {2, 1};
  scene.camera = camera;
  PerspectiveCamera narrow = camera;
  narrow.window_min = {-1, -0.5f};
  narrow.window_max = {1, 0.5f};
  scene.adjacent_cameras = {narrow, camera};
  const std::vector<Vector> vectors = vectors_of(scene);
  for (std::size_t x = 0; x < width; ++x) {
    const Vector& vector = vectors[3 * width + x];
    EXPECT_NEAR(vector[0], static_cast<float>(x) + 0.5f - 0.5f * width, 0.51f);
    EXPECT_NEAR(vector[2], 0, 1e-4f);
  }
}

TEST(VectorPass, what_is_behind_everything_moves_as_the_camera_turns) {
  Scene scene = scene_of_rectangle({-99, -0.1f}, {-98, 0.1f});  // out of sight
  PerspectiveCamera camera;
  camera.to_world = moved({0, 0, 5});
  camera.window_min = {-2, -1};
  camera.window_max = {2, 1};
  scene.camera = camera;
  PerspectiveCamera turned = camera, elsewhere = camera;
  turned.to_world.rows = {{{0, -1, 0, 3}, {1, 0, 0, -7}, {0, 0, 1, 9}}};  // a quarter about the axis of view
  elsewhere.to_world = moved({1, 2, 3});
  scene.adjacent_cameras = {turned, elsewhere};
  const std::vector<Vector> vectors = vectors_of(scene);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const float right = static_cast<float>(x) + 0.5f - 0.5f * width,
                  up = static_cast<float>(y) + 0.5f - 0.5f * height;
      const Vector& vector = vectors[static_cast<std::size_t>(y * width + x)];
      // Samples are up to half a pixel to each side, twice over.
      EXPECT_NEAR(vector[0], up - right, 1.01f);
      EXPECT_NEAR(vector[1], -right - up, 1.01f);
      EXPECT_NEAR(vector[2], 0, 1e-3f);
      EXPECT_NEAR(vector[3], 0, 1e-3f);
    }
  EXPECT_GT(std::abs(vectors.front()[1]), 8);
  scene.settings.has_background_vectors = false;
  expect_all(scene, {0, 0, 0, 0}, 0);
  scene.settings.has_background_vectors = true;
  scene.camera = camera_from_above();  // infinitely far it sees one point alone
  scene.adjacent_cameras = {turned, camera_from_above()};
  expect_all(scene, {0, 0, 0, 0}, 0);
}

TEST(VectorPass, the_background_counts_like_everything_else_where_it_is_shown) {
  Scene scene = scene_of_rectangle({-0.75f, -99}, {0.75f, 99});  // one and a half pixels to both sides
  edit_instance(scene, [](Instance& strip) { strip.adjacent_transforms = {moved({-1, 0, 0}), moved({1, 0, 0})}; });
  scene.settings.samples = 64;
  scene.settings.filter = {.kind = FilterKind::box, .radius = 0.5f};
  const std::vector<Vector> vectors = vectors_of(scene);
  EXPECT_NEAR(vectors[5][0], 0, 1e-4f);
  EXPECT_NEAR(vectors[6][0], -1, 0.05f);
  EXPECT_NEAR(vectors[7][0], -2, 1e-4f);
}

TEST(VectorPass, without_the_background_it_is_the_mean_of_what_is_hit) {
  Scene scene = scene_of_rectangle({-0.75f, -99}, {0.75f, 99});  // one and a half pixels to both sides
  edit_instance(scene, [](Instance& strip) { strip.adjacent_transforms = {moved({-1, 0, 0}), moved({1, 0, 0})}; });
  scene.settings.has_background_vectors = false;
  scene.settings.samples = 64;
  scene.settings.filter = {.kind = FilterKind::box, .radius = 0.5f};
  const std::vector<Vector> vectors = vectors_of(scene);
  for (std::size_t x = 0; x < width; ++x) {
    const bool is_seen = x >= 6 && x <= 9;  // half of the first and of the last
    EXPECT_NEAR(vectors[x][0], is_seen ? -2 : 0, 1e-4f) << x;
    EXPECT_NEAR(vectors[x][3], 0, 1e-4f) << x;
  }
  scene.settings.filter = {.kind = FilterKind::mitchell, .radius = 2};
  for (const Vector& vector : vectors_of(scene))
    EXPECT_TRUE(vector[0] == 0 || std::abs(vector[0] + 2) < 1e-4f) << vector[0];
}

TEST(VectorPass, what_was_behind_the_camera_has_none) {
  Scene scene = scene_of_floor();
  PerspectiveCamera camera;
  camera.to_world = moved({0, 0, 5});
  scene.camera = camera;
  edit_instance(scene, [](Instance& floor) { floor.adjacent_transforms = {moved({1, 0, 9}), moved({1, 0, 0})}; });
  const std::vector<Vector> vectors = vectors_of(scene);
  for (const Vector& vector : vectors) {
    EXPECT_EQ(vector[0], 0);
    EXPECT_NEAR(vector[2], -width / 2 / 5.0f, 1e-4f);
  }
}

TEST(VectorPass, around_a_panorama_goes_the_shorter_way) {
  Scene scene = scene_of_floor();
  EquirectangularCamera camera;
  camera.to_world = moved({0, 0, 5});
  scene.camera = camera;
  // Turned to the left and to the right by 30 degrees about the vertical of the picture.
  const float s = 0.5f, c = std::sqrt(0.75f);
  EquirectangularCamera left = camera, right = camera;
  left.to_world.rows = {{{c, 0, s, 0}, {0, 1, 0, 0}, {-s, 0, c, 5}}};
  right.to_world.rows = {{{c, 0, -s, 0}, {0, 1, 0, 0}, {s, 0, c, 5}}};
  scene.adjacent_cameras = {left, right};
  const float expected = width / 12.0f;
  const std::vector<Vector> vectors = vectors_of(scene);
  int seen = 0;
  for (const Vector& vector : vectors) {
    if (vector == Vector{}) continue;
    ++seen;
    EXPECT_NEAR(vector[0], expected, 1e-3f);
    EXPECT_NEAR(vector[2], expected, 1e-3f);
  }
  EXPECT_GT(seen, width);
}

// From where it is at the sample's time.
TEST(VectorPass, what_is_blurred_has_it_too) {
  Scene scene = scene_of_floor();
  edit_instance(scene, [](Instance& floor) {
    floor.motion_transforms = {moved({1, 0, 0})};
    floor.adjacent_transforms = {moved({-1, 0, 0}), moved({3, 0, 0})};
  });
  scene.settings.samples = 1024;
  scene.settings.width = 2;
  scene.settings.height = 1;
  scene.camera = camera_from_above();
  for (const Vector& vector : vectors_of(scene)) {
    EXPECT_NEAR(vector[0], -1.5f / 4, 0.01f);
    EXPECT_NEAR(vector[2], -2.5f / 4, 0.01f);
  }
}

TEST(VectorPass, follows_instances_that_were_moved_since_the_last_picture) {
  Scene scene = scene_of_floor();
  Report report;
  PreparedScene prepared = prepare(scene, report);
  edit_instance(scene, [](Instance& floor) { floor.adjacent_transforms = {moved({-1, 0, 0}), moved({0, 0, 0})}; });
  OrthographicCamera camera = std::get<OrthographicCamera>(camera_from_above()), shifted = camera;
  shifted.to_world = moved({0, -1, 5});
  scene.adjacent_cameras = {camera, shifted};
  prepared = prepare(scene, report, std::move(prepared));
  const std::vector<float> values = render(std::move(prepared)).values(Pass::vector);
  EXPECT_NEAR(values[0], -2, 1e-4f);
  EXPECT_NEAR(values[3], -2, 1e-4f);
}

}  // namespace
}  // namespace basicrt
