// SPDX-License-Identifier: GPL-3.0-or-later
// Cameras: they look along local -z with y up.
#pragma once

#include <string_view>
#include <tuple>
#include <variant>

#include "base/describe.h"
#include "math/ray.h"
#include "math/transform.h"

namespace basicrt {

// The window is the part of the plane z = -1 that the picture shows; lens shift and sensor fit are in it.
struct PerspectiveCamera {
  Transform to_world;
  Vec2f window_min{-1, -1}, window_max{1, 1};
  float clip_near = 0, clip_far = infinity;  // depth along -z
  static constexpr std::string_view kind = "perspective";
  static constexpr auto fields() {
    return std::tuple{
        field("transform", &PerspectiveCamera::to_world, "camera to world; looks along -z, y is up"),
        field("window_min", &PerspectiveCamera::window_min, "lower left corner on the plane z = -1"),
        field("window_max", &PerspectiveCamera::window_max, "upper right corner on the plane z = -1"),
        field("clip_near", &PerspectiveCamera::clip_near, "nothing nearer is seen, metres", at_least(0)),
        field("clip_far", &PerspectiveCamera::clip_far, "nothing farther is seen, metres", above_or_infinite(0))};
  }
};

// The window is in metres.
struct OrthographicCamera {
  Transform to_world;
  Vec2f window_min{-1, -1}, window_max{1, 1};
  float clip_near = 0, clip_far = infinity;
  static constexpr std::string_view kind = "orthographic";
  static constexpr auto fields() {
    return std::tuple{
        field("transform", &OrthographicCamera::to_world, "camera to world; looks along -z, y is up"),
        field("window_min", &OrthographicCamera::window_min, "lower left corner, metres"),
        field("window_max", &OrthographicCamera::window_max, "upper right corner, metres"),
        field("clip_near", &OrthographicCamera::clip_near, "nothing nearer is seen, metres", at_least(0)),
        field("clip_far", &OrthographicCamera::clip_far, "nothing farther is seen, metres", above_or_infinite(0))};
  }
};

using Camera = std::variant<PerspectiveCamera, OrthographicCamera>;

// `fov` is the full vertical angle, radians; `aspect` is width over height.
[[nodiscard]] PerspectiveCamera make_look_at_camera(Vec3f position, Vec3f look_at, Vec3f up, float fov, float aspect);

// A camera made ready for a film of one size. Places on the film are in pixels, (0, 0) its lower left corner.
class CameraView {
 public:
  CameraView() = default;
  CameraView(const Camera& camera, Vec2i film_size);

  [[nodiscard]] Ray ray(Vec2f pixel) const {
    const Vec3f towards = direction_ + direction_dx_ * pixel.x + direction_dy_ * pixel.y;
    const float reach = length(towards), distance_per_depth = reach * (1 / dot(towards, axis_));
    return {.origin = origin_ + origin_dx_ * pixel.x + origin_dy_ * pixel.y,
            .t_min = clip_near_ * distance_per_depth,
            .direction = towards * (1 / reach),
            .t_max = clip_far_ * distance_per_depth,
            .kinds = ray_camera};
  }
  // How the ray there changes.
  [[nodiscard]] RayDifferentials differentials(Vec2f pixel) const;
  // Depth along the viewing axis, as the Depth pass has it.
  [[nodiscard]] float depth(Vec3f position) const { return dot(position - position_, axis_); }

 private:
  void set_window(const PerspectiveCamera& camera, Vec2f step);
  void set_window(const OrthographicCamera& camera, Vec2f step);

  // Of the ray through (0, 0), and how they change from pixel to pixel. Directions are not yet of unit length.
  Vec3f origin_, origin_dx_, origin_dy_;
  Vec3f direction_, direction_dx_, direction_dy_;
  Vec3f position_, axis_;  // the camera's, of unit length
  float clip_near_ = 0, clip_far_ = infinity;
};

}  // namespace basicrt
