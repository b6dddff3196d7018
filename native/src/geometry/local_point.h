// SPDX-License-Identifier: GPL-3.0-or-later
// A surface point in object space: of spheres and curves, and the derivatives of every kind of geometry.
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
  Vec3d shading_normal;  // the same
  Vec2f uv;
  bool is_backfacing;
};

[[nodiscard]] LocalPoint local_point_on(const Sphere& sphere, const PreciseRay& ray, const Hit& hit);
[[nodiscard]] LocalPoint local_point_on(const PointCloud& cloud, const PreciseRay& ray, const Hit& hit);
[[nodiscard]] LocalPoint local_point_on(const Curves& curves, const PreciseRay& ray, const Hit& hit);

// How a point changes with its uv, and its normal with it.
struct LocalDerivatives {
  Vec3d dpdu, dpdv;
  Vec3d normal, dndu, dndv;  // of any length, but all of the same; zero where there is no shading normal
};

[[nodiscard]] LocalDerivatives derivatives_on_triangle(const Mesh& mesh, std::uint32_t triangle, Vec2f barycentrics,
                                                       float time);
[[nodiscard]] LocalDerivatives derivatives_on_sphere(const Sphere& sphere, Vec3d position);
// Along the segment and across it, as Blender has them. The change of normals counts as none.
[[nodiscard]] LocalDerivatives derivatives_on_curve(const Curves& curves, std::uint32_t segment, double u,
                                                    Vec3d normal);

}  // namespace basicrt
