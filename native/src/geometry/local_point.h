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
  Vec3d error;           // bounds how far each coordinate is off, and how far off the surface rays are found to start
  Vec3d normal;          // out of the front face, of any length
  Vec3d shading_normal;  // of any length, zero where there is none
  Vec2d uv;
  Vec3d dpdu, dpdv;
  Vec3d dndu, dndv;  // of shading_normal as it is here
  std::uint32_t material_slot = 0;
};

[[nodiscard]] LocalPoint local_point_on_triangle(const Mesh& mesh, const PreciseRay& ray, const Hit& hit);
[[nodiscard]] LocalPoint local_point_on_sphere(const Sphere& sphere, const PreciseRay& ray, const Hit& hit);

}  // namespace basicrt
