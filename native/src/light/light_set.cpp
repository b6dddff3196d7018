// SPDX-License-Identifier: GPL-3.0-or-later
// Lights are chosen by their power; the environment, being the same everywhere, is left to BSDF sampling: that follows
// the cosine and the lobes, which is all that varies.
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

}  // namespace

LightSet::LightSet(std::vector<Light> lamps, std::vector<EmissiveInstance> emitters, const Environment& environment,
                   const Bounds3f& scene_bounds)
    : lamps_(std::move(lamps)), environment_(environment) {
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
  choices_ = DiscreteDistribution(choice_weights(std::move(powers)));
}

std::optional<LightSample> LightSet::sample(Vec3f position, float choice, Vec2f u, float time) const {
  if (is_empty()) return std::nullopt;
  const auto [light, probability, remainder] = choices_.choose(choice);
  std::optional<LightSample> sample;
  if (light < lamps_.size()) {
    sample = sample_light(lamps_[light], position, u);
  } else {
    const Emitter& emitter = emitters_[light - lamps_.size()];
    sample = std::visit(Overloaded{[&](const MeshEmitter& mesh) { return mesh.sample(position, remainder, u, time); },
                                   [&](const SphereEmitter& sphere) { return sphere.sample(position, u, time); }},
                        emitter);
  }
  if (!sample) return std::nullopt;
  sample->pdf *= static_cast<float>(probability);
  if (!(sample->pdf > 0 && sample->pdf < infinity) || is_black(sample->radiance)) return std::nullopt;
  return sample;
}

float LightSet::pdf_surface(const SurfacePoint& point, Vec3f origin) const {
  if (point.instance >= emitter_of_instance_.size()) return 0;
  const std::uint32_t index = emitter_of_instance_[point.instance];
  if (index == no_emitter) return 0;
  const double pdf = std::visit(
      Overloaded{[&](const MeshEmitter& mesh) { return mesh.pdf(point.primitive, point.position, origin, point.time); },
                 [&](const SphereEmitter& sphere) { return sphere.pdf(point.position, origin, point.time); }},
      emitters_[index]);
  const double probability = choices_.probability(static_cast<std::uint32_t>(lamps_.size()) + index);
  const auto result = static_cast<float>(pdf * probability);
  return result < infinity ? result : 0;
}

float LightSet::pdf_environment() const { return 0; }

}  // namespace basicrt
