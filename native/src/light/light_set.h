// SPDX-License-Identifier: GPL-3.0-or-later
// Everything that shines in a scene - lamps, emissive shapes, the environment - and how one of them is chosen.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "geometry/shape.h"
#include "geometry/surface_point.h"
#include "light/light.h"
#include "math/bounds.h"

namespace basicrt {

// The same radiance from everywhere.
struct Environment {
  Color radiance{0.0f};
  static constexpr auto fields() {
    return std::tuple{field("radiance", &Environment::radiance, "W / (m^2 sr), each direction alike", at_least(0))};
  }
};

// An instance with a material that emits. The pointers must outlive the LightSet.
struct EmissiveInstance {
  std::uint32_t instance = 0;
  const Shape* shape = nullptr;
  TransformD object_to_world;
  TransformD world_to_object;
  // Radiance of each material slot's front and back.
  std::vector<Color> front, back;
};

class LightSet {
 public:
  LightSet() = default;
  LightSet(std::vector<Light> lamps, std::vector<EmissiveInstance> emitters, const Environment& environment,
           const Bounds3f& scene_bounds);

  // Chooses a light with `choice` and a point on it with `u`; the pdf includes the choice. Nothing where no light
  // reaches the position.
  [[nodiscard]] std::optional<LightSample> sample(Vec3f position, float choice, Vec2f u) const;

  // The density of sample() for a ray from `origin` that hit an emissive surface.
  [[nodiscard]] float pdf_surface(const SurfacePoint& point, Vec3f origin) const;
  [[nodiscard]] float pdf_environment() const;  // 0: the same from everywhere is found by BSDF sampling alone

  // Calls visit(LightHit) for each lamp that the ray passes through, with pdfs that include the choice. All of them:
  // lamps don't block rays.
  template <class Visitor>
  void for_each_lamp_hit(const Ray& ray, Visitor&& visit) const {
    for (std::uint32_t i = 0; i < lamps_.size(); ++i) {
      if (auto hit = intersect_light(lamps_[i], ray)) {
        hit->pdf *= lamp_probability(i);
        visit(*hit);
      }
    }
  }

  [[nodiscard]] const Environment& environment() const { return environment_; }
  [[nodiscard]] bool is_empty() const;  // nothing to sample

 private:
  [[nodiscard]] float lamp_probability(std::uint32_t lamp) const;

  std::vector<Light> lamps_;
  Environment environment_;
  // (the light layer's own business)
};

}  // namespace basicrt
