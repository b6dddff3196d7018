// SPDX-License-Identifier: GPL-3.0-or-later
// The widths of cones: 1 - cos of the half angle, which keeps its precision however narrow they are.
#pragma once

#include <algorithm>
#include <cmath>

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

}  // namespace basicrt
