// SPDX-License-Identifier: GPL-3.0-or-later
// Rays against axis-aligned boxes: a slab test in single precision that never loses a box that the ray touches.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "math/bounds.h"
#include "math/vec.h"

namespace basicrt {

// Distances along a ray, both ends included.
struct Interval {
  float entry = 0;
  float exit = std::numeric_limits<float>::infinity();
};

// What a distance computed by the slab test may be off by, relative to itself: the roundings of the direction, its
// inverse (which may be denormal), the difference and the product, and as much again for the t_max compared with
// (Ize 2013, "Robust BVH Ray Traversal").
inline constexpr float slab_error = 0x1p-20f;

// A ray made ready for slab tests. The origin is rounded twice, so that planes where the ray enters come out nearer
// and planes where it leaves farther than they are.
struct BoxRay {
  Vec3f entry_origin, exit_origin;
  Vec3f inverse_direction;
  bool enters_at_upper[3];
};

// One axis of a BoxRay. Along a direction of exactly zero the inverse is infinite: planes lie at -inf or +inf, and at
// NaN only where the origin is in the plane, which the comparisons below take for a touch.
inline void set_box_ray_axis(BoxRay& ray, std::size_t axis, double origin, double direction) {
  const float o = static_cast<float>(origin);
  const float d = static_cast<float>(direction);
  const float largest = std::numeric_limits<float>::max();
  const bool is_representable =
      std::abs(o) <= largest && (direction == 0 || (std::isnormal(d) && std::abs(d) <= largest));
  const float padding = std::copysign(std::abs(o) * 0x1p-23f + std::numeric_limits<float>::min(), d);
  ray.enters_at_upper[axis] = std::signbit(d) && is_representable;
  // An axis that floats can't hold culls nothing but empty boxes: the planes of others lie at -inf and +inf.
  ray.inverse_direction[axis] = is_representable ? 1.0f / d : std::numeric_limits<float>::infinity();
  ray.entry_origin[axis] = is_representable ? o + padding : largest;
  ray.exit_origin[axis] = is_representable ? o - padding : -largest;
}

inline BoxRay make_box_ray(Vec3d origin, Vec3d direction) {
  BoxRay ray{};
  for (std::size_t axis = 0; axis < 3; ++axis) set_box_ray_axis(ray, axis, origin[axis], direction[axis]);
  return ray;
}

inline float slab_margin(float t) { return std::min(std::abs(t), std::numeric_limits<float>::max()) * slab_error; }

// Where the ray is inside the box, clamped to `range`; nothing where it passes by. An empty box is never touched.
inline std::optional<Interval> intersect_box(const BoxRay& ray, const Bounds3f& box, Interval range) {
  if (box.is_empty()) return std::nullopt;
  float entry = -std::numeric_limits<float>::infinity();
  float exit = std::numeric_limits<float>::infinity();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const bool flipped = ray.enters_at_upper[axis];
    const float near_plane = flipped ? box.upper[axis] : box.lower[axis];
    const float far_plane = flipped ? box.lower[axis] : box.upper[axis];
    const float axis_entry = (near_plane - ray.entry_origin[axis]) * ray.inverse_direction[axis];
    const float axis_exit = (far_plane - ray.exit_origin[axis]) * ray.inverse_direction[axis];
    entry = axis_entry > entry ? axis_entry : entry;  // a NaN changes nothing
    exit = axis_exit < exit ? axis_exit : exit;
  }
  entry = std::max(range.entry, entry - slab_margin(entry));
  exit = std::min(range.exit, exit + slab_margin(exit));
  if (!(entry <= exit)) return std::nullopt;
  return Interval{entry, exit};
}

}  // namespace basicrt
