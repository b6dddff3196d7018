// SPDX-License-Identifier: GPL-3.0-or-later
// What a lamp's material makes of its light.
#pragma once

#include <cstdint>

#include "light/lamp_point.h"
#include "scene/prepare.h"

namespace basicrt {

// Some of a lamp, seen from a place: `wi` is of unit length and leads to it.
struct LampView {
  const Lamp& lamp;
  Vec3f position, wi;
  float distance = infinity;
  float time = 0;
};

// What the lamp's own radiance counts times. As Blender has it the material doesn't know the ray's kind; the counts of
// bounces are for set_counts(ShadingContext&) to add.
template <class CountsFunction>
[[nodiscard]] Color lamp_emission(const PreparedScene& scene, const PreparedScene::LampMaterial& of_lamp,
                                  const LampView& view, CountsFunction&& set_counts) {
  const SurfacePoint point = lamp_point(view.lamp, view.position, view.wi, view.distance, view.time);
  const PreparedMaterial& material = scene.materials[of_lamp.material];
  const auto context = [&] {
    ShadingContext made{.placement = &of_lamp.placement,
                        .world_to_camera = &scene.world_to_camera,
                        .window = scene.window ? &*scene.window : nullptr,
                        .material_index = material.material.pass_index};
    set_counts(made);
    return made;
  };
  return shade(material, scene.textures, point, -view.wi, context).emission;
}

}  // namespace basicrt
