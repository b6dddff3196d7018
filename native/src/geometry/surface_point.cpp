// SPDX-License-Identifier: GPL-3.0-or-later
// From a hit to a surface point: solved in the object's space in double precision, then taken to the world.
#include "geometry/surface_point.h"

#include <cmath>

#include "base/overloaded.h"
#include "geometry/error_bounds.h"
#include "geometry/local_point.h"
#include "math/next_float.h"

namespace basicrt {
namespace {

// The direction that `v` has, or `otherwise` where it has none.
Vec3d direction_or(Vec3d v, Vec3d otherwise) {
  const double squared = length_squared(v);
  return squared > 0 && std::isfinite(squared) ? v * (1 / std::sqrt(squared)) : otherwise;
}

// Taking the point to the world, and taking it back as the origin of the next ray, both round.
Vec3d world_error(const TransformD& object_to_world, const TransformD& world_to_object, const LocalPoint& local,
                  Vec3d position) {
  const Vec3d error_back = point_error(world_to_object, position, Vec3d(0));
  return point_error(object_to_world, local.position, local.error + error_back);
}

void set_normals(SurfacePoint& point, const TransformD& world_to_object, const LocalPoint& local,
                 bool has_derivatives) {
  // By the inverse transpose, which keeps the outward side outward under mirroring too.
  const Vec3d geometric = direction_or(world_to_object.transposed_vector(local.normal), {0, 0, 1});
  point.geometric_normal = point.shading_normal = Vec3f(geometric);

  const Vec3d shading = world_to_object.transposed_vector(local.shading_normal);
  const double inverse_length = 1 / length(shading);
  if (!(inverse_length > 0 && std::isfinite(inverse_length))) return;
  const Vec3d unit = shading * inverse_length;
  const double side = dot(unit, geometric) < 0 ? -1 : 1;
  point.shading_normal = Vec3f(unit * side);
  if (!has_derivatives) return;
  // The derivative of n / |n|, given that of n.
  const auto unit_derivative = [&](Vec3d local_derivative) {
    const Vec3d derivative = world_to_object.transposed_vector(local_derivative);
    return Vec3f((derivative - unit * dot(unit, derivative)) * (inverse_length * side));
  };
  point.dndu = unit_derivative(local.dndu);
  point.dndv = unit_derivative(local.dndv);
}

// Igehy 1999, "Tracing Ray Differentials": the neighbouring rays meet the tangent plane.
void set_position_change(SurfacePoint& point, const Ray& ray, double t, const RayDifferentials& differentials) {
  const Vec3d normal(point.geometric_normal), direction(ray.direction);
  const double inverse_cosine = 1 / dot(direction, normal);
  if (!std::isfinite(inverse_cosine)) return;
  const auto shift = [&](Vec3f origin_change, Vec3f direction_change) {
    const Vec3d moved = Vec3d(origin_change) + Vec3d(direction_change) * t;
    return Vec3f(moved - direction * (dot(moved, normal) * inverse_cosine));
  };
  const Vec3f dpdx = shift(differentials.origin_dx, differentials.direction_dx);
  const Vec3f dpdy = shift(differentials.origin_dy, differentials.direction_dy);
  if (!is_finite(dpdx) || !is_finite(dpdy)) return;
  point.dpdx = dpdx;
  point.dpdy = dpdy;
}

// The least-squares solutions of dpdu * du + dpdv * dv = dpdx (dpdy).
void set_uv_change(SurfacePoint& point) {
  const Vec3d dpdu(point.dpdu), dpdv(point.dpdv);
  const double uu = length_squared(dpdu), uv = dot(dpdu, dpdv), vv = length_squared(dpdv);
  const double inverse_determinant = 1 / (uu * vv - uv * uv);
  if (!(inverse_determinant > 0 && std::isfinite(inverse_determinant))) return;
  const auto solve = [&](Vec3f change) {
    const double u = dot(dpdu, Vec3d(change)), v = dot(dpdv, Vec3d(change));
    return Vec2f(Vec2d{vv * u - uv * v, uu * v - uv * u} * inverse_determinant);
  };
  point.duvdx = solve(point.dpdx);
  point.duvdy = solve(point.dpdy);
}

}  // namespace

SurfacePoint make_surface_point(const Shape& shape, const TransformD& object_to_world,
                                const TransformD& world_to_object, const Ray& ray, const Hit& hit,
                                const RayDifferentials* differentials) {
  const PreciseRay local_ray = transform_ray(world_to_object, ray);
  const LocalPoint local =
      std::visit(Overloaded{[&](const Mesh& mesh) { return local_point_on_triangle(mesh, local_ray, hit); },
                            [&](const Sphere& sphere) { return local_point_on_sphere(sphere, local_ray, hit); }},
                 shape);

  SurfacePoint point;
  point.t = static_cast<float>(local.t);
  const Vec3d position = object_to_world.point(local.position);
  point.position = Vec3f(position);
  point.position_error = add_float_rounding(position, world_error(object_to_world, world_to_object, local, position));
  set_normals(point, world_to_object, local, differentials != nullptr);
  point.uv = Vec2f(local.uv);
  point.dpdu = Vec3f(object_to_world.vector(local.dpdu));
  point.dpdv = Vec3f(object_to_world.vector(local.dpdv));
  point.instance = hit.instance;
  point.primitive = std::holds_alternative<Mesh>(shape) ? hit.primitive : Hit::none;
  point.material_slot = local.material_slot;
  point.is_backfacing = dot(local_ray.direction, local.normal) > 0;
  if (differentials) {
    set_position_change(point, ray, local.t, *differentials);
    set_uv_change(point);
  }
  return point;
}

// Moves by the bound along the normal, then rounds away from the surface (Pharr, Jakob and Humphreys 2023,
// "Physically Based Rendering", section 6.8.6).
Vec3f offset_origin(const SurfacePoint& point, Vec3f direction) {
  const Vec3f normal = point.geometric_normal;
  const float distance = dot(abs(normal), point.position_error);
  const Vec3f offset = normal * (dot(direction, normal) < 0 ? -distance : distance);
  const auto move = [](float position, float by) {
    const float moved = position + by;
    return by > 0 ? next_float_up(moved) : by < 0 ? next_float_down(moved) : moved;
  };
  return {move(point.position.x, offset.x), move(point.position.y, offset.y), move(point.position.z, offset.z)};
}

}  // namespace basicrt
