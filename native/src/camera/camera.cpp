// SPDX-License-Identifier: GPL-3.0-or-later
// From a place on the film to a ray in the world.
#include "camera/camera.h"

#include <cmath>

namespace basicrt {

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

CameraView::CameraView(const Camera& camera, Vec2i film_size) {
  const auto set = [&](const auto& kind) {
    const Vec2f window = kind.window_max - kind.window_min;
    set_window(kind, {window.x / static_cast<float>(film_size.x), window.y / static_cast<float>(film_size.y)});
    position_ = kind.to_world.column(3);
    axis_ = normalize(-kind.to_world.column(2));
    clip_near_ = kind.clip_near;
    clip_far_ = kind.clip_far;
  };
  std::visit(set, camera);
}

void CameraView::set_window(const PerspectiveCamera& camera, Vec2f step) {
  origin_ = camera.to_world.column(3);
  direction_ = camera.to_world.vector(Vec3f{camera.window_min.x, camera.window_min.y, -1});
  direction_dx_ = camera.to_world.column(0) * step.x;
  direction_dy_ = camera.to_world.column(1) * step.y;
}

void CameraView::set_window(const OrthographicCamera& camera, Vec2f step) {
  origin_ = camera.to_world.point(Vec3f{camera.window_min.x, camera.window_min.y, 0});
  origin_dx_ = camera.to_world.column(0) * step.x;
  origin_dy_ = camera.to_world.column(1) * step.y;
  direction_ = -camera.to_world.column(2);
}

RayDifferentials CameraView::differentials(Vec2f pixel) const {
  const Vec3f direction = direction_ + direction_dx_ * pixel.x + direction_dy_ * pixel.y;
  const float scale = 1 / length(direction);
  // The derivative of v / |v|, given that of v.
  const auto unit_change = [&](Vec3f change) {
    return (change - direction * (dot(direction, change) * scale * scale)) * scale;
  };
  return {.origin_dx = origin_dx_,
          .origin_dy = origin_dy_,
          .direction_dx = unit_change(direction_dx_),
          .direction_dy = unit_change(direction_dy_)};
}

}  // namespace basicrt
