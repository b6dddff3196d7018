// SPDX-License-Identifier: GPL-3.0-or-later
// What share of the light each way of scattering returns: the passes Diffuse Color and so on.
#include <algorithm>
#include <cmath>

#include "bsdf/albedo.h"
#include "bsdf/bsdf.h"
#include "bsdf/lobe_kind.h"

namespace basicrt {
namespace {

// What single scattering by facets leaves of the light, before any Fresnel.
float facet_albedo(float alpha, float cos_theta) {
  return alpha > 0 ? 1 / multiple_scattering(std::sqrt(alpha), cos_theta, Color(1.0f)).x : 1;
}

Color albedo_of(const MicrofacetReflection<InterfaceFresnel>& lobe, float cos_theta) {
  const float alpha = lobe.microfacets.alpha_x, eta = lobe.fresnel.eta;
  if (!(alpha > 0) || eta < 1) return lobe.fresnel(cos_theta);
  const DielectricLayer layer = dielectric_layer(std::sqrt(alpha), eta, cos_theta);
  return Color(layer.albedo / layer.scale);
}

Color albedo_of(const ChiangHair& lobe, float /*cos_theta*/) { return lobe.albedo(); }

template <class Fresnel>
Color albedo_of(const MicrofacetReflection<Fresnel>& lobe, float cos_theta) {
  const Microfacets& facets = lobe.microfacets;
  return lobe.fresnel(cos_theta) * facet_albedo(std::sqrt(facets.alpha_x * facets.alpha_y), cos_theta);
}

// Whatever else there is returns all that its weight leaves.
template <class AnyLobe>
Color albedo_of(const AnyLobe& /*lobe*/, float /*cos_theta*/) {
  return Color(1.0f);
}

void remove_other(Dielectric& lobe, ScatterKind kind) {
  (kind == ScatterKind::glossy ? lobe.transmit_tint : lobe.reflect_tint) = Color(0.0f);
}
void remove_other(FilmDielectric& lobe, ScatterKind kind) {
  (kind == ScatterKind::glossy ? lobe.is_transmitting : lobe.is_reflecting) = false;
}

// Of one that reflects and transmits, what it scatters in one of these ways.
template <class AnyDielectric>
Color albedo_of(AnyDielectric lobe, float cos_theta, ScatterKind kind) {
  remove_other(lobe, kind);
  const Color smooth = lobe.albedo(cos_theta);
  if (!(lobe.alpha > 0)) return smooth;
  return smooth / glass_multiple_scattering(std::sqrt(lobe.alpha), lobe.eta, cos_theta, Color(1.0f));
}

// What a lobe scatters in one of these ways.
Color albedo_of(const Lobe& any, float cos_theta, ScatterKind kind) {
  return std::visit(
      [&]<class AnyLobe>(const AnyLobe& lobe) {
        if constexpr (is_two_sided<AnyLobe>) {
          const bool is_part = kind == ScatterKind::glossy || kind == ScatterKind::transmission;
          return is_part ? albedo_of(lobe, cos_theta, kind) : Color(0.0f);
        } else {
          return reflection_kind_of(lobe) == kind ? albedo_of(lobe, cos_theta) : Color(0.0f);
        }
      },
      any);
}

float smooth_step(float edge, float x) {
  const float t = std::clamp(x / edge, 0.0f, 1.0f);
  return t * t * (3 - 2 * t);
}

}  // namespace

Color Bsdf::albedo(Vec3f wo, ScatterKind kind) const {
  Color sum(0.0f);
  for (const WeightedLobe& weighted : lobes_.used()) {
    const float cos_theta = std::clamp(find_side(frame_of(weighted), wo).wo.z, 1e-3f, 1.0f);
    sum += weighted.weight * albedo_of(weighted.lobe, cos_theta, kind);
  }
  return sum;
}

Specularity Bsdf::specularity(Vec3f wo) const {
  constexpr float least_rough_alpha = 0.15f;  // Cycles'
  Specularity sum;
  float weights = 0;
  for (const WeightedLobe& weighted : lobes_.used()) {
    const float cos_theta = std::clamp(find_side(frame_of(weighted), wo).wo.z, 1e-3f, 1.0f);
    Color albedo(0.0f);
    for (const ScatterKind kind : {ScatterKind::diffuse, ScatterKind::glossy, ScatterKind::transmission})
      albedo += weighted.weight * albedo_of(weighted.lobe, cos_theta, kind);
    const float alpha = facet_alpha(weighted.lobe).value_or(1);
    sum.albedo += albedo * (1 - smooth_step(least_rough_alpha, alpha));
    sum.roughness += std::sqrt(alpha) * average(albedo);
    weights += average(albedo);
  }
  if (weights > 0) sum.roughness /= weights;
  return sum;
}

}  // namespace basicrt
