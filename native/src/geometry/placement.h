// SPDX-License-Identifier: GPL-3.0-or-later
// Where an instance stands in the world.
#pragma once

#include "geometry/precise_ray.h"
#include "math/transform.h"

namespace basicrt {

// The transforms both ways. Most objects are only moved, or stay where they were made: that is known beforehand.
struct Placement {
  TransformD object_to_world, world_to_object;
  bool is_translation = true;

  Placement() = default;
  explicit Placement(const TransformD& to_world)
      : object_to_world(to_world), world_to_object(inverse(to_world)), is_translation(is_only_moved(to_world)) {}

  [[nodiscard]] PreciseRay to_object(const Ray& ray) const {
    return is_translation ? translate_ray(world_to_object.column(3), ray) : transform_ray(world_to_object, ray);
  }

 private:
  static bool is_only_moved(TransformD transform) {
    for (auto& row : transform.rows) row[3] = 0;
    return transform == TransformD{};
  }
};

}  // namespace basicrt
