// SPDX-License-Identifier: GPL-3.0-or-later
// What solves hits on triangles again, several at once, gets and gives. A kernel is the same code (triangle_points.inl)
// compiled for one instruction set. Plain data only: an ordinary inline function compiled with AVX could be linked into
// code for machines without it.
#pragma once

#include <cstddef>

namespace basicrt {

// A hit on a triangle, by where its numbers are.
struct PointRequest {
  const float* corners[3];      // three numbers each, object space
  const float* corner_normals;  // nine numbers
  const float* ray;             // as a Ray begins: origin, t_min, direction, t_max, in the world
  const double* to_object;      // three rows of four
  const double* to_world;
  float t, u, v;  // as the tracer found them, for a ray in the triangle's plane
};

// In the world: see SurfacePoint.
struct alignas(16) PointResult {
  float position[3], position_error[3];
  float geometric_normal[3], shading_normal[3];
  float barycentrics[2];
  float t;
  float is_backfacing;  // 1 or 0
};

// What all requests of one call have in common.
struct PointKind {
  bool is_translation;  // to_world only moves
  bool has_normals;     // else the triangles are flat, and corner_normals is not looked at
};

struct PointKernel {
  const char* name;
  void (*solve)(PointKind kind, const PointRequest* requests, PointResult* results, std::size_t count);
};

}  // namespace basicrt
