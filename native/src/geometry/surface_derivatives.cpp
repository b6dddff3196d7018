// SPDX-License-Identifier: GPL-3.0-or-later
// How a surface point changes: with its uv, and from pixel to pixel.
#include <cmath>
#include <limits>

#include "base/overloaded.h"
#include "geometry/local_point.h"
#include "geometry/sphere.h"
#include "geometry/surface_point.h"

namespace basicrt {
namespace {

void set_normal_change(SurfaceDerivatives& derivatives, Vec3f shading_normal, const TransformD& world_to_object,
                       const LocalDerivatives& local) {
  const Vec3d normal = world_to_object.transposed_vector(local.normal);
  const double inverse_length = 1 / length(normal);
  if (!(inverse_length > 0 && std::isfinite(inverse_length))) return;
  const Vec3d unit = normal * inverse_length;
  const double side = dot(unit, Vec3d(shading_normal)) < 0 ? -1 : 1;
  // The derivative of n / |n|, given that of n.
  const auto unit_derivative = [&](Vec3d local_derivative) {
    const Vec3d derivative = world_to_object.transposed_vector(local_derivative);
    return Vec3f((derivative - unit * dot(unit, derivative)) * (inverse_length * side));
  };
  derivatives.dndu = unit_derivative(local.dndu);
  derivatives.dndv = unit_derivative(local.dndv);
}

// Igehy 1999, "Tracing Ray Differentials": the neighbouring rays meet the tangent plane.
void set_position_change(SurfacePoint& point, const Ray& ray, const RayDifferentials& differentials) {
  const Vec3d normal(point.geometric_normal), direction(ray.direction);
  const double inverse_cosine = 1 / dot(direction, normal);
  if (!std::isfinite(inverse_cosine)) return;
  const auto shift = [&](Vec3f origin_change, Vec3f direction_change) {
    const Vec3d moved = Vec3d(origin_change) + Vec3d(direction_change) * point.t;
    return Vec3f(moved - direction * (dot(moved, normal) * inverse_cosine));
  };
  const Vec3f dpdx = shift(differentials.origin_dx, differentials.direction_dx);
  const Vec3f dpdy = shift(differentials.origin_dy, differentials.direction_dy);
  if (!is_finite(dpdx) || !is_finite(dpdy)) return;
  point.derivatives->dpdx = dpdx;
  point.derivatives->dpdy = dpdy;
}

// The least-squares solutions of dpdu * du + dpdv * dv = dpdx (dpdy).
void set_uv_change(SurfaceDerivatives& derivatives) {
  const Vec3d dpdu(derivatives.dpdu), dpdv(derivatives.dpdv);
  const double uu = length_squared(dpdu), uv = dot(dpdu, dpdv), vv = length_squared(dpdv);
  const double inverse_determinant = 1 / (uu * vv - uv * uv);
  if (!(inverse_determinant > 0 && std::isfinite(inverse_determinant))) return;
  const auto solve = [&](Vec3f change) {
    const double u = dot(dpdu, Vec3d(change)), v = dot(dpdv, Vec3d(change));
    return Vec2f(Vec2d{vv * u - uv * v, uu * v - uv * u} * inverse_determinant);
  };
  derivatives.duvdx = solve(derivatives.dpdx);
  derivatives.duvdy = solve(derivatives.dpdy);
}

}  // namespace

void add_derivatives(SurfacePoint& point, const Shape& shape, const Placement& placement) {
  const auto on_triangle = [&](const Mesh& mesh) {
    return derivatives_on_triangle(mesh, point.primitive, point.barycentrics, point.time);
  };
  const auto on_sphere = [&](const Sphere& sphere) {
    return derivatives_on_sphere(sphere, placement.world_to_object.point(Vec3d(point.position)));
  };
  const auto on_point = [&](const PointCloud& cloud) { return on_sphere(sphere_of(cloud, point.primitive)); };
  const auto on_curve = [&](const Curves& curves) {
    const Vec3d normal = placement.object_to_world.transposed_vector(Vec3d(point.geometric_normal));
    return derivatives_on_curve(curves, point.primitive, point.barycentrics.x, normal);
  };
  const LocalDerivatives local = std::visit(Overloaded{on_triangle, on_sphere, on_point, on_curve}, shape);
  SurfaceDerivatives& derivatives = point.derivatives.emplace();
  derivatives.dpdu = Vec3f(placement.object_to_world.vector(local.dpdu));
  derivatives.dpdv = Vec3f(placement.object_to_world.vector(local.dpdv));
  set_normal_change(derivatives, point.shading_normal, placement.world_to_object, local);
}

void add_radial_tangents(SurfacePoint& point, const Bounds3f& box, const Placement& placement) {
  const Vec3d local = placement.world_to_object.point(Vec3d(point.position)) - Vec3d(box.center());
  const Vec3f extent = box.extent();
  const auto coordinate = [&](std::size_t axis) { return extent[axis] > 0 ? local[axis] / extent[axis] : 0; };
  const double x = coordinate(0), y = coordinate(1), z = coordinate(2);
  const std::array<Vec3d, 3> around = {Vec3d{0, -z, y}, Vec3d{-z, 0, x}, Vec3d{-y, x, 0}};
  // As normals, for Blender does so.
  for (std::size_t axis = 0; axis < 3; ++axis)
    point.derivatives->radial_tangents[axis] = Vec3f(placement.world_to_object.transposed_vector(around[axis]));
}

void add_pixel_change(SurfacePoint& point, const Ray& ray, const RayDifferentials& differentials) {
  set_position_change(point, ray, differentials);
  set_uv_change(*point.derivatives);
}

}  // namespace basicrt
