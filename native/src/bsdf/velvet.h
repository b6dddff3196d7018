// SPDX-License-Identifier: GPL-3.0-or-later
// Sheen by microfacets that stand on end: the Sheen BSDF's Ashikhmin type.
#pragma once

#include <algorithm>
#include <cmath>

#include "bsdf/lobe.h"
#include "math/warp.h"

namespace basicrt {

// Ashikhmin, Premoze and Shirley 2000, "A microfacet-based BRDF generator": an inverted Gaussian of the microfacets'
// slopes, with the shadowing of Cook and Torrance's grooves.
struct Velvet {
  static constexpr ScatterKind reflection_kind = ScatterKind::diffuse;

  float inverse_sigma2;

  [[nodiscard]] bool is_delta() const { return false; }

  [[nodiscard]] LobeValue eval(Vec3f wo, Vec3f wi) const {
    if (!(wi.z > 0) || !(wo.z > 0)) return {};
    LobeValue value{.pdf = pdf_hemisphere};
    const Vec3f normal = normalize(wo + wi);
    const float cos_incident = std::max(std::abs(dot(wo, normal)), 1e-5f), cos_o = std::max(wo.z, 1e-5f);
    const float sin2 = std::max(normal.x * normal.x + normal.y * normal.y, 2e-5f);
    // Never quite nothing, for black samples would count as absorbed though they have a density.
    const float exponent = std::min(normal.z * normal.z / sin2 * inverse_sigma2, 60.0f);
    const float density = std::exp(-exponent) * inverse_sigma2 * inv_pi / (sin2 * sin2);
    const float groove = 2 * std::max(normal.z / cos_incident, 1e-5f);
    const float unshadowed = std::min({1.0f, groove * cos_o, groove * std::max(wi.z, 1e-5f)});
    value.value = Color(density * unshadowed / (4 * cos_o));
    return value;
  }

  [[nodiscard]] std::optional<LobeSample> sample(Vec3f wo, float /*choice*/, Vec2f u) const {
    const Vec3f wi = sample_hemisphere(u);
    const LobeValue value = eval(wo, wi);
    if (!(value.pdf > 0)) return std::nullopt;
    return LobeSample{wi, value.value / value.pdf, value.pdf, false, ScatterKind::diffuse};
  }
};

[[nodiscard]] inline Velvet make_velvet(float roughness) {
  const float sigma = std::clamp(roughness, 0.01f, 1.0f);
  return {1 / (sigma * sigma)};
}

}  // namespace basicrt
