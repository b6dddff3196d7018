// SPDX-License-Identifier: GPL-3.0-or-later
// From a hit to a surface point: solved in the object's space in double precision, then taken to the world.
#include "geometry/surface_point.h"

#include <cmath>

#include "geometry/error_bounds.h"
#include "geometry/local_point.h"
#include "geometry/triangle_point.h"

namespace basicrt {
namespace {

// The direction that `v` has, or `otherwise` where it has none.
template <class T>
Vec3<T> direction_or(Vec3<T> v, Vec3<T> otherwise) {
  const T squared = length_squared(v);
  return squared >= std::numeric_limits<T>::min() && squared <= std::numeric_limits<T>::max()
             ? v * (1 / std::sqrt(squared))
             : otherwise;
}

struct WorldPoint {
  Vec3d position, error;
  Vec3d normal;          // of any length
  Vec3f shading_normal;  // the same
};

// Taking the point to the world, and taking it back as the origin of the next ray, both round.
WorldPoint translate(const LocalPoint& local, Vec3d translation) {
  return {.position = local.position + translation,
          .error = local.error + (abs(local.position) + abs(translation)) * gamma(4),
          .normal = local.normal,
          .shading_normal = local.shading_normal};
}

// Normals by the inverse transpose, which keeps the outward side outward under mirroring too.
WorldPoint transform(LocalPoint local, const TransformD& to_world, const TransformD& to_object) {
  const Vec3d position = to_world.point(local.position);
  return {.position = position,
          .error = point_error(to_world, local.position, local.error + point_error(to_object, position, Vec3d(0))),
          .normal = to_object.transposed_vector(local.normal),
          .shading_normal = Vec3f(to_object.transposed_vector(Vec3d(local.shading_normal)))};
}

template <class Geometry>
SurfacePoint make_point(const Geometry& geometry, const Placement& placement, const Ray& ray, const Hit& hit) {
  const LocalPoint local = local_point_on(geometry, placement.to_object(ray), hit);
  const WorldPoint world = placement.is_translation
                               ? translate(local, placement.object_to_world.column(3))
                               : transform(local, placement.object_to_world, placement.world_to_object);
  const auto normal = Vec3f(direction_or(world.normal, {0, 0, 1}));
  const Vec3f shading_normal = direction_or(world.shading_normal, normal);
  return {.position = Vec3f(world.position),
          .position_error = add_float_rounding(world.position, world.error),
          .geometric_normal = normal,
          .shading_normal = dot(shading_normal, normal) < 0 ? -shading_normal : shading_normal,
          .uv = local.uv,
          .barycentrics = local.barycentrics,
          .t = static_cast<float>(local.t),
          .instance = hit.instance,
          .primitive = std::is_same_v<Geometry, Mesh> ? hit.primitive : Hit::none,
          .material_slot = local.material_slot,
          .is_backfacing = local.is_backfacing,
          .derivatives = {}};
}

}  // namespace

SurfacePoint make_surface_point(const Shape& shape, const Placement& placement, const Ray& ray, const Hit& hit) {
  return std::visit([&](const auto& geometry) { return make_point(geometry, placement, ray, hit); }, shape);
}

}  // namespace basicrt
