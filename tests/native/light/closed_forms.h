// SPDX-License-Identifier: GPL-3.0-or-later
// Irradiance in closed form, for tests of whatever shines.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "math/vec.h"

namespace basicrt::test {

// From a polygon of radiance one to a surface at the origin that faces `normal`: Lambert's formula. The polygon lies
// on the side of the normal; either order of its corners will do.
inline double polygon_irradiance(const std::vector<Vec3d>& corners, Vec3d normal) {
  double sum = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3d a = corners[i], b = corners[(i + 1) % corners.size()];
    const Vec3d across = cross(a, b);
    sum += std::atan2(length(across), dot(a, b)) * dot(normalize(across), normal);
  }
  return std::abs(sum) / 2;
}

}  // namespace basicrt::test
