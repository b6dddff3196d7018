// SPDX-License-Identifier: GPL-3.0-or-later
// A surface point in object space, as each kind of geometry finds it.
#pragma once

#include <cstdint>

#include "geometry/hit.h"
#include "geometry/precise_ray.h"
#include "geometry/shape.h"

namespace basicrt {

struct LocalPoint {
  double t;  // along the ray, solved again
  Vec3d position;
  Vec3d error;           // bounds how far each coordinate is off
  Vec3d normal;          // out of the front face, of any length
  Vec3f shading_normal;  // of any length, zero where there is none
  Vec2f uv;
  Vec2f barycentrics;  // as in SurfacePoint
  bool is_backfacing;
  std::uint32_t material_slot;
};

[[nodiscard]] LocalPoint local_point_on(const Sphere& sphere, const PreciseRay& ray, const Hit& hit);

// How a point changes with its uv, and its normal with it.
struct LocalDerivatives {
  Vec3d dpdu, dpdv;
  Vec3d normal, dndu, dndv;  // of any length, but all of the same; zero where there is no shading normal
};

[[nodiscard]] LocalDerivatives derivatives_on_triangle(const Mesh& mesh, std::uint32_t triangle, Vec2f barycentrics);
[[nodiscard]] LocalDerivatives derivatives_on_sphere(const Sphere& sphere, Vec3d position);

}  // namespace basicrt
