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

LightSet::LightSet(const std::vector<Light>& lamps, const std::vector<EmissiveInstance>& emitters,
                   EnvironmentSampler environment, const Bounds3f& scene_bounds)
    : lamps_(lamps.begin(), lamps.end()), environment_(std::move(environment)) {
  const float scene_radius = radius_of(scene_bounds);
  double power = 0;
  const auto add_power = [&](double of_one) {
    power += std::min<double>(of_one, std::numeric_limits<float>::max());  // it may have become infinite
  };
  for (std::uint32_t i = 0; i < lamps_.size(); ++i) {
    const std::size_t before = picker_.size();
    add_power(power_estimate(lamps_[i], scene_radius));
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
  environment_share_ = environment_share(environment_, scene_radius, picker_.size() == 0 ? 0 : power);
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
      is_environment ? environment_.sample(rest, u) : sample_lamp_or_emitter(point, rest, u, time);
  if (!sample) return std::nullopt;
  sample->pdf *= share;
  if (is_environment) sample->light_group = environment_.light_group();
  if (!(sample->pdf > 0 && sample->pdf < infinity) || is_black(sample->radiance)) return std::nullopt;
  return sample;
}

std::optional<LightSample> LightSet::sample_lamp_or_emitter(const LitPoint& point, float choice, Vec2f u,
                                                            float time) const {
  const auto [light, probability] = picker_.pick(point, choice);
  std::optional<LightSample> sample;
  if (light.source < lamps_.size()) {
    sample = sample_light(lamps_[light.source], point.position, u);
  } else {
    const std::uint32_t primitive = light.primitive;
    sample =
        std::visit(Overloaded{[&](const MeshEmitter& mesh) { return mesh.sample(primitive, point.position, u, time); },
                              [&](const SphereEmitter& sphere) { return sphere.sample(point.position, u, time); }},
                   emitters_[light.source - lamps_.size()]);
    if (sample) sample->light_group = emitter_groups_[light.source - lamps_.size()];
  }
  if (sample) sample->pdf *= probability;
  return sample;
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
