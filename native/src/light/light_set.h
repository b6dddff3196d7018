// SPDX-License-Identifier: GPL-3.0-or-later
// Everything that shines in a scene - lamps, emissive shapes, the environment - and how one of them is chosen.
#pragma once

#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "geometry/surface_point.h"
#include "light/emissive_instance.h"
#include "light/light.h"
#include "light/mesh_emitter.h"
#include "light/sphere_emitter.h"
#include "math/bounds.h"
#include "math/distribution.h"

namespace basicrt {

// The same radiance from everywhere.
struct Environment {
  Color radiance{0.0f};
  static constexpr auto fields() {
    return std::tuple{field("radiance", &Environment::radiance, "W / (m^2 sr), each direction alike", at_least(0))};
  }
};

class LightSet {
 public:
  LightSet() = default;
  LightSet(std::vector<Light> lamps, std::vector<EmissiveInstance> emitters, const Environment& environment,
           const Bounds3f& scene_bounds);

  // Chooses a light with `choice` and a point on it with `u`; the pdf includes the choice. Nothing where no light
  // reaches the position. Emissive shapes that move are where they are at the time.
  [[nodiscard]] std::optional<LightSample> sample(Vec3f position, float choice, Vec2f u, float time = 0) const;

  // The density of sample() for a ray from `origin` that hit an emissive surface.
  [[nodiscard]] float pdf_surface(const SurfacePoint& point, Vec3f origin) const;
  [[nodiscard]] float pdf_environment() const;  // 0: the same from everywhere is found by BSDF sampling alone

  // Calls visit(LightHit) for each lamp that the ray passes through, with pdfs that include the choice. All of them:
  // lamps don't block rays.
  template <class Visitor>
  void for_each_lamp_hit(const Ray& ray, Visitor&& visit) const {
    for (const std::uint32_t lamp : lamps_with_size_) {
      if (auto hit = intersect_light(lamps_[lamp], ray)) {
        hit->pdf *= static_cast<float>(choices_.probability(lamp));
        visit(*hit);
      }
    }
  }

  [[nodiscard]] const Environment& environment() const { return environment_; }
  [[nodiscard]] bool is_empty() const { return !(choices_.total() > 0); }  // nothing to sample

 private:
  using Emitter = std::variant<MeshEmitter, SphereEmitter>;

  std::vector<Light> lamps_;
  std::vector<std::uint32_t> lamps_with_size_;  // those that rays can run into
  std::vector<Emitter> emitters_;
  std::vector<std::uint32_t> emitter_of_instance_;  // index into emitters_, or no_emitter
  DiscreteDistribution choices_;                    // lamps first, then emitters
  Environment environment_;
};

}  // namespace basicrt
