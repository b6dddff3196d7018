// SPDX-License-Identifier: GPL-3.0-or-later
// Everything that shines in a scene - lamps, emissive shapes, the environment - and how one of them is chosen.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "geometry/surface_point.h"
#include "light/emissive_instance.h"
#include "light/environment_sampler.h"
#include "light/lamp.h"
#include "light/light_picker.h"
#include "light/mesh_emitter.h"
#include "light/sphere_emitter.h"
#include "math/distribution.h"

namespace basicrt {

// A ball about a light.
struct LightExtent {
  Vec3f center;
  float radius = 0;
};

class LightSet {
 public:
  LightSet() = default;
  // `has_volumes`: choose() will be called. A number of a varying lamp is its index in `lamps`.
  LightSet(const std::vector<Lamp>& lamps, const std::vector<EmissiveInstance>& emitters,
           EnvironmentSampler environment, const Bounds3f& scene_bounds, bool has_volumes = false);
  LightSet(const std::vector<Light>& lamps, const std::vector<EmissiveInstance>& emitters,
           EnvironmentSampler environment, const Bounds3f& scene_bounds, bool has_volumes = false)
      : LightSet(std::vector<Lamp>(lamps.begin(), lamps.end()), emitters, std::move(environment), scene_bounds,
                 has_volumes) {}

  // Chooses a light with `choice` and a place on it with `u`; the pdf includes the choice. Nothing where no light
  // reaches the point. Emissive shapes that move are where they are at the time.
  [[nodiscard]] std::optional<LightSample> sample(const LitPoint& point, float choice, Vec2f u, float time = 0) const;

  // One light for all of a ray on which light may be scattered anywhere. A guess at the place counts for the choice, but
  // no light that reaches some other place is left out. Nothing where no light lights the receiver.
  struct Choice {
    bool is_environment = false;
    LightRef light{};  // else
    float probability = 0;
    float rest = 0;  // uniform in [0, 1) again
  };
  [[nodiscard]] std::optional<Choice> choose(const LitPoint& guess, float u) const;
  // Where it is, at time 0; nothing where it is infinitely far away.
  [[nodiscard]] std::optional<LightExtent> extent(const Choice& choice) const;
  // About how much of its light it sends to a place, for what has a beam; above 0.
  [[nodiscard]] float beam(const Choice& choice, Vec3f position) const;
  // A place on it: the pdf is of that alone.
  [[nodiscard]] std::optional<LightSample> sample_chosen(const Choice& choice, Vec3f position, Vec2f u,
                                                         float time) const;
  // How often sample() chooses this light.
  [[nodiscard]] float probability(const Choice& choice, const LitPoint& point) const;

  // The density of sample() for a ray from the point that hit an emissive surface; 0, too, where that doesn't light it.
  [[nodiscard]] float pdf_surface(const SurfacePoint& hit, const LitPoint& point) const;
  // The same for a ray that hit nothing; 0 where BSDF sampling alone finds the environment.
  [[nodiscard]] float pdf_environment(Vec3f direction, int receiver_set = LinkSets::unlinked) const {
    const float share = chooser_of(receiver_set).environment_share;
    return share == 0 ? 0 : share * environment_.pdf(direction);
  }

  // Calls visit(LightHit) for each lamp that the ray passes through, with pdfs that include the choice at its origin: of
  // those that light what is there. All of them: lamps don't block rays.
  template <class Visitor>
  void for_each_lamp_hit(const Ray& ray, const LitPoint& origin, Visitor&& visit) const {
    const auto visit_lamp = [&](std::uint32_t lamp) { visit_hit(lamp, ray, origin, visit); };
    if (lamps_with_size_.size() <= few_lamps)
      std::for_each(lamps_with_size_.begin(), lamps_with_size_.end(), visit_lamp);
    else
      chooser_of(origin.receiver_set).picker.visit_solid(ray, visit_lamp);
  }
  // The same for lamps infinitely far away, whatever the ray's end: for rays that hit nothing.
  template <class Visitor>
  void for_each_distant_hit(Ray ray, const LitPoint& origin, Visitor&& visit) const {
    ray.t_max = infinity;
    for (const std::uint32_t lamp : distant_lamps_with_size_) visit_hit(lamp, ray, origin, visit);
  }
  // The same for all lamps, near and far, that only some objects dim.
  template <class Visitor>
  void for_each_linked_hit(Ray ray, const LitPoint& origin, Visitor&& visit) const {
    ray.t_max = infinity;
    for (const std::uint32_t lamp : linked_lamps_with_size_) visit_hit(lamp, ray, origin, visit);
  }

  // What a ray sees that hits nothing.
  [[nodiscard]] Color environment_radiance(Vec3f direction, bool is_camera_ray) const {
    return environment_.eval(direction, is_camera_ray);
  }
  [[nodiscard]] int environment_light_group() const { return environment_.light_group(); }
  [[nodiscard]] const Lamp& lamp(std::uint32_t number) const { return lamps_[number]; }
  // Nothing to sample.
  [[nodiscard]] bool is_empty() const { return chooser_of(LinkSets::unlinked).is_empty(); }

 private:
  // What a surface that shines is sampled by.
  struct Emitter {
    std::variant<MeshEmitter, SphereEmitter> shape;
    int light_group;
    LinkSets lit_sets;
    std::uint32_t shadow_kind;
  };
  // How often each light is chosen, for receivers that the same ones light.
  struct Chooser {
    LightPicker picker;           // its sources are the lamps first, then the emitters
    DiscreteDistribution powers;  // for choose(): of each light, by its number
    float environment_share = 0;  // how often the environment is chosen
    [[nodiscard]] bool is_empty() const { return picker.size() == 0 && environment_share == 0; }
  };

  void add_lamp(std::uint32_t lamp);
  void add_emitter(const EmissiveInstance& instance);
  void add_choosers(bool has_volumes);
  [[nodiscard]] Chooser make_chooser(int receiver_set, bool has_volumes) const;
  [[nodiscard]] DiscreteDistribution powers_for(int receiver_set) const;
  [[nodiscard]] const Chooser& chooser_of(int receiver_set) const {
    return choosers_[chooser_of_set_[static_cast<std::size_t>(receiver_set)]];
  }
  [[nodiscard]] std::optional<LightSample> sample_lamp_or_emitter(LightRef light, Vec3f position, Vec2f u,
                                                                  float time) const;
  [[nodiscard]] const Emitter& emitter_of(LightRef light) const { return emitters_[light.source - lamps_.size()]; }
  [[nodiscard]] bool is_lamp(LightRef light) const { return light.source < lamps_.size(); }

  // So few are looked at one by one.
  static constexpr std::size_t few_lamps = 2;

  template <class Visitor>
  void visit_hit(std::uint32_t lamp, const Ray& ray, const LitPoint& origin, Visitor&& visit) const {
    if (!lamps_[lamp].lit_sets.has(origin.receiver_set)) return;
    std::optional<LightHit> hit = intersect_light(lamps_[lamp], ray);
    if (!hit) return;
    const Chooser& chooser = chooser_of(origin.receiver_set);
    hit->pdf *= (1 - chooser.environment_share) * chooser.picker.probability({lamp, 0}, origin);
    hit->shadow_kind = lamps_[lamp].shadow_kind;
    if (lamps_[lamp].is_varying) hit->varying_lamp = lamp;
    visit(*hit);
  }

  std::vector<Lamp> lamps_;
  // Those that rays can run into.
  std::vector<std::uint32_t> lamps_with_size_, distant_lamps_with_size_, linked_lamps_with_size_;
  std::vector<Emitter> emitters_;
  std::vector<std::uint32_t> emitter_of_instance_;  // index into emitters_, or no_emitter
  // Of each source of pickers, its first light's number among the powers.
  std::vector<std::uint32_t> first_numbers_;
  std::vector<Chooser> choosers_ = std::vector<Chooser>(1);
  std::array<std::uint8_t, LinkSets::count + 1> chooser_of_set_{};  // an index into choosers_
  EnvironmentSampler environment_;
  float scene_radius_ = 1;
};

}  // namespace basicrt
