// SPDX-License-Identifier: GPL-3.0-or-later
// The environment's pictures or one of the other lights; those are chosen by their power.
#include "light/light_set.h"

#include <algorithm>

#include "base/overloaded.h"

namespace basicrt {
namespace {

constexpr std::uint32_t no_emitter = ~0u;

// The share of choices that do not go by power: a strong light may be far off or, like a sun over a wide scene, spend
// its power elsewhere, and must not starve the small one nearby.
constexpr double even_share = 0.25;

float radius_of(const Bounds3f& bounds) {
  if (bounds.is_empty()) return 1;
  const auto radius = static_cast<float>(length(Vec3d(bounds.upper) - Vec3d(bounds.lower)) / 2);
  return radius > 0 && radius < infinity ? radius : 1;
}

// Each light's weight, adding up to one; nothing for one without power.
std::vector<double> choice_weights(std::vector<double> powers) {
  double total = 0;
  int shining = 0;
  for (double& power : powers) {
    power = std::min<double>(power, std::numeric_limits<float>::max());  // may have become infinite
    total += power;
    if (power > 0) ++shining;
  }
  for (double& power : powers)
    if (power > 0) power = (1 - even_share) * power / total + even_share / shining;
  return powers;
}

double total_power(const std::vector<double>& powers) {
  double total = 0;
  for (const double power : powers) total += std::min<double>(power, std::numeric_limits<float>::max());
  return total;
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

LightSet::LightSet(std::vector<Light> lamps, std::vector<EmissiveInstance> emitters, EnvironmentSampler environment,
                   const Bounds3f& scene_bounds)
    : lamps_(std::move(lamps)), environment_(std::move(environment)) {
  std::vector<double> powers;
  const float scene_radius = radius_of(scene_bounds);
  for (std::uint32_t i = 0; i < lamps_.size(); ++i) {
    powers.push_back(power_estimate(lamps_[i], scene_radius));
    if (!is_delta(lamps_[i])) lamps_with_size_.push_back(i);
  }

  emitters_.reserve(emitters.size());
  for (const EmissiveInstance& instance : emitters) {
    if (emitter_of_instance_.size() <= instance.instance)
      emitter_of_instance_.resize(std::size_t{instance.instance} + 1, no_emitter);
    emitter_of_instance_[instance.instance] = static_cast<std::uint32_t>(emitters_.size());
    std::visit(Overloaded{[&](const Mesh& mesh) { emitters_.emplace_back(MeshEmitter(instance, mesh)); },
                          [&](const Sphere& sphere) { emitters_.emplace_back(SphereEmitter(instance, sphere)); }},
               *instance.shape);
    powers.push_back(std::visit([](const auto& emitter) { return emitter.power(); }, emitters_.back()));
  }
  environment_share_ = environment_share(environment_, scene_radius, total_power(powers));
  choices_ = DiscreteDistribution(choice_weights(std::move(powers)));
}

std::optional<LightSample> LightSet::sample(Vec3f position, float choice, Vec2f u) const {
  if (is_empty()) return std::nullopt;
  const bool is_environment = choice < environment_share_;
  const float share = is_environment ? environment_share_ : 1 - environment_share_;
  const float rest = std::min((is_environment ? choice : choice - environment_share_) / share, one_minus_epsilon);
  std::optional<LightSample> sample =
      is_environment ? environment_.sample(rest, u) : sample_lamp_or_emitter(position, rest, u);
  if (!sample) return std::nullopt;
  sample->pdf *= share;
  if (!(sample->pdf > 0 && sample->pdf < infinity) || is_black(sample->radiance)) return std::nullopt;
  return sample;
}

std::optional<LightSample> LightSet::sample_lamp_or_emitter(Vec3f position, float choice, Vec2f u) const {
  const auto [light, probability, remainder] = choices_.choose(choice);
  std::optional<LightSample> sample;
  if (light < lamps_.size()) {
    sample = sample_light(lamps_[light], position, u);
  } else {
    const Emitter& emitter = emitters_[light - lamps_.size()];
    sample = std::visit(Overloaded{[&](const MeshEmitter& mesh) { return mesh.sample(position, remainder, u); },
                                   [&](const SphereEmitter& sphere) { return sphere.sample(position, u); }},
                        emitter);
  }
  if (sample) sample->pdf *= static_cast<float>(probability);
  return sample;
}

float LightSet::pdf_surface(const SurfacePoint& point, Vec3f origin) const {
  if (point.instance >= emitter_of_instance_.size()) return 0;
  const std::uint32_t index = emitter_of_instance_[point.instance];
  if (index == no_emitter) return 0;
  const double pdf =
      std::visit(Overloaded{[&](const MeshEmitter& mesh) { return mesh.pdf(point.primitive, point.position, origin); },
                            [&](const SphereEmitter& sphere) { return sphere.pdf(point.position, origin); }},
                 emitters_[index]);
  const double probability = choices_.probability(static_cast<std::uint32_t>(lamps_.size()) + index);
  const auto result = (1 - environment_share_) * static_cast<float>(pdf * probability);
  return result < infinity ? result : 0;
}

}  // namespace basicrt
