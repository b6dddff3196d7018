// SPDX-License-Identifier: GPL-3.0-or-later
// Rays against spheres, in double precision, and a sphere's texture coordinates.
#pragma once

#include <cmath>
#include <numbers>
#include <optional>

#include "geometry/precise_ray.h"
#include "geometry/shape.h"
#include "math/next_float.h"

namespace basicrt {

inline Bounds3f sphere_bounds(Vec3f center, float radius) {
  Bounds3f result;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    // One float wider: center +- radius was rounded.
    result.lower[axis] = next_float_down(center[axis] - radius);
    result.upper[axis] = next_float_up(center[axis] + radius);
  }
  return result;
}

// The nearer point of the two within [t_min, t_max], which becomes the ray's new t_max. The discriminant is that of
// Haines et al. 2019, "Precision Improvements for Ray/Sphere Intersection": it holds for small and distant spheres.
inline std::optional<double> intersect_sphere(PreciseRay& ray, const Sphere& sphere) {
  const Vec3d from_center = ray.origin - Vec3d(sphere.center);
  const double radius = static_cast<double>(sphere.radius);
  const double a = length_squared(ray.direction);
  const double b = -dot(from_center, ray.direction);
  const double squared_miss = length_squared(from_center + ray.direction * (b / a));
  const double discriminant = radius * radius - squared_miss;
  if (!(discriminant >= 0)) return std::nullopt;
  const double c = length_squared(from_center) - radius * radius;
  const double q = b + std::copysign(std::sqrt(a * discriminant), b);
  const double t0 = q == 0 ? 0 : c / q, t1 = q / a;
  for (const double t : {std::fmin(t0, t1), std::fmax(t0, t1)}) {
    if (!(t >= ray.t_min && t <= ray.t_max)) continue;
    ray.t_max = t;
    return t;
  }
  return std::nullopt;
}

inline Sphere sphere_of(const PointCloud& cloud, std::uint32_t point) {
  return {.center = cloud.positions[point], .radius = cloud.radii[point]};
}

// Longitude and latitude in [0, 1] of a unit direction from the centre, poles on z.
inline Vec2d sphere_uv(Vec3d direction) {
  const double longitude = std::atan2(direction.y, direction.x) / (2 * std::numbers::pi);
  const double latitude =
      std::atan2(direction.z, std::sqrt(direction.x * direction.x + direction.y * direction.y)) / std::numbers::pi;
  return {longitude < 0 ? longitude + 1 : longitude, latitude + 0.5};
}

}  // namespace basicrt
