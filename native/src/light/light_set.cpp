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
  for (std::uint32_t i = 0; i < lamps_.size(); ++i) add_lamp(i);
  emitters_.reserve(emitters.size());
  for (const EmissiveInstance& instance : emitters) add_emitter(instance);
  std::uint32_t number = 0;
  const auto count_source = [&](std::uint32_t primitives) {
    first_numbers_.push_back(number);
    number += primitives;
  };
  for (std::size_t i = 0; i < lamps_.size(); ++i) count_source(1);
  for (const Emitter& emitter : emitters_) {
    const auto* mesh = std::get_if<MeshEmitter>(&emitter.shape);
    count_source(mesh != nullptr ? mesh->triangle_count() : 1);
  }
  add_choosers(has_volumes);
}

void LightSet::add_lamp(std::uint32_t index) {
  const Lamp& lamp = lamps_[index];
  const bool is_black = std::visit(Overloaded{[](const LightBounds& bounds) { return !(bounds.intensity > 0); },
                                              [](const DistantBounds& bounds) { return !(bounds.irradiance > 0); }},
                                   light_bounds(lamp));
  if (is_black || is_delta(lamp)) return;
  const bool is_distant = std::holds_alternative<SunLight>(lamp.kind);
  (is_distant ? distant_lamps_with_size_ : lamps_with_size_).push_back(index);
  if (lamp.shadow_kind != ray_shadow) linked_lamps_with_size_.push_back(index);
}

void LightSet::add_emitter(const EmissiveInstance& instance) {
  if (emitter_of_instance_.size() <= instance.instance)
    emitter_of_instance_.resize(std::size_t{instance.instance} + 1, no_emitter);
  emitter_of_instance_[instance.instance] = static_cast<std::uint32_t>(emitters_.size());
  const auto add = [&](const auto& shape) {
    emitters_.push_back({shape, instance.light_group, instance.lit_sets, instance.shadow_kind});
  };
  std::visit(Overloaded{[&](const Mesh& mesh) { add(MeshEmitter(instance, mesh)); },
                        [&](const Sphere& sphere) { add(SphereEmitter(instance, sphere)); },
                        // Rays run into those: see find_emission().
                        [](const PointCloud&) { BASICRT_ASSERT(false); }, [](const Curves&) { BASICRT_ASSERT(false); }},
             *instance.shape);
}

// One for all sets that the same lights light.
void LightSet::add_choosers(bool has_volumes) {
  std::vector<LinkSets> links;
  const auto add_link = [&](LinkSets sets) {
    if (!sets.is_all() && std::ranges::find(links, sets) == links.end()) links.push_back(sets);
  };
  for (const Lamp& lamp : lamps_) add_link(lamp.lit_sets);
  for (const Emitter& emitter : emitters_) add_link(emitter.lit_sets);

  choosers_.clear();
  std::vector<std::vector<bool>> shining;  // for each chooser, which of the links are to its sets
  for (int set = 0; set <= LinkSets::count; ++set) {
    std::vector<bool> of_set;
    for (const LinkSets link : links) of_set.push_back(link.has(set));
    const auto known = std::ranges::find(shining, of_set);
    chooser_of_set_[set] = static_cast<std::uint8_t>(known - shining.begin());
    if (known != shining.end()) continue;
    shining.push_back(std::move(of_set));
    choosers_.push_back(make_chooser(set, has_volumes));
  }
}

LightSet::Chooser LightSet::make_chooser(int receiver_set, bool has_volumes) const {
  Chooser chooser;
  double power = 0;
  const auto add_power = [&](double of_one) {
    power += std::min<double>(of_one, std::numeric_limits<float>::max());  // it may have become infinite
  };
  for (std::uint32_t i = 0; i < lamps_.size(); ++i) {
    chooser.picker.add_source(1);
    if (!lamps_[i].lit_sets.has(receiver_set)) continue;
    add_power(power_estimate(lamps_[i], scene_radius_));
    std::visit(Overloaded{[&](const LightBounds& bounds) { chooser.picker.add({i, 0}, bounds); },
                          [&](const DistantBounds& bounds) { chooser.picker.add_distant({i, 0}, bounds); }},
               light_bounds(lamps_[i]));
  }
  for (const Emitter& emitter : emitters_) {
    const auto source = static_cast<std::uint32_t>(lamps_.size() + (&emitter - emitters_.data()));
    const bool shines = emitter.lit_sets.has(receiver_set);
    if (shines) add_power(std::visit([](const auto& shape) { return shape.power(); }, emitter.shape));
    std::visit(Overloaded{[&](const MeshEmitter& mesh) {
                            chooser.picker.add_source(mesh.triangle_count());
                            for (std::uint32_t i = 0; shines && i < mesh.triangle_count(); ++i)
                              chooser.picker.add({source, i}, mesh.bounds(i));
                          },
                          [&](const SphereEmitter& sphere) {
                            chooser.picker.add_source(1);
                            if (shines) chooser.picker.add({source, 0}, sphere.bounds());
                          }},
               emitter.shape);
  }
  chooser.picker.build();
  if (has_volumes && chooser.picker.size() > 1) chooser.powers = powers_for(receiver_set);
  chooser.environment_share = environment_share(environment_, scene_radius_, chooser.picker.size() == 0 ? 0 : power);
  return chooser;
}

std::optional<LightSample> LightSet::sample(const LitPoint& point, float choice, Vec2f u, float time) const {
  const Chooser& chooser = chooser_of(point.receiver_set);
  if (chooser.is_empty()) return std::nullopt;
  const float environment_share = chooser.environment_share;
  const bool is_environment = choice < environment_share;
  const float share = is_environment ? environment_share : 1 - environment_share;
  const float rest = std::min((is_environment ? choice : choice - environment_share) / share, one_minus_epsilon);
  std::optional<LightSample> sample;
  if (is_environment) {
    sample = environment_.sample(rest, u);
    if (sample) sample->light_group = environment_.light_group();
  } else {
    const auto [light, probability] = chooser.picker.pick(point, rest);
    sample = sample_lamp_or_emitter(light, point.position, u, time);
    if (sample) sample->pdf *= probability;
  }
  if (!sample) return std::nullopt;
  sample->pdf *= share;
  if (!(sample->pdf > 0 && sample->pdf < infinity) || is_black(sample->radiance)) return std::nullopt;
  return sample;
}

std::optional<LightSample> LightSet::sample_lamp_or_emitter(LightRef light, Vec3f position, Vec2f u, float time) const {
  if (is_lamp(light)) {
    const Lamp& lamp = lamps_[light.source];
    std::optional<LightSample> of_lamp = sample_light(lamp, position, u);
    if (of_lamp && lamp.is_varying) of_lamp->varying_lamp = light.source;
    return of_lamp;
  }
  const Emitter& emitter = emitter_of(light);
  std::optional<LightSample> sample =
      std::visit(Overloaded{[&](const MeshEmitter& mesh) { return mesh.sample(light.primitive, position, u, time); },
                            [&](const SphereEmitter& sphere) { return sphere.sample(position, u, time); }},
                 emitter.shape);
  if (!sample) return std::nullopt;
  sample->light_group = emitter.light_group;
  sample->shadow_kind = emitter.shadow_kind;
  return sample;
}

// 0 of those that don't light the set.
DiscreteDistribution LightSet::powers_for(int receiver_set) const {
  std::vector<double> powers;
  const auto add = [&](LinkSets lit_sets, double power) {
    powers.push_back(lit_sets.has(receiver_set) ? std::min<double>(power, std::numeric_limits<float>::max()) : 0);
  };
  for (const Lamp& lamp : lamps_) add(lamp.lit_sets, power_estimate(lamp, scene_radius_));
  for (const Emitter& emitter : emitters_)
    std::visit(Overloaded{[&](const MeshEmitter& mesh) {
                            for (std::uint32_t i = 0; i < mesh.triangle_count(); ++i)
                              add(emitter.lit_sets, mesh.power(i));
                          },
                          [&](const SphereEmitter& sphere) { add(emitter.lit_sets, sphere.power()); }},
               emitter.shape);
  return DiscreteDistribution(std::move(powers));
}

std::optional<LightSet::Choice> LightSet::choose(const LitPoint& guess, float u) const {
  // The share that goes by power alone: what doesn't reach the guess may reach another place.
  constexpr float power_share = 0.25f;
  const auto rest_of = [](float number, float begin, float share) {
    return std::clamp((number - begin) / share, 0.0f, one_minus_epsilon);
  };
  const auto& [picker, powers, environment_share] = chooser_of(guess.receiver_set);
  if (picker.size() == 0 && environment_share == 0) return std::nullopt;
  if (u < environment_share)
    return Choice{.is_environment = true, .probability = environment_share, .rest = rest_of(u, 0, environment_share)};
  const float others = 1 - environment_share;
  u = rest_of(u, environment_share, others);
  if (picker.size() == 1) return Choice{.light = picker.pick(guess, u).light, .probability = others};
  LightRef light;
  if (u < power_share) {
    const std::uint32_t number = powers.choose(rest_of(u, 0, power_share)).index;
    const auto after = std::ranges::upper_bound(first_numbers_, number);
    light.source = static_cast<std::uint32_t>(after - first_numbers_.begin()) - 1;
    light.primitive = number - first_numbers_[light.source];
  } else {
    light = picker.pick(guess, rest_of(u, power_share, 1 - power_share)).light;
  }
  const double by_power = powers.probability(first_numbers_[light.source] + light.primitive);
  const float by_guess = picker.probability(light, guess);
  return Choice{.light = light,
                .probability = others * (power_share * static_cast<float>(by_power) + (1 - power_share) * by_guess)};
}

std::optional<LightExtent> LightSet::extent(const Choice& choice) const {
  if (choice.is_environment) return std::nullopt;
  if (!is_lamp(choice.light)) {
    const Bounds3f box =
        std::visit(Overloaded{[&](const MeshEmitter& mesh) { return mesh.bounds(choice.light.primitive).box; },
                              [](const SphereEmitter& sphere) { return sphere.bounds().box; }},
                   emitter_of(choice.light).shape);
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

float LightSet::probability(const Choice& choice, const LitPoint& point) const {
  const Chooser& chooser = chooser_of(point.receiver_set);
  if (choice.is_environment) return chooser.environment_share;
  return (1 - chooser.environment_share) * chooser.picker.probability(choice.light, point);
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
      emitters_[index].shape);
  if (pdf == 0) return 0;
  const Chooser& chooser = chooser_of(point.receiver_set);
  const LightRef light{static_cast<std::uint32_t>(lamps_.size()) + index, primitive};
  const float probability = chooser.picker.probability(light, point);
  const auto result = (1 - chooser.environment_share) * static_cast<float>(pdf * double(probability));
  return result < infinity ? result : 0;
}

}  // namespace basicrt
