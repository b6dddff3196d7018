// SPDX-License-Identifier: GPL-3.0-or-later
// What all cameras have: a place, a window, clipping and an aperture.
#pragma once

#include <string_view>
#include <vector>

#include "base/describe.h"
#include "math/constants.h"
#include "math/transform.h"

namespace basicrt {

// The window is the rectangle that the picture shows; lens shift and sensor fit are in it. What it is measured in, each
// kind of camera says. A clipping or focus distance is a depth along -z, in a panorama it is one along the ray.
struct CameraBase {
  Transform to_world;
  Vec2f window_min{-1, -1}, window_max{1, 1};
  float clip_near = 0, clip_far = infinity;
  // What is out of focus is blurred to the aperture's shape.
  float aperture_radius = 0;
  int aperture_blades = 0;
  float aperture_rotation = 0, aperture_ratio = 1;
  float focus_distance = 10;
  std::vector<Transform> motion_transforms;  // at further times, as of an Instance
};

// The fields of a kind of camera: these, then its own.
template <class Kind, class... Own>
constexpr auto camera_fields(std::string_view window_min_doc, std::string_view window_max_doc, Own... own) {
  return fields_of(
      field<Kind, Transform>("transform", &Kind::to_world, "camera to world; looks along -z, y is up"),
      field<Kind, Vec2f>("window_min", &Kind::window_min, window_min_doc),
      field<Kind, Vec2f>("window_max", &Kind::window_max, window_max_doc),
      field<Kind, float>("clip_near", &Kind::clip_near, "nothing nearer is seen, metres", at_least(0)),
      field<Kind, float>("clip_far", &Kind::clip_far, "nothing farther is seen, metres", above_or_infinite(0)),
      field<Kind, float>("aperture_radius", &Kind::aperture_radius, "metres; 0: everything is in focus", at_least(0)),
      field<Kind, int>("aperture_blades", &Kind::aperture_blades, "corners of the aperture; below 3 it is round",
                       at_least(0)),
      field<Kind, float>("aperture_rotation", &Kind::aperture_rotation, "of the blades, radians"),
      field<Kind, float>("aperture_ratio", &Kind::aperture_ratio, "the aperture's height over its width", above(0)),
      field<Kind, float>("focus_distance", &Kind::focus_distance, "what is that far is sharp, metres", above(0)),
      field<Kind, std::vector<Transform>>(
          "motion_transforms", &Kind::motion_transforms,
          "camera to world at further times, equally spaced; the last is when the shutter closes"),
      own...);
}

// A place on the aperture, metres, x right and y up; `u` in [0, 1)^2.
[[nodiscard]] Vec2f sample_aperture(const CameraBase& camera, Vec2f u);
// Per square metre, within the aperture.
[[nodiscard]] float pdf_aperture(const CameraBase& camera);

}  // namespace basicrt
