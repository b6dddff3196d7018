// SPDX-License-Identifier: GPL-3.0-or-later
// Two triangles tested at once, number for number as intersect_triangle() tests one.
#pragma once

#include <array>
#include <cstdint>

#include "geometry/precise_ray.h"
#include "math/simd.h"
#include "math/vec.h"

namespace basicrt {

// Their vertices, copied out of the mesh in the order in which leaves are visited. A missing second triangle is all
// zeros, which no ray hits.
struct TrianglePair {
  float p[3][3][2] = {};  // [corner][axis][triangle]
  std::uint32_t primitive[2] = {~0u, ~0u};

  void set(std::size_t lane, std::uint32_t primitive_index, const std::array<Vec3f, 3>& corners) {
    for (std::size_t corner = 0; corner < 3; ++corner)
      for (std::size_t axis = 0; axis < 3; ++axis) p[corner][axis][lane] = corners[corner][axis];
    primitive[lane] = primitive_index;
  }
};

// What the tests of many rays share.
struct PreparedPair {
  Double2 p0[3], edge1[3], edge2[3];

  explicit PreparedPair(const TrianglePair& pair) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      p0[axis] = Double2::from_floats(pair.p[0][axis]);
      edge1[axis] = Double2::from_floats(pair.p[1][axis]) - p0[axis];
      edge2[axis] = Double2::from_floats(pair.p[2][axis]) - p0[axis];
    }
  }
};

struct PairHits {
  Double2 t, u, v;
  int bits;  // bit i: the ray hits triangle i within [t_min, t_max]
};

inline PairHits intersect_pair(const PreparedPair& pair, const PreciseRay& ray, double t_max) {
  const auto& [ax, ay, az] = pair.edge1;
  const auto& [bx, by, bz] = pair.edge2;
  const Double2 dx = Double2::all(ray.direction.x), dy = Double2::all(ray.direction.y),
                dz = Double2::all(ray.direction.z);
  const Double2 sx = Double2::all(ray.origin.x) - pair.p0[0], sy = Double2::all(ray.origin.y) - pair.p0[1],
                sz = Double2::all(ray.origin.z) - pair.p0[2];
  const Double2 px = dy * bz - dz * by, py = dz * bx - dx * bz, pz = dx * by - dy * bx;
  const Double2 qx = sy * az - sz * ay, qy = sz * ax - sx * az, qz = sx * ay - sy * ax;
  const Double2 one = Double2::all(1), zero = Double2::all(0);
  const Double2 inverse_determinant = one / (ax * px + ay * py + az * pz);
  PairHits hits;
  hits.t = (bx * qx + by * qy + bz * qz) * inverse_determinant;
  hits.u = (sx * px + sy * py + sz * pz) * inverse_determinant;
  hits.v = (dx * qx + dy * qy + dz * qz) * inverse_determinant;
  const Mask2 is_inside = (zero <= hits.u) & (zero <= hits.v) & (hits.u + hits.v <= one);
  const Mask2 is_in_range = (Double2::all(ray.t_min) <= hits.t) & (hits.t <= Double2::all(t_max));
  hits.bits = (is_inside & is_in_range).bits();
  return hits;
}

}  // namespace basicrt
