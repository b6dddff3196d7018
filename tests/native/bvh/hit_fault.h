// SPDX-License-Identifier: GPL-3.0-or-later
// Judges a kernel's hit by double precision, with room for what single precision must round.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <variant>
#include <vector>

#include "bvh/test_scenes.h"

namespace basicrt::test {

struct DistanceAndBorder {
  double t;
  // How far inside the triangle the ray passes, in parts of what its coordinates may be rounded by; negative outside.
  double border;
  double scale;  // what distances may be wrong by in parts of
};

// What the rounding of coordinates means for a ray and a triangle, both in one space.
struct Sensitivity {
  double moved;  // how far the hit moves in barycentrics, in parts of the rounding: far where the ray grazes
  double scale;
};

// What single precision rounds by, with room for several operations.
constexpr double rounding = 2e-5;

inline Sensitivity sensitivity(Vec3d origin, Vec3d direction, Vec3d p0, Vec3d p1, Vec3d p2) {
  const Vec3d edge1 = p1 - p0, edge2 = p2 - p0;
  const double area = length(cross(edge1, edge2)), size = length(direction);
  const double cosine = std::abs(dot(cross(edge1, edge2), direction)) / (area * size);
  const double longest = std::max({length(edge1), length(edge2), length(edge2 - edge1)});
  const double altitude = area / longest;
  const double reach = std::max({length(origin), length(p0), length(p1), length(p2)});
  // Distances are those of the corners, shared out by barycentrics: of a sliver they may be any of the triangle's.
  const double scale = reach / (cosine * size);
  return {reach / (cosine * altitude),
          std::max(scale, std::min(scale * longest / altitude, longest / (size * rounding)))};
}

// Of a ray and one primitive, in double precision. Kernels may round in the instance's space or in the world.
inline DistanceAndBorder distance_and_border(const std::vector<Shape>& shapes,
                                             const std::vector<TracedInstance>& instances, const Ray& ray,
                                             std::uint32_t instance, std::uint32_t primitive) {
  const TracedInstance& placed = instances[instance];
  const PreciseRay local = transform_ray(world_to_object(placed, ray.time), ray);
  if (const auto* sphere = std::get_if<Sphere>(&shapes[placed.shape])) {
    PreciseRay copy = local;
    return {intersect_sphere(copy, *sphere).value_or(-1), 1, 0};
  }
  if (const auto* cloud = std::get_if<PointCloud>(&shapes[placed.shape])) {
    PreciseRay copy = local;
    return {intersect_sphere(copy, sphere_of(*cloud, primitive)).value_or(-1), 1, 0};
  }
  const Mesh& mesh = std::get<Mesh>(shapes[placed.shape]);
  const auto corner = [&](int i) { return mesh.position_at(primitive, i, ray.time); };
  const Vec3f p0 = corner(0), p1 = corner(1), p2 = corner(2);
  const TriangleHit hit = intersect_triangle_plane(local, p0, p1, p2);
  const TransformD object_to_world =
      placed.motion.empty() ? placed.object_to_world : transform_at(placed.motion, ray.time);
  const auto in_world = [&](Vec3f p) { return object_to_world.point(Vec3d(p)); };
  const Sensitivity here = sensitivity(local.origin, local.direction, Vec3d(p0), Vec3d(p1), Vec3d(p2));
  const Sensitivity there =
      sensitivity(Vec3d(ray.origin), Vec3d(ray.direction), in_world(p0), in_world(p1), in_world(p2));
  const double moved = std::max(here.moved, there.moved), inside = std::min({hit.u, hit.v, 1 - hit.u - hit.v});
  return {hit.t, std::isfinite(inside) && moved > 0 ? inside / moved : 0, std::max(here.scale, there.scale)};
}

// What is wrong with a hit, given the nearest by testing everything in double precision, or an empty string. A kernel
// rounds: it may take another surface that is as near within rounding, and rays that pass a triangle's border within
// rounding, or meet it at an end of their range, may hit it or not.
inline std::string find_hit_fault(const Hit& hit, const Hit& expected, const std::vector<Shape>& shapes,
                                  const std::vector<TracedInstance>& instances, const Ray& ray) {
  const auto distance = [&](const Hit& of) {
    return distance_and_border(shapes, instances, ray, of.instance, of.primitive);
  };
  // Distances below the smallest normal float round by as much as that of the denormal ones.
  const auto allowed = [&](const DistanceAndBorder& of) {
    return rounding * std::max(of.t, of.scale) + static_cast<double>(std::numeric_limits<float>::denorm_min());
  };
  const auto may_miss = [&](const DistanceAndBorder& of) {
    return of.border < rounding || std::abs(of.t - static_cast<double>(ray.t_min)) < allowed(of) ||
           std::abs(of.t - static_cast<double>(ray.t_max)) < allowed(of);
  };
  if (!hit.is_hit() && !expected.is_hit()) return {};
  if (!hit.is_hit()) return may_miss(distance(expected)) ? "" : "misses a hit";
  const DistanceAndBorder found = distance(hit);
  if (found.border < -rounding) return "hits a triangle that the ray passes by";
  if (std::abs(static_cast<double>(hit.t) - found.t) > allowed(found)) return "has the wrong distance";
  if (!expected.is_hit()) return may_miss(found) ? "" : "hits what isn't there";
  const bool is_same = hit.instance == expected.instance && hit.primitive == expected.primitive;
  const auto expected_t = static_cast<double>(expected.t);
  if (is_same || std::abs(found.t - expected_t) <= allowed(found)) return {};
  return may_miss(found.t < expected_t ? found : distance(expected)) ? "" : "is not the nearest";
}

}  // namespace basicrt::test
