// SPDX-License-Identifier: GPL-3.0-or-later
// Rays against triangles: Möller and Trumbore 1997, "Fast, Minimum Storage Ray/Triangle Intersection", in double
// precision over vertices in single precision.
#pragma once

#include <optional>

#include "geometry/precise_ray.h"

namespace basicrt {

// The point is (1 - u - v) p0 + u p1 + v p2.
struct TriangleHit {
  double t = 0, u = 0, v = 0;
};

// Where the ray's line meets the triangle's plane. Not finite where the two are parallel or the triangle is none.
inline TriangleHit intersect_triangle_plane(const PreciseRay& ray, Vec3f p0, Vec3f p1, Vec3f p2) {
  const Vec3d edge1 = Vec3d(p1) - Vec3d(p0), edge2 = Vec3d(p2) - Vec3d(p0);
  const Vec3d from_p0 = ray.origin - Vec3d(p0);
  const Vec3d p = cross(ray.direction, edge2), q = cross(from_p0, edge1);
  const double inverse_determinant = 1 / dot(edge1, p);
  return {.t = dot(edge2, q) * inverse_determinant,
          .u = dot(from_p0, p) * inverse_determinant,
          .v = dot(ray.direction, q) * inverse_determinant};
}

// Both sides count. A hit within [t_min, t_max] becomes the ray's new t_max.
inline std::optional<TriangleHit> intersect_triangle(PreciseRay& ray, Vec3f p0, Vec3f p1, Vec3f p2) {
  const TriangleHit hit = intersect_triangle_plane(ray, p0, p1, p2);
  // Every comparison fails for a NaN.
  const bool is_inside = hit.u >= 0 && hit.v >= 0 && hit.u + hit.v <= 1;
  if (!is_inside || !(hit.t >= ray.t_min && hit.t <= ray.t_max)) return std::nullopt;
  ray.t_max = hit.t;
  return hit;
}

}  // namespace basicrt
