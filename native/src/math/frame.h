// SPDX-License-Identifier: GPL-3.0-or-later
// An orthonormal basis around a direction.
#pragma once

#include <cmath>

#include "math/vec.h"

namespace basicrt {

struct Frame {
  Vec3f tangent{1, 0, 0}, bitangent{0, 1, 0}, normal{0, 0, 1};

  [[nodiscard]] Vec3f to_local(Vec3f v) const { return {dot(v, tangent), dot(v, bitangent), dot(v, normal)}; }
  [[nodiscard]] Vec3f to_world(Vec3f v) const { return tangent * v.x + bitangent * v.y + normal * v.z; }
};

// Duff et al. 2017, "Building an Orthonormal Basis, Revisited". `normal` has unit length.
inline Frame make_frame(Vec3f normal) {
  const float sign = std::copysign(1.0f, normal.z);
  const float a = -1.0f / (sign + normal.z);
  const float b = normal.x * normal.y * a;
  return {{1.0f + sign * normal.x * normal.x * a, sign * b, -sign * normal.x},
          {b, sign + normal.y * normal.y * a, -normal.y},
          normal};
}

// The same with the tangent as near to `tangent` as the normal allows.
inline Frame make_frame(Vec3f normal, Vec3f tangent) {
  const Vec3f flat = tangent - normal * dot(normal, tangent);
  if (!(length_squared(flat) > 1e-12f * length_squared(tangent))) return make_frame(normal);
  const Vec3f unit = normalize(flat);
  return {unit, cross(normal, unit), normal};
}

}  // namespace basicrt
