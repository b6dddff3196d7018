// SPDX-License-Identifier: GPL-3.0-or-later
// Two triangles tested at once, number for number as intersect_triangle() tests one.
#pragma once

#include <array>
#include <cstdint>

#include "bvh/simd.h"
#include "geometry/precise_ray.h"
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

// A ray with each number twice.
struct PairRay {
  Double2 origin[3], direction[3];
  Double2 t_min;

  explicit PairRay(const PreciseRay& ray) : t_min(Double2::all(ray.t_min)) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      origin[axis] = Double2::all(ray.origin[axis]);
      direction[axis] = Double2::all(ray.direction[axis]);
    }
  }
};

struct PairHits {
  Double2 t, u, v;
  int bits;  // bit i: the ray hits triangle i within [t_min, t_max]
};

inline PairHits intersect_pair(const TrianglePair& pair, const PairRay& ray, double t_max) {
  const auto corner = [&](int index, int axis) { return Double2::from_floats(pair.p[index][axis]); };
  const Double2 p0x = corner(0, 0), p0y = corner(0, 1), p0z = corner(0, 2);
  const Double2 ax = corner(1, 0) - p0x, ay = corner(1, 1) - p0y, az = corner(1, 2) - p0z;
  const Double2 bx = corner(2, 0) - p0x, by = corner(2, 1) - p0y, bz = corner(2, 2) - p0z;
  const Double2 sx = ray.origin[0] - p0x, sy = ray.origin[1] - p0y, sz = ray.origin[2] - p0z;
  const Double2 dx = ray.direction[0], dy = ray.direction[1], dz = ray.direction[2];
  const Double2 px = dy * bz - dz * by, py = dz * bx - dx * bz, pz = dx * by - dy * bx;
  const Double2 qx = sy * az - sz * ay, qy = sz * ax - sx * az, qz = sx * ay - sy * ax;
  const Double2 one = Double2::all(1), zero = Double2::all(0);
  const Double2 inverse_determinant = one / (ax * px + ay * py + az * pz);
  PairHits hits;
  hits.t = (bx * qx + by * qy + bz * qz) * inverse_determinant;
  hits.u = (sx * px + sy * py + sz * pz) * inverse_determinant;
  hits.v = (dx * qx + dy * qy + dz * qz) * inverse_determinant;
  hits.bits = less_equal_bits(zero, hits.u) & less_equal_bits(zero, hits.v) & less_equal_bits(hits.u + hits.v, one) &
              less_equal_bits(ray.t_min, hits.t) & less_equal_bits(hits.t, Double2::all(t_max));
  return hits;
}

}  // namespace basicrt
