// SPDX-License-Identifier: GPL-3.0-or-later
// A ray and its differentials.
#pragma once

#include <cstdint>

#include "math/constants.h"
#include "math/vec.h"

namespace basicrt {

// Which rays see an object: one bit per kind of ray, as in Blender's Ray Visibility.
enum RayKind : std::uint32_t {
  ray_camera = 1u << 0,
  ray_diffuse = 1u << 1,
  ray_glossy = 1u << 2,
  ray_transmission = 1u << 3,
  ray_volume = 1u << 4,
  ray_shadow = 1u << 5,
  ray_own_choice = (1u << 6) - 1,  // all that objects choose by themselves
  ray_catcher = 1u << 6,           // sees shadow catchers and nothing else
  ray_linked_emitter = 1u << 7,    // sees what shines and has a shadow link of its own, and nothing else
  ray_all = ~0u,
};

// Shadow rays towards lights that only some objects dim: a kind for each choice of objects, number 0 first.
inline constexpr int most_shadow_links = 24;
[[nodiscard]] constexpr std::uint32_t shadow_link_kind(int number) { return 1u << (8 + number); }

// Points origin + t * direction for t in [t_min, t_max]. The direction need not have unit length.
struct Ray {
  Vec3f origin;
  float t_min = 0;
  Vec3f direction;
  float t_max = infinity;
  std::uint32_t kinds = ray_all;  // an instance is seen when its visibility has a bit of these
  float time = 0;                 // within the shutter, 0 opens and 1 closes
  // The triangle that the ray starts on, which it can't hit again; none for a ray that starts in space.
  std::uint32_t from_instance = ~0u, from_primitive = ~0u;

  [[nodiscard]] Vec3f at(float t) const { return origin + direction * t; }
};

// How the ray changes to the right and up, as derivatives: what texture filtering and texture coordinates' derivatives need.
struct RayDifferentials {
  Vec3f origin_dx, origin_dy;        // change of the origin per pixel
  Vec3f direction_dx, direction_dy;  // change of the direction per pixel
};

}  // namespace basicrt
