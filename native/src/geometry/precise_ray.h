// SPDX-License-Identifier: GPL-3.0-or-later
// A ray in double precision: what hits are computed with, in an object's own space.
#pragma once

#include <limits>

#include "math/ray.h"
#include "math/transform.h"

namespace basicrt {

struct PreciseRay {
  Vec3d origin, direction;
  double t_min = 0, t_max = 0;
  float time = 0;
};

// The direction is not normalised, so that t means the same in both spaces. Distances are neither negative nor larger
// than a float can hold.
inline PreciseRay make_precise_ray(Vec3d origin, Vec3d direction, const Ray& ray) {
  constexpr float largest = std::numeric_limits<float>::max();
  return {.origin = origin,
          .direction = direction,
          .t_min = ray.t_min < 0 ? 0 : ray.t_min,
          .t_max = ray.t_max > largest ? largest : ray.t_max,
          .time = ray.time};
}
inline PreciseRay transform_ray(const TransformD& world_to_object, const Ray& ray) {
  return make_precise_ray(world_to_object.point(Vec3d(ray.origin)), world_to_object.vector(Vec3d(ray.direction)), ray);
}
// The same, number for number, where the transform does no more than this.
inline PreciseRay translate_ray(Vec3d translation, const Ray& ray) {
  return make_precise_ray(Vec3d(ray.origin) + translation, Vec3d(ray.direction), ray);
}

}  // namespace basicrt
