// SPDX-License-Identifier: GPL-3.0-or-later
// The environment's pictures or one of the other lights; those are chosen by what they may matter to a point.
#include "light/light_set.h"

#include <algorithm>

#include "base/assert.h"
#include "base/overloaded.h"

namespace basicrt {
namespace {

constexpr std::uint32_t no_emitter = ~0u;

float radius_of(const Bounds3f& bounds) {
  if (bounds.is_empty()) return 1;
  const auto radius = static_cast<float>(length(Vec3d(bounds.upper) - Vec3d(bounds.lower)) / 2);
  return radius > 0 && radius < infinity ? radius : 1;
}

// How often the environment is chosen, where all other lights together have some power: by the two's powers, but
// neither too seldom, for what arrives at a point may be very different from what the whole scene receives.
float environment_share(const EnvironmentSampler& environment, float scene_radius, double other_power) {
  if (environment.is_empty()) return 0;
  if (!(other_power > 0)) return 1;
  constexpr double least_share = 0.25;
  const double power = environment.power(scene_radius);
  return static_cast<float>(least_share + (1 - 2 * least_share) * power / (power + other_power));
}

}  // namespace

LightSet::LightSet(const std::vector<Lamp>& lamps, const std::vector<EmissiveInstance>& emitters,
                   EnvironmentSampler environment, const Bounds3f& scene_bounds, bool has_volumes)
    : lamps_(lamps), environment_(std::move(environment)) {
  scene_radius_ = radius_of(scene_bounds);
  double power = 0;
  const auto add_power = [&](double of_one) {
    power += std::min<double>(of_one, std::numeric_limits<float>::max());  // it may have become infinite
  };
  for (std::uint32_t i = 0; i < lamps_.size(); ++i) {
    const std::size_t before = picker_.size();
    add_power(power_estimate(lamps_[i], scene_radius_));
    picker_.add_source(1);
    std::visit(Overloaded{[&](const LightBounds& bounds) { picker_.add({i, 0}, bounds); },
                          [&](const DistantBounds& bounds) { picker_.add_distant({i, 0}, bounds); }},
               light_bounds(lamps_[i]));
    if (picker_.size() == before || is_delta(lamps_[i])) continue;  // black ones needn't be met
    (std::holds_alternative<SunLight>(lamps_[i].kind) ? distant_lamps_with_size_ : lamps_with_size_).push_back(i);
  }
  emitters_.reserve(emitters.size());
  for (const EmissiveInstance& instance : emitters) {
    add_emitter(instance);
    add_power(std::visit([](const auto& emitter) { return emitter.power(); }, emitters_.back()));
  }
  picker_.build();
  if (has_volumes && picker_.size() > 1) share_by_power();
  environment_share_ = environment_share(environment_, scene_radius_, picker_.size() == 0 ? 0 : power);
}

void LightSet::add_emitter(const EmissiveInstance& instance) {
  if (emitter_of_instance_.size() <= instance.instance)
    emitter_of_instance_.resize(std::size_t{instance.instance} + 1, no_emitter);
  const auto index = static_cast<std::uint32_t>(emitters_.size());
  const auto source = static_cast<std::uint32_t>(lamps_.size()) + index;
  emitter_of_instance_[instance.instance] = index;
  emitter_groups_.push_back(instance.light_group);
  std::visit(Overloaded{[&](const Mesh& mesh) {
                          const MeshEmitter emitter(instance, mesh);
                          picker_.add_source(emitter.triangle_count());
                          for (std::uint32_t i = 0; i < emitter.triangle_count(); ++i)
                            picker_.add({source, i}, emitter.bounds(i));
                          emitters_.emplace_back(emitter);
                        },
                        [&](const Sphere& sphere) {
                          const SphereEmitter emitter(instance, sphere);
                          picker_.add_source(1);
                          picker_.add({source, 0}, emitter.bounds());
                          emitters_.emplace_back(emitter);
                        },
                        // Rays run into those: see find_emission().
                        [](const PointCloud&) { BASICRT_ASSERT(false); }, [](const Curves&) { BASICRT_ASSERT(false); }},
             *instance.shape);
}

std::optional<LightSample> LightSet::sample(const LitPoint& point, float choice, Vec2f u, float time) const {
  if (is_empty()) return std::nullopt;
  const bool is_environment = choice < environment_share_;
  const float share = is_environment ? environment_share_ : 1 - environment_share_;
  const float rest = std::min((is_environment ? choice : choice - environment_share_) / share, one_minus_epsilon);
  std::optional<LightSample> sample =
      is_environment ? environment_.sample(rest, u) : sample_picked(point, rest, u, time);
  if (!sample) return std::nullopt;
  sample->pdf *= share;
  if (is_environment) sample->light_group = environment_.light_group();
  if (!(sample->pdf > 0 && sample->pdf < infinity) || is_black(sample->radiance)) return std::nullopt;
  return sample;
}

std::optional<LightSample> LightSet::sample_picked(const LitPoint& point, float choice, Vec2f u, float time) const {
  const auto [light, probability] = picker_.pick(point, choice);
  std::optional<LightSample> sample = sample_lamp_or_emitter(light, point.position, u, time);
  if (sample) sample->pdf *= probability;
  return sample;
}

std::optional<LightSample> LightSet::sample_lamp_or_emitter(LightRef light, Vec3f position, Vec2f u, float time) const {
  if (is_lamp(light)) {
    const Lamp& lamp = lamps_[light.source];
    std::optional<LightSample> of_lamp = sample_light(lamp, position, u);
    if (of_lamp && lamp.is_varying) of_lamp->varying_lamp = light.source;
    return of_lamp;
  }
  std::optional<LightSample> sample =
      std::visit(Overloaded{[&](const MeshEmitter& mesh) { return mesh.sample(light.primitive, position, u, time); },
                            [&](const SphereEmitter& sphere) { return sphere.sample(position, u, time); }},
                 emitter_of(light));
  if (sample) sample->light_group = emitter_groups_[light.source - lamps_.size()];
  return sample;
}

void LightSet::share_by_power() {
  std::vector<double> powers;
  const auto add = [&](double power) { powers.push_back(std::min<double>(power, std::numeric_limits<float>::max())); };
  for (const Lamp& lamp : lamps_) {
    first_numbers_.push_back(static_cast<std::uint32_t>(powers.size()));
    add(power_estimate(lamp, scene_radius_));
  }
  for (const Emitter& emitter : emitters_) {
    first_numbers_.push_back(static_cast<std::uint32_t>(powers.size()));
    std::visit(Overloaded{[&](const MeshEmitter& mesh) {
                            for (std::uint32_t i = 0; i < mesh.triangle_count(); ++i) add(mesh.power(i));
                          },
                          [&](const SphereEmitter& sphere) { add(sphere.power()); }},
               emitter);
  }
  powers_ = DiscreteDistribution(std::move(powers));
}

std::optional<LightSet::Choice> LightSet::choose(Vec3f guess, float u) const {
  // The share that goes by power alone: what doesn't reach the guess may reach another place.
  constexpr float power_share = 0.25f;
  const auto rest_of = [](float number, float begin, float share) {
    return std::clamp((number - begin) / share, 0.0f, one_minus_epsilon);
  };
  if (is_empty()) return std::nullopt;
  if (u < environment_share_)
    return Choice{.is_environment = true, .probability = environment_share_, .rest = rest_of(u, 0, environment_share_)};
  const float others = 1 - environment_share_;
  u = rest_of(u, environment_share_, others);
  if (picker_.size() == 1) return Choice{.light = picker_.pick(guess, u).light, .probability = others};
  LightRef light;
  if (u < power_share) {
    const std::uint32_t number = powers_.choose(rest_of(u, 0, power_share)).index;
    const auto after = std::ranges::upper_bound(first_numbers_, number);
    light.source = static_cast<std::uint32_t>(after - first_numbers_.begin()) - 1;
    light.primitive = number - first_numbers_[light.source];
  } else {
    light = picker_.pick(guess, rest_of(u, power_share, 1 - power_share)).light;
  }
  const double by_power = powers_.probability(first_numbers_[light.source] + light.primitive);
  const float by_guess = picker_.probability(light, guess);
  return Choice{.light = light,
                .probability = others * (power_share * static_cast<float>(by_power) + (1 - power_share) * by_guess)};
}

std::optional<LightExtent> LightSet::extent(const Choice& choice) const {
  if (choice.is_environment) return std::nullopt;
  if (!is_lamp(choice.light)) {
    const Bounds3f box =
        std::visit(Overloaded{[&](const MeshEmitter& mesh) { return mesh.bounds(choice.light.primitive).box; },
                              [](const SphereEmitter& sphere) { return sphere.bounds().box; }},
                   emitter_of(choice.light));
    return LightExtent{(box.lower + box.upper) * 0.5f, length(box.upper - box.lower) / 2};
  }
  return std::visit(Overloaded{[](const SunLight&) -> std::optional<LightExtent> { return std::nullopt; },
                               [](const PointLight& lamp) -> std::optional<LightExtent> {
                                 return LightExtent{lamp.position, lamp.radius};
                               },
                               [](const SpotLamp& lamp) -> std::optional<LightExtent> {
                                 return LightExtent{lamp.to_world.column(3), lamp.radius};
                               },
                               [](const AreaLamp& lamp) -> std::optional<LightExtent> {
                                 return LightExtent{Vec3f(lamp.center), float(std::hypot(lamp.width, lamp.depth) / 2)};
                               }},
                    lamps_[choice.light.source].kind);
}

float LightSet::beam(const Choice& choice, Vec3f position) const {
  // At its edge a lamp of some size reaches farther than its middle does.
  constexpr float least = 0.02f;
  if (choice.is_environment || !is_lamp(choice.light)) return 1;
  const auto* spot = std::get_if<SpotLamp>(&lamps_[choice.light.source].kind);
  return spot ? std::max(beam_share(*spot, position), least) : 1;
}

std::optional<LightSample> LightSet::sample_chosen(const Choice& choice, Vec3f position, Vec2f u, float time) const {
  std::optional<LightSample> sample = choice.is_environment ? environment_.sample(choice.rest, u)
                                                            : sample_lamp_or_emitter(choice.light, position, u, time);
  if (!sample || !(sample->pdf > 0 && sample->pdf < infinity) || is_black(sample->radiance)) return std::nullopt;
  if (choice.is_environment) sample->light_group = environment_.light_group();
  return sample;
}

float LightSet::probability(const Choice& choice, Vec3f position) const {
  if (choice.is_environment) return environment_share_;
  return (1 - environment_share_) * picker_.probability(choice.light, position);
}

float LightSet::pdf_surface(const SurfacePoint& hit, const LitPoint& point) const {
  if (hit.instance >= emitter_of_instance_.size()) return 0;
  const std::uint32_t index = emitter_of_instance_[hit.instance];
  if (index == no_emitter) return 0;
  std::uint32_t primitive = 0;
  const double pdf = std::visit(
      Overloaded{[&](const MeshEmitter& mesh) {
                   primitive = hit.primitive;
                   return mesh.pdf(primitive, hit.position, point.position, hit.time);
                 },
                 [&](const SphereEmitter& sphere) { return sphere.pdf(hit.position, point.position, hit.time); }},
      emitters_[index]);
  if (pdf == 0) return 0;
  const float probability = picker_.probability({static_cast<std::uint32_t>(lamps_.size()) + index, primitive}, point);
  const auto result = (1 - environment_share_) * static_cast<float>(pdf * double(probability));
  return result < infinity ? result : 0;
}

}  // namespace basicrt
