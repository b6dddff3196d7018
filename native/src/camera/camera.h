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

struct CameraRay {
  Ray ray;
  RayDifferentials differentials;
};

// `pixel` is a place on the film in pixels, (0, 0) its lower left corner; `size` the film's.
[[nodiscard]] CameraRay make_camera_ray(const Camera& camera, Vec2f pixel, Vec2i size);
// Depth along the viewing axis, as the Depth pass has it.
[[nodiscard]] float camera_depth(const Camera& camera, Vec3f position);

}  // namespace basicrt
