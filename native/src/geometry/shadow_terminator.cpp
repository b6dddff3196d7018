// SPDX-License-Identifier: GPL-3.0-or-later
// Hanika 2021, "Hacking the shadow terminator": the point is projected onto the planes that touch the smooth surface at
// the corners, and the projections are interpolated.
#include "geometry/shadow_terminator.h"

#include <array>

namespace basicrt {

Vec3f shift_to_smooth_surface(const Mesh& mesh, const Placement& placement, const SurfacePoint& point, Vec3f wi) {
  const Vec2f b = point.barycentrics;
  const std::array<float, 3> weights = {1 - b.x - b.y, b.x, b.y};
  const float side = dot(point.shading_normal, wi) < 0 ? -1.0f : 1.0f;
  const Vec3d position(point.position), facing(point.geometric_normal);
  Vec3d shift(0);
  for (int corner = 0; corner < 3; ++corner) {
    const Vec3d local_normal(mesh.corner_normals[3 * std::size_t{point.primitive} + corner]);
    const Vec3d world_normal = placement.world_to_object.transposed_vector(local_normal);
    if (!(length_squared(world_normal) > 0)) continue;
    Vec3d normal = normalize(world_normal) * double(side);
    if (dot(normal, facing) * side < 0) normal = -normal;
    const Vec3d touched = placement.object_to_world.point(Vec3d(mesh.position(point.primitive, corner)));
    const double height = dot(touched - position, normal);
    if (height > 0) shift += normal * (height * weights[corner]);
  }
  return Vec3f(shift);
}

}  // namespace basicrt
