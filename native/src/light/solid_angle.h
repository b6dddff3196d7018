// SPDX-License-Identifier: GPL-3.0-or-later
// Measures of sets of directions. The width of a cone is 1 - cos of its half angle: precise however narrow it is.
#pragma once

#include <algorithm>
#include <cmath>

#include "math/transform.h"

namespace basicrt {

template <class T>
T one_minus_cos(T angle) {
  const T s = std::sin(angle / 2);
  return 2 * s * s;
}
// Of an angle up to pi / 2.
template <class T>
T one_minus_cos_from_sin_squared(T sin_squared) {
  return sin_squared / (T(1) + std::sqrt(std::max(T(0), T(1) - sin_squared)));
}

// How much solid angle there is in local space for each bit of it in world space, around a local direction of unit
// length: what turns a local density into one of the world.
inline double solid_angle_ratio(const TransformD& local_to_world, Vec3d local) {
  const double stretch = length(local_to_world.vector(local));
  return stretch * stretch * stretch / std::abs(local_to_world.determinant());
}

}  // namespace basicrt
