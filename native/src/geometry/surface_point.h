// SPDX-License-Identifier: GPL-3.0-or-later
// All that shading needs to know of a hit.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>

#include "geometry/hit.h"
#include "geometry/placement.h"
#include "geometry/shape.h"
#include "math/ray.h"

namespace basicrt {

// How a point changes, in world space.
struct SurfaceDerivatives {
  Vec3f dpdu, dpdv;  // of position with uv
  Vec3f dndu, dndv;  // of the shading normal with uv
  // Around the object's axes x, y and z, through the middle of its box, of any length. Zero before add_radial_tangents().
  std::array<Vec3f, 3> radial_tangents;
  // Zero before add_pixel_change():
  Vec3f dpdx, dpdy;    // of position per pixel
  Vec2f duvdx, duvdy;  // of uv per pixel
};

// World space. Normals keep the side of the surface (they point out of the front face), whatever side was hit.
struct SurfacePoint {
  Vec3f position;
  Vec3f position_error;    // the true point is within position +- position_error
  Vec3f geometric_normal;  // unit length; in object space by the winding p0 p1 p2, whatever the transform mirrors
  Vec3f shading_normal;    // unit length, on the same side as geometric_normal
  Vec2f uv;
  Vec2f
      barycentrics;  // the shares of a triangle's second and third corner; a sphere's uv; along and across a curve's segment
  float t = 0;       // distance along the ray, solved in double precision
  float time = 0;  // the ray's
  std::uint32_t instance = 0;
  std::uint32_t primitive = 0;  // the triangle, point or segment; Hit::none on a sphere
  std::uint32_t material_slot = 0;
  bool is_backfacing = false;                     // the ray came from the side that geometric_normal points away from
  std::optional<SurfaceDerivatives> derivatives;  // once add_derivatives() was called
};

// The hit solved again from the vertices at the ray's time (`placement` is of that time too) in double precision, but never outside the triangle that the tracer found: where
// its rounding took the ray inside, the point is on the edge.
[[nodiscard]] SurfacePoint make_surface_point(const Shape& shape, const Placement& placement, const Ray& ray,
                                              const Hit& hit);

// What make_surface_point() is given, and where its answer goes.
struct SurfaceHit {
  const Shape* shape;
  const Placement* placement;
  const Ray* ray;
  const Hit* hit;
  SurfacePoint* point;
};
// The same for many hits together, which takes a fraction of the time. Any number of them: all that is read stays in
// the cache for about surface_hits_at_once.
void make_surface_points(std::span<const SurfaceHit> hits);
inline constexpr std::size_t surface_hits_at_once = 64;

// What few materials need, and so is worked out only for them.
void add_derivatives(SurfacePoint& point, const Shape& shape, const Placement& placement);
// For a point that has its derivatives; `box` is the shape's. Coordinates count in sizes of the box, as in Blender.
void add_radial_tangents(SurfacePoint& point, const Bounds3f& box, const Placement& placement);
// For a point that has its derivatives.
void add_pixel_change(SurfacePoint& point, const Ray& ray, const RayDifferentials& differentials);

// An origin for a ray that leaves the surface towards `direction`: moved off it by the error bound, no more (Pharr, Jakob
// and Humphreys 2023, "Physically Based Rendering", section 6.8.6). What rounding the moved point may take back, half a
// unit in the last place, is moved beforehand and twice over.
[[nodiscard]] inline Vec3f offset_origin(const SurfacePoint& point, Vec3f direction) {
  const Vec3f normal = point.geometric_normal;
  const float distance = dot(abs(normal), point.position_error + abs(point.position) * 0x1p-23f);
  return point.position + normal * std::copysign(distance, dot(direction, normal));
}

}  // namespace basicrt
