// SPDX-License-Identifier: GPL-3.0-or-later
// Surface points on spheres.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/error_bounds.h"
#include "geometry/local_point.h"
#include "geometry/sphere.h"

namespace basicrt {

LocalPoint local_point_on(const Sphere& sphere, const PreciseRay& ray, const Hit& hit) {
  const Vec3d center(sphere.center);
  const double radius = sphere.radius;
  // The hit's distance is a float: solved again near it.
  PreciseRay near_hit = ray;
  const double slack = 1e-6 * std::abs(hit.t);
  near_hit.t_min = std::max(ray.t_min, hit.t - slack);
  near_hit.t_max = std::min(ray.t_max, hit.t + slack);
  const double t = intersect_sphere(near_hit, sphere).value_or(hit.t);

  // Put back onto the sphere, which takes out nearly all of the error in t.
  const Vec3d outward = normalize(ray.origin + ray.direction * t - center);
  const double grazing = std::abs(dot(normalize(ray.direction), outward));
  const double along_ray = gamma(16) * (length(ray.origin) + length(center) + radius) / std::max(grazing, 1e-6);
  return {.t = t,
          .position = center + outward * radius,
          .error = Vec3d(gamma(16) * (length(center) + radius) + along_ray),
          .normal = outward,
          .shading_normal = outward,
          .uv = Vec2f(sphere_uv(outward)),
          .is_backfacing = dot(ray.direction, outward) > 0};
}

LocalPoint local_point_on(const PointCloud& cloud, const PreciseRay& ray, const Hit& hit) {
  return local_point_on(sphere_of(cloud, hit.primitive), ray, hit);
}

LocalDerivatives derivatives_on_sphere(const Sphere& sphere, Vec3d position) {
  const Vec3d outward = normalize(position - Vec3d(sphere.center));
  const double ring = std::hypot(outward.x, outward.y);
  const double cosine = ring > 0 ? outward.x / ring : 1, sine = ring > 0 ? outward.y / ring : 0;
  const Vec3d dndu = Vec3d{-outward.y, outward.x, 0} * (2 * std::numbers::pi);
  const Vec3d dndv = Vec3d{-outward.z * cosine, -outward.z * sine, ring} * std::numbers::pi;
  const double radius = sphere.radius;
  return {.dpdu = dndu * radius, .dpdv = dndv * radius, .normal = outward, .dndu = dndu, .dndv = dndv};
}

}  // namespace basicrt
