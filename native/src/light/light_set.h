// SPDX-License-Identifier: GPL-3.0-or-later
// Everything that shines in a scene - lamps, emissive shapes, the environment - and how one of them is chosen.
#pragma once

#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "geometry/surface_point.h"
#include "light/emissive_instance.h"
#include "light/environment_sampler.h"
#include "light/light.h"
#include "light/mesh_emitter.h"
#include "light/sphere_emitter.h"
#include "math/bounds.h"
#include "math/distribution.h"

namespace basicrt {

class LightSet {
 public:
  LightSet() = default;
  LightSet(std::vector<Light> lamps, std::vector<EmissiveInstance> emitters, EnvironmentSampler environment,
           const Bounds3f& scene_bounds);

  // Chooses a light with `choice` and a point on it with `u`; the pdf includes the choice. Nothing where no light
  // reaches the position.
  [[nodiscard]] std::optional<LightSample> sample(Vec3f position, float choice, Vec2f u) const;

  // The density of sample() for a ray from `origin` that hit an emissive surface.
  [[nodiscard]] float pdf_surface(const SurfacePoint& point, Vec3f origin) const;
  // The same for a ray that hit nothing; 0 where BSDF sampling alone finds the environment.
  [[nodiscard]] float pdf_environment(Vec3f direction) const {
    return environment_share_ == 0 ? 0 : environment_share_ * environment_.pdf(direction);
  }

  // Calls visit(LightHit) for each lamp that the ray passes through, with pdfs that include the choice. All of them:
  // lamps don't block rays.
  template <class Visitor>
  void for_each_lamp_hit(const Ray& ray, Visitor&& visit) const {
    for (const std::uint32_t lamp : lamps_with_size_) {
      if (auto hit = intersect_light(lamps_[lamp], ray)) {
        hit->pdf *= (1 - environment_share_) * static_cast<float>(choices_.probability(lamp));
        visit(*hit);
      }
    }
  }

  // What a ray sees that hits nothing.
  [[nodiscard]] Color environment_radiance(Vec3f direction, bool is_camera_ray) const {
    return eval_environment(environment_.environment(), direction, is_camera_ray);
  }
  // Nothing to sample.
  [[nodiscard]] bool is_empty() const { return !(choices_.total() > 0) && environment_share_ == 0; }

 private:
  using Emitter = std::variant<MeshEmitter, SphereEmitter>;

  [[nodiscard]] std::optional<LightSample> sample_lamp_or_emitter(Vec3f position, float choice, Vec2f u) const;

  std::vector<Light> lamps_;
  std::vector<std::uint32_t> lamps_with_size_;  // those that rays can run into
  std::vector<Emitter> emitters_;
  std::vector<std::uint32_t> emitter_of_instance_;  // index into emitters_, or no_emitter
  DiscreteDistribution choices_;                    // lamps first, then emitters
  EnvironmentSampler environment_;
  float environment_share_ = 0;  // how often the environment is chosen
};

}  // namespace basicrt
