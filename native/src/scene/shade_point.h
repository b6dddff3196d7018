// SPDX-License-Identifier: GPL-3.0-or-later
// The surface that a ray met, and its material's answer.
#pragma once

#include "geometry/surface_point.h"
#include "scene/prepare.h"

namespace basicrt {

// What only the materials of some instances ask for.
inline void add_details(const PreparedScene::PreparedInstance& instance, SurfacePoint& point, const Shape& shape,
                        const Placement& placement) {
  add_derivatives(point, shape, placement);
  add_radial_tangents(point, instance.box, placement);
}

[[nodiscard]] inline SurfacePoint surface_point_at(const PreparedScene& scene, const Ray& ray, const Hit& hit) {
  const PreparedScene::PreparedInstance& instance = scene.instances[hit.instance];
  const Shape& shape = scene.shapes[instance.shape];
  const auto at = [&](const Placement& placement) {
    SurfacePoint point = make_surface_point(shape, placement, ray, hit);
    if (instance.needs_derivatives) add_details(instance, point, shape, placement);
    return point;
  };
  return instance.motion.empty() ? at(instance.placement) : at(Placement(transform_at(instance.motion, ray.time)));
}

// What programs see of a point that a ray of these kinds met. The counts of bounces are the caller's to add.
[[nodiscard]] inline ShadingContext shading_context(const PreparedScene& scene, const SurfacePoint& point,
                                                    std::uint32_t ray_kinds) {
  const PreparedScene::PreparedInstance& instance = scene.instances[point.instance];
  const Shape& shape = scene.shapes[instance.shape];
  return {.mesh = std::get_if<Mesh>(&shape),
          .curves = std::get_if<Curves>(&shape),
          .points = std::get_if<PointCloud>(&shape),
          .placement = &instance.placement,
          .object = &instance.info,
          .world_to_camera = &scene.world_to_camera,
          .window = scene.window ? &*scene.window : nullptr,
          .footprint = scene.pixel_width + scene.pixel_spread * point.t,
          .object_index = instance.pass_index,
          .material_index = scene.material_of(point).material.pass_index,
          .ray_kinds = ray_kinds};
}

// `context` is called where the material asks for it.
template <class ContextFunction>
[[nodiscard]] SurfaceShading shade_at(const PreparedScene& scene, const SurfacePoint& point, Vec3f wo,
                                      ContextFunction&& context) {
  return shade(scene.material_of(point), scene.textures, point, wo, context);
}

}  // namespace basicrt
