// SPDX-License-Identifier: GPL-3.0-or-later
// A sphere that shines, or the ellipsoid that its transform makes of it, sampled by the cone in which it is seen.
#pragma once

#include <optional>

#include "geometry/surface_point.h"
#include "light/ball.h"
#include "light/emissive_instance.h"
#include "light/light.h"
#include "light/light_bounds.h"

namespace basicrt {

class SphereEmitter {
 public:
  SphereEmitter(const EmissiveInstance& instance, const Sphere& sphere);

  [[nodiscard]] double power() const { return power_; }  // watts, of the luminance
  [[nodiscard]] Vec3f center() const { return Vec3f(placement_.object_to_world.point(Vec3d(ball_.center))); }
  [[nodiscard]] LightBounds bounds() const;  // at all times
  [[nodiscard]] std::optional<LightSample> sample(Vec3f position, Vec2f u, float time) const;
  // The density of sample() for a place on the surface.
  [[nodiscard]] double pdf(Vec3f place, Vec3f position, float time) const;

 private:
  [[nodiscard]] Placement placement_at(float time) const {
    return motion_.empty() ? placement_ : Placement(transform_at(motion_, time));
  }

  Ball ball_;  // object space
  Placement placement_;
  std::vector<TransformD> motion_;
  std::uint32_t instance_;
  bool is_varying_;
  Color front_, back_;
  EmissiveInstance::Estimate emitted_;  // luminance
  double power_;
};

}  // namespace basicrt
