// SPDX-License-Identifier: GPL-3.0-or-later
// Reflection by microfacets (Cook and Torrance 1982), a mirror where they are smooth.
#pragma once

#include "bsdf/fresnel.h"
#include "bsdf/lobe.h"
#include "bsdf/microfacets.h"

namespace basicrt {

// Single scattering: what bounces between microfacets is lost, see albedo.h for its compensation.
template <class Fresnel>
struct MicrofacetReflection {
  static constexpr ScatterKind reflection_kind = ScatterKind::glossy;

  Microfacets microfacets;
  Fresnel fresnel;

  [[nodiscard]] bool is_delta() const { return microfacets.is_smooth(); }

  [[nodiscard]] LobeValue eval(Vec3f wo, Vec3f wi) const {
    if (is_delta() || !(wo.z > 0) || !(wi.z > 0)) return {};
    if (!microfacets.turn.is_none()) {
      wo = microfacets.turn.to_own(wo);
      wi = microfacets.turn.to_own(wi);
    }
    const Vec3f normal = normalize(wo + wi);
    const float density = microfacets.density(normal) / 4;
    return {fresnel(std::min(dot(wo, normal), 1.0f)) * (density * microfacets.masking_over_cosine(wo, wi)),
            density / microfacets.projected_area(wo)};
  }

  [[nodiscard]] std::optional<LobeSample> sample(Vec3f wo, float /*choice*/, Vec2f u) const {
    if (!(wo.z > 0)) return std::nullopt;
    if (is_delta()) return LobeSample{{-wo.x, -wo.y, wo.z}, fresnel(wo.z), 1, true, ScatterKind::glossy};
    const bool is_turned = !microfacets.turn.is_none();
    if (is_turned) wo = microfacets.turn.to_own(wo);
    const Vec3f normal = microfacets.sample_visible_normal(wo, u);
    const float cos_incident = dot(wo, normal);
    const Vec3f wi = normal * (2 * cos_incident) - wo;
    if (!(wi.z > 0)) return std::nullopt;
    const float area = microfacets.projected_area(wo);
    return LobeSample{is_turned ? microfacets.turn.from_own(wi) : wi,
                      fresnel(std::clamp(cos_incident, 0.0f, 1.0f)) * (area * microfacets.masking_over_cosine(wo, wi)),
                      microfacets.density(normal) / (4 * area), false, ScatterKind::glossy};
  }
};

}  // namespace basicrt
