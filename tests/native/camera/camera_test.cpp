// SPDX-License-Identifier: GPL-3.0-or-later
// Cameras against the geometry that defines them.
#include "camera/camera.h"

#include <gtest/gtest.h>

#include <cmath>

namespace basicrt {
namespace {

constexpr Vec2i size{200, 100};

void expect_near(Vec3f a, Vec3f b, float tolerance) { EXPECT_LT(length(a - b), tolerance); }

TEST(Camera, the_picture_s_centre_looks_at_the_target) {
  const Vec3f position{3, 1, -2}, target{0, 2, 5};
  const Camera camera = make_look_at_camera(position, target, {0, 1, 0}, 0.7f, 2);
  const Ray ray = CameraView(camera, size).ray({100, 50});
  EXPECT_EQ(ray.origin, position);
  expect_near(ray.direction, normalize(target - position), 1e-6f);
}

TEST(Camera, the_field_of_view_is_the_full_vertical_angle_and_up_is_up) {
  const float fov = 0.7f;
  const Camera camera = make_look_at_camera({0, 0, 0}, {0, 0, -1}, {0, 1, 0}, fov, 2);
  const Vec3f top = CameraView(camera, size).ray({100, 100}).direction;
  const Vec3f right = CameraView(camera, size).ray({200, 50}).direction;
  EXPECT_NEAR(std::atan2(top.y, -top.z), fov / 2, 1e-6);
  EXPECT_NEAR(right.x / -right.z, 2 * std::tan(fov / 2), 1e-6);
}

TEST(Camera, clipping_is_by_depth_and_not_by_distance) {
  PerspectiveCamera camera;
  camera.window_min = {-2, -1};
  camera.window_max = {2, 1};
  camera.clip_near = 0.5f;
  camera.clip_far = 10;
  const Ray corner = CameraView(camera, size).ray({0, 0});
  EXPECT_NEAR(corner.at(corner.t_min).z, -0.5, 1e-5);
  EXPECT_NEAR(corner.at(corner.t_max).z, -10, 1e-4);
  EXPECT_NEAR(CameraView(camera, size).depth(corner.at(corner.t_max)), 10, 1e-4);
}

TEST(Camera, orthographic_rays_are_parallel_and_start_on_the_window) {
  OrthographicCamera camera;
  camera.window_min = {-4, -2};
  camera.window_max = {4, 2};
  const Ray lower_left = CameraView(camera, size).ray({0, 0}), center = CameraView(camera, size).ray({100, 50});
  expect_near(lower_left.origin, {-4, -2, 0}, 1e-6f);
  expect_near(center.origin, {0, 0, 0}, 1e-6f);
  EXPECT_EQ(lower_left.direction, (Vec3f{0, 0, -1}));
  EXPECT_EQ(center.direction, lower_left.direction);
}

TEST(Camera, differentials_are_the_change_over_a_small_step_on_the_film) {
  constexpr float step = 1.0f / 16;
  const PerspectiveCamera perspective = make_look_at_camera({1, 2, 3}, {0, 0, 0}, {0, 1, 0}, 1, 2);
  OrthographicCamera orthographic;
  orthographic.to_world = perspective.to_world;
  for (const Camera& camera : {Camera(perspective), Camera(orthographic)}) {
    const Vec2f pixel{30.25f, 60.5f};
    const CameraView view(camera, size);
    const Ray ray = view.ray(pixel), right = view.ray(pixel + Vec2f{step, 0}), above = view.ray(pixel + Vec2f{0, step});
    const RayDifferentials change = view.differentials(pixel);
    expect_near(ray.direction + change.direction_dx * step, right.direction, 1e-6f);
    expect_near(ray.direction + change.direction_dy * step, above.direction, 1e-6f);
    expect_near(ray.origin + change.origin_dx * step, right.origin, 1e-5f);
    expect_near(ray.origin + change.origin_dy * step, above.origin, 1e-5f);
  }
}

}  // namespace
}  // namespace basicrt
