// SPDX-License-Identifier: GPL-3.0-or-later
// The description of a scene: plain structs in tables, with typed indices and no pointers.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/report.h"
#include "base/table.h"
#include "camera/camera.h"
#include "geometry/shape.h"
#include "light/light_set.h"
#include "scene/settings.h"
#include "shading/evaluator.h"
#include "shading/material.h"

namespace basicrt {

// A shape placed in the world with materials for its slots. A slot without a material (and an instance without any)
// has the default: a diffuse grey of 0.8, both sides.
struct Instance {
  std::string name;
  Id<Shape> shape;
  Transform object_to_world;
  std::vector<Id<Material>> materials;
  std::uint32_t visibility = ray_all;  // RayKind bits
  // Object to world at further times: equally spaced, `object_to_world` being of time 0, the last of time 1. Between
  // two of them matrices are linear.
  std::vector<Transform> motion_transforms;
  // For the pass Vector: object to world one frame before and one frame after. None, or these two.
  std::vector<Transform> adjacent_transforms;
  bool is_holdout = false;         // a hole in the picture, for camera rays
  bool is_shadow_catcher = false;  // the camera sees through it, to where it darkens by others' shadows
  ObjectInfo info;                 // for materials that ask
  // See shadow_terminator.h, both in [0, 1].
  float shadow_terminator_offset = 0, shadow_terminator_shading_offset = 0;
  int pass_index = 0;                     // the pass Object Index
  int light_group = 0;                    // of what its materials emit
  std::string asset_name;                 // what it is part of, for the passes CryptoAsset; none: `name`
  int receiver_set = 0, blocker_set = 0;  // by which lights know it, see link_sets.h
  LinkSets lit_sets, blocker_sets;        // of what its materials emit: receivers, and what dims it
};

struct Scene {
  Table<Shape> shapes;
  Table<Texture> textures;
  Table<Material> materials;
  Table<Instance> instances;
  Table<Light> lights;
  Environment environment;
  Id<Material> world_volume;  // whose volume fills all space, within shapes too; none: nothing does
  std::optional<Camera> camera;
  std::vector<Camera>
      adjacent_cameras;  // for the pass Vector: one frame before and one frame after. None, or these two
  RenderSettings settings;
};

// Throws SceneError naming the first item that can't be rendered, the rule and the value. After it nothing throws.
void validate(const Scene& scene);
// The same but for what only rendering needs, a camera.
void validate_description(const Scene& scene);
// One instance alone; its shape must be valid.
void validate_instance(const Scene& scene, Id<Instance> id);
// The camera and the settings alone.
void validate_view(const Camera& camera, const RenderSettings& settings);
// The same of a scene, and the cameras of the frames beside it.
void validate_views(const Scene& scene);

}  // namespace basicrt
