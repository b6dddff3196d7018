// SPDX-License-Identifier: GPL-3.0-or-later
// Rays for programs that ask what is around a point.
#pragma once

#include "integrator/hit_shading.h"

namespace basicrt {

class SceneProbe final : public RayProbe {
 public:
  explicit SceneProbe(const PreparedScene& scene) : scene_(scene) {}

  [[nodiscard]] bool is_occluded(const SurfacePoint& point, Vec3f direction, float distance,
                                 bool is_local) const override {
    Ray ray = spawn_ray(point, direction, is_local ? std::uint32_t{ray_all} : ray_shadow, point.time);
    ray.t_max = distance;
    if (!is_local) {
      std::uint8_t result = 0;
      scene_.tracer.occluded({&ray, 1}, {&result, 1});
      return result != 0;
    }
    return next_hit(ray, point.instance).has_value();
  }

  [[nodiscard]] std::optional<SurfacePoint> next_hit(Ray& ray, std::uint32_t instance) const override {
    while (true) {
      Hit hit;
      scene_.tracer.intersect({&ray, 1}, {&hit, 1});
      if (!hit.is_hit()) return std::nullopt;
      const SurfacePoint point = surface_point_at(scene_, ray, hit);
      continue_behind(ray, hit, point);
      if (hit.instance == instance) return point;
    }
  }

 private:
  const PreparedScene& scene_;
};

}  // namespace basicrt
