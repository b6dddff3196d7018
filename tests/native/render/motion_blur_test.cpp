// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures of what moves against closed forms, and against what stands still.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "render/session.h"

namespace basicrt {
namespace {

constexpr int width = 64;
constexpr float travel = 4;  // metres

// Radiance 1 on both sides.
Id<Material> add_white_light(Scene& scene) {
  Material material;
  material.surface = material.add(EmissionShader{.radiance = Color(1.0f), .is_two_sided = true});
  return scene.materials.append(std::move(material));
}

Mesh square() {
  Mesh mesh;
  mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

Transform translation(Vec3f offset) {
  Transform transform;
  for (std::size_t axis = 0; axis < 3; ++axis) transform.rows[axis][3] = offset[axis];
  return transform;
}

// A row of pixels over x from -2 to 6, seen from above; a square of two metres that shines.
Scene scene_of_square(const Mesh& mesh) {
  Scene scene;
  OrthographicCamera camera;
  camera.to_world = translation({0, 0, 5});
  camera.window_min = {-2, -0.05f};
  camera.window_max = {6, 0.05f};
  scene.camera = camera;
  scene.settings.width = width;
  scene.settings.height = 1;
  scene.settings.samples = 256;
  scene.settings.filter.kind = FilterKind::box;
  scene.settings.filter.radius = 0.5f;
  scene.instances.append(
      {.name = "", .shape = scene.shapes.append(mesh), .object_to_world = {}, .materials = {add_white_light(scene)}});
  return scene;
}

Scene scene_of_moving_instance() {
  Scene scene = scene_of_square(square());
  Instance instance = scene.instances[Id<Instance>{0}];
  instance.motion_transforms = {translation({travel / 2, 0, 0}), translation({travel, 0, 0})};
  scene.instances.set(Id<Instance>{0}, instance);
  return scene;
}
Scene scene_of_deforming_mesh() {
  Mesh mesh = square();
  for (Vec3f& position : mesh.motion_positions.emplace_back(mesh.positions)) position.x += travel;
  return scene_of_square(mesh);
}
Scene scene_of_moving_camera() {
  Scene scene = scene_of_square(square());
  std::get<OrthographicCamera>(*scene.camera).motion_transforms = {translation({-travel, 0, 5})};
  return scene;
}

Film render_scene(const Scene& scene) {
  Report report;
  return render(prepare(scene, report));
}

// Of a pixel that is seen so much of the time, by place along x, averaged over the pixel.
double mean_over_pixel(int pixel, const std::function<double(double)>& seen_share) {
  constexpr int steps = 200;
  double sum = 0;
  for (int i = 0; i < steps; ++i) sum += seen_share(-2 + 8 * (pixel + (i + 0.5) / steps) / width);
  return sum / steps;
}

// How much of the shutter's light the square is over a place, given the integral of the normalised curve.
double seen_share(double x, const std::function<double(double)>& integral) {
  const double begin = std::clamp((x - 1) / travel, 0.0, 1.0), end = std::clamp((x + 1) / travel, 0.0, 1.0);
  return integral(end) - integral(begin);
}

void expect_smear(const Scene& scene, const std::function<double(double)>& integral) {
  const Film film = render_scene(scene);
  const std::vector<float>& combined = film.values(Pass::combined);
  for (int pixel = 0; pixel < width; ++pixel) {
    const double expected = mean_over_pixel(pixel, [&](double x) { return seen_share(x, integral); });
    EXPECT_NEAR(double{combined[4 * static_cast<std::size_t>(pixel)]}, expected, 0.02) << "pixel " << pixel;
  }
}

TEST(MotionBlur, a_square_that_moves_is_smeared_evenly) {
  const auto even = [](double time) { return time; };
  {
    SCOPED_TRACE("instance");
    expect_smear(scene_of_moving_instance(), even);
  }
  {
    SCOPED_TRACE("deforming mesh");
    expect_smear(scene_of_deforming_mesh(), even);
  }
  SCOPED_TRACE("camera");
  expect_smear(scene_of_moving_camera(), even);
}

TEST(MotionBlur, the_shutter_s_curve_weighs_the_smear) {
  for (Scene scene : {scene_of_moving_instance(), scene_of_deforming_mesh(), scene_of_moving_camera()}) {
    scene.settings.shutter_curve = {1, 0};
    expect_smear(scene, [](double time) { return time * (2 - time); });
    scene.settings.shutter_curve = {0, 1, 0};
    expect_smear(scene, [](double time) { return time < 0.5 ? 2 * time * time : 1 - 2 * (1 - time) * (1 - time); });
  }
}

// A floor under a shining square that flies over it: light samples and paths that run into it must agree.
TEST(MotionBlur, what_shines_lights_others_from_where_it_is) {
  const auto mean_on_floor = [](std::vector<Vec3f> stops, int max_bounces) {
    Scene scene;
    OrthographicCamera camera;
    camera.to_world = translation({0, 0, 0.5f});
    camera.window_min = {-0.1f, -0.1f};
    camera.window_max = {0.1f, 0.1f};
    scene.camera = camera;
    scene.settings.width = scene.settings.height = 4;
    scene.settings.samples = 4096;
    scene.settings.max_bounces = max_bounces;
    Mesh floor = square();
    scene.instances.append(
        {.name = "floor", .shape = scene.shapes.append(floor), .object_to_world = {}, .materials = {}});
    Instance lamp{.name = "lamp",
                  .shape = scene.shapes.append(square()),
                  .object_to_world = translation(stops[0]),
                  .materials = {add_white_light(scene)}};
    for (std::size_t i = 1; i < stops.size(); ++i) lamp.motion_transforms.push_back(translation(stops[i]));
    scene.instances.append(lamp);
    const Film film = render_scene(scene);
    double sum = 0;
    for (std::size_t i = 0; i < 16; ++i) sum += double{film.values(Pass::combined)[4 * i]} / 16;
    return sum;
  };
  const Vec3f begin{0, 0, 1}, end{6, 0, 3};
  double expected = 0;
  constexpr int moments = 16;
  for (int i = 0; i < moments; ++i)
    expected += mean_on_floor({begin + (end - begin) * ((static_cast<float>(i) + 0.5f) / moments)}, 0) / moments;
  EXPECT_NEAR(mean_on_floor({begin, end}, 0), expected, 0.01 * expected);
}

// Keys that are all alike change nothing. Both scenes draw times, for something else moves out of sight.
TEST(MotionBlur, equal_keys_give_the_picture_of_what_stands_still) {
  const auto make = [](bool has_keys) {
    Scene scene = scene_of_moving_instance();
    scene.camera = make_look_at_camera({0, -6, 8}, {0, 0, 6}, {0, 0, 1}, 0.6f, 1.5f);
    scene.settings.width = 48;
    scene.settings.height = 32;
    scene.settings.samples = 8;
    scene.environment.radiance = Color(0.2f, 0.3f, 0.5f);
    Mesh bumpy;
    for (std::uint32_t i = 0; i <= 20; ++i)
      for (std::uint32_t j = 0; j <= 20; ++j)
        bumpy.positions.push_back({static_cast<float>(i) / 5 - 2, static_cast<float>(j) / 5 - 2,
                                   0.3f * std::sin(static_cast<float>(3 * i + j))});
    for (std::uint32_t i = 0; i < 20; ++i)
      for (std::uint32_t j = 0; j < 20; ++j) {
        const std::uint32_t corner = 21 * i + j;
        bumpy.triangles.push_back({corner, corner + 21, corner + 22});
        bumpy.triangles.push_back({corner, corner + 22, corner + 1});
      }
    if (has_keys) bumpy.motion_positions = {bumpy.positions, bumpy.positions};
    Instance ball{.name = "ball",
                  .shape = scene.shapes.append(Sphere{{0, 0, 0}, 0.8f}),
                  .object_to_world = translation({0.3f, 0.1f, 6}),
                  .materials = {}};
    Instance ground{.name = "ground",
                    .shape = scene.shapes.append(bumpy),
                    .object_to_world = translation({0, 0, 5}),
                    .materials = {}};
    ground.object_to_world.rows[0][1] = 0.2f;
    if (has_keys) {
      ball.motion_transforms = std::vector<Transform>(2, ball.object_to_world);
      ground.motion_transforms = std::vector<Transform>(3, ground.object_to_world);
      auto& camera = std::get<PerspectiveCamera>(*scene.camera);
      camera.motion_transforms = {camera.to_world};
    }
    scene.instances.append(ball);
    scene.instances.append(ground);
    return scene;
  };
  EXPECT_EQ(render_scene(make(true)).values(Pass::combined), render_scene(make(false)).values(Pass::combined));
}

TEST(MotionBlur, the_same_bytes_for_any_number_of_threads) {
  Scene scene = scene_of_moving_instance();
  scene.settings.samples = 3;
  Report report;
  const Film one = render(prepare(scene, report), {.threads = 1, .tile_size = 64});
  const Film many = render(prepare(scene, report), {.threads = 3, .tile_size = 5});
  EXPECT_EQ(one.values(Pass::combined), many.values(Pass::combined));
}

}  // namespace
}  // namespace basicrt
