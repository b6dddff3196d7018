// SPDX-License-Identifier: GPL-3.0-or-later
// What moves, at one time. Keys that are equal give exactly what each of them is.
#pragma once

#include <span>
#include <vector>

#include "geometry/key_interval.h"
#include "math/transform.h"

namespace basicrt {

// At least two keys. What is flat between two keys that are not has no inverse at that moment: nothing hits it.
[[nodiscard]] inline TransformD transform_at(std::span<const TransformD> keys, float time) {
  const auto [first, fraction] = key_interval(static_cast<std::uint32_t>(keys.size() - 1), time);
  const TransformD &from = keys[first], &to = keys[first + 1];
  TransformD result;
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t column = 0; column < 4; ++column)
      result.rows[row][column] =
          from.rows[row][column] + (to.rows[row][column] - from.rows[row][column]) * double{fraction};
  return result;
}

// In single precision, which is what kernels compute: to all others the vertex is where that says.
[[nodiscard]] inline Vec3f interpolate(Vec3f from, Vec3f to, float fraction) { return from + (to - from) * fraction; }

}  // namespace basicrt
