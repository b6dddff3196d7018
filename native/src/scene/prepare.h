// SPDX-License-Identifier: GPL-3.0-or-later
// From a description to what can be traced.
#pragma once

#include <algorithm>
#include <vector>

#include "base/report.h"
#include "bsdf/prepared_material.h"
#include "bvh/tracer.h"
#include "geometry/placement.h"
#include "light/light_set.h"
#include "scene/scene.h"

namespace basicrt {

// Read-only while rendering. Holds its own copy of all that shading needs.
struct PreparedScene {
  struct PreparedInstance {
    std::uint32_t shape = 0;
    Placement placement;
    std::vector<std::uint32_t> materials;  // for each slot, an index into `materials`
    bool needs_derivatives = false;        // one of the materials does
  };

  CameraView view;
  RenderSettings settings;
  std::vector<Shape> shapes;
  std::vector<std::uint64_t> shape_revisions;
  Table<Texture> textures;
  std::vector<PreparedMaterial> materials;  // the last one is the default
  std::vector<PreparedInstance> instances;
  Tracer tracer;
  LightSet lights;
  bool has_transparency = false;  // shadow rays must look at what they hit

  [[nodiscard]] const PreparedMaterial& material_of(const SurfacePoint& point) const {
    const std::vector<std::uint32_t>& slots = instances[point.instance].materials;
    return materials[slots[std::min<std::size_t>(point.material_slot, slots.size() - 1)]];
  }
};

// Validates, then builds the trees and the lights. `previous`, the outcome of an earlier call for the same Scene object,
// lends the trees of shapes that have not changed since. Throws SceneError.
[[nodiscard]] PreparedScene prepare(const Scene& scene, Report& report, PreparedScene previous = {});

}  // namespace basicrt
