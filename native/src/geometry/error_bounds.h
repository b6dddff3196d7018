// SPDX-License-Identifier: GPL-3.0-or-later
// Running error bounds of computations in double precision.
#pragma once

#include <array>
#include <cmath>
#include <limits>

#include "geometry/gamma.h"
#include "math/transform.h"

namespace basicrt {

// Of each coordinate of transform.vector(p), given that each coordinate of p is off by at most `error`.
inline Vec3d spread(const TransformD& transform, Vec3d error) {
  const auto of_row = [&](const std::array<double, 4>& row) {
    return std::abs(row[0]) * error.x + std::abs(row[1]) * error.y + std::abs(row[2]) * error.z;
  };
  return {of_row(transform.rows[0]), of_row(transform.rows[1]), of_row(transform.rows[2])};
}

// Of each coordinate of transform.point(p), given that each coordinate of p is off by at most `error`.
inline Vec3d point_error(const TransformD& transform, Vec3d p, Vec3d error) {
  return spread(transform, error + abs(p) * gamma(4)) + abs(transform.column(3)) * gamma(4);
}

// At least the error of p after it is rounded to floats too.
inline Vec3f add_float_rounding(Vec3d p, Vec3d error) {
  const auto add = [](double x, double x_error) {
    const double bound = x_error + std::abs(x) * 0x1p-24;
    // Rounding the bound itself takes off less than is added here.
    return static_cast<float>(bound * (1 + 0x1p-23)) + std::numeric_limits<float>::denorm_min();
  };
  return {add(p.x, error.x), add(p.y, error.y), add(p.z, error.z)};
}

}  // namespace basicrt
