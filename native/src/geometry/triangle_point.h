// SPDX-License-Identifier: GPL-3.0-or-later
// Surface points on a mesh's triangles. Here for the one caller to inline: it is run for every hit.
#pragma once

#include <algorithm>
#include <cmath>

#include "geometry/error_bounds.h"
#include "geometry/local_point.h"
#include "geometry/triangle.h"

namespace basicrt {

// At least the length of v, without a root.
inline double length_bound(Vec3d v) { return std::abs(v.x) + std::abs(v.y) + std::abs(v.z); }

template <class V>
V interpolate(const V* corners, float w0, float w1, float w2) {
  return corners[0] * w0 + corners[1] * w1 + corners[2] * w2;
}

static inline LocalPoint local_point_on(const Mesh& mesh, const PreciseRay& ray, const Hit& hit) {
  const std::uint32_t triangle = hit.primitive;
  const auto& corners = mesh.triangles[triangle];
  const Vec3d p0(mesh.positions[corners[0]]);
  const Vec3d edge1 = Vec3d(mesh.positions[corners[1]]) - p0, edge2 = Vec3d(mesh.positions[corners[2]]) - p0;

  // As in intersect_triangle_plane(), in terms of the normal.
  const Vec3d normal = cross(edge1, edge2), from_p0 = ray.origin - p0, q = cross(from_p0, ray.direction);
  const double determinant = dot(ray.direction, normal), inverse_determinant = 1 / determinant;
  double t = -dot(from_p0, normal) * inverse_determinant;
  double u = -dot(edge2, q) * inverse_determinant, v = dot(edge1, q) * inverse_determinant;
  double along_plane = gamma(16) * std::abs(inverse_determinant);
  // The hit knows better where the line of the ray doesn't say.
  if (!(std::isfinite(t) && std::isfinite(u) && std::isfinite(v))) t = hit.t, u = hit.u, v = hit.v, along_plane = 0;
  u = std::clamp(u, 0.0, 1.0);
  v = std::clamp(v, 0.0, 1 - u);

  // Two parts: interpolation; and the barycentrics, which a grazing ray leaves uncertain along the plane.
  const Vec3d edge_sum = abs(edge1) + abs(edge2);
  const double edges = length_bound(edge_sum);
  const double reach = length_bound(from_p0) + length_bound(p0) + length_bound(ray.origin) + edges;
  along_plane *= length_bound(ray.direction) * reach * edges;

  const auto u_float = static_cast<float>(u), v_float = static_cast<float>(v), w_float = 1 - u_float - v_float;
  const std::size_t first_corner = 3 * std::size_t{triangle};
  const bool has_normals = !mesh.corner_normals.empty(), has_uvs = !mesh.uvs.empty();
  return {.t = t,
          .position = p0 + edge1 * u + edge2 * v,
          .error = abs(p0) * gamma(6) + edge_sum * (gamma(6) + along_plane),
          .normal = normal,
          .shading_normal =
              has_normals ? interpolate(&mesh.corner_normals[first_corner], w_float, u_float, v_float) : Vec3f(0),
          // Without texture coordinates the barycentrics parametrise the triangle.
          .uv = has_uvs ? interpolate(&mesh.uvs[first_corner], w_float, u_float, v_float) : Vec2f{u_float, v_float},
          .barycentrics = {u_float, v_float},
          .is_backfacing = determinant > 0,
          .material_slot = mesh.material_slots.empty() ? 0 : mesh.material_slots[triangle]};
}

}  // namespace basicrt
