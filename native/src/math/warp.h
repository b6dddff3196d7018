// SPDX-License-Identifier: GPL-3.0-or-later
// Warps from the unit square to the shapes that light and scattering need, each with its density.
#pragma once

#include <algorithm>
#include <cmath>

#include "math/constants.h"
#include "math/vec.h"

namespace basicrt {

// Directions are local: z is the axis. Densities over the sphere are per solid angle, on the disc per area.

// Concentric: neighbours stay neighbours (Shirley and Chiu 1997). The unit disc has the density 1/pi.
inline Vec2f sample_disk(Vec2f u) {
  const float a = 2 * u.x - 1, b = 2 * u.y - 1;
  if (a == 0 && b == 0) return {0, 0};
  const bool is_wide = std::abs(a) > std::abs(b);
  const float radius = is_wide ? a : b;
  const float phi = is_wide ? pi / 4 * (b / a) : pi / 2 - pi / 4 * (a / b);
  return {radius * std::cos(phi), radius * std::sin(phi)};
}
inline constexpr float pdf_disk = inv_pi;

inline Vec3f sample_cosine_hemisphere(Vec2f u) {
  const Vec2f d = sample_disk(u);
  // 1 - r^2 would round to zero at the rim, and so give a direction of no density.
  return {d.x, d.y, std::sqrt(std::max(1 - d.x * d.x - d.y * d.y, 0x1p-24f))};
}
constexpr float pdf_cosine_hemisphere(float cos_theta) { return std::max(cos_theta, 0.0f) * inv_pi; }

// The cap of directions whose cosine with z is above 1 - one_minus_cos: given so, narrow cones lose no digits.
inline Vec3f sample_cone(Vec2f u, float one_minus_cos) {
  const float height = u.x * one_minus_cos;  // 1 - cos of the direction
  const float sin_theta = std::sqrt(std::max(height * (2 - height), 0.0f));
  const float phi = 2 * pi * u.y;
  return {sin_theta * std::cos(phi), sin_theta * std::sin(phi), 1 - height};
}
constexpr float pdf_cone(float one_minus_cos) { return 1 / (2 * pi * one_minus_cos); }

inline Vec3f sample_hemisphere(Vec2f u) { return sample_cone(u, 1); }
inline constexpr float pdf_hemisphere = inv_pi / 2;

inline Vec3f sample_sphere(Vec2f u) { return sample_cone(u, 2); }
inline constexpr float pdf_sphere = inv_pi / 4;

// The weights of the second and third corner; the density is one over the area. Heitz 2019, "A low-distortion map
// between triangle and square".
inline Vec2f sample_triangle(Vec2f u) {
  if (u.y > u.x) {
    const float x = u.x / 2;
    return {x, u.y - x};
  }
  const float y = u.y / 2;
  return {u.x - y, y};
}

// In the regular polygon whose corners lie on the unit circle; the middle of a side is on the x axis. All places are
// alike: the density is one over the area.
inline Vec2f sample_regular_polygon(Vec2f u, int corners) {
  const auto count = static_cast<float>(corners);
  const float wedge = std::min(std::floor(u.x * count), count - 1);
  // The wedge's triangle has its other corners on both sides of the x axis.
  const Vec2f weights = sample_triangle({u.x * count - wedge, u.y});
  const float half_angle = pi / count, angle = 2 * half_angle * wedge;
  const float x = (weights.x + weights.y) * std::cos(half_angle), y = (weights.x - weights.y) * std::sin(half_angle);
  const float c = std::cos(angle), s = std::sin(angle);
  return {c * x - s * y, s * x + c * y};
}
inline float pdf_regular_polygon(int corners) {
  const auto count = static_cast<float>(corners);
  return 2 / (count * std::sin(2 * pi / count));
}

}  // namespace basicrt
