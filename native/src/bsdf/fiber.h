// SPDX-License-Identifier: GPL-3.0-or-later
// What lobes of hair have in common: which way the fibre runs, and directions by their angles to it.
#pragma once

#include <algorithm>
#include <cmath>

#include "math/constants.h"
#include "math/vec.h"

namespace basicrt {

// A direction of unit length in two numbers. Lobes' z is the surface's normal, so that a fibre's is near zero.
struct FiberDirection {
  float z = 0, azimuth = 0;

  FiberDirection() = default;
  // Of any length; without one the x axis stands in.
  explicit FiberDirection(Vec3f along) {
    const float size = length(along);
    if (!(size > 0 && std::isfinite(size))) return;
    z = std::clamp(along.z / size, -1.0f, 1.0f);
    azimuth = std::atan2(along.y, along.x);
  }
  [[nodiscard]] Vec3f vector() const {
    const float ring = std::sqrt(std::max(0.0f, 1 - z * z));
    return {ring * std::cos(azimuth), ring * std::sin(azimuth), z};
  }
};

// Across the fibre as the viewer sees it. `towards` is the viewer's direction without its part along the fibre.
struct FiberFrame {
  Vec3f along, towards, side;  // right-handed

  FiberFrame(Vec3f fiber, Vec3f wo) : along(fiber) {
    Vec3f flat = wo - along * dot(along, wo);
    if (!(length_squared(flat) > 1e-12f))
      flat = cross(along, std::abs(along.x) < 0.5f ? Vec3f{1, 0, 0} : Vec3f{0, 1, 0});
    towards = normalize(flat);
    side = cross(along, towards);
  }
  // By the sine and cosine of the angle to the plane across the fibre, and the angle around it, 0 being the viewer's.
  [[nodiscard]] Vec3f direction(float sine, float cosine, float around) const {
    return towards * (cosine * std::cos(around)) + side * (cosine * std::sin(around)) + along * sine;
  }
  [[nodiscard]] float angle_around(Vec3f direction) const {
    return std::atan2(dot(direction, side), dot(direction, towards));
  }
};

inline float cos_of_sin(float sine) { return std::sqrt(std::max(0.0f, 1 - sine * sine)); }

}  // namespace basicrt
