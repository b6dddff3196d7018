// SPDX-License-Identifier: GPL-3.0-or-later
// From a place on the film to a ray in the world.
#include "camera/camera.h"

#include <cmath>

namespace basicrt {
namespace {

// The place on the window, in its own units.
Vec2f window_point(Vec2f window_min, Vec2f window_max, Vec2f pixel, Vec2i size) {
  return {std::lerp(window_min.x, window_max.x, pixel.x / static_cast<float>(size.x)),
          std::lerp(window_min.y, window_max.y, pixel.y / static_cast<float>(size.y))};
}

Vec2f window_step(Vec2f window_min, Vec2f window_max, Vec2i size) {
  return {(window_max.x - window_min.x) / static_cast<float>(size.x),
          (window_max.y - window_min.y) / static_cast<float>(size.y)};
}

CameraRay make_ray(const PerspectiveCamera& camera, Vec2f pixel, Vec2i size) {
  const Vec2f p = window_point(camera.window_min, camera.window_max, pixel, size);
  const Vec2f step = window_step(camera.window_min, camera.window_max, size);
  const Vec3f local{p.x, p.y, -1};
  const float distance_per_depth = length(local);
  const Vec3f towards = camera.to_world.vector(local);
  const float scale = 1 / length(towards);

  CameraRay result;
  Ray& ray = result.ray;
  ray.origin = camera.to_world.column(3);
  ray.direction = towards * scale;
  ray.t_min = camera.clip_near * distance_per_depth;
  ray.t_max = camera.clip_far * distance_per_depth;
  ray.kinds = ray_camera;
  // The derivative of v / |v|, given that of v.
  const auto direction_change = [&](Vec3f change) {
    return (change - ray.direction * dot(ray.direction, change)) * scale;
  };
  result.differentials.direction_dx = direction_change(camera.to_world.column(0) * step.x);
  result.differentials.direction_dy = direction_change(camera.to_world.column(1) * step.y);
  return result;
}

CameraRay make_ray(const OrthographicCamera& camera, Vec2f pixel, Vec2i size) {
  const Vec2f p = window_point(camera.window_min, camera.window_max, pixel, size);
  const Vec2f step = window_step(camera.window_min, camera.window_max, size);

  CameraRay result;
  Ray& ray = result.ray;
  ray.origin = camera.to_world.point(Vec3f{p.x, p.y, 0});
  ray.direction = normalize(camera.to_world.vector(Vec3f{0, 0, -1}));
  ray.t_min = camera.clip_near;
  ray.t_max = camera.clip_far;
  ray.kinds = ray_camera;
  result.differentials.origin_dx = camera.to_world.vector(Vec3f{step.x, 0, 0});
  result.differentials.origin_dy = camera.to_world.vector(Vec3f{0, step.y, 0});
  return result;
}

}  // namespace

PerspectiveCamera make_look_at_camera(Vec3f position, Vec3f look_at, Vec3f up, float fov, float aspect) {
  const Vec3f forward = normalize(look_at - position);
  const Vec3f right = normalize(cross(forward, up));
  const Vec3f camera_up = cross(right, forward);
  const float half_height = std::tan(fov / 2), half_width = half_height * aspect;

  PerspectiveCamera camera;
  for (int i = 0; i < 3; ++i) camera.to_world.rows[i] = {right[i], camera_up[i], -forward[i], position[i]};
  camera.window_min = {-half_width, -half_height};
  camera.window_max = {half_width, half_height};
  return camera;
}

CameraRay make_camera_ray(const Camera& camera, Vec2f pixel, Vec2i size) {
  return std::visit([&](const auto& kind) { return make_ray(kind, pixel, size); }, camera);
}

float camera_depth(const Camera& camera, Vec3f position) {
  const Transform& to_world = std::visit([](const auto& kind) -> const Transform& { return kind.to_world; }, camera);
  return dot(position - to_world.column(3), normalize(-to_world.column(2)));
}

}  // namespace basicrt
