// SPDX-License-Identifier: GPL-3.0-or-later
// A shape in the scene whose material shines.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/shape.h"
#include "light/link_sets.h"
#include "math/color.h"
#include "math/ray.h"
#include "math/transform.h"

namespace basicrt {

// The pointer must outlive whatever is made from this.
struct EmissiveInstance {
  std::uint32_t instance = 0;
  int light_group = 0;
  LinkSets lit_sets;                       // of receivers
  std::uint32_t shadow_kind = ray_shadow;  // RayKind bits of the rays that find out what dims its light
  const Shape* shape = nullptr;
  TransformD object_to_world;
  TransformD world_to_object;
  std::vector<TransformD> motion;  // as of a TracedInstance: object to world over time, or none
  // Radiance of each material slot's front and back, where that is the same everywhere.
  std::vector<Color> front, back;
  // Where it isn't on some slot: about how much each triangle's (or the sphere's) two sides emit, luminance.
  struct Estimate {
    float front = 0, back = 0;
  };
  std::vector<Estimate> estimates;
  std::vector<bool> is_varying;  // of each slot, where there are estimates
};

}  // namespace basicrt
