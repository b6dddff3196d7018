// SPDX-License-Identifier: GPL-3.0-or-later
// Axis-aligned boxes.
#pragma once

#include <limits>

#include "math/vec.h"

namespace basicrt {

// Empty as made: lower > upper, and the union with anything is that thing.
template <class T>
struct Bounds3 {
  Vec3<T> lower = Vec3<T>(std::numeric_limits<T>::infinity());
  Vec3<T> upper = Vec3<T>(-std::numeric_limits<T>::infinity());

  [[nodiscard]] constexpr bool is_empty() const { return lower.x > upper.x || lower.y > upper.y || lower.z > upper.z; }
  [[nodiscard]] constexpr Vec3<T> extent() const { return upper - lower; }
  [[nodiscard]] constexpr Vec3<T> center() const { return lower * T(0.5) + upper * T(0.5); }
  [[nodiscard]] constexpr T half_area() const {
    if (is_empty()) return 0;
    const Vec3<T> e = extent();
    return e.x * e.y + e.y * e.z + e.z * e.x;
  }
  [[nodiscard]] constexpr bool contains(const Bounds3& b) const {
    return b.is_empty() || (lower.x <= b.lower.x && lower.y <= b.lower.y && lower.z <= b.lower.z &&
                            upper.x >= b.upper.x && upper.y >= b.upper.y && upper.z >= b.upper.z);
  }
  constexpr void extend(Vec3<T> p) {
    lower = min(lower, p);
    upper = max(upper, p);
  }
  constexpr void extend(const Bounds3& b) {
    lower = min(lower, b.lower);
    upper = max(upper, b.upper);
  }
};

using Bounds3f = Bounds3<float>;

}  // namespace basicrt
