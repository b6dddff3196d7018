// SPDX-License-Identifier: GPL-3.0-or-later
// The geometry of refraction by a microfacet; `eta` is the index beyond the surface over that on the viewer's side.
#pragma once

#include <algorithm>
#include <cmath>

#include "math/vec.h"

namespace basicrt {

// Snell's law; unit length again, for rounding adds up from surface to surface.
[[nodiscard]] inline Vec3f refract(Vec3f wo, Vec3f normal, float cos_incident, float cos_transmitted, float eta) {
  return normalize(normal * (cos_incident / eta - cos_transmitted) - wo * (1 / eta));
}

// |d normal / d wi| * (wo . normal), for a normal that refracts wo into wi.
[[nodiscard]] inline float refraction_jacobian(Vec3f wo, Vec3f wi, Vec3f normal, float eta) {
  const float cos_o = dot(wo, normal), cos_i = dot(wi, normal);
  const float denominator = cos_i + cos_o / eta;
  return std::abs(cos_i * cos_o) / std::max(denominator * denominator, 1e-30f);
}

}  // namespace basicrt
