// SPDX-License-Identifier: GPL-3.0-or-later
// Rays against axis-aligned boxes: a slab test in single precision that never loses a box that the ray touches.
#pragma once

#include <algorithm>
#include <limits>
#include <optional>

#include "math/bounds.h"
#include "math/simd.h"
#include "math/vec.h"

namespace basicrt {

// Distances along a ray, both ends included.
struct Interval {
  float entry = 0;
  float exit = std::numeric_limits<float>::infinity();
};

// What is left of an entry distance after taking off all that entry and exit may be wrong by: the roundings of the
// direction, its inverse (which may be denormal), the difference and the product, twice over (Ize 2013, "Robust BVH Ray
// Traversal"), and as much again for the double-precision distances that are compared with it.
inline constexpr float slab_scale = 1 - 0x1p-19f;

// A ray made ready for slab tests: lane i is axis i. The origin is rounded twice, so that planes where the ray enters
// come out nearer and planes where it leaves farther than they are.
struct BoxRay {
  Float4 entry_origin, exit_origin, inverse_direction;
  int enters_at_upper;  // bit i: along axis i the ray comes from the upper side

  [[nodiscard]] bool enters_at_upper_of(std::size_t axis) const { return enters_at_upper >> axis & 1; }
};

// `direction` as rounded to floats, but zero only where it really is. Along a direction of exactly zero the inverse is
// infinite: planes lie at -inf or +inf, and at NaN only where the origin is in the plane, which counts as a touch.
inline BoxRay make_box_ray(Float4 origin, Float4 direction) {
  using limits = std::numeric_limits<float>;
  const Float4 smallest = Float4::all(limits::min()), largest = Float4::all(limits::max());
  const Mask4 is_direction_usable = (smallest <= abs(direction)) | (direction == Float4::all(0));
  const Mask4 is_usable = is_direction_usable & (abs(direction) <= largest) & (abs(origin) <= largest);
  const Float4 padding = copysign(abs(origin) * Float4::all(0x1p-23f) + smallest, direction);
  // An axis that floats can't hold culls nothing but empty boxes: the planes of others lie at -inf and +inf.
  return {.entry_origin = select(is_usable, origin + padding, largest),
          .exit_origin = select(is_usable, origin - padding, Float4::all(-limits::max())),
          .inverse_direction = select(is_usable, Float4::all(1) / direction, Float4::all(limits::infinity())),
          .enters_at_upper = direction.sign_bits() & is_usable.bits()};
}
inline BoxRay make_box_ray(Vec3f origin, Vec3f direction) {
  return make_box_ray(Float4::of(origin.x, origin.y, origin.z, 0),
                      Float4::of(direction.x, direction.y, direction.z, 0));
}
inline BoxRay make_box_ray(Vec3d origin, Vec3d direction) {
  const auto round = [](double x) {
    const auto rounded = static_cast<float>(x);
    return rounded == 0 && x != 0 ? std::numeric_limits<float>::denorm_min() : rounded;
  };
  return make_box_ray(Vec3f(origin), Vec3f{round(direction.x), round(direction.y), round(direction.z)});
}

// Where the ray is inside the box, clamped to `range`, which has no negative distances; nothing where it passes by. An
// empty box is never touched.
inline std::optional<Interval> intersect_box(const BoxRay& ray, const Bounds3f& box, Interval range) {
  if (box.is_empty()) return std::nullopt;
  alignas(16) float entry_origin[4], exit_origin[4], inverse_direction[4];
  ray.entry_origin.store(entry_origin);
  ray.exit_origin.store(exit_origin);
  ray.inverse_direction.store(inverse_direction);
  float entry = range.entry, exit = range.exit;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const bool flipped = ray.enters_at_upper_of(axis);
    const float entry_plane = flipped ? box.upper[axis] : box.lower[axis];
    const float exit_plane = flipped ? box.lower[axis] : box.upper[axis];
    const float axis_entry = (entry_plane - entry_origin[axis]) * inverse_direction[axis];
    const float axis_exit = (exit_plane - exit_origin[axis]) * inverse_direction[axis];
    entry = axis_entry > entry ? axis_entry : entry;  // a NaN changes nothing
    exit = axis_exit < exit ? axis_exit : exit;
  }
  if (!(entry * slab_scale <= exit)) return std::nullopt;
  return Interval{std::max(range.entry, entry * slab_scale), std::min(range.exit, exit / slab_scale)};
}

}  // namespace basicrt
