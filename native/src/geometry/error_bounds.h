// SPDX-License-Identifier: GPL-3.0-or-later
// Running error bounds of computations in double precision.
#pragma once

#include <cmath>
#include <limits>

#include "math/next_float.h"
#include "math/transform.h"

namespace basicrt {

// Bounds the relative error of n roundings in a row (Higham 2002, "Accuracy and Stability of Numerical Algorithms").
constexpr double gamma(int n) {
  constexpr double unit_roundoff = std::numeric_limits<double>::epsilon() / 2;
  return n * unit_roundoff / (1 - n * unit_roundoff);
}

// Of each coordinate of transform.vector(p), given that each coordinate of p is off by at most `error`.
inline Vec3d spread(const TransformD& transform, Vec3d error) {
  Vec3d result;
  for (std::size_t i = 0; i < 3; ++i)
    result[i] = std::abs(transform.rows[i][0]) * error.x + std::abs(transform.rows[i][1]) * error.y +
                std::abs(transform.rows[i][2]) * error.z;
  return result;
}

// Of each coordinate of transform.point(p) by rounding alone.
inline Vec3d point_rounding(const TransformD& transform, Vec3d p) {
  return (spread(transform, abs(p)) + abs(transform.column(3))) * gamma(4);
}

// What rounding p to floats adds to an error: half a unit in the last place, or the smallest float near zero. The
// result is rounded up.
inline Vec3f round_up_with_float_error(Vec3d p, Vec3d error) {
  Vec3f result;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto rounded = static_cast<float>(p[i]);
    const double bound = error[i] + std::abs(p[i] - static_cast<double>(rounded));
    result[i] = next_float_up(static_cast<float>(bound));
  }
  return result;
}

}  // namespace basicrt
