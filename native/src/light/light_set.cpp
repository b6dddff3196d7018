// SPDX-License-Identifier: GPL-3.0-or-later
// Lights are chosen by what they may matter to a point; the environment, being the same everywhere, is left to BSDF sampling: that follows
// the cosine and the lobes, which is all that varies.
#include "light/light_set.h"

#include <algorithm>

#include "base/overloaded.h"

namespace basicrt {
namespace {

constexpr std::uint32_t no_emitter = ~0u;

}  // namespace

LightSet::LightSet(std::vector<Light> lamps, std::vector<EmissiveInstance> emitters, const Environment& environment)
    : lamps_(std::move(lamps)), environment_(environment) {
  for (std::uint32_t i = 0; i < lamps_.size(); ++i) {
    const std::size_t before = picker_.size();
    picker_.add_source(1);
    std::visit(Overloaded{[&](const LightBounds& bounds) { picker_.add({i, 0}, bounds); },
                          [&](const DistantBounds& bounds) { picker_.add_distant({i, 0}, bounds); }},
               light_bounds(lamps_[i]));
    if (picker_.size() == before || is_delta(lamps_[i])) continue;  // black ones needn't be met
    (std::holds_alternative<SunLight>(lamps_[i]) ? distant_lamps_with_size_ : lamps_with_size_).push_back(i);
  }
  emitters_.reserve(emitters.size());
  for (const EmissiveInstance& instance : emitters) add_emitter(instance);
  picker_.build();
}

void LightSet::add_emitter(const EmissiveInstance& instance) {
  if (emitter_of_instance_.size() <= instance.instance)
    emitter_of_instance_.resize(std::size_t{instance.instance} + 1, no_emitter);
  const auto index = static_cast<std::uint32_t>(emitters_.size());
  const auto source = static_cast<std::uint32_t>(lamps_.size()) + index;
  emitter_of_instance_[instance.instance] = index;
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
                        }},
             *instance.shape);
}

std::optional<LightSample> LightSet::sample(const LitPoint& point, float choice, Vec2f u) const {
  if (is_empty()) return std::nullopt;
  const auto [light, probability] = picker_.pick(point, choice);
  std::optional<LightSample> sample;
  if (light.source < lamps_.size()) {
    sample = sample_light(lamps_[light.source], point.position, u);
  } else {
    const std::uint32_t primitive = light.primitive;
    sample = std::visit(Overloaded{[&](const MeshEmitter& mesh) { return mesh.sample(primitive, point.position, u); },
                                   [&](const SphereEmitter& sphere) { return sphere.sample(point.position, u); }},
                        emitters_[light.source - lamps_.size()]);
  }
  if (!sample) return std::nullopt;
  sample->pdf *= probability;
  if (!(sample->pdf > 0 && sample->pdf < infinity) || is_black(sample->radiance)) return std::nullopt;
  return sample;
}

float LightSet::pdf_surface(const SurfacePoint& hit, const LitPoint& point) const {
  if (hit.instance >= emitter_of_instance_.size()) return 0;
  const std::uint32_t index = emitter_of_instance_[hit.instance];
  if (index == no_emitter) return 0;
  std::uint32_t primitive = 0;
  const double pdf =
      std::visit(Overloaded{[&](const MeshEmitter& mesh) {
                              primitive = hit.primitive;
                              return mesh.pdf(primitive, hit.position, point.position);
                            },
                            [&](const SphereEmitter& sphere) { return sphere.pdf(hit.position, point.position); }},
                 emitters_[index]);
  if (pdf == 0) return 0;
  const float probability = picker_.probability({static_cast<std::uint32_t>(lamps_.size()) + index, primitive}, point);
  const auto result = static_cast<float>(pdf * double(probability));
  return result < infinity ? result : 0;
}

float LightSet::pdf_environment() const { return 0; }

}  // namespace basicrt
