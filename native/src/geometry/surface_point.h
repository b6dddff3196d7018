// SPDX-License-Identifier: GPL-3.0-or-later
// All that shading needs to know of a hit.
#pragma once

#include <cstdint>

#include "geometry/hit.h"
#include "geometry/placement.h"
#include "geometry/shape.h"
#include "math/ray.h"

namespace basicrt {

// World space. Normals keep the side of the surface (they point out of the front face), whatever side was hit.
struct SurfacePoint {
  Vec3f position;
  Vec3f position_error;    // the true point is within position +- position_error
  Vec3f geometric_normal;  // unit length; in object space by the winding p0 p1 p2, whatever the transform mirrors
  Vec3f shading_normal;    // unit length, on the same side as geometric_normal
  Vec2f uv;
  Vec2f barycentrics;  // the shares of a triangle's second and third corner; a sphere's uv
  float t = 0;         // distance along the ray, solved in double precision
  std::uint32_t instance = 0;
  std::uint32_t primitive = 0;  // the triangle; Hit::none on a sphere
  std::uint32_t material_slot = 0;
  bool is_backfacing = false;  // the ray came from the side that geometric_normal points away from
  // Zero before add_derivatives():
  Vec3f dpdu, dpdv;  // change of position with uv
  Vec3f dndu, dndv;  // change of the shading normal with uv
  // Zero before add_pixel_change():
  Vec3f dpdx, dpdy;    // change of position per pixel
  Vec2f duvdx, duvdy;  // change of uv per pixel
};

// The hit solved again from the vertices in double precision, but never outside the triangle that the tracer found: where
// its rounding took the ray inside, the point is on the edge.
[[nodiscard]] SurfacePoint make_surface_point(const Shape& shape, const Placement& placement, const Ray& ray,
                                              const Hit& hit);

// What few materials need, and so is worked out only for them.
void add_derivatives(SurfacePoint& point, const Shape& shape, const Placement& placement);
// Needs the derivatives.
void add_pixel_change(SurfacePoint& point, const Ray& ray, const RayDifferentials& differentials);

// An origin for a ray that leaves the surface towards `direction`: moved off it by the error bound, no more.
[[nodiscard]] Vec3f offset_origin(const SurfacePoint& point, Vec3f direction);

}  // namespace basicrt
