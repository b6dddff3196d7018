// SPDX-License-Identifier: GPL-3.0-or-later
// What passes tell of a surface that is made of several lobes: one normal, one roughness.
#include <cmath>

#include "bsdf/bsdf.h"
#include "bsdf/lobe_kind.h"

namespace basicrt {

Vec3f Bsdf::mean_normal(std::optional<ScatterKind> kind) const {
  Vec3f sum(0.0f);
  for (const WeightedLobe& weighted : lobes_.used()) {
    const ScatterKind own = std::visit([](const auto& lobe) { return reflection_kind_of(lobe); }, weighted.lobe);
    if (!kind || own == *kind) sum += frame_of(weighted).normal * average(weighted.weight);
  }
  return length_squared(sum) > 0 ? normalize(sum) : smooth_normal_;
}

namespace {

// Of one lobe; negative where it has none.
float roughness_of(const Lobe& any) {
  if (const auto* lobe = std::get_if<OrenNayar>(&any)) return lobe->roughness();
  const std::optional<float> alpha = facet_alpha(any);
  return alpha ? std::sqrt(*alpha) : -1;
}

}  // namespace

float Bsdf::mean_roughness() const {
  float sum = 0, weights = 0;
  for (const WeightedLobe& weighted : lobes_.used()) {
    const float roughness = roughness_of(weighted.lobe);
    if (roughness < 0) continue;
    sum += roughness * average(weighted.weight);
    weights += average(weighted.weight);
  }
  return weights > 0 ? sum / weights : 1;
}

}  // namespace basicrt
