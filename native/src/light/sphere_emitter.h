// SPDX-License-Identifier: GPL-3.0-or-later
// A sphere that shines, or the ellipsoid that its transform makes of it, sampled by the cone in which it is seen.
#pragma once

#include <optional>

#include "geometry/surface_point.h"
#include "light/ball.h"
#include "light/emissive_instance.h"
#include "light/light.h"

namespace basicrt {

class SphereEmitter {
 public:
  SphereEmitter(const EmissiveInstance& instance, const Sphere& sphere);

  [[nodiscard]] double power() const { return power_; }  // watts, of the luminance
  [[nodiscard]] LightBounds bounds() const;
  [[nodiscard]] std::optional<LightSample> sample(Vec3f position, Vec2f u) const;
  // The density of sample() for a place on the surface.
  [[nodiscard]] double pdf(Vec3f place, Vec3f position) const;

 private:
  [[nodiscard]] Color radiance_towards(Vec3f local_position) const;

  Ball ball_;  // object space
  TransformD object_to_world_, world_to_object_;
  Color front_, back_;
  double power_;
};

}  // namespace basicrt
