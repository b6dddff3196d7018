// SPDX-License-Identifier: GPL-3.0-or-later
// Surface points on a mesh's triangles. Here for the one caller to inline: it is run for every hit.
#pragma once

#include <algorithm>
#include <cmath>

#include "geometry/error_bounds.h"
#include "geometry/local_point.h"
#include "geometry/triangle.h"
#include "math/simd.h"

namespace basicrt {

// Two vectors side by side, which SIMD works on together.
struct VectorPair {
  Double2 x, y, z;

  static VectorPair of(Vec3d a, Vec3d b) {
    return {Double2::of(a.x, b.x), Double2::of(a.y, b.y), Double2::of(a.z, b.z)};
  }
  friend VectorPair operator-(const VectorPair& a, const VectorPair& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend VectorPair abs(const VectorPair& a) { return {abs(a.x), abs(a.y), abs(a.z)}; }
};

// The product of the two.
inline Vec3d cross(const VectorPair& pair) {
  const auto difference = [](Double2 a) { return a.first() - a.second(); };
  return {difference(pair.y * pair.z.swapped()), difference(pair.z * pair.x.swapped()),
          difference(pair.x * pair.y.swapped())};
}
// Of each with v.
inline Double2 dot(const VectorPair& pair, Vec3d v) {
  return pair.x * Double2::all(v.x) + pair.y * Double2::all(v.y) + pair.z * Double2::all(v.z);
}
// Each times its weight.
inline Vec3d weighted_sum(const VectorPair& pair, Double2 weights) {
  const auto sum = [](Double2 a) { return a.first() + a.second(); };
  return {sum(pair.x * weights), sum(pair.y * weights), sum(pair.z * weights)};
}
inline double sum(Vec3d v) { return v.x + v.y + v.z; }

template <class V>
V interpolate(const V* corners, float w0, float w1, float w2) {
  return corners[0] * w0 + corners[1] * w1 + corners[2] * w2;
}

static inline LocalPoint local_point_on(const Mesh& mesh, const PreciseRay& ray, const Hit& hit) {
  const std::uint32_t triangle = hit.primitive;
  const auto& corners = mesh.triangles[triangle];
  const Vec3d p0(mesh.positions[corners[0]]);
  const VectorPair edges =
      VectorPair::of(Vec3d(mesh.positions[corners[1]]), Vec3d(mesh.positions[corners[2]])) - VectorPair::of(p0, p0);
  const VectorPair line = VectorPair::of(ray.origin - p0, ray.direction);

  // As in intersect_triangle_plane(), in terms of the normal.
  const Vec3d normal = cross(edges), q = cross(line);
  const Double2 line_normal = dot(line, normal), edges_q = dot(edges, q);
  const double determinant = line_normal.second(), inverse_determinant = 1 / determinant;
  double t = -line_normal.first() * inverse_determinant;
  double u = -edges_q.second() * inverse_determinant, v = edges_q.first() * inverse_determinant;
  double along_plane = gamma(16) * std::abs(inverse_determinant);
  // The hit knows better where the line of the ray doesn't say.
  if (!std::isfinite(t + u + v)) t = hit.t, u = hit.u, v = hit.v, along_plane = 0;
  u = std::max(0.0, std::min(u, 1.0));
  v = std::max(0.0, std::min(v, 1 - u));

  // Two parts: interpolation; and the barycentrics, which a grazing ray leaves uncertain along the plane. Sums of
  // coordinates bound lengths without a root; the origin is no farther than p0 and it from there.
  const Vec3d edge_sum = weighted_sum(abs(edges), Double2::all(1));
  const Double2 lengths = dot(abs(line), Vec3d(1));
  const double size = sum(edge_sum), reach = 2 * (lengths.first() + sum(abs(p0))) + size;
  along_plane *= lengths.second() * reach * size;

  const auto u_float = static_cast<float>(u), v_float = static_cast<float>(v), w_float = 1 - u_float - v_float;
  const std::size_t first_corner = 3 * std::size_t{triangle};
  const bool has_normals = !mesh.corner_normals.empty(), has_uvs = !mesh.uvs.empty();
  return {.t = t,
          .position = p0 + weighted_sum(edges, Double2::of(u, v)),
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
