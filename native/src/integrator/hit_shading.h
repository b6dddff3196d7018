// SPDX-License-Identifier: GPL-3.0-or-later
// What every integrator does with a hit: the surface there, and its material's answer.
#pragma once

#include "bsdf/bsdf.h"
#include "geometry/surface_point.h"
#include "scene/prepare.h"

namespace basicrt {

[[nodiscard]] inline SurfacePoint surface_point_at(const PreparedScene& scene, const Ray& ray, const Hit& hit,
                                                   const RayDifferentials* differentials = nullptr) {
  const PreparedScene::PreparedInstance& instance = scene.instances[hit.instance];
  return make_surface_point(scene.shapes[instance.shape], instance.object_to_world, instance.world_to_object, ray, hit,
                            differentials);
}

[[nodiscard]] inline SurfaceShading shade_at(const PreparedScene& scene, const SurfacePoint& point, Vec3f wo) {
  return shade(scene.material_of(point), scene.textures, point, wo);
}

// Notes the passes of a camera ray's first hit.
inline void record_first_hit(const PreparedScene& scene, const SurfacePoint& point, PixelSample& sample) {
  sample.has_hit = true;
  sample.depth = camera_depth(scene.camera, point.position);
  sample.normal = point.is_backfacing ? -point.shading_normal : point.shading_normal;
}

// A ray that leaves the surface, free of hitting it again.
[[nodiscard]] inline Ray spawn_ray(const SurfacePoint& point, Vec3f direction, std::uint32_t kinds, float time) {
  return {.origin = offset_origin(point, direction), .direction = direction, .kinds = kinds, .time = time};
}

// A ray from the surface that ends just before what is `distance` away.
[[nodiscard]] inline Ray spawn_shadow_ray(const SurfacePoint& point, Vec3f direction, float distance, float time) {
  Ray ray = spawn_ray(point, direction, ray_shadow, time);
  ray.t_max = distance * (1 - 1e-4f);
  return ray;
}

}  // namespace basicrt
